// Measures how wide solid features and holes of a carved wall are, from its mesh alone: knows nothing of voxels,
// labels or skeletons, so that it can judge the stages that do.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>

#include "core/mesh/triangle_mesh.h"

namespace fretwork::testing {

struct WidthJudgement {
    std::size_t samples = 0;
    double solid_share = 0.0;
    /// Share of the solid samples that no disc of solid of the asked width covers.
    double too_thin_share = 0.0;
    /// Share of the empty samples that no disc of empty of the asked width covers.
    double too_narrow_share = 0.0;
};

/// Spreads samples over `surface` (about one per `spacing_mm`^2), looks up whether the wall is there by going
/// `depth_mm` along the inward normal and asking `carved`, and tests each sample against discs of samples.
/// Discs are Euclidean balls around samples; they reach round an edge, not through to the other side of a wall.
/// \param counted  whether a place of the surface counts in the shares; all places bound the discs
WidthJudgement judge_widths(
    const TriangleMesh& surface, const TriangleMesh& carved, double depth_mm, double spacing_mm, double solid_width_mm,
    double hole_width_mm, const std::function<bool(const Vec3&)>& counted = [](const Vec3&) { return true; });

}  // namespace fretwork::testing
