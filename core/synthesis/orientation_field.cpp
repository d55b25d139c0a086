#include "core/synthesis/orientation_field.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "core/base/parallel.h"

namespace fretwork {
namespace {

using Vectors = std::vector<Vec3f>;

Vectors project(const std::vector<Vec3f>& normals, const Vec3f& direction) {
    Vectors tangents(normals.size());
    parallel_for(normals.size(), 4096,
                 [&](std::size_t v) { tangents[v] = direction - direction.dot(normals[v]) * normals[v]; });
    return tangents;
}

/// One Jacobi step of the screened Laplace equation of the header.
Vectors smooth_once(const PyramidLevel& level, const Vectors& x, const Vectors& projected, float pull, bool symmetric) {
    Vectors next(x.size());
    parallel_for(x.size(), 1024, [&](std::size_t v) {
        const float weight = pull * projected[v].squaredNorm();
        const auto neighbors = level.adjacency.of(static_cast<VoxelIndex>(v));
        Vec3f sum = pull * projected[v].norm() * projected[v];
        if (symmetric && sum.dot(x[v]) < 0.0F) sum = -sum;
        for (const VoxelIndex w : neighbors) {
            const Vec3f turned = turn_into_plane(x[w], level.normals[w], level.normals[v]);
            sum += symmetric && turned.dot(x[v]) < 0.0F ? Vec3f(-turned) : turned;
        }
        const float total = weight + static_cast<float>(neighbors.size());
        next[v] = total > 0.0F ? Vec3f(sum / total) : x[v];
        next[v] -= next[v].dot(level.normals[v]) * level.normals[v];
    });
    return next;
}

Vectors prolong(const PyramidLevel& fine, const PyramidLevel& coarse, const Vectors& x) {
    Vectors result(fine.size());
    parallel_for(fine.size(), 4096, [&](std::size_t v) {
        const VoxelIndex parent = fine.parent[v];
        result[v] = turn_into_plane(x[parent], coarse.normals[parent], fine.normals[v]);
    });
    return result;
}

/// \param full  length of a vector that deserves full trust
OrientationField to_field(const Vectors& x, float full) {
    OrientationField field;
    field.direction.resize(x.size());
    field.certainty.resize(x.size());
    parallel_for(x.size(), 4096, [&](std::size_t v) {
        const float length = x[v].norm();
        field.direction[v] = length > 1e-6F ? Vec3f(x[v] / length) : Vec3f(Vec3f::Zero());
        field.certainty[v] = length > 1e-6F ? std::min(1.0F, length / full) : 0.0F;
    });
    return field;
}

}  // namespace

std::vector<OrientationField> orientation_fields(const VoxelPyramid& pyramid, int levels,
                                                 const OrientationFieldSettings& settings, const RunControl& run) {
    const auto count = static_cast<std::size_t>(levels);
    const Vec3f direction = settings.direction.normalized();
    std::vector<OrientationField> fields(count);
    if (!(settings.smoothing_voxels > 0.0)) {
        for (std::size_t l = 0; l < count; ++l)
            fields[l] = to_field(project(pyramid.levels[l].normals, direction), 1e-6F);
        return fields;
    }

    // Coarser levels than the synthesis uses only help the field.
    Vectors x;
    for (std::size_t l = pyramid.levels.size(); l-- > 0;) {
        run.throw_if_stopped();
        const PyramidLevel& level = pyramid.levels[l];
        const Vectors projected = project(level.normals, direction);
        x = x.empty() ? projected : prolong(level, pyramid.levels[l + 1], x);
        // On a shell of cells of side h a sum of differences over the neighbours is about 3.3 h^2 Laplacians.
        const double cells = settings.smoothing_voxels / std::ldexp(1.0, static_cast<int>(l));
        const auto pull = static_cast<float>(3.3 / (cells * cells));
        const int rank = static_cast<int>(l) + settings.skipped_levels;
        const int steps = rank >= 3 ? 40 : rank == 2 ? 16 : rank == 1 ? 6 : 2;
        for (int i = 0; i < steps; ++i) x = smooth_once(level, x, projected, pull, settings.symmetric);
        if (l < count) fields[l] = to_field(x, 0.5F);
    }
    return fields;
}

}  // namespace fretwork
