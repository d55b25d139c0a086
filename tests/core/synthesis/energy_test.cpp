#include "core/synthesis/energy.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstddef>

#include "core/exemplar/gaussian_stack.h"
#include "core/synthesis/optimize.h"
#include "core/synthesis/start_labels.h"
#include "core/synthesis/synthesis_presets.h"
#include "core/synthesis/synthesis_problem.h"
#include "synthesis_fixtures.h"

namespace fretwork {
namespace {

using namespace testing;

std::size_t wrap(double x, int size) {
    const auto i = static_cast<long>(std::floor(x)) % size;
    return static_cast<std::size_t>(i < 0 ? i + size : i);
}

/// Section 4.2.2 of the paper term by term, from nothing but the frames and the finest level.
class PaperEnergy {
  public:
    PaperEnergy(const PyramidLevel& level, const Exemplar& exemplar, const TexelFrames& frames)
        : level_(level), exemplar_(exemplar), frames_(frames), texels_(build_gaussian_stack(exemplar, {}).levels[0]) {}

    [[nodiscard]] double total(bool per_neighbor) const {
        double sum = 0;
        for (VoxelIndex v = 0; v < level_.size(); ++v) {
            const double n = std::max(1.0, static_cast<double>(level_.neighborhoods.count[v]));
            sum += transition(v) / (per_neighbor ? n : 1.0) + distortion(v);
        }
        return sum;
    }

  private:
    using Color = Eigen::Vector4d;

    /// I at distance d from voxel v under its own label.
    [[nodiscard]] Color color(VoxelIndex v, const Vec3f& d) const {
        const Vec2 at = texel_of(frames_[v], d);
        const std::uint32_t t = texels_[wrap(at.y(), exemplar_.height) * static_cast<std::size_t>(exemplar_.width) +
                                        wrap(at.x(), exemplar_.width)];
        return Color(t & 255u, t >> 8 & 255u, t >> 16 & 255u, t >> 24) / 255.0;
    }
    [[nodiscard]] double transition(VoxelIndex v) const {
        const Neighborhoods& n = level_.neighborhoods;
        double sum = 0;
        for (std::uint32_t i = 0; i < n.count[v]; ++i) {
            const VoxelIndex w = n.neighbor(v, i);
            const Vec3f here = Vec3f::Zero();
            sum += (color(v, here) - color(w, n.way_back(v, i))).squaredNorm();
            sum += (color(v, n.way_out(v, i)) - color(w, here)).squaredNorm();
        }
        return sum;
    }
    [[nodiscard]] double distortion(VoxelIndex v) const {
        const Vec3f normal = frames_[v].du.cross(-frames_[v].dv).normalized();
        return 1.0 - static_cast<double>(level_.normals[v].dot(normal));
    }

