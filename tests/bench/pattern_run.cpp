#include "pattern_run.h"

#include <algorithm>
#include <chrono>

#include "core/pipeline/intended_use.h"
#include "core/pipeline/resolve_settings.h"
#include "core/pipeline/structure_loop.h"
#include "core/shell/voxelize.h"
#include "core/synthesis/synthesizer.h"
#include "support/make_meshes.h"

namespace fretwork::bench {
namespace {

using likeness::PatternPicture;
using likeness::PatternPixel;
using likeness::ShownPattern;
using Over = ShownPattern::Over;

constexpr double kSideMm = 100.0;
constexpr int kLargestWidth = 128;

double share_of_solid(const SolidStates& solid) {
    return static_cast<double>(std::ranges::count(solid, SolidState::kSolid)) / static_cast<double>(solid.size());
}

std::vector<Over> where_forced(const SolidStates& shown, const std::vector<std::uint8_t>& forced) {
    std::vector<Over> over(forced.size(), Over::kNothing);
    for (std::size_t v = 0; v < forced.size(); ++v)
        if (forced[v] != 0 && shown[v] == SolidState::kEmpty) over[v] = Over::kPaint;
    return over;
}

double seconds_since(std::chrono::steady_clock::time_point start) {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

}  // namespace

std::vector<Over> where_states_differ(const SolidStates& shown, const SolidStates& states) {
    std::vector<Over> over(states.size(), Over::kNothing);
    for (std::size_t v = 0; v < states.size(); ++v)
        if (shown[v] != states[v]) over[v] = states[v] == SolidState::kSolid ? Over::kSolid : Over::kEmpty;
    return over;
}

BenchModel make_model(std::string name, TriangleMesh mesh, int resolution, bool open) {
    const double scale = kSideMm / longest_side(mesh);
    for (Vec3& p : mesh.positions_mm) p *= scale;
    BenchModel model{std::move(name), std::move(mesh), {}, {}, open, resolution};
    model.shell = voxelize(model.mesh, {.resolution = resolution});
    model.pyramid = build_pyramid(model.shell, 8);
    return model;
}

BenchModel make_plate(int resolution) {
    TriangleMesh mesh = testing::make_square(kSideMm, 2);
    // Off the borders between layers of voxels, so that it is one voxel thick.
    for (Vec3& p : mesh.positions_mm) p = Vec3(p.x(), 0.3 * kSideMm / resolution, p.y());
    return make_model("plate", std::move(mesh), resolution, true);
}

BenchExemplar make_bench_exemplar(std::string name, Exemplar exemplar) {
    BenchExemplar result{std::move(name), std::move(exemplar), {}, {}};
    result.reference = likeness::picture_of(result.exemplar, std::min(result.exemplar.width, kLargestWidth));
    float weight = 0.0F;
    for (const PatternPixel& p : result.reference.pixels) {
        for (std::size_t c = 0; c < 3; ++c) result.solid_mean[c] += p[3] * p[c];
        weight += p[3];
    }
    for (std::size_t c = 0; c < 3; ++c) result.solid_mean[c] /= std::max(weight, 1.0F);
    result.solid_mean[3] = 1.0F;
    return result;
}

PatternRun run_pattern(const BenchModel& model, const BenchExemplar& exemplar, Settings settings,
                       WithStructure structure) {
    settings.shell.resolution = model.resolution;
    settings.exemplar.width_mm = kSideMm * exemplar.reference.width / model.resolution;
    const ResolvedSettings resolved =
        resolve_settings(settings, {kSideMm, model.open}, exemplar_facts(exemplar.exemplar));
    const double pixels_per_voxel = resolved.synthesis.pixels_per_voxel;

    PatternRun run;
    auto start = std::chrono::steady_clock::now();
    Synthesizer synthesizer(model.pyramid, exemplar.exemplar, resolved.synthesis);
    synthesizer.synthesize();
    run.seconds_first = seconds_since(start);
    run.first = {synthesizer.frames(), pixels_per_voxel, {}, {}};
    const SolidStates first_states = read_solid(exemplar.exemplar, run.first.frames);
    run.solid_fraction = share_of_solid(first_states);
    if (structure == WithStructure::kNo) return run;

    start = std::chrono::steady_clock::now();
    const ForceProfile profile = intended_use(model.mesh, model.shell, settings);
    const std::vector<std::uint8_t> keep(model.shell.size(), 0);
    const StructureLoopResult loop =
        structure_loop(model.shell, exemplar.exemplar, synthesizer, profile, resolved, keep, {});
    run.seconds_structure = seconds_since(start);
    run.turns = loop.records.size();
    run.painted = {run.first.frames, pixels_per_voxel, where_forced(first_states, loop.forced), exemplar.solid_mean};
    run.resynthesized = {synthesizer.frames(),
                         pixels_per_voxel,
                         where_states_differ(read_solid(exemplar.exemplar, synthesizer.frames()), loop.solid),
                         {}};
    run.solid_fraction_after = share_of_solid(loop.solid);
    return run;
}

PatternPicture plate_picture(const BenchModel& plate, const ShownPattern& pattern, const PatternPicture& reference) {
    const SurfaceVoxels& shell = plate.shell;
    VoxelCoord low = shell.coords.front(), high = low;
    for (const VoxelCoord& c : shell.coords)
        for (std::size_t a = 0; a < 3; ++a) low[a] = std::min(low[a], c[a]), high[a] = std::max(high[a], c[a]);
    PatternPicture picture{high[0] - low[0] + 1, high[2] - low[2] + 1, false, {}};
    picture.pixels.resize(static_cast<std::size_t>(picture.width) * static_cast<std::size_t>(picture.height));
    const bool from_behind = shell.normals[0].y() > 0;
    for (VoxelIndex v = 0; v < shell.size(); ++v) {
        const VoxelCoord& c = shell.coords[v];
        const int x = from_behind ? high[0] - c[0] : c[0] - low[0], y = high[2] - c[2];
        picture.pixels[static_cast<std::size_t>(y * picture.width + x)] = pattern.at(reference, v, Vec3f::Zero());
    }
    return picture;
}

}  // namespace fretwork::bench
