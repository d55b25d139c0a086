// The `fretwork` program: parse, dispatch, exit code.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <cstdlib>

#ifdef __GLIBC__
#include <malloc.h>
#endif

#include "cli/command.h"
#include "core/base/detached.h"
#include "core/pipeline/carve.h"

namespace {

/// Stages hand large arrays on to each other: what one has given back serves the next, instead of fresh pages that the
/// system has to clear.
void keep_freed_memory() {
#ifdef __GLIBC__
    constexpr int kLargestKept = 32 << 20;  // the most that glibc allows
    mallopt(M_MMAP_THRESHOLD, kLargestKept);
    mallopt(M_TRIM_THRESHOLD, -1);
#endif
}

int report_usage(const CLI::App& program, const CLI::ParseError& error) {
    // Help and version are not mistakes, and are what was asked for: they go to stdout.
    if (error.get_exit_code() == 0) return program.exit(error);
    fmt::print(stderr, "fretwork: error: {} (see fretwork -h)\n", error.what());
    return fretwork::cli::kBadUsage;
}

}  // namespace

// NOLINTNEXTLINE(bugprone-exception-escape): nothing but running out of memory can throw before the parser
int main(int argc, char** argv) {
    using namespace fretwork::cli;
    keep_freed_memory();
    CLI::App program("Carves a pattern, given by an example picture, through the shell of an object.", "fretwork");
    program.set_version_flag("--version", "fretwork " + fretwork::version());
    program.require_subcommand(1);
    program.get_formatter()->column_width(34);
    program.footer(
        "Example:\n  fretwork carve bunny.off --size-mm 100 --pattern cells -o out.3mf\n\n"
        "Each command explains itself with -h.");

    Action chosen;
    add_carve(program, chosen);
    add_convert(program, chosen);
    add_info(program, chosen);
    add_pattern(program, chosen);
    add_spec(program, chosen);
    add_render(program, chosen);
    add_verify(program, chosen);
    try {
        program.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        return report_usage(program, error);
    }
    Interrupt interrupt;
    const int code = run_action(chosen, interrupt);
    if (!fretwork::detached_work_runs()) return code;
    std::fflush(nullptr);
    std::_Exit(code);
}
