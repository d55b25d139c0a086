#include "core/pipeline/stage_plan.h"

#include <cassert>

namespace fretwork {

StagePlan::StagePlan(std::vector<PlannedStage> stages, const RunControl& run) : stages_(std::move(stages)), run_(run) {
    for (const PlannedStage& stage : stages_) total_weight_ += stage.weight;
}

RunControl StagePlan::begin(std::string_view name) {
    assert(next_ < stages_.size() && stages_[next_].name == name);
    stage_started_ = Clock::now();
    const double from = done_weight_ / total_weight_;
    done_weight_ += stages_[next_].weight;
    const double to = next_ + 1 == stages_.size() ? 1.0 : done_weight_ / total_weight_;
    const RunControl slice = run_.slice(from, to);
    slice.checkpoint(name, 0.0);
    return slice;
}

void StagePlan::end() {
    const std::chrono::duration<double> elapsed = Clock::now() - stage_started_;
    seconds_.push_back({std::string(stages_[next_].name), elapsed.count()});
    ++next_;
}

double StagePlan::total_seconds() const {
    return std::chrono::duration<double>(Clock::now() - started_).count();
}

}  // namespace fretwork
