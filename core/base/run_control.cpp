#include "core/base/run_control.h"

#include <algorithm>
#include <utility>

#include "core/base/error.h"

namespace fretwork {

RunControl::RunControl(Progress progress, std::stop_token stop)
    : progress_(std::move(progress)), stop_(std::move(stop)) {}

void RunControl::throw_if_stopped() const {
    if (stop_.stop_requested()) throw Cancelled();
}

void RunControl::checkpoint(std::string_view stage, double fraction) const {
    throw_if_stopped();
    if (progress_) progress_(stage, from_ + (to_ - from_) * std::clamp(fraction, 0.0, 1.0));
}

RunControl RunControl::slice(double from, double to) const {
    RunControl part = *this;
    part.from_ = from_ + (to_ - from_) * from;
    part.to_ = from_ + (to_ - from_) * to;
    return part;
}

}  // namespace fretwork
