#include "likeness/surface_windows.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <optional>

#include "core/base/counter_random.h"
#include "core/base/parallel.h"
#include "core/synthesis/orientation_field.h"

namespace fretwork::likeness {
namespace {

/// The way to a neighbouring voxel laid flat into the tangent plane, its length kept.
Vec3f laid_flat(const PyramidLevel& shell, VoxelIndex from, VoxelIndex to) {
    const Vec3f way = shell.positions[to] - shell.positions[from];
    const Vec3f flat = way - way.dot(shell.normals[from]) * shell.normals[from];
    const float length = flat.norm();
    return length > 1e-6F ? Vec3f(flat * (way.norm() / length)) : Vec3f(Vec3f::Zero());
}

/// A square patch of points one voxel apart; nothing where it leaves the surface.
std::optional<PatternPicture> patch_around(const PyramidLevel& shell, const ShownPattern& pattern,
                                           const PatternPicture& reference, VoxelIndex middle, int side) {
    const TexelFrame& frame = pattern.frames[middle];
    const Vec3f& normal = shell.normals[middle];
    const auto tangent = [&](const Vec3f& x) { return Vec3f(x - x.dot(normal) * normal); };
    SurfacePoint start{middle, Vec3f::Zero(), tangent(frame.du).normalized(), Vec3f::Zero()};
    // As seen from outside, whatever the label does: a mirrored picture is not the picture.
    start.down = start.right.cross(normal);

    const float reach = 0.5F * static_cast<float>(side - 1);
    constexpr float on_surface = 1.0F;
    PatternPicture patch{side, side, false, {}};
    SurfacePoint row = walk(shell, start, -reach, -reach);
    for (int y = 0; y < side; ++y) {
        SurfacePoint point = row;
        for (int x = 0; x < side; ++x) {
            if (point.beside.norm() > on_surface) return std::nullopt;
            patch.pixels.push_back(pattern.at(reference, point.voxel, point.beside));
            if (x + 1 < side) point = walk(shell, point, 1.0F, 0.0F);
        }
        row = walk(shell, row, 0.0F, 1.0F);
    }
    return patch;
}

/// The middle of a patch, as one window.
void write_window(const PatternPicture& patch, float* out) {
    const int x0 = (patch.width - kWindowSide) / 2, y0 = (patch.height - kWindowSide) / 2;
    for (int j = 0; j < kWindowSide; ++j)
        for (int i = 0; i < kWindowSide; ++i, out += 4) std::ranges::copy(patch.at(x0 + i, y0 + j), out);
}

}  // namespace

PatternPixel ShownPattern::at(const PatternPicture& reference, VoxelIndex v, const Vec3f& d) const {
    const Over laid = over.empty() ? Over::kNothing : over[v];
    if (laid == Over::kPaint) return paint;
    const TexelFrame& f = frames[v];
    PatternPixel pixel = reference.read(static_cast<double>(f.u + f.du.dot(d)) / pixels_per_voxel,
                                        static_cast<double>(f.v + f.dv.dot(d)) / pixels_per_voxel);
    if (laid != Over::kNothing) pixel[3] = laid == Over::kSolid ? 1.0F : 0.0F;
    return pixel;
}

SurfacePoint walk(const PyramidLevel& shell, SurfacePoint at, float right_voxels, float down_voxels) {
    at.beside += right_voxels * at.right + down_voxels * at.down;
    while (true) {
        VoxelIndex next = at.voxel;
        Vec3f step = Vec3f::Zero();
        float left = at.beside.squaredNorm() - 1e-4F;
        for (const VoxelIndex n : shell.adjacency.of(at.voxel)) {
            const Vec3f way = laid_flat(shell, at.voxel, n);
            if (const float rest = (at.beside - way).squaredNorm(); rest < left) left = rest, next = n, step = way;
        }
        if (next == at.voxel) return at;
        const Vec3f &from = shell.normals[at.voxel], &to = shell.normals[next];
        at.beside = turn_into_plane(at.beside - step, from, to);
        at.right = turn_into_plane(at.right, from, to);
        at.down = turn_into_plane(at.down, from, to);
        at.voxel = next;
    }
}

std::vector<Windows> surface_windows(const PyramidLevel& shell, const ShownPattern& pattern,
                                     const PatternPicture& reference, std::size_t count, int levels,
                                     std::uint64_t seed) {
    const int side = kWindowSide << (levels - 1);
    std::vector<std::optional<PatternPicture>> patches(count);
    parallel_for(count, 16, [&](std::size_t i) {
        const auto v =
            index_below(counter_random(seed, RandomStream::kTest, 2, i, 0), static_cast<std::uint32_t>(shell.size()));
        patches[i] = patch_around(shell, pattern, reference, v, side);
    });
    std::erase_if(patches, [](const auto& patch) { return !patch; });

    std::vector<Windows> result(static_cast<std::size_t>(levels));
    for (Windows& w : result) w.resize(static_cast<Eigen::Index>(patches.size()), kWindowSize);
    for (std::size_t i = 0; i < patches.size(); ++i) {
        PatternPicture patch = std::move(*patches[i]);
        for (std::size_t l = 0; l < result.size(); ++l) {
            if (l > 0) patch = halved(patch);
            write_window(patch, result[l].row(static_cast<Eigen::Index>(i)).data());
        }
    }
    return result;
}

}  // namespace fretwork::likeness
