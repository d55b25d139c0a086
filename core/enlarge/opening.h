// Where a set on the surface is wide: its morphological opening by a geodesic disc. Internal to this folder.
#pragma once

#include <cstddef>
#include <limits>
#include <vector>

#include "core/base/run_control.h"
#include "core/enlarge/geodesic_links.h"

namespace fretwork {

/// Sums of links of one voxel come out a little under or over the half widths they are compared with.
inline constexpr float kWidthSlack = 1e-3F;

/// The part of the shell that an operation looks at: all of it, or what lies near some voxels.
class Nearby {
  public:
    /// All of the shell.
    Nearby() = default;
    /// \param distance  of every voxel from the nearest of those that it is about
    explicit Nearby(std::vector<float> distance) : distance_(std::move(distance)) {}

    [[nodiscard]] bool holds(std::size_t v, double reach_voxels) const {
        return distance_.empty() || static_cast<double>(distance_[v]) <= reach_voxels;
    }

  private:
    std::vector<float> distance_;
};

/// Voxels of a set that lie in a disc of `width_voxels` inside the set. A disc that touches the border has its centre
/// half a width from it, which is half a width from the first voxel outside less the half voxel by which that voxel's
/// centre lies beyond; an even width centres its disc between two voxels, which the missing half allows for.
/// \param outside              what is not in the set
/// \param distance_to_outside  up to half a width at least
/// \param near, reach_voxels   where both are known; right for voxels that are half a width farther in
VoxelMask opened(const GeodesicLinks& links, const VoxelMask& outside, const std::vector<float>& distance_to_outside,
                 double width_voxels, const RunControl& run, const Nearby& near = {},
                 double reach_voxels = std::numeric_limits<double>::infinity());

}  // namespace fretwork
