#include "cli/interrupt.h"

#include <fcntl.h>
#include <pthread.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <ctime>
#include <string_view>

#include "cli/command.h"
#include "core/base/error.h"

namespace fretwork::cli {
namespace {

constexpr int kWakeUp = SIGUSR1;                 // from the destructor to its own thread
constexpr long kGraceNanoseconds = 120'000'000;  // a stage stops within 0.2 s, and so does the program

sigset_t watched_signals() {
    sigset_t set;
    sigemptyset(&set);
    for (const int signal : {SIGINT, SIGTERM, SIGHUP, kWakeUp}) sigaddset(&set, signal);
    return set;
}

void leave_at_once() {
    constexpr std::string_view message = "\nfretwork: cancelled\n";
    [[maybe_unused]] const auto written = ::write(STDERR_FILENO, message.data(), message.size());
    ::_exit(kCancelled);
}

}  // namespace

Interrupt::Interrupt() {
    // Threads inherit the mask, so that the signals reach nobody but the watcher. A closed pipe on stdout is
    // told by write() instead of a signal.
    const sigset_t set = watched_signals();
    pthread_sigmask(SIG_BLOCK, &set, nullptr);
    std::signal(SIGPIPE, SIG_IGN);
    watcher_ = std::jthread([this](const std::stop_token& ended) { watch(ended); });
}

Interrupt::~Interrupt() {
    watcher_.request_stop();
    pthread_kill(watcher_.native_handle(), kWakeUp);
}

void Interrupt::begin_commit() {
    committing_ = true;
    if (!source_.stop_requested()) return;
    committing_ = false;
    throw Cancelled();
}

void Interrupt::watch(const std::stop_token& ended) {
    const sigset_t set = watched_signals();
    while (!ended.stop_requested()) {
        const int signal = sigwaitinfo(&set, nullptr);
        if (signal < 0 || signal == kWakeUp) continue;
        source_.request_stop();
        const timespec grace{0, kGraceNanoseconds};
        nanosleep(&grace, nullptr);
        if (!ended.stop_requested() && !committing_) leave_at_once();
    }
}

}  // namespace fretwork::cli
