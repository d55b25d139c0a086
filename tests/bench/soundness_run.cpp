#include "soundness_run.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "core/enlarge/enlarge_features.h"
#include "core/graph/connect_samples.h"
#include "core/graph/firm_links.h"
#include "core/graph/poisson_disk.h"
#include "core/mesh/region.h"
#include "core/pipeline/choose_exemplar.h"
#include "core/pipeline/intended_use.h"
#include "core/pipeline/prepare_surface.h"
#include "core/pipeline/resolve_settings.h"
#include "core/pipeline/structure_loop.h"
#include "core/pyramid/voxel_pyramid.h"
#include "core/reinforce/paint_bridges.h"
#include "core/reinforce/select_bridges.h"
#include "core/shell/components.h"
#include "core/shell/voxelize.h"
#include "core/solidify/solidify.h"
#include "core/synthesis/synthesizer.h"
#include "likeness/likeness_meter.h"
#include "pattern_run.h"

namespace fretwork::bench {
namespace {

/// What all schemes start from.
struct Start {
    ChosenExemplar chosen;
    PreparedSurface surface;
    ResolvedSettings resolved;
    SurfaceVoxels shell;
    VoxelPyramid pyramid;
    ForceProfile profile;
};

Start start_of(const TriangleMesh& mesh, const Settings& settings) {
    Start start{builtin_exemplar(settings.exemplar),
                prepare_surface(mesh, settings.input, CountSelfIntersections::kNo),
                {},
                {},
                {},
                {}};
    start.resolved =
        resolve_settings(settings, {longest_side(start.surface.mesh), start.surface.open, start.surface.found.area_mm2},
                         exemplar_facts(start.chosen.exemplar, start.chosen.natural_width_mm));
    start.shell = voxelize(start.surface.mesh, start.resolved.voxelize);
    start.pyramid = build_pyramid(start.shell, start.resolved.pyramid_levels);
    start.profile = intended_use(start.surface.mesh, start.shell, settings);
    return start;
}

std::size_t solid_count(const SolidStates& solid) {
    return static_cast<std::size_t>(std::ranges::count(solid, SolidState::kSolid));
}

TriangleMesh carved_mesh(const Start& start, const SolidStates& pattern, const TexelFrames& frames, SoundnessRun& run) {
    const GeodesicLinks links = link_two_rings(start.shell);
    const SolidStates solid = enlarge_features(start.shell, links, pattern, {}, start.resolved.enlarge).solid;
    run.solid_fraction = static_cast<double>(solid_count(solid)) / static_cast<double>(start.shell.size());
    const RegionField nothing_kept(start.surface.mesh, {});
    const PatternField field(start.surface.mesh, start.shell, links, solid, frames, start.chosen.exemplar,
                             nothing_kept);
    return solidify(start.surface.mesh, start.shell, field, start.resolved.solidify).mesh;
}

void bear_weight(const Start& start, const TriangleMesh& carved, SoundnessRun& run) {
    StrengthSettings settings;
    settings.material = start.resolved.material;
    const VoxelModel voxels = make_voxel_model(carved, start.resolved.voxel_mm);
    const std::vector<VoxelCase> cases = self_weight_cases(voxels);
    const StrengthReport report = analyze_strength(voxels, {cases[2], cases[0]}, settings);
    run.expected = report.cases[0].stress_sum;
    run.unexpected = report.cases[1].stress_sum;
    run.volume_mm3 = report.volume_mm3;
}

/// Measures patterns of one start with the same windows.
class WindowMeter {
  public:
    explicit WindowMeter(const Start& start)
        : start_(start),
          reference_(likeness::picture_of(
              start.chosen.exemplar,
              static_cast<int>(std::lround(start.resolved.exemplar_width_mm / start.resolved.voxel_mm)))),
          meter_(reference_, {.samples = 400, .levels = kLevels}) {}

    [[nodiscard]] likeness::Likeness measure(const likeness::ShownPattern& pattern) const {
        return meter_.measure(
            likeness::surface_windows(start_.pyramid.levels[0], pattern, reference_, kWindows, kLevels, 1));
    }

