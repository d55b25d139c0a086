#include "core/solidify/smooth_border.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Dense>

#include "core/base/parallel.h"

namespace fretwork {
namespace {

constexpr std::size_t kGrain = 512;
constexpr int kPasses = 14;
constexpr float kAnchorSlack = 0.5F;

/// Reach of the neighbours used, and the widths of the weights along and across the level line, in voxels.
constexpr float kReach = 2.4F;
constexpr float kAlong = 1.2F;
constexpr float kAcross = 0.6F;

Vec3f offset_voxels(const SurfaceVoxels& shell, VoxelIndex from, VoxelIndex to) {
    const Vec3 d = (shell.points_mm[to] - shell.points_mm[from]) / shell.grid.voxel_mm;
    return d.cast<float>();
}

/// The gradient is sought in the tangent plane: with the normal's own equation the system stays regular.
Vec3f gradient_at(const SurfaceVoxels& shell, const GeodesicLinks& links, const std::vector<float>& value,
                  VoxelIndex v) {
    Eigen::Matrix3f normal_matrix = Eigen::Matrix3f::Zero();
    Vec3f right = Vec3f::Zero();
    const Vec3f& n = shell.normals[v];
    for (std::uint32_t k = links.first[v]; k < links.first[v + 1]; ++k) {
        const float length = links.length_voxels[k];
        if (length > kReach) continue;
        const VoxelIndex u = links.neighbor[k];
        Vec3f d = offset_voxels(shell, v, u);
        d -= d.dot(n) * n;
        const float w = std::exp(-length * length / 2.0F);
        normal_matrix += w * d * d.transpose();
        right += w * (value[u] - value[v]) * d;
    }
    normal_matrix += n * n.transpose() + 1e-3F * Eigen::Matrix3f::Identity();
    Vec3f g = normal_matrix.ldlt().solve(right);
    return g - g.dot(n) * n;
}

}  // namespace

std::vector<float> signed_border_distance(const GeodesicLinks& links, const VoxelMask& solid, const RunControl& run) {
    VoxelMask empty(solid.size());
    for (std::size_t v = 0; v < solid.size(); ++v) empty[v] = solid[v] == 0 ? 1 : 0;
    const std::vector<float> to_solid = geodesic_distance(links, solid, kBorderReach + 0.5, run);
    const std::vector<float> to_empty = geodesic_distance(links, empty, kBorderReach + 0.5, run);
    std::vector<float> signed_distance(solid.size());
    for (std::size_t v = 0; v < solid.size(); ++v) {
        const float d = solid[v] != 0 ? to_empty[v] : to_solid[v];
        const float to_border = std::min(std::max(0.5F * d, d - 0.5F), static_cast<float>(kBorderReach));
        signed_distance[v] = solid[v] != 0 ? -to_border : to_border;
    }
    return signed_distance;
}

std::vector<Vec3f> surface_gradient(const SurfaceVoxels& shell, const GeodesicLinks& links,
                                    const std::vector<float>& value) {
    std::vector<Vec3f> gradient(shell.size());
    parallel_for(shell.size(), kGrain,
                 [&](std::size_t v) { gradient[v] = gradient_at(shell, links, value, static_cast<VoxelIndex>(v)); });
    return gradient;
}

void smooth_along_levels(const SurfaceVoxels& shell, const GeodesicLinks& links, const std::vector<float>& anchor,
                         const VoxelMask& fixed, std::vector<float>& value, const RunControl& run) {
    std::vector<float> next = value;
    for (int pass = 0; pass < kPasses; ++pass) {
        parallel_chunks(shell.size(), kGrain, [&](std::size_t begin, std::size_t end) {
            run.throw_if_stopped();
            for (std::size_t i = begin; i < end; ++i) {
                const auto v = static_cast<VoxelIndex>(i);
                if (fixed[v] != 0 || std::abs(anchor[v]) > 2.5F) continue;
                const Vec3f g = gradient_at(shell, links, value, v);
                const float slope = g.norm();
                if (slope < 1e-3F) continue;
                float sum = value[v], weights = 1.0F;
                for (std::uint32_t k = links.first[v]; k < links.first[v + 1]; ++k) {
                    const float length = links.length_voxels[k];
                    if (length > kReach) continue;
                    const VoxelIndex u = links.neighbor[k];
                    const float rise = g.dot(offset_voxels(shell, v, u));
                    const float across = rise / slope;
                    const float along2 = std::max(0.0F, length * length - across * across);
                    const float w =
                        std::exp(-0.5F * (across * across / (kAcross * kAcross) + along2 / (kAlong * kAlong)));
                    sum += w * (value[u] - rise);
                    weights += w;
                }
                next[v] = std::clamp(sum / weights, anchor[v] - kAnchorSlack, anchor[v] + kAnchorSlack);
            }
        });
        value = next;
    }
}

}  // namespace fretwork
