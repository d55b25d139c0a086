// Work in a process of its own, so that its peak of memory is its own.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace fretwork::bench {

struct ChildResult {
    std::string output;  ///< what `work` returned; empty for commands
    int exit_code = 0;   ///< 128 + signal where one ended it
    std::uint64_t peak_bytes = 0;
    double seconds = 0.0;      ///< wall clock
    double cpu_seconds = 0.0;  ///< all threads
};

/// Runs `work` in a copy of this process. Call before anything has started threads. An exception of `work` goes to
/// stderr and gives exit code 1.
/// \throws FileError  no process could be made.
ChildResult run_in_child(const std::function<std::string()>& work);

/// Runs a program found by its path; its stdout is dropped, its stderr passed on.
/// \throws FileError  no process could be made.
ChildResult run_command(const std::vector<std::string>& arguments);

/// Starts VmHWM of this process afresh, so that the next reading is the peak from here on.
/// \return false where the system does not allow it.
bool restart_peak_memory();

}  // namespace fretwork::bench
