// Ctrl-C and its like, turned into a stop request.
#pragma once

#include <array>
#include <atomic>
#include <stop_token>
#include <thread>

namespace fretwork::cli {

/// While it lives, SIGINT, SIGTERM and SIGHUP request a stop. A run that has not ended a moment later, because a
/// library cannot be interrupted, is ended from here with exit code 130: nothing was written yet. Only between
/// `begin_commit` and `end_commit`, while a finished file is put in its place, is it left to end by itself.
/// One at a time. Signals that were ignored before stay so.
class Interrupt {
  public:
    /// \throws FileError  no pipe could be made.
    Interrupt();
    ~Interrupt();
    Interrupt(const Interrupt&) = delete;
    Interrupt& operator=(const Interrupt&) = delete;

    [[nodiscard]] std::stop_token token() const { return source_.get_token(); }

    /// From here on results are being put in place. \throws Cancelled  a stop was requested before.
    void begin_commit();
    void end_commit() { committing_ = false; }

  private:
    void watch();

    std::stop_source source_;
    std::atomic<bool> committing_ = false, ended_ = false;
    std::array<int, 2> pipe_ = {-1, -1};
    std::jthread watcher_;
};

}  // namespace fretwork::cli
