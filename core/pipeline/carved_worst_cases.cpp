#include "core/pipeline/carved_worst_cases.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <utility>

#include "core/base/parallel.h"
#include "core/fem/worst_cases.h"
#include "core/graph/connect_samples.h"
#include "core/graph/poisson_disk.h"
#include "core/mesh/nearest_point.h"

namespace fretwork {
namespace {

/// Of the object's voxel, from the surface to the middle of a voxel that touches it.
constexpr double kBeside = 0.9;

SolidStates pattern_of(const SurfaceVoxels& shell, const VoxelModel& object, const RunControl& run) {
    std::vector<Vec3> middles_mm;
    for (const VoxelCoord& v : object.voxels) middles_mm.push_back(object.grid.center_mm(v));
    const NearestPoint nearest(middles_mm, run);
    SolidStates solid(shell.size(), SolidState::kEmpty);
    parallel_for(shell.size(), 1024, [&](std::size_t v) {
        if (v % 1024 == 0) run.throw_if_stopped();
        const double away_mm = (middles_mm[nearest.to(shell.points_mm[v])] - shell.points_mm[v]).norm();
        if (away_mm < kBeside * object.grid.voxel_mm) solid[v] = SolidState::kSolid;
    });
    return solid;
}

double wall_mm(const SurfaceVoxels& shell, const SolidStates& solid, const VoxelModel& object) {
    double area_mm2 = 0.0;
    for (VoxelIndex v = 0; v < shell.size(); ++v)
        if (solid[v] == SolidState::kSolid) area_mm2 += static_cast<double>(shell.area_mm2[v]);
    const double voxel_mm = object.grid.voxel_mm;
    return static_cast<double>(object.voxels.size()) * voxel_mm * voxel_mm * voxel_mm / area_mm2;
}

}  // namespace

std::vector<LoadCase> carved_worst_cases(const SurfaceVoxels& shell, const VoxelModel& object,
                                         const WorstCaseSettings& settings, const Material& material,
                                         const RunControl& run) {
    const SolidStates solid = pattern_of(shell, object, run);
    if (std::ranges::count(solid, SolidState::kSolid) == 0) return {};
    Samples samples = poisson_samples(shell.adjacency, connected_components(shell.adjacency), solid, {}, run);
    const AbstractGraph graph =
        connect_samples(shell.adjacency, solid, std::move(samples.voxels), ExtendFrom::kTree, run);
    BeamModelSettings model;
    model.thickness_mm = wall_mm(shell, solid, object);
    model.facing = facing_voxels(shell, model.thickness_mm);
    const BeamSystem system(shell, solid, graph, beam_half_widths(shell, solid), material, model, run);
    std::vector<LoadCase> cases;
    for (WorstCase& worst : worst_cases(shell, solid, graph, system, settings, run))
        cases.push_back(std::move(worst.load_case));
    return cases;
}

}  // namespace fretwork
