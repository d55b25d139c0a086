#include "cli/child_process.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <string_view>

#include "core/base/error.h"

extern char** environ;

namespace fretwork::cli {
namespace {

constexpr int kLookEveryMs = 50;

class Pipe {
  public:
    Pipe() {
        if (::pipe2(ends_.data(), O_CLOEXEC) != 0)
            throw FileError(fmt::format("no pipe could be made: {}", std::strerror(errno)));
    }
    ~Pipe() {
        close_end(0);
        close_end(1);
    }
    Pipe(const Pipe&) = delete;
    Pipe& operator=(const Pipe&) = delete;

    [[nodiscard]] int reading() const { return ends_[0]; }
    [[nodiscard]] int writing() const { return ends_[1]; }
    void close_writing() { close_end(1); }

  private:
    void close_end(std::size_t i) {
        if (ends_[i] >= 0) ::close(ends_[i]);
        ends_[i] = -1;
    }
    std::array<int, 2> ends_{-1, -1};
};

/// As the calls of the system take lists of texts.
std::vector<char*> pointers_to(const std::vector<std::string>& texts) {
    std::vector<char*> pointers;
    for (const std::string& text : texts) pointers.push_back(const_cast<char*>(text.c_str()));
    pointers.push_back(nullptr);
    return pointers;
}

/// Our environment with `variables` instead of those of the same name.
std::vector<std::string> environment_with(std::vector<std::string> variables) {
    const std::size_t own = variables.size();
    for (char** entry = environ; *entry != nullptr; ++entry) {
        const std::string_view text = *entry;
        const std::string_view name = text.substr(0, text.find('=') + 1);
        if (std::none_of(variables.begin(), variables.begin() + static_cast<std::ptrdiff_t>(own),
                         [&](const std::string& v) { return v.starts_with(name); }))
            variables.emplace_back(text);
    }
    return variables;
}

pid_t start(const std::vector<std::string>& arguments, const std::vector<std::string>& environment,
            const std::string& standard_input, const Pipe& out, const Pipe& err) {
    const std::vector<char*> argv = pointers_to(arguments), envp = pointers_to(environment);
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, standard_input.c_str(), O_RDONLY, 0);
    posix_spawn_file_actions_adddup2(&actions, out.writing(), STDOUT_FILENO);
    posix_spawn_file_actions_adddup2(&actions, err.writing(), STDERR_FILENO);
    posix_spawnattr_t attributes;
    posix_spawnattr_init(&attributes);
    // A group of its own, so that what it starts itself ends with it.
    posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP);
    posix_spawnattr_setpgroup(&attributes, 0);
    pid_t child = 0;
    const int failed = posix_spawnp(&child, argv[0], &actions, &attributes, argv.data(), envp.data());
    posix_spawnattr_destroy(&attributes);
    posix_spawn_file_actions_destroy(&actions);
    if (failed != 0) throw FileError(fmt::format("{}: cannot be run: {}", arguments.front(), std::strerror(failed)));
    return child;
}

int wait_for(pid_t child) {
    int status = 0;
    while (::waitpid(child, &status, 0) < 0 && errno == EINTR) continue;
    return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

/// Takes what there is; false at the end.
bool drain(int descriptor, std::string& into) {
    std::array<char, 1 << 14> block{};
    const ssize_t count = ::read(descriptor, block.data(), block.size());
    if (count < 0) return errno == EINTR;
    into.append(block.data(), static_cast<std::size_t>(count));
    return count > 0;
}

void listen(const Pipe& out, const Pipe& err, ProcessResult& result, const RunControl& run) {
    std::array<pollfd, 2> watched{pollfd{out.reading(), POLLIN, 0}, pollfd{err.reading(), POLLIN, 0}};
    const std::array<std::string*, 2> texts{&result.out, &result.err};
    while (watched[0].fd >= 0 || watched[1].fd >= 0) {
        run.throw_if_stopped();
        if (::poll(watched.data(), watched.size(), kLookEveryMs) <= 0) continue;
        for (std::size_t i = 0; i < watched.size(); ++i)
            if (watched[i].fd >= 0 && watched[i].revents != 0 && !drain(watched[i].fd, *texts[i])) watched[i].fd = -1;
    }
}

}  // namespace

ProcessResult run_process(const std::vector<std::string>& arguments, const RunControl& run,
                          const std::vector<std::string>& variables, const std::string& standard_input) {
    Pipe out, err;
    const pid_t child = start(arguments, environment_with(variables), standard_input, out, err);
    out.close_writing();
    err.close_writing();
    ProcessResult result;
    try {
        listen(out, err, result, run);
    } catch (...) {
        ::kill(-child, SIGKILL);
        wait_for(child);
        throw;
    }
    result.exit_code = wait_for(child);
    return result;
}

}  // namespace fretwork::cli
