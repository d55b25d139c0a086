// Progress out, stop request in: one small object that callers lend to every long function.
#pragma once

#include <functional>
#include <stop_token>
#include <string_view>

namespace fretwork {

/// Copies are cheap and share the same listener. A default-made one reports nothing and never stops.
class RunControl {
  public:
    /// Called with the name of the stage and the share done of the whole run, in [0, 1], never
    /// falling. May be called from the thread that runs the stage only.
    using Progress = std::function<void(std::string_view stage, double fraction)>;

    RunControl() = default;
    explicit RunControl(Progress progress, std::stop_token stop = {});

    /// True once a stop was requested. Safe and cheap from any thread.
    [[nodiscard]] bool stop_requested() const { return stop_.stop_requested(); }

    /// \throws Cancelled  when a stop was requested. For inner loops; reports nothing.
    void throw_if_stopped() const;

    /// Reports `fraction` of this stage, in [0, 1], then honours a stop request.
    /// \throws Cancelled  when a stop was requested.
    void checkpoint(std::string_view stage, double fraction) const;

    /// A view in which [0, 1] stands for [from, to] of this one, so that a stage need not know how
    /// much of the run it is.
    [[nodiscard]] RunControl slice(double from, double to) const;

  private:
    Progress progress_;
    std::stop_token stop_;
    double from_ = 0.0;
    double to_ = 1.0;
};

}  // namespace fretwork
