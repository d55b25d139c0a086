#include "cli/run_options.h"

#include <fmt/format.h>

#include <charconv>

#include "cli/progress.h"
#include "core/base/error.h"

namespace fretwork::cli {
namespace {

std::uint64_t bytes_of(const std::string& text) {
    double number = 0.0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    std::string_view unit(end, static_cast<std::size_t>(text.data() + text.size() - end));
    if (unit.ends_with('B')) unit.remove_suffix(1);
    double factor = 0.0;
    if (unit.empty())
        factor = 1.0;
    else if (unit == "K" || unit == "k")
        factor = 1024.0;
    else if (unit == "M")
        factor = 1024.0 * 1024.0;
    else if (unit == "G")
        factor = 1024.0 * 1024.0 * 1024.0;
    else if (unit == "T")
        factor = 1024.0 * 1024.0 * 1024.0 * 1024.0;
    const double bytes = number * factor;
    if (error != std::errc{} || !(bytes >= 1.0 && bytes < 1e18))
        throw InvalidSetting(fmt::format("--max-memory {}: expected a size such as 4G or 800M", text));
    return static_cast<std::uint64_t>(bytes);
}

}  // namespace

void add_run_flags(CLI::App& command, RunOptions& o) {
    const char* group = "Run";
    command.add_option("--threads", o.threads, "Threads to use; 0 = all. Does not change the result")
        ->type_name("N")
        ->check(CLI::Range(0, 1024))
        ->group(group);
    command.add_option("--max-memory", o.max_memory, "Refuse to start what would need more, such as 4G or 800M")
        ->type_name("SIZE")
        ->group(group);
    command
        .add_option("--progress", o.progress, "auto: a bar on a terminal; none; json: one object per line on stderr")
        ->type_name("STYLE")
        ->group(group);
    command.add_flag("-q,--quiet", o.quiet, "Only errors on stderr")->group(group);
}

RunLimits limits_of(const RunOptions& options) {
    return {options.threads, options.max_memory.empty() ? 0 : bytes_of(options.max_memory)};
}

RunControl control_of(const RunOptions& options, const Interrupt& interrupt) {
    const ProgressStyle style = progress_style(options.progress);
    return shown_progress(options.quiet && style == ProgressStyle::kAuto ? ProgressStyle::kNone : style,
                          interrupt.token());
}

}  // namespace fretwork::cli
