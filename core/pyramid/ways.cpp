#include "core/pyramid/ways.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "core/base/parallel.h"
#include "core/pyramid/flat_ways.h"

namespace fretwork {
namespace {

// `step` turned into the plane of the unit normal `n`, length kept.
Vec3f lay_flat(const Vec3f& step, const Vec3f& n) {
    const Vec3f flat = step - n * n.dot(step);
    const float squared = flat.squaredNorm();
    return squared > 0.0F ? Vec3f(flat * std::sqrt(step.squaredNorm() / squared)) : Vec3f::Zero();
}

// A tangent vector of `from` carried to `to` by the smallest rotation between the two unit normals, which do
// not oppose.
Vec3f carry(const Vec3f& t, const Vec3f& from, const Vec3f& to) {
    const Vec3f axis = from.cross(to);
    return t + axis.cross(t) + axis.cross(axis.cross(t)) / (1.0F + from.dot(to));
}

}  // namespace

Ways::Ways(const PyramidLevel& level) : level_(level), cosine_(level.adjacency.neighbor.size()) {
    parallel_for(level.size(), 1024, [&](std::size_t v) {
        for (std::uint32_t e = level.adjacency.first[v]; e < level.adjacency.first[v + 1]; ++e)
            cosine_[e] = level.normals[v].dot(level.normals[level.adjacency.neighbor[e]]);
    });
}

VoxelIndex Ways::least_bent(VoxelIndex v, VoxelIndex w) const {
    const Adjacency& links = level_.adjacency;
    VoxelIndex between = v;
    float best = -1.0F, direct = -1.0F;
    std::uint32_t e = links.first[v];
    std::uint32_t f = links.first[w];
    while (e < links.first[v + 1] && f < links.first[w + 1]) {
        const VoxelIndex from_v = links.neighbor[e];
        const VoxelIndex from_w = links.neighbor[f];
        if (from_v == w) direct = cosine_[e];
        if (from_v == from_w) {
            const float cosine = std::min(cosine_[e], cosine_[f]);
            if (cosine > best) {
                best = cosine;
                between = from_v;
            }
        }
        e += from_v <= from_w;
        f += from_w <= from_v;
    }
    // The direct link may be the last of the row of v.
    for (; e < links.first[v + 1]; ++e)
        if (links.neighbor[e] == w) direct = cosine_[e];
    return direct >= best ? v : between;
}

Unfolder::BothWays Unfolder::unfold(VoxelIndex v, VoxelIndex w, bool smooth_way) const {
    if (!smooth_way)
        if (const std::optional<Vec3f> out = around_hinge(v, w))
            if (const std::optional<Vec3f> back = around_hinge(w, v)) return {*out, *back};
    const VoxelIndex between = ways_.least_bent(v, w);
    if (between == v) return {one_step(v, w), one_step(w, v)};
    return {over(v, between, w), over(w, between, v)};
}

Vec3f Unfolder::over(VoxelIndex v, VoxelIndex between, VoxelIndex w) const {
    return one_step(v, between) + carry(one_step(between, w), level_.normals[between], level_.normals[v]);
}

Vec3f Unfolder::one_step(VoxelIndex v, VoxelIndex w) const {
    if (const std::optional<Vec3f> hinged = around_hinge(v, w)) return *hinged;
    const float cosine = level_.normals[v].dot(level_.normals[w]);
    // The stretch of flat_ways.h.
    return (1.0F + (1.0F - cosine) / 12.0F) * lay_flat(level_.positions[w] - level_.positions[v], level_.normals[v]);
}

// Takes the surface as the two tangent planes, folded along the line where they meet, and turns w about this
// line into the plane of v. Exact on two flat faces. Nothing where the line does not lie between the two.
std::optional<Vec3f> Unfolder::around_hinge(VoxelIndex v, VoxelIndex w) const {
    const Vec3f& n = level_.normals[v];
    const Vec3f& m = level_.normals[w];
    const float cosine = n.dot(m);
    if (cosine >= kSmoothCosine || cosine < kTurningRoundCosine) return std::nullopt;
    const Vec3f line = n.cross(m).normalized();
    const Vec3f across_v = line.cross(n);  // in the plane of v, square to the line
    const Vec3f across_w = line.cross(m);
    const Vec3f way = level_.positions[w] - level_.positions[v];
    const float to_line = m.dot(way) / m.dot(across_v);
    const float from_line = n.dot(way) / n.dot(across_w);
    if (to_line * from_line < 0.0F) return std::nullopt;
    return (to_line + from_line) * across_v + line.dot(way) * line;
}

}  // namespace fretwork
