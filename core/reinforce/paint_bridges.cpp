#include "core/reinforce/paint_bridges.h"

#include <algorithm>

namespace fretwork {
namespace {

constexpr float kSameSheetCosine = 0.5f;
constexpr float kAnyDirection = -2.0f;

double squared_distance(const VoxelCoord& a, const VoxelCoord& b) {
    double sum = 0.0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const double d = a[axis] - b[axis];
        sum += d * d;
    }
    return sum;
}

/// The discs of a path overlap: what they cover is listed several times.
void sort_once(PaintedVoxels& painted) {
    std::ranges::sort(painted.added);
    std::ranges::sort(painted.covered);
    painted.covered.erase(std::unique(painted.covered.begin(), painted.covered.end()), painted.covered.end());
}

}  // namespace

BridgePainter::BridgePainter(const SurfaceVoxels& shell, const Adjacency& firm, double radius_voxels)
    : shell_(&shell), firm_(&firm), radius_voxels_(radius_voxels), seen_(shell.size(), 0) {}

void BridgePainter::flood(VoxelIndex center, double radius_voxels, float least_cosine, SolidStates& solid,
                          PaintedVoxels& painted) {
    ++floods_;
    const double limit = radius_voxels * radius_voxels + 1e-9;
    const Vec3f& normal = shell_->normals[center];
    open_.assign(1, center);
    seen_[center] = floods_;
    while (!open_.empty()) {
        const VoxelIndex v = open_.back();
        open_.pop_back();
        if (solid[v] == SolidState::kEmpty) {
            solid[v] = SolidState::kSolid;
            painted.added.push_back(v);
        }
        painted.covered.push_back(v);
        for (const VoxelIndex w : firm_->of(v)) {
            if (seen_[w] == floods_ || shell_->normals[w].dot(normal) < least_cosine) continue;
            if (squared_distance(shell_->coords[w], shell_->coords[center]) > limit) continue;
            seen_[w] = floods_;
            open_.push_back(w);
        }
    }
}

PaintedVoxels BridgePainter::paint(std::span<const VoxelIndex> path, DilatedPart part, SolidStates& solid) {
    std::vector<VoxelIndex> centers(path.begin(), path.end());
    if (part == DilatedPart::kGap) std::erase_if(centers, [&](VoxelIndex v) { return solid[v] == SolidState::kSolid; });
    PaintedVoxels painted;
    const float least_cosine = part == DilatedPart::kWholePath ? kAnyDirection : kSameSheetCosine;
    for (const VoxelIndex center : centers) flood(center, radius_voxels_, least_cosine, solid, painted);
    sort_once(painted);
    return painted;
}

PaintedVoxels BridgePainter::paint_strand(std::span<const VoxelIndex> path, double radius_voxels, SolidStates& solid) {
    PaintedVoxels painted;
    for (const VoxelIndex center : path) flood(center, radius_voxels, kSameSheetCosine, solid, painted);
    sort_once(painted);
    return painted;
}

PaintedVoxels BridgePainter::paint_disc(VoxelIndex center, double radius_voxels, SolidStates& solid) {
    PaintedVoxels painted;
    flood(center, radius_voxels, kAnyDirection, solid, painted);
    sort_once(painted);
    return painted;
}

}  // namespace fretwork
