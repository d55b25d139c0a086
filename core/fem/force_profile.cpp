#include "core/fem/force_profile.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>

#include "core/base/error.h"

namespace fretwork {
namespace {

/// Extent of each connected component of the mesh.
struct Bounds {
    Vec3 min_mm = Vec3::Constant(std::numeric_limits<double>::infinity());
    Vec3 max_mm = Vec3::Constant(-std::numeric_limits<double>::infinity());
};

std::vector<Bounds> component_bounds(const SurfaceVoxels& shell) {
    std::vector<Bounds> bounds;
    for (std::size_t v = 0; v < shell.size(); ++v) {
        if (shell.components[v] >= bounds.size()) bounds.resize(shell.components[v] + std::size_t{1});
        Bounds& b = bounds[shell.components[v]];
        b.min_mm = b.min_mm.cwiseMin(shell.points_mm[v]);
        b.max_mm = b.max_mm.cwiseMax(shell.points_mm[v]);
    }
    return bounds;
}

enum class Side { kLow, kHigh };

/// For each component the voxels within `share` of its extent from one end of an axis.
std::vector<std::vector<VoxelIndex>> end_slabs(const SurfaceVoxels& shell, const std::vector<Bounds>& bounds, int axis,
                                               Side side, double share) {
    std::vector<std::vector<VoxelIndex>> slabs(bounds.size());
    for (VoxelIndex v = 0; v < shell.size(); ++v) {
        const Bounds& b = bounds[shell.components[v]];
        const double reach = share * (b.max_mm[axis] - b.min_mm[axis]);
        const double at = shell.points_mm[v][axis];
        if (side == Side::kLow ? at <= b.min_mm[axis] + reach : at >= b.max_mm[axis] - reach)
            slabs[shell.components[v]].push_back(v);
    }
    return slabs;
}

std::vector<VoxelIndex> lowest_voxels(const SurfaceVoxels& shell, const std::vector<Bounds>& bounds, double share) {
    if (!(share > 0.0 && share <= 1.0))
        throw InvalidSetting("force profile: fixed share " + std::to_string(share) + "; expected above 0, at most 1");
    std::vector<VoxelIndex> fixed;
    for (const std::vector<VoxelIndex>& slab : end_slabs(shell, bounds, 2, Side::kLow, share))
        fixed.insert(fixed.end(), slab.begin(), slab.end());
    std::ranges::sort(fixed);
    return fixed;
}

/// The same total force on the slab of every component.
void push(const std::vector<std::vector<VoxelIndex>>& slabs, const Vec3& force_n, LoadCase& load_case) {
    for (const std::vector<VoxelIndex>& slab : slabs)
        if (!slab.empty()) load_case.loads.push_back({slab, force_n, 0.0});
}

}  // namespace

std::string place_name(const Vec3& at_mm) {
    std::string name = "(";
    for (int axis = 0; axis < 3; ++axis) name += std::to_string(std::lround(at_mm[axis])) + (axis < 2 ? ", " : ") mm");
    return name;
}

LoadCase gravity_case(const SurfaceVoxels& shell, const Vec3& direction, double fixed_share) {
    if (!(direction.norm() > 0.0) || !direction.allFinite())
        throw InvalidSetting("force profile: gravity has no direction; expected a vector other than zero");
    LoadCase result;
    result.name = "gravity";
    result.acceleration_g = direction.normalized();
    result.fixed = lowest_voxels(shell, component_bounds(shell), fixed_share);
    return result;
}

std::vector<LoadCase> handling_cases(const SurfaceVoxels& shell, double force_n, double fixed_share) {
    constexpr double kPatchShare = 0.06;
    const std::vector<Bounds> bounds = component_bounds(shell);
    const std::vector<VoxelIndex> base = lowest_voxels(shell, bounds, fixed_share);
    const std::array<const char*, 3> axis_name{"x", "y", "z"};
    std::vector<LoadCase> cases;
    for (int axis = 0; axis < 3; ++axis) {
        LoadCase pinch;
        pinch.name = std::string("pinch along ") + axis_name[static_cast<std::size_t>(axis)];
        pinch.fixed = base;
        push(end_slabs(shell, bounds, axis, Side::kHigh, kPatchShare), -force_n * Vec3::Unit(axis), pinch);
        // Along z the base is the other finger.
        if (axis < 2) push(end_slabs(shell, bounds, axis, Side::kLow, kPatchShare), force_n * Vec3::Unit(axis), pinch);
        cases.push_back(std::move(pinch));
    }
    // Stresses of opposite forces are opposite, and the score does not see signs: two cases stand for four sides.
    for (int axis = 0; axis < 2; ++axis) {
        LoadCase side_push;
        side_push.name = std::string("push at the top along ") + axis_name[static_cast<std::size_t>(axis)];
        side_push.fixed = base;
        push(end_slabs(shell, bounds, 2, Side::kHigh, kPatchShare), force_n * Vec3::Unit(axis), side_push);
        cases.push_back(std::move(side_push));
    }
    return cases;
}

}  // namespace fretwork
