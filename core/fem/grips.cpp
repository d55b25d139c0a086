#include "core/fem/grips.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <set>
#include <string>
#include <utility>

#include "core/fem/facing_sheets.h"
#include "core/graph/shortest_path_forest.h"

namespace fretwork {
namespace {

constexpr double kFingerMm = 5.0;
constexpr double kFingerShare = 0.1;  // of the longest side
constexpr double kFriction = 0.5;
constexpr std::size_t kTriesPerGrip = 12;

double extent_mm(const SurfaceVoxels& shell) {
    Eigen::AlignedBox3d box;
    for (const Vec3& p : shell.points_mm) box.extend(p);
    return box.sizes().maxCoeff();
}

/// Voxels one after the other, each as far as can be from all before it.
std::vector<VoxelIndex> spread_voxels(const SurfaceVoxels& shell, std::size_t count) {
    std::vector<VoxelIndex> chosen = {0};
    std::vector<double> distance(shell.size(), std::numeric_limits<double>::infinity());
    while (chosen.size() < std::min(count, shell.size())) {
        const Vec3 last = shell.points_mm[chosen.back()];
        VoxelIndex farthest = 0;
        for (VoxelIndex v = 0; v < shell.size(); ++v) {
            distance[v] = std::min(distance[v], (shell.points_mm[v] - last).squaredNorm());
            if (distance[v] > distance[farthest]) farthest = v;
        }
        chosen.push_back(farthest);
    }
    return chosen;
}

/// What a finger covers: of the surface around a voxel, what faces as it does.
std::vector<VoxelIndex> finger_patch(const SurfaceVoxels& shell, VoxelIndex middle, double radius_mm) {
    std::vector<VoxelIndex> patch = {middle};
    std::set<VoxelIndex> known = {middle};
    for (std::size_t next = 0; next < patch.size(); ++next)
        for (const VoxelIndex v : shell.adjacency.of(patch[next])) {
            const bool near = (shell.points_mm[v] - shell.points_mm[middle]).norm() <= radius_mm;
            if (near && shell.normals[v].dot(shell.normals[middle]) > 0.0F && known.insert(v).second)
                patch.push_back(v);
        }
    std::ranges::sort(patch);
    return patch;
}

Vec3 middle_of(const SurfaceVoxels& shell, const std::vector<VoxelIndex>& patch) {
    Vec3 sum = Vec3::Zero();
    for (const VoxelIndex v : patch) sum += shell.points_mm[v];
    return sum / static_cast<double>(patch.size());
}

struct Grip {
    Vec3 from_mm, to_mm;  ///< middles of the patches
    std::vector<VoxelIndex> from, to;
};

/// The grip that has one finger on `v`; none where there is nothing to hold against, or it would slip off.
std::optional<Grip> grip_at(const SurfaceVoxels& shell, VoxelIndex v, double longest_mm) {
    const VoxelIndex w = facing_voxel(shell, v, 2.0 * longest_mm);
    if (w == kNoVoxel) return std::nullopt;
    const double finger_mm = std::min(kFingerMm, kFingerShare * longest_mm);
    Grip grip{{}, {}, finger_patch(shell, v, finger_mm), finger_patch(shell, w, finger_mm)};
    grip.from_mm = middle_of(shell, grip.from);
    grip.to_mm = middle_of(shell, grip.to);
    const Vec3 way = grip.to_mm - grip.from_mm;
    if (way.norm() < 2.0 * shell.grid.voxel_mm) return std::nullopt;
    const double within = std::cos(std::atan(kFriction)) * way.norm();
    const bool holds =
        -shell.normals[v].cast<double>().dot(way) >= within && shell.normals[w].cast<double>().dot(way) >= within;
    return holds ? std::optional(std::move(grip)) : std::nullopt;
}

/// Are the fingers where they are in another grip, whichever is on which side?
bool same_grip(const Grip& a, const Grip& b, double apart_mm) {
    const auto close = [&](const Vec3& p, const Vec3& q) { return (p - q).norm() < apart_mm; };
    return (close(a.from_mm, b.from_mm) && close(a.to_mm, b.to_mm)) ||
           (close(a.from_mm, b.to_mm) && close(a.to_mm, b.from_mm));
}

std::string name_of(const Grip& grip) {
    return "grip at " + place_name(grip.from_mm) + " and " + place_name(grip.to_mm);
}

}  // namespace

std::vector<LoadCase> grip_cases(const SurfaceVoxels& shell, std::size_t most, double force_n) {
    if (shell.size() == 0 || most == 0) return {};
    const double longest_mm = extent_mm(shell);
    std::vector<Grip> grips;
    for (const VoxelIndex v : spread_voxels(shell, kTriesPerGrip * most)) {
        if (grips.size() == most) break;
        std::optional<Grip> grip = grip_at(shell, v, longest_mm);
        const bool known = grip && std::ranges::any_of(grips, [&](const Grip& other) {
                               return same_grip(*grip, other, kFingerShare * longest_mm);
                           });
        if (grip && !known) grips.push_back(*std::move(grip));
    }
    std::vector<LoadCase> cases;
    for (Grip& grip : grips) {
        LoadCase& pinch = cases.emplace_back();
        pinch.name = name_of(grip);
        const Vec3 push_n = force_n * (grip.to_mm - grip.from_mm).normalized();
        pinch.loads.push_back({std::move(grip.from), push_n, 0.0});
        pinch.loads.push_back({std::move(grip.to), -push_n, 0.0});
    }
    return cases;
}

}  // namespace fretwork
