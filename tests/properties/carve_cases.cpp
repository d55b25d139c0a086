#include "properties/carve_cases.h"

#include <Eigen/Geometry>
#include <numeric>
#include <utility>

#include "core/exemplar/builtin/builtin_patterns.h"
#include "core/pipeline/resolve_settings.h"
#include "support/make_meshes.h"

namespace fretwork::testing {

std::vector<PropertyModel> property_models() {
    std::vector<PropertyModel> models;
    models.push_back({"sphere", make_icosphere(20.0, 4), 1});
    models.push_back({"torus", make_torus(20.0, 8.0, 48, 24), 1});
    models.push_back({"vase", make_vase(50.0), 1});
    models.push_back({"bracket", make_bracket(), 1, false, 56});
    models.push_back({"box of twelve triangles", make_box(Vec3::Zero(), Vec3(40, 30, 20)), 1});
    models.push_back({"frame of genus five", make_frame(40.0, 9.0), 1});
    models.push_back({"linked tori", make_linked_tori(16.0, 5.0), 2, false, 64});
    models.push_back({"open bowl", make_open_bowl(20.0, 16, 48), 1, true});
    models.push_back({"soup with flipped, repeated and flat triangles",
                      with_degenerates(with_duplicates(with_flipped(as_soup(make_icosphere(20.0, 3)), 7), 9), 6), 1});
    // Opposite faces are nearer to each other than two voxels, and the asked wall is thicker than the plate.
    models.push_back({"thin plate", make_thin_plate(40.0, 30.0, 1.2), 1, false, 48, 0.6});
    models.push_back({"sphere with a hollow", make_nested_spheres(20.0, 12.0, 4), 2});
    return models;
}

CarveResult carve_model(const PropertyModel& model, const std::string& pattern, std::uint64_t seed, int threads,
                        const RunControl& run) {
    CarveInput input;
    input.mesh = model.mesh;
    input.model_name = model.name;
    input.exemplar = make_builtin(pattern);
    input.exemplar_name = pattern;

    const double voxel_mm = longest_side(model.mesh) / model.resolution;
    Settings settings;
    settings.shell.resolution = model.resolution;
    settings.shell.thickness_mm = 3.0 * voxel_mm;
    settings.shell.side = model.open ? WallSide::kCentred : WallSide::kInward;
    settings.fabrication.min_feature_mm = 2.5 * voxel_mm;
    settings.fabrication.min_hole_mm = 2.5 * voxel_mm;
    settings.exemplar.width_mm = 0.9 * longest_side(model.mesh);
    settings.structure.steps.samples = 200;
    settings.structure.steps.max_iterations = 6;
    settings.synthesis.search.seed = seed;
    RunLimits limits;
    limits.threads = threads;
    return carve(input, settings, limits, run);
}

std::size_t body_count(const TriangleMesh& mesh) {
    std::vector<std::uint32_t> leader(mesh.positions_mm.size());
    std::iota(leader.begin(), leader.end(), 0u);
    const auto find = [&](std::uint32_t v) {
        while (leader[v] != v) v = leader[v] = leader[leader[v]];
        return v;
    };
    for (const Triangle& t : mesh.triangles)
        for (const int k : {1, 2}) leader[find(t[static_cast<std::size_t>(k)])] = find(t[0]);
    std::vector<double> six_volumes(mesh.positions_mm.size(), 0.0);
    for (const Triangle& t : mesh.triangles)
        six_volumes[find(t[0])] += mesh.positions_mm[t[0]].dot(mesh.positions_mm[t[1]].cross(mesh.positions_mm[t[2]]));
    std::size_t bodies = 0;
    for (const double v : six_volumes) bodies += v > 0.0 ? 1 : 0;
    return bodies;
}

}  // namespace fretwork::testing
