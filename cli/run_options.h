// Flags about the run itself, shared by the commands that take their time.
#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <string>

#include "cli/interrupt.h"
#include "core/base/run_control.h"
#include "core/pipeline/carve.h"

namespace fretwork::cli {

struct RunOptions {
    int threads = 0;
    std::string max_memory;  ///< "4G", "800M"; empty: no limit
    std::string progress = "auto";
    bool quiet = false;
};

void add_run_flags(CLI::App& command, RunOptions& options);

/// \throws InvalidSetting  a size that is not a number with an optional K, M, G or T
RunLimits limits_of(const RunOptions& options);

RunControl control_of(const RunOptions& options, const Interrupt& interrupt);

}  // namespace fretwork::cli
