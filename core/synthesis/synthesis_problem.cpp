#include "core/synthesis/synthesis_problem.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/base/parallel.h"
#include "core/shell/cell_rows.h"

namespace fretwork {
namespace {

/// Share of the picture's own contrast below which a blurred one counts as flat. From a flat start
/// no two places differ enough to lock in a seam.
constexpr double kFlatContrast = 0.15;

int start_level(const VoxelPyramid& pyramid, const GaussianStack& stack, const SynthesisSettings& settings) {
    const int coarsest = static_cast<int>(pyramid.levels.size()) - 1;
    if (settings.start_level) return std::clamp(*settings.start_level - settings.skipped_levels, 0, coarsest);
    return static_cast<int>(stack.levels.size()) - 1;
}

SolidTexels list_solid(const Exemplar& exemplar) {
    SolidTexels list;
    std::vector<float> depth;
    for (std::uint32_t i = 0; i < exemplar.solid.size(); ++i)
        if (exemplar.solid[i] != 0) {
            list.all.push_back(i);
            depth.push_back(exemplar.feature_distance_px[i]);
        }
    const auto middle = depth.begin() + static_cast<std::ptrdiff_t>(depth.size() / 2);
    std::nth_element(depth.begin(), middle, depth.end());
    for (const std::uint32_t i : list.all)
        if (exemplar.feature_distance_px[i] <= *middle) list.deep.push_back(i);
    return list;
}

/// To a cell of one of the coarsest levels, so that a draft and its full run agree on it.
double longest_side_voxels(const VoxelPyramid& pyramid) {
    constexpr std::size_t height = 4;
    const std::size_t l = pyramid.levels.size() > height ? pyramid.levels.size() - 1 - height : 0;
    const VoxelCoord extent = extent_of(pyramid.levels[l].coords);
    return std::ldexp(*std::max_element(extent.begin(), extent.end()), static_cast<int>(l));
}

ProblemLevel prepare_level(const SynthesisProblem& problem, int index) {
    ProblemLevel level;
    const auto l = static_cast<std::size_t>(index);
    level.shell = &problem.pyramid.levels[l];
    level.index = index;
    level.rank = index + problem.settings.skipped_levels;
    level.height = static_cast<int>(problem.pyramid.levels.size()) - 1 - index;
    level.texels = {problem.stack.levels[l].data(),
                    static_cast<std::uint32_t>(problem.map.width()),
                    static_cast<std::uint32_t>(problem.map.height()),
                    problem.map.u_shift(index),
                    problem.map.v_shift(index),
                    problem.map.u_place_shift(),
                    problem.map.v_place_shift()};
    const std::size_t voxels = level.shell->size();
    level.points.resize(voxels);
    level.best_plane.resize(voxels);
    parallel_for(voxels, 4096, [&](std::size_t v) {
        level.points[v] = to_fixed(level.shell->positions[v], problem.settings.skipped_levels);
        level.best_plane[v] = problem.planes.nearest(level.shell->normals[v]);
    });
    std::vector<VoxelIndex> all(voxels);
    std::iota(all.begin(), all.end(), VoxelIndex{0});
    level.subpasses = split_into_subpasses(level.shell->coords, all);
    return level;
}

}  // namespace

std::uint64_t ProblemLevel::place(VoxelIndex v) const {
    const std::vector<VoxelCoord>& coords = shell->coords;
    std::uint64_t before = 0;
    for (VoxelIndex w = v; w > 0 && same_cell(coords[w - 1], coords[v]); --w) ++before;
    const auto at = [&](std::size_t axis) { return static_cast<std::uint64_t>(coords[v][axis]); };
    return before << 48 | at(2) << 32 | at(1) << 16 | at(0);
}

SynthesisProblem::SynthesisProblem(const VoxelPyramid& shells, const Exemplar& picture, const SynthesisSettings& chosen)
    : pyramid(shells),
      exemplar(picture),
      settings(chosen),
      map(picture.width, picture.height, chosen.pixels_per_voxel, chosen.skipped_levels),
      planes(chosen.directions, chosen.direction.cast<float>()),
      transforms(planes, chosen.rotations, map),
      border_band(static_cast<std::uint32_t>(chosen.border_band * 4294967296.0)),
      kernels(chosen.portable_code ? kPortableMismatch : best_mismatch_kernels()) {}

void SynthesisProblem::prepare(const RunControl& run) {
    stack = build_gaussian_stack(exemplar, {.levels = static_cast<int>(pyramid.levels.size()),
                                            .pixels_per_voxel = settings.pixels_per_voxel,
                                            .feature_weight = settings.feature_weight,
                                            .flat_contrast = settings.start_level ? 0.0 : kFlatContrast});
    solid_texels = list_solid(exemplar);
    const int coarsest = start_level(pyramid, stack, settings);
    for (int l = 0; l <= coarsest; ++l) {
        run.throw_if_stopped();
        levels.push_back(prepare_level(*this, l));
    }
    if (settings.orientation == Orientation::kFree) return;

    const double longest = longest_side_voxels(pyramid);
    std::vector<OrientationField> fields =
        orientation_fields(pyramid, coarsest + 1,
                           {settings.direction.cast<float>(), settings.symmetric,
                            settings.orientation_smoothing * longest, settings.skipped_levels},
                           run);
    for (std::size_t l = 0; l < levels.size(); ++l) levels[l].field = std::move(fields[l]);
}

Choice SynthesisProblem::make_choice(const ProblemLevel& level, const Label& label, const LinearPart& part,
                                     const FixedPoint& p) const {
    const TexelPosition texel = texel_at(map, part, label.origin, p);
    return {texel, part, color_at(level, texel), label};
}

}  // namespace fretwork
