#include "core/pipeline/label_patches.h"

#include <algorithm>
#include <cmath>

#include "core/base/disjoint_sets.h"

namespace fretwork {
namespace {

constexpr float kSamePixel = 0.5F;
constexpr float kSameTurn = 0.02F;  ///< of a step's length

/// Distance on a ring.
float apart(float a, float b, int period) {
    const auto p = static_cast<float>(period);
    const float d = std::fmod(std::abs(a - b), p);
    return std::min(d, p - d);
}

bool alike(const Vec3f& a, const Vec3f& b) {
    return (a - b).squaredNorm() <= kSameTurn * kSameTurn * a.squaredNorm();
}

}  // namespace

std::vector<std::uint16_t> label_patches(const SurfaceVoxels& shell, const TexelFrames& frames,
                                         const Exemplar& exemplar) {
    DisjointSets patches(shell.size());
    for (VoxelIndex v = 0; v < shell.size(); ++v)
        for (const VoxelIndex n : shell.adjacency.of(v)) {
            if (n < v) continue;
            const TexelFrame &a = frames[v], &b = frames[n];
            if (!alike(a.du, b.du) || !alike(a.dv, b.dv)) continue;
            const Vec3f step = ((shell.points_mm[n] - shell.points_mm[v]) / shell.grid.voxel_mm).cast<float>();
            if (apart(a.u + a.du.dot(step), b.u, exemplar.width) < kSamePixel &&
                apart(a.v + a.dv.dot(step), b.v, exemplar.height) < kSamePixel)
                patches.unite(v, n);
        }
    std::vector<std::uint16_t> label(shell.size(), 0);
    std::uint32_t next = 0;
    for (VoxelIndex v = 0; v < shell.size(); ++v) {
        // Sets are named by their lowest member, which has its number by now.
        const std::uint32_t first = patches.find(v);
        label[v] = first == v ? static_cast<std::uint16_t>(1 + next++ % 65535) : label[first];
    }
    return label;
}

}  // namespace fretwork
