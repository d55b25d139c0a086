// The stages of a run as one list, from which the shares of progress follow and in which seconds are noted.
#pragma once

#include <chrono>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/run_control.h"
#include "core/pipeline/run_report.h"

namespace fretwork {

struct PlannedStage {
    std::string_view name;
    double weight;  ///< share of a typical run's time, in any unit
};

/// Hands out slices of one RunControl in the order of the list. Progress rises from 0 to 1 whatever the
/// stages report, and a stage that ends early is made up for at its end.
class StagePlan {
  public:
    StagePlan(std::vector<PlannedStage> stages, const RunControl& run);

    /// Runs `work(RunControl)` as the next stage of the list, which must have this name, and notes its seconds.
    /// \return what `work` returns
    template <class Work>
    auto run(std::string_view name, const Work& work) {
        const RunControl slice = begin(name);
        const Ending ending{*this, slice};
        return work(slice);
    }

    [[nodiscard]] std::vector<StageSeconds> take_seconds() { return std::move(seconds_); }
    [[nodiscard]] double total_seconds() const;

  private:
    using Clock = std::chrono::steady_clock;
    struct Ending {
        StagePlan& plan;
        RunControl slice;
        ~Ending() { plan.end(); }
    };
    RunControl begin(std::string_view name);
    void end();

    std::vector<PlannedStage> stages_;
    RunControl run_;
    double total_weight_ = 0.0;
    double done_weight_ = 0.0;
    std::size_t next_ = 0;
    Clock::time_point started_ = Clock::now();
    Clock::time_point stage_started_ = started_;
    std::vector<StageSeconds> seconds_;
};

/// Slices for a loop whose number of turns is not known: each turn gets `share` of what is left.
class OpenEndedSlices {
  public:
    OpenEndedSlices(const RunControl& run, double share) : run_(run), share_(share) {}
    RunControl next() {
        const double from = done_;
        done_ += (1.0 - done_) * share_;
        return run_.slice(from, done_);
    }

  private:
    RunControl run_;
    double share_;
    double done_ = 0.0;
};

}  // namespace fretwork
