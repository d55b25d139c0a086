// Which of many points is nearest.
#pragma once

#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include "core/mesh/box_tree.h"

namespace fretwork {

/// Ties go to the lowest number. Cost  some microseconds a question among 100,000 points; may be asked by many threads.
class NearestPoint {
  public:
    /// \param points_mm  at least one. \throws Cancelled  `run` asked to stop.
    explicit NearestPoint(std::vector<Vec3> points_mm, const RunControl& run = {})
        : points_mm_(std::move(points_mm)), tree_(boxes_around(points_mm_), run) {}

    [[nodiscard]] std::uint32_t to(const Vec3& at_mm) const {
        double least = std::numeric_limits<double>::infinity();
        std::uint32_t nearest = 0;
        tree_.near(at_mm, least, [&](std::uint32_t i) {
            const double distance = (points_mm_[i] - at_mm).norm();
            if (distance < least || (distance == least && i < nearest)) {
                least = distance;
                nearest = i;
            }
            return least;
        });
        return nearest;
    }

  private:
    static std::vector<Box> boxes_around(const std::vector<Vec3>& points_mm) {
        std::vector<Box> boxes;
        boxes.reserve(points_mm.size());
        for (const Vec3& p : points_mm) boxes.push_back({p, p});
        return boxes;
    }

    std::vector<Vec3> points_mm_;
    BoxTree tree_;
};

}  // namespace fretwork
