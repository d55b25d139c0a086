#include "child_process.h"

#include <fcntl.h>
#include <spawn.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <cstdio>
#include <exception>
#include <fstream>

#include "core/base/error.h"

extern char** environ;

namespace fretwork::bench {
namespace {

double seconds_of(const timeval& t) {
    return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
}

/// Waits for the end and notes what the process has used.
void finish(pid_t child, std::chrono::steady_clock::time_point start, ChildResult& result) {
    int status = 0;
    rusage used{};
    if (wait4(child, &status, 0, &used) != child) throw FileError("a child process cannot be waited for");
    result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    result.cpu_seconds = seconds_of(used.ru_utime) + seconds_of(used.ru_stime);
    result.peak_bytes = static_cast<std::uint64_t>(used.ru_maxrss) * 1024;
    result.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

/// Never returns: what follows a fork must not run the parent's destructors.
[[noreturn]] void work_and_exit(const std::function<std::string()>& work, int pipe_end) {
    int code = 0;
    try {
        const std::string output = work();
        for (std::size_t at = 0; at < output.size();) {
            const ssize_t written = write(pipe_end, output.data() + at, output.size() - at);
            if (written <= 0) break;
            at += static_cast<std::size_t>(written);
        }
    } catch (const std::exception& e) {
        std::fprintf(stderr, "%s\n", e.what());
        code = 1;
    }
    close(pipe_end);
    _exit(code);
}

}  // namespace

ChildResult run_in_child(const std::function<std::string()>& work) {
    std::array<int, 2> ends{};
    if (pipe(ends.data()) != 0) throw FileError("no pipe could be made");
    std::fflush(nullptr);
    ChildResult result;
    const auto start = std::chrono::steady_clock::now();
    const pid_t child = fork();
    if (child < 0) throw FileError("no process could be made");
    if (child == 0) {
        close(ends[0]);
        work_and_exit(work, ends[1]);
    }
    close(ends[1]);
    std::array<char, 4096> buffer{};
    for (ssize_t got = 0; (got = read(ends[0], buffer.data(), buffer.size())) > 0;)
        result.output.append(buffer.data(), static_cast<std::size_t>(got));
    close(ends[0]);
    finish(child, start, result);
    return result;
}

ChildResult run_command(const std::vector<std::string>& arguments) {
    std::vector<char*> argv;
    for (const std::string& a : arguments) argv.push_back(const_cast<char*>(a.c_str()));
    argv.push_back(nullptr);
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
    ChildResult result;
    const auto start = std::chrono::steady_clock::now();
    pid_t child = 0;
    const int failed = posix_spawn(&child, argv[0], &actions, nullptr, argv.data(), environ);
    posix_spawn_file_actions_destroy(&actions);
    if (failed != 0) throw FileError("cannot run " + arguments.front());
    finish(child, start, result);
    return result;
}

bool restart_peak_memory() {
    std::ofstream file("/proc/self/clear_refs");
    file << "5" << std::flush;
    return file.good();
}

}  // namespace fretwork::bench
