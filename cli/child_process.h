// Other programs, run and listened to.
#pragma once

#include <string>
#include <vector>

#include "core/base/run_control.h"

namespace fretwork::cli {

struct ProcessResult {
    int exit_code = 0;  ///< 128 + signal where one ended it
    std::string out;
    std::string err;
};

/// Runs a program found along PATH and waits for it. A stop ends it and its children.
/// \param arguments  the program first
/// \param variables  NAME=VALUE of the environment that it sees beside and instead of ours
/// \param standard_input  a file that it reads from
/// \throws FileError  it cannot be started. \throws Cancelled
ProcessResult run_process(const std::vector<std::string>& arguments, const RunControl& run,
                          const std::vector<std::string>& variables = {},
                          const std::string& standard_input = "/dev/null");

}  // namespace fretwork::cli
