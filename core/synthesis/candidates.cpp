#include "core/synthesis/candidates.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/base/counter_random.h"

namespace fretwork {
namespace {

constexpr std::uint32_t kTurns = 256;  // steps of the angle at which a plane is drawn in its cone

/// The position of the middle of a pixel.
std::uint32_t middle_of(std::uint32_t pixel, int size) {
    return static_cast<std::uint32_t>((static_cast<std::uint64_t>(2 * pixel + 1) << 31) /
                                      static_cast<std::uint64_t>(size));
}

std::uint64_t scramble(std::uint64_t bits) {
    bits *= 0xD1342543DE82EF95ull;
    return bits ^ (bits >> 29);
}

}  // namespace

Candidate transported_candidate(const SynthesisProblem& problem, const ProblemLevel& level, VoxelIndex v,
                                const Choice& neighbor, const LevelOffset& offset) {
    const PlaneIndex plane = level.best_plane[v];
    const Vec3f& from = problem.planes.normal(problem.transforms.plane_of(neighbor.label.linear));
    const Vec3f up = turn_into_plane(-problem.map.v_vector(neighbor.part), from, problem.planes.normal(plane));
    const LinearIndex linear = problem.transforms.index(plane, problem.transforms.rotation_towards(plane, up));
    const LinearPart part = problem.transforms.linear_part(linear);
    const TexelPosition step = problem.map.project(part, offset, level.index);
    const FixedPoint& p = level.points[v];
    const Label label =
        label_through(problem.map, linear, part, p, {neighbor.texel.u - step.u, neighbor.texel.v - step.v});
    return {label, part, texel_at(problem.map, part, label.origin, p)};
}

Candidate snapped_candidate(const SynthesisProblem& problem, const ProblemLevel& level, VoxelIndex v,
                            const FixedPoint& probe, const Choice& neighbor) {
    const Exemplar& e = problem.exemplar;
    TexelPosition at = texel_at(problem.map, neighbor.part, neighbor.label.origin, probe);
    const auto distance = [&](std::int64_t x, std::int64_t y) {
        const std::int64_t w = e.width, h = e.height;
        return e.feature_distance_px[static_cast<std::size_t>((y % h + h) % h * w + (x % w + w) % w)];
    };
    // The distance field leads to the border; one pixel more leads into the solid.
    for (int step = 0; step < 4 && !problem.solid_at(at); ++step) {
        const auto x = static_cast<std::int64_t>(problem.map.column(at.u));
        const auto y = static_cast<std::int64_t>(problem.map.row(at.v));
        const float dx = 0.5F * (distance(x + 1, y) - distance(x - 1, y));
        const float dy = 0.5F * (distance(x, y + 1) - distance(x, y - 1));
        const float length = std::sqrt(dx * dx + dy * dy);
        if (!(length > 0.1F)) break;
        const float way = (distance(x, y) + 1.0F) / length;
        const auto share = [](float pixels, int size) {
            return static_cast<std::uint32_t>(
                static_cast<std::int64_t>(pixels * (4294967296.0F / static_cast<float>(size))));
        };
        at.u -= share(way * dx, e.width);
        at.v -= share(way * dy, e.height);
    }
    const Label label = label_through(problem.map, neighbor.label.linear, neighbor.part, probe, at);
    return {label, neighbor.part, texel_at(problem.map, neighbor.part, label.origin, level.points[v])};
}

RandomCandidates::RandomCandidates(const SynthesisProblem& problem, const ProblemLevel& level)
    : problem_(problem),
      level_(level),
      cone_height_(static_cast<float>(1.0 - std::cos(problem.settings.cone_deg * std::numbers::pi / 180.0))) {
    for (std::uint32_t i = 0; i < kTurns; ++i) {
        const double angle = 2.0 * std::numbers::pi * i / kTurns;
        cosine_.push_back(static_cast<float>(std::cos(angle)));
        sine_.push_back(static_cast<float>(std::sin(angle)));
    }
}

PlaneIndex RandomCandidates::plane(VoxelIndex v, std::uint64_t bits) const {
    const Vec3f& n = level_.shell->normals[v];
    const PlaneIndex best = level_.best_plane[v];
    // A frame around the normal; that of the best plane, made orthogonal to it.
    const Vec3f& up = problem_.planes.up(best);
    const Vec3f a = (up - up.dot(n) * n).normalized(), b = n.cross(a);
    const float z = 1.0F - cone_height_ * static_cast<float>(bits >> 8 & 0xFFFFu) * 0x1p-16F;
    const float r = std::sqrt(std::max(0.0F, 1.0F - z * z));
    const std::size_t turn = bits & 0xFFu;
    return problem_.planes.nearest(z * n + r * (cosine_[turn] * a + sine_[turn] * b));
}

std::uint32_t RandomCandidates::rotation(VoxelIndex v, PlaneIndex plane, std::uint64_t bits) const {
    const PlaneTransforms& transforms = problem_.transforms;
    const bool defined = !level_.field.direction.empty() && level_.field.certainty[v] > 0.0F;
    if (!defined) return index_below(bits, transforms.rotations());
    const Vec3f& n = level_.shell->normals[v];
    Vec3f up = turn_into_plane(level_.field.direction[v], n, problem_.planes.normal(plane));
    if (problem_.settings.symmetric && (bits & 1u) != 0) up = -up;
    return transforms.rotation_towards(plane, up);
}

TexelPosition RandomCandidates::texel(std::uint64_t bits) {
    return {static_cast<std::uint32_t>(bits >> 32 & 0xFFFF0000u), static_cast<std::uint32_t>(bits >> 16 & 0xFFFF0000u)};
}

TexelPosition RandomCandidates::solid_texel(std::uint64_t bits) const {
    const std::vector<std::uint32_t>& list = (bits >> 63) != 0 ? problem_.solid_texels.deep : problem_.solid_texels.all;
    const std::uint32_t pixel = list[index_below(bits << 1, static_cast<std::uint32_t>(list.size()))];
    const auto width = static_cast<std::uint32_t>(problem_.map.width());
    return {middle_of(pixel % width, problem_.map.width()), middle_of(pixel / width, problem_.map.height())};
}

Candidate RandomCandidates::candidate(VoxelIndex v, PlaneIndex plane, const TexelPosition& texel, const FixedPoint& p,
                                      std::uint64_t bits) const {
    const LinearIndex linear = problem_.transforms.index(plane, rotation(v, plane, scramble(bits)));
    const LinearPart part = problem_.transforms.linear_part(linear);
    Label label = label_through(problem_.map, linear, part, p, texel);
    if (const auto steps = static_cast<std::uint32_t>(problem_.settings.translations); steps > 0) {
        const auto snap = [&](std::uint32_t share) { return (((share * steps) >> 16) * 65536u / steps) & 0xFFFFu; };
        label.origin = snap(label.origin >> 16) << 16 | snap(label.origin & 0xFFFFu);
    }
    return {label, part, texel_at(problem_.map, part, label.origin, level_.points[v])};
}

}  // namespace fretwork
