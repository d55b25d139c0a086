// A draft is the coarse part of the full run: the same cells, and the same large features.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstddef>
#include <map>
#include <numeric>
#include <string>
#include <vector>

#include "core/exemplar/builtin/builtin_patterns.h"
#include "core/shell/cell_rows.h"
#include "core/synthesis/optimize.h"
#include "core/synthesis/synthesizer.h"
#include "synthesis_fixtures.h"

namespace fretwork {
namespace {

using namespace testing;

/// Share of solid voxels within each cell of `cell_voxels` full voxels: a low-pass view of a pattern.
using Coarse = std::map<VoxelCoord, double>;

constexpr int kCellVoxels = 8;

PyramidCase case_of(const TriangleMesh& mesh, int resolution, int halvings) {
    PyramidCase c;
    c.shell = voxelize(mesh, {.resolution = resolution, .halvings = halvings});
    c.pyramid = build_pyramid(c.shell, 8 - halvings);
    return c;
}

Coarse pattern_of(const PyramidCase& c, const Exemplar& e, std::uint64_t seed, int halvings) {
    SynthesisSettings settings;
    settings.seed = seed;
    settings.pixels_per_voxel = std::ldexp(0.5, halvings);
    settings.skipped_levels = halvings;
    Synthesizer synthesizer(c.pyramid, e, settings);
    synthesizer.synthesize();
    const SolidStates solid = read_solid(e, synthesizer.frames());
    std::map<VoxelCoord, std::pair<double, double>> sums;
    const int cells = kCellVoxels >> halvings;
    for (std::size_t v = 0; v < solid.size(); ++v) {
        VoxelCoord at = c.shell.coords[v];
        for (std::int32_t& x : at) x /= cells;
        sums[at].first += solid[v] == SolidState::kSolid ? 1.0 : 0.0;
        sums[at].second += 1.0;
    }
    Coarse coarse;
    for (const auto& [at, sum] : sums) coarse[at] = sum.first / sum.second;
    return coarse;
}

double correlation(const Coarse& a, const Coarse& b) {
    std::vector<std::pair<double, double>> both;
    for (const auto& [at, value] : a)
        if (const auto other = b.find(at); other != b.end()) both.emplace_back(value, other->second);
    const auto n = static_cast<double>(both.size());
    double mean_a = 0, mean_b = 0, aa = 0, bb = 0, ab = 0;
    for (const auto& [x, y] : both) mean_a += x / n, mean_b += y / n;
    for (const auto& [x, y] : both) {
        aa += (x - mean_a) * (x - mean_a);
        bb += (y - mean_b) * (y - mean_b);
        ab += (x - mean_a) * (y - mean_b);
    }
    return ab / std::sqrt(aa * bb);
}

TEST_CASE("draft: shows the large features of the full run with the same seed, and of no other",
          "[synthesis][property]") {
    const std::string model = GENERATE("sphere", "vase");
    const std::string pattern = GENERATE("cells", "waves");
    const TriangleMesh mesh = model == "sphere" ? make_icosphere(10, 5) : make_vase(50.0, 60, 30);
    const Exemplar e = make_builtin(pattern);
    const Coarse full = pattern_of(case_of(mesh, 160, 0), e, 3, 0);
    for (const int halvings : {1, 2}) {
        const PyramidCase coarse = case_of(mesh, 160, halvings);
        const double same = correlation(full, pattern_of(coarse, e, 3, halvings));
        const double other = correlation(full, pattern_of(coarse, e, 4, halvings));
        CAPTURE(model, pattern, halvings, same, other);
        CHECK(same > 0.9);
        CHECK(std::fabs(other) < 0.4);
    }
}

TEST_CASE("draft: random numbers follow the place of a voxel and not its index", "[synthesis]") {
    const PyramidCase full = case_of(make_thin_plate(20, 15, 0.3), 40, 0),
                      draft = case_of(make_thin_plate(20, 15, 0.3), 40, 1);
    const Exemplar e = discs(48, 5.0);
    SynthesisSettings settings;
    SynthesisProblem fine(full.pyramid, e, settings);
    settings.skipped_levels = 1;
    settings.pixels_per_voxel = 2.0;
    SynthesisProblem coarse(draft.pyramid, e, settings);
    fine.prepare({});
    coarse.prepare({});
    REQUIRE(fine.levels.size() == coarse.levels.size() + 1);
    for (std::size_t l = 0; l < coarse.levels.size(); ++l) {
        const ProblemLevel &a = fine.levels[l + 1], &b = coarse.levels[l];
        CHECK(a.rank == b.rank);
        CHECK(a.height == b.height);
        REQUIRE(a.size() == b.size());
        std::vector<std::uint64_t> places;
        for (VoxelIndex v = 0; v < a.size(); ++v) {
            CHECK(a.place(v) == b.place(v));
            places.push_back(a.place(v));
        }
        // Sheets of one cell are told apart.
        std::sort(places.begin(), places.end());
        CHECK(std::adjacent_find(places.begin(), places.end()) == places.end());
    }
}

}  // namespace
}  // namespace fretwork
