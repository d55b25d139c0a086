// What every command of the program is made of.
#pragma once

#include <CLI/CLI.hpp>
#include <functional>
#include <string>

#include "cli/interrupt.h"
#include "core/base/run_control.h"

namespace fretwork::cli {

/// Exit codes of the program (docs/cli.md).
enum ExitCode : int {
    kDone = 0,
    kBadUsage = 1,
    kBadInput = 2,
    kCannotBeMet = 3,
    kBelowStandard = 4,
    kInternalError = 5,
    kCancelled = 130,
};

/// What the chosen command does once the line is parsed. Throws errors of core/base/error.h.
using Action = std::function<int(Interrupt&)>;

/// Each adds one command to the program; when it is the one that was called, `chosen` becomes its action.
void add_carve(CLI::App& program, Action& chosen);
void add_convert(CLI::App& program, Action& chosen);
void add_info(CLI::App& program, Action& chosen);
void add_pattern(CLI::App& program, Action& chosen);
void add_spec(CLI::App& program, Action& chosen);
void add_verify(CLI::App& program, Action& chosen);
void add_render(CLI::App& program, Action& chosen);

/// Runs the action and turns what it throws into one line on stderr and an exit code.
int run_action(const Action& action, Interrupt& interrupt);

}  // namespace fretwork::cli
