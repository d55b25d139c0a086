// Candidates for geometric queries: which of many boxes are near a point or met by a segment.
#pragma once

#include <cstdint>
#include <memory>
#include <span>

#include "core/base/run_control.h"
#include "core/base/vec.h"

namespace fretwork {

struct Box {
    Vec3 min_mm, max_mm;
};

/// A tree over boxes, built and walked by Embree in float. Boxes are grown and queries widened by more than float's
/// rounding, so that no box that qualifies in exact arithmetic is left out; some that do not may be visited as well.
/// The caller decides each candidate in double. The order of visits is unspecified. Queries are const and thread-safe.
/// Cost  about 0.7 s and 150 MB for a million boxes; a query around a microsecond plus its visits.
class BoxTree {
  public:
    /// Boxes are named by their place in `boxes`, which is not kept. All coordinates must be finite.
    /// \throws Cancelled  `run` asked to stop.
    explicit BoxTree(std::span<const Box> boxes, const RunControl& run = {});
    ~BoxTree();
    BoxTree(BoxTree&&) noexcept;
    BoxTree& operator=(BoxTree&&) noexcept;

    /// Calls `visit(item)` for boxes within `reach_mm` of the point. It returns the reach that is still of interest,
    /// in mm; a return above the reach so far changes nothing.
    template <class Visit>
    void near(const Vec3& point_mm, double reach_mm, const Visit& visit) const {
        walk_near(
            point_mm, reach_mm,
            [](const void* self, std::uint32_t item) { return (*static_cast<const Visit*>(self))(item); }, &visit);
    }

    /// Calls `visit(item)` for boxes met by the segment. It returns the parameter in [0, 1] past which nothing is of
    /// interest any more.
    template <class Visit>
    void along(const Vec3& from_mm, const Vec3& to_mm, const Visit& visit) const {
        walk_along(
            from_mm, to_mm,
            [](const void* self, std::uint32_t item) { return (*static_cast<const Visit*>(self))(item); }, &visit);
    }

  private:
    using Visitor = double (*)(const void* self, std::uint32_t item);
    void walk_near(const Vec3& point_mm, double reach_mm, Visitor visit, const void* self) const;
    void walk_along(const Vec3& from_mm, const Vec3& to_mm, Visitor visit, const void* self) const;

    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace fretwork
