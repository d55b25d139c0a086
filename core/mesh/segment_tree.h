// Distance to many segments.
#pragma once

#include <algorithm>
#include <limits>
#include <utility>
#include <vector>

#include "core/mesh/box_tree.h"
#include "core/mesh/triangle_math.h"

namespace fretwork {

using Segment = std::pair<Vec3, Vec3>;

/// Exact to rounding; const queries from any thread.
class SegmentTree {
  public:
    explicit SegmentTree(std::vector<Segment> segments) : segments_(std::move(segments)), tree_(boxes(segments_)) {}

    /// Infinite without segments.
    [[nodiscard]] double distance_mm(const Vec3& p) const {
        double best = std::numeric_limits<double>::infinity();
        tree_.near(p, best, [&](std::uint32_t i) {
            best = std::min(best, (p - closest_on_segment(p, segments_[i].first, segments_[i].second)).norm());
            return best;
        });
        return best;
    }

  private:
    static std::vector<Box> boxes(const std::vector<Segment>& segments) {
        std::vector<Box> all;
        all.reserve(segments.size());
        for (const auto& [a, b] : segments) all.push_back({a.cwiseMin(b), a.cwiseMax(b)});
        return all;
    }

    std::vector<Segment> segments_;
    BoxTree tree_;
};

}  // namespace fretwork