  private:
    static constexpr int kLevels = 2;
    static constexpr std::size_t kWindows = 1000;
    const Start& start_;
    likeness::PatternPicture reference_;
    likeness::LikenessMeter meter_;
};

/// Samples and gaps between them, as the structural step sees them.
AbstractGraph graph_of(const SurfaceVoxels& shell, const SolidStates& solid) {
    Samples samples = poisson_samples(shell.adjacency, connected_components(shell.adjacency), solid, SampleSettings{});
    return connect_samples(shell.adjacency, solid, std::move(samples.voxels), ExtendFrom::kTree);
}

/// Empty edges in an order in which each is as far as possible from all before it.
std::vector<EdgeIndex> evenly_spread(const SurfaceVoxels& shell, const AbstractGraph& graph) {
    const EdgePlaces places = edge_places(shell, graph);
    std::vector<EdgeIndex> left, order;
    for (EdgeIndex e = 0; e < graph.edges.size(); ++e)
        if (graph.edges[e].state == EdgeState::kEmpty) left.push_back(e);
    std::vector<double> apart(graph.edges.size(), std::numeric_limits<double>::infinity());
    while (!left.empty()) {
        const auto farthest = std::ranges::max_element(left, {}, [&](EdgeIndex e) { return apart[e]; });
        const EdgeIndex taken = *farthest;
        left.erase(farthest);
        order.push_back(taken);
        for (const EdgeIndex e : left)
            apart[e] = std::min(apart[e], (places.middle_mm[e] - places.middle_mm[taken]).norm());
    }
    return order;
}

std::size_t bridge_evenly(const Start& start, std::size_t solid_voxels, StructureLoopResult& loop) {
    const SurfaceVoxels& shell = start.shell;
    const AbstractGraph graph = graph_of(shell, loop.solid);
    const Adjacency firm = firm_links(shell.adjacency);
    BridgePainter painter(shell, firm, start.resolved.reinforce.pattern_radius_voxels);
    std::size_t solid = solid_count(loop.solid), bridges = 0;
    for (const EdgeIndex e : evenly_spread(shell, graph)) {
        if (solid >= solid_voxels) break;
        const PaintedVoxels painted = painter.paint(graph.voxel_path(e), DilatedPart::kGap, loop.solid);
        for (const VoxelIndex v : painted.added) loop.forced[v] = 1;
        solid += painted.added.size();
        ++bridges;
    }
    return bridges;
}

SoundnessRun run_scheme(const TriangleMesh& mesh, const Settings& settings, std::size_t naive_voxels) {
    const Start start = start_of(mesh, settings);
    const Exemplar& exemplar = start.chosen.exemplar;
    Synthesizer synthesizer(start.pyramid, exemplar, start.resolved.synthesis);
    synthesizer.synthesize();
    const double pixels_per_voxel = start.resolved.synthesis.pixels_per_voxel;
    const WindowMeter meter(start);
    const likeness::Likeness first = meter.measure({synthesizer.frames(), pixels_per_voxel, {}, {}});

    const std::vector<std::uint8_t> keep(start.shell.size(), 0);
    StructureLoopResult loop =
        structure_loop(start.shell, exemplar, synthesizer, start.profile, start.resolved, keep, {});
    SoundnessRun run;
    for (const ReinforceRecord& turn : loop.records)
        run.bridges += turn.bridges_connect + turn.bridges_stress + turn.bridges_geodesic;
    run.turns = loop.records.size();
    if (naive_voxels > 0) run.bridges += bridge_evenly(start, naive_voxels, loop);
    run.solid_voxels = solid_count(loop.solid);

    const likeness::Likeness last =
        meter.measure({synthesizer.frames(),
                       pixels_per_voxel,
                       where_states_differ(read_solid(exemplar, synthesizer.frames()), loop.solid),
                       {}});
    run.patches_first = first.patches();
    run.seams_first = first.worst_seam;
    run.patches = last.patches();
    run.seams = last.worst_seam;
    bear_weight(start, carved_mesh(start, loop.solid, synthesizer.frames(), run), run);
    return run;
}

}  // namespace

SoundnessRun run_soundness(const TriangleMesh& mesh, const Settings& settings) {
    return run_scheme(mesh, settings, 0);
}

SoundnessRun run_naively(const TriangleMesh& mesh, Settings settings, std::size_t solid_voxels) {
    settings.structure.steps.max_iterations = 1;
    return run_scheme(mesh, settings, solid_voxels);
}

}  // namespace fretwork::bench