    const PyramidLevel& level_;
    const Exemplar& exemplar_;
    const TexelFrames& frames_;
    std::vector<std::uint32_t> texels_;
};

TEST_CASE("energy: equals the formulas of the paper", "[synthesis]") {
    const bool per_neighbor = GENERATE(true, false);
    const PyramidCase c = sphere_case(24);
    const Exemplar e = hills(53, 40);
    SynthesisSettings settings;
    settings.orientation = Orientation::kFree;
    settings.normalize_energy = per_neighbor;
    // A poor result, so that there is energy to compare.
    settings.candidates = 2;
    settings.coarse_passes = 1;
    settings.start_level = 1;
    Synthesizer synthesizer(c.pyramid, e, settings);
    synthesizer.synthesize();
    const double expected = PaperEnergy(c.pyramid.levels[0], e, synthesizer.frames()).total(per_neighbor);
    REQUIRE(expected > 0.005 * static_cast<double>(c.shell.size()));
    // Texels are looked up from positions rounded to 2^-16 of the period, a few of which fall into the
    // pixel beside.
    CHECK(synthesizer.energy() == Approx(expected).epsilon(0.01));
}

TEST_CASE("energy: one label over a flat plate costs its distortion alone", "[synthesis]") {
    const PyramidCase c = plate_case(32);
    const Exemplar e = stripes(48);
    SynthesisProblem problem(c.pyramid, e, synthesis_settings(SynthesisPreset::kPaper));
    problem.prepare({});
    const ProblemLevel& level = problem.levels[0];
    const double energy = total_energy(problem, level, constant_labels(problem, level));
    double distortion = 0;
    for (const Vec3f& n : level.shell->normals)
        distortion += 1.0 - static_cast<double>(n.dot(problem.planes.normal(0)));
    CHECK(energy == Approx(distortion).epsilon(1e-3));
}

TEST_CASE("energy: bounds of a random candidate stay below its energy", "[synthesis][property]") {
    const PyramidCase c = sphere_case(24);
    const Exemplar e = discs(48, 4.0, false);
    SynthesisProblem problem(c.pyramid, e, {});
    problem.prepare({});
    const ProblemLevel& level = problem.levels[0];
    const Choices choices = random_labels(problem, level);
    VoxelEnergy energy(problem, level);
    for (VoxelIndex v = 0; v < level.size(); v += 7) {
        energy.look_at(v, choices);
        const Choice& own = choices[v];
        const Energy full = energy.of({own.label, own.part, own.texel}, kNoEnergy);
        const PlaneIndex plane = problem.transforms.plane_of(own.label.linear);
        const Energy half = energy.first_half(own.texel);
        REQUIRE(half >= 0);
        REQUIRE(half <= energy.bound(own.texel, half));
        REQUIRE(energy.bound(own.texel, half) <= energy.bound(own.texel, half, plane));
        REQUIRE(energy.bound(own.texel, half, plane) <= full);
        REQUIRE(energy.of({own.label, own.part, own.texel}, full) == full);
        REQUIRE(energy.of({own.label, own.part, own.texel}, full - 1) > full - 1);
    }
}

TEST_CASE("energy: random planes lie in the cone, and fill it", "[synthesis][property]") {
    const double cone = GENERATE(5.0, 25.0, 60.0);
    const PyramidCase c = sphere_case(20);
    const Exemplar e = hills(32, 32);
    SynthesisSettings settings;
    settings.cone_deg = cone;
    settings.directions = 2000;  // no direction is farther than 3.5 degrees from a plane
    SynthesisProblem problem(c.pyramid, e, settings);
    problem.prepare({});
    const ProblemLevel& level = problem.levels[0];
    double widest = 0;
    const Choices choices = random_labels(problem, level);
    for (std::size_t v = 0; v < level.size(); ++v) {
        const Vec3f& n = problem.planes.normal(problem.transforms.plane_of(choices[v].label.linear));
        const double angle =
            std::acos(std::min(1.0, static_cast<double>(n.dot(level.shell->normals[v])))) * 180 / std::numbers::pi;
        REQUIRE(angle <= cone + 3.5);
        widest = std::max(widest, angle);
    }
    CHECK(widest > 0.9 * cone);
}

TEST_CASE("energy: a transported label shows the neighbour what it shows, on the voxel's own plane",
          "[synthesis][property]") {
    const PyramidCase c = sphere_case(32);
    const Exemplar e = hills(64, 50);
    SynthesisProblem problem(c.pyramid, e, {});
    problem.prepare({});
    const ProblemLevel& level = problem.levels[0];
    const Choices choices = random_labels(problem, level);
    const Neighborhoods& n = level.shell->neighborhoods;
    for (VoxelIndex v = 0; v < level.size(); v += 5) {
        const NeighborBlock& block = *n.of(v);
        const Choice& from = choices[block.neighbor[0]];
        const Candidate moved = transported_candidate(problem, level, v, from, {block.out_xy[0], low16(block.z[0])});
        REQUIRE(problem.transforms.plane_of(moved.label.linear) == level.best_plane[v]);
        const Vec3f offset = n.way_out(v, 0);
        const double u =
            moved.texel.u / 4294967296.0 * e.width + static_cast<double>(problem.map.u_vector(moved.part).dot(offset));
        const double w =
            moved.texel.v / 4294967296.0 * e.height + static_cast<double>(problem.map.v_vector(moved.part).dot(offset));
        REQUIRE(std::fabs(std::remainder(u - from.texel.u / 4294967296.0 * e.width, e.width)) < 0.01);
        REQUIRE(std::fabs(std::remainder(w - from.texel.v / 4294967296.0 * e.height, e.height)) < 0.01);
    }
}

}  // namespace
}  // namespace fretwork
