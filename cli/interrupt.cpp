#include "cli/interrupt.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstring>
#include <ctime>
#include <string>
#include <string_view>

#include "cli/command.h"
#include "core/base/error.h"

namespace fretwork::cli {
namespace {

constexpr char kEnded = 'e';                     // from the destructor to the watcher
constexpr long kGraceNanoseconds = 120'000'000;  // a stage stops within 0.2 s, and so does the program
constexpr std::array kSignals = {SIGINT, SIGTERM, SIGHUP};

/// Where the handler writes; signals come to a program, not to an object.
std::atomic<int> signal_pipe = -1;

void on_signal(int signal) {
    const int error = errno;
    const char byte = static_cast<char>(signal);
    [[maybe_unused]] const auto written = ::write(signal_pipe, &byte, 1);
    errno = error;
}

void leave_at_once() {
    constexpr std::string_view message = "\nfretwork: cancelled\n";
    [[maybe_unused]] const auto written = ::write(STDERR_FILENO, message.data(), message.size());
    ::_exit(kCancelled);
}

}  // namespace

Interrupt::Interrupt() {
    if (::pipe2(pipe_.data(), O_CLOEXEC) != 0)
        throw FileError(std::string("no pipe for signals: ") + std::strerror(errno));
    signal_pipe = pipe_[1];
    // A handler and no mask: libraries start threads before main does, and those would take a signal that the others
    // block, and end the program.
    struct sigaction handler {};
    handler.sa_handler = on_signal;
    handler.sa_flags = SA_RESTART;
    for (const int signal : kSignals) {
        struct sigaction before {};
        ::sigaction(signal, nullptr, &before);
        if (before.sa_handler != SIG_IGN) ::sigaction(signal, &handler, nullptr);  // nohup stays nohup
    }
    std::signal(SIGPIPE, SIG_IGN);  // a closed pipe on stdout is told by write() instead
    watcher_ = std::jthread([this] { watch(); });
}

Interrupt::~Interrupt() {
    ended_ = true;
    [[maybe_unused]] const auto written = ::write(pipe_[1], &kEnded, 1);
    watcher_.join();
    // The pipe stays open: a signal may still come.
}

void Interrupt::begin_commit() {
    committing_ = true;
    if (!source_.stop_requested()) return;
    committing_ = false;
    throw Cancelled();
}

void Interrupt::watch() {
    char byte = 0;
    while (!ended_) {
        if (::read(pipe_[0], &byte, 1) != 1 || byte == kEnded) continue;
        source_.request_stop();
        const timespec grace{0, kGraceNanoseconds};
        nanosleep(&grace, nullptr);
        if (!ended_ && !committing_) leave_at_once();
    }
}

}  // namespace fretwork::cli
