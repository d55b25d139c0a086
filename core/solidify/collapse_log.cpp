#include "core/solidify/collapse_log.h"

#include <algorithm>

namespace fretwork {

void CollapseLog::append(std::vector<Corner> entries) {
    entries_.insert(entries_.end(), entries.begin(), entries.end());
    first_.clear();
}

/// Calls `visit` for each triangle that the collapse changed.
template <class Visit>
void CollapseLog::for_each_touched(std::uint32_t place, const Visit& visit) const {
    const Corner edge = entries_[place];
    for (const std::uint32_t t : state_.mesh.touched_by(edge)) visit(t);
    for (std::uint32_t k = 0; k < entries_[place + 1]; ++k) visit(entries_[place + 2 + k] / 3);
}

void CollapseLog::list_by_triangle() {
    first_.assign(state_.shape.size() + 1, 0);
    const auto for_each_entry = [&](const auto& visit) {
        for (std::uint32_t place = 0; place < entries_.size(); place += 2 + entries_[place + 1]) visit(place);
    };
    for_each_entry([&](std::uint32_t place) { for_each_touched(place, [&](std::uint32_t t) { ++first_[t + 1]; }); });
    for (std::size_t t = 0; t + 1 < first_.size(); ++t) first_[t + 1] += first_[t];
    by_triangle_.resize(first_.back());
    end_.assign(first_.begin(), first_.end() - 1);
    for_each_entry([&](std::uint32_t place) {
        for_each_touched(place, [&](std::uint32_t t) { by_triangle_[end_[t]++] = place; });
    });
}

std::vector<std::uint32_t> CollapseLog::take_back(std::span<const std::uint32_t> triangles, int count) {
    if (first_.empty()) list_by_triangle();
    changed_.clear();
    for (const std::uint32_t t : triangles)
        for (int k = 0; k < count && end_[t] > first_[t]; ++k) take_back(by_triangle_[end_[t] - 1]);
    std::sort(changed_.begin(), changed_.end());
    changed_.erase(std::unique(changed_.begin(), changed_.end()), changed_.end());
    std::erase_if(changed_, [&](std::uint32_t t) { return !state_.mesh.triangle_alive(t); });
    return changed_;
}

void CollapseLog::take_back(std::uint32_t place) {
    std::vector<std::uint32_t> waiting = {place};
    while (!waiting.empty()) {
        std::uint32_t later = kNone;
        for_each_touched(waiting.back(), [&](std::uint32_t t) {
            const std::uint32_t last = by_triangle_[end_[t] - 1];
            if (last != waiting.back()) later = last;
        });
        if (later != kNone) {
            waiting.push_back(later);
            continue;
        }
        for_each_touched(waiting.back(), [&](std::uint32_t t) {
            --end_[t];
            changed_.push_back(t);
        });
        undo(waiting.back());
        waiting.pop_back();
    }
}

void CollapseLog::undo(std::uint32_t place) {
    const Corner edge = entries_[place];
    const std::uint32_t u = state_.mesh.vertex(edge);
    const std::span<const Corner> stayed(entries_.data() + place + 2, entries_[place + 1]);
    state_.mesh.undo(edge, stayed);
    state_.locked[u] = 1;
    std::vector<std::uint32_t> fan = {edge / 3, state_.mesh.facing(edge) / 3};
    for (const Corner c : stayed) fan.push_back(c / 3);
    for (const std::uint32_t t : fan) state_.measure(t);
    file_again(u, fan);
}

/// The samples of the fan around u go to the nearest of its triangles; u is a vertex again.
void CollapseLog::file_again(std::uint32_t u, const std::vector<std::uint32_t>& fan) {
    std::vector<std::uint32_t> samples;
    for (const std::uint32_t t : fan) {
        for (std::uint32_t s = state_.first_sample[t]; s != kNone; s = state_.next_sample[s])
            if (s != u) samples.push_back(s);
        state_.first_sample[t] = kNone;
    }
    for (const std::uint32_t s : samples) {
        double nearest2 = std::numeric_limits<double>::infinity();
        std::uint32_t nearest = kNone;
        for (const std::uint32_t t : fan) {
            const Triangle& k = state_.mesh.triangle(t);
            const Vec3& at = state_.mesh.position(s);
            const Vec3 on = closest_on_triangle(at, state_.mesh.position(k[0]), state_.mesh.position(k[1]),
                                                state_.mesh.position(k[2]));
            const double d2 = (on - at).squaredNorm();
            if (d2 >= nearest2) continue;
            nearest2 = d2;
            nearest = t;
        }
        state_.file(s, nearest);
    }
}

}  // namespace fretwork
