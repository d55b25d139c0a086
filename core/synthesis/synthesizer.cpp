#include "core/synthesis/synthesizer.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "core/base/error.h"
#include "core/base/parallel.h"
#include "core/synthesis/optimize.h"
#include "core/synthesis/passes.h"
#include "core/synthesis/resynthesize.h"
#include "core/synthesis/start_labels.h"
#include "core/synthesis/synthesis_problem.h"

namespace fretwork {
namespace {

constexpr double kPrepareShare = 0.2;  // of the time of a synthesis, about
constexpr int kLargestSide = 16384;    // pixels; positions carry 16 bits

void require(bool holds, const char* name, double found, const char* expected) {
    if (holds) return;
    throw InvalidSetting("synthesis: " + std::string(name) + " is " + std::to_string(found) + ", expected " + expected);
}

void check(const SynthesisSettings& s) {
    const auto within = [](double x, double low, double high) { return x >= low && x <= high; };
    require(s.pixels_per_voxel > 0.0 && s.pixels_per_voxel <= 64.0, "pixels_per_voxel", s.pixels_per_voxel,
            "a number in (0, 64]");
    require(s.orientation == Orientation::kFree || (s.direction.allFinite() && s.direction.norm() > 0.0),
            "length of direction", s.direction.norm(), "a finite vector that is not zero");
    require(within(s.orientation_smoothing, 0, 1), "orientation_smoothing", s.orientation_smoothing, "[0, 1]");
    require(within(s.directions, 6, 4096), "directions", s.directions, "[6, 4096]");
    require(within(s.rotations, 1, 4096), "rotations", s.rotations, "[1, 4096]");
    require(within(s.translations, 0, 1024), "translations", s.translations, "[0, 1024]");
    require(within(s.cone_deg, 0, 90), "cone_deg", s.cone_deg, "[0, 90]");
    require(within(s.candidates, 1, 256), "candidates", s.candidates, "[1, 256]");
    require(within(s.fine_random_candidates, 0, 256), "fine_random_candidates", s.fine_random_candidates, "[0, 256]");
    require(within(s.transported, 0, 64), "transported", s.transported, "[0, 64]");
    require(within(s.distortion_weight, 0, 100), "distortion_weight", s.distortion_weight, "[0, 100]");
    require(within(s.orientation_weight, 0, 100), "orientation_weight", s.orientation_weight, "[0, 100]");
    require(within(s.border_weight, 0, 100), "border_weight", s.border_weight, "[0, 100]");
    require(within(s.border_band, 0, 0.4), "border_band", s.border_band, "[0, 0.4]");
    require(within(s.feature_weight, 0, 1), "feature_weight", s.feature_weight, "[0, 1]");
    require(within(s.coarse_passes, 1, 64), "coarse_passes", s.coarse_passes, "[1, 64]");
    require(within(s.jitter, 0, 1), "jitter", s.jitter, "[0, 1]");
    require(within(s.skipped_levels, 0, 10), "skipped_levels", s.skipped_levels, "[0, 10]");
    require(s.jitter_from_level >= 0, "jitter_from_level", s.jitter_from_level, "0 or more");
    require(!s.start_level || *s.start_level >= 0, "start_level", s.start_level.value_or(0), "0 or more");
}

void check(const VoxelPyramid& pyramid, const Exemplar& exemplar) {
    if (pyramid.levels.empty() || pyramid.levels[0].size() == 0)
        throw InvalidInput("synthesis: the pyramid has no voxels, expected at least one");
    if (exemplar.width < 1 || exemplar.height < 1 || exemplar.width > kLargestSide || exemplar.height > kLargestSide)
        throw InvalidInput("synthesis: the exemplar is " + std::to_string(exemplar.width) + " x " +
                           std::to_string(exemplar.height) + " pixels, expected sides in [1, 16384]");
}

/// Pixels from shares of the period, never rounded up into the next pixel.
float to_pixels(std::uint32_t share, std::uint32_t pixel, int size) {
    const double exact = static_cast<double>(share) / 4294967296.0 * size;
    const auto low = static_cast<float>(pixel);
    return std::clamp(static_cast<float>(exact), low, std::nextafter(low + 1.0F, low));
}

}  // namespace

struct Synthesizer::Impl {
    Impl(const VoxelPyramid& pyramid, const Exemplar& exemplar, const SynthesisSettings& settings)
        : problem(pyramid, exemplar, settings) {}

    void update_frame(VoxelIndex v) {
        const Choice& c = choices[0][v];
        TexelFrame& f = frames[v];
        f.u = to_pixels(c.texel.u, problem.map.column(c.texel.u), problem.map.width());
        f.v = to_pixels(c.texel.v, problem.map.row(c.texel.v), problem.map.height());
        f.du = problem.map.u_vector(c.part);
        f.dv = problem.map.v_vector(c.part);
    }

    /// Algorithm 2.
    void synthesize(const RunControl& run) {
        double total = 0.0, done = 0.0;
        for (const ProblemLevel& level : problem.levels)
            total += static_cast<double>(level.size()) * passes_on_level(problem.settings, level.rank);
        choices.assign(problem.levels.size(), {});
        for (std::size_t l = problem.levels.size(); l-- > 0;) {
            const ProblemLevel& level = problem.levels[l];
            const bool coarsest = l + 1 == problem.levels.size();
            if (!coarsest) {
                choices[l] = upsample(problem, level, choices[l + 1]);
                jitter(problem, level, choices[l]);
            } else if (problem.settings.random_start) {
                choices[l] = random_labels(problem, level);
            } else {
                choices[l] = constant_labels(problem, level);
                if (l > 0) continue;  // the paper leaves the coarsest level as it is
            }
            for (int pass = 0; pass < passes_on_level(problem.settings, level.rank); ++pass) {
                optimize_pass(problem, level, level.subpasses, {}, epoch_of(level.height, pass, 0), choices[l], run);
                done += static_cast<double>(level.size());
                run.checkpoint("synthesis", kPrepareShare + (1.0 - kPrepareShare) * done / total);
            }
        }
    }

    SynthesisProblem problem;
    std::vector<Choices> choices;  // per level, finest first
    TexelFrames frames;
    std::uint32_t calls = 0;
};

Synthesizer::Synthesizer(const VoxelPyramid& pyramid, const Exemplar& exemplar, const SynthesisSettings& settings) {
    check(settings);
    check(pyramid, exemplar);
    impl_ = std::make_unique<Impl>(pyramid, exemplar, settings);
}

Synthesizer::~Synthesizer() = default;
Synthesizer::Synthesizer(Synthesizer&&) noexcept = default;
Synthesizer& Synthesizer::operator=(Synthesizer&&) noexcept = default;

void Synthesizer::synthesize(const RunControl& run) {
    run.checkpoint("synthesis", 0.0);
    if (impl_->problem.levels.empty()) impl_->problem.prepare(run);
    run.checkpoint("synthesis", kPrepareShare);
    impl_->synthesize(run);
    impl_->frames.resize(impl_->choices[0].size());
    parallel_for(impl_->frames.size(), 4096, [&](std::size_t v) { impl_->update_frame(static_cast<VoxelIndex>(v)); });
    run.checkpoint("synthesis", 1.0);
}

std::vector<VoxelIndex> Synthesizer::resynthesize(const std::vector<std::uint8_t>& forced_solid,
                                                  const std::vector<VoxelIndex>& changed, double pattern_radius_voxels,
                                                  const RunControl& run) {
    const SynthesisProblem& problem = impl_->problem;
    if (impl_->choices.empty()) throw InvalidInput("resynthesis: no labels yet, expected a call of synthesize before");
    if (forced_solid.size() != problem.levels[0].size())
        throw InvalidInput("resynthesis: forced_solid has " + std::to_string(forced_solid.size()) +
                           " entries, expected " + std::to_string(problem.levels[0].size()));
    for (const VoxelIndex v : changed)
        if (v >= forced_solid.size())
            throw InvalidInput("resynthesis: changed names voxel " + std::to_string(v) + ", expected one below " +
                               std::to_string(forced_solid.size()));
    require(pattern_radius_voxels > 0.0 && std::isfinite(pattern_radius_voxels), "pattern_radius_voxels",
            pattern_radius_voxels, "a positive number");
    run.checkpoint("resynthesis", 0.0);
    const int back = std::max(0, static_cast<int>(std::ceil(std::log2(pattern_radius_voxels))));
    const int coarsest = std::min(back, static_cast<int>(problem.levels.size()) - 1);
    std::vector<VoxelIndex> relabelled;
    if (!changed.empty()) {
        const LocalVoxels local = voxels_around(problem, changed, coarsest);
        relabelled = update_locally(problem, forced_solid, local, ++impl_->calls, impl_->choices, run);
        for (const VoxelIndex v : relabelled) impl_->update_frame(v);
    }
    run.checkpoint("resynthesis", 1.0);
    return relabelled;
}

const TexelFrames& Synthesizer::frames() const {
    return impl_->frames;
}

double Synthesizer::energy() const {
    return impl_->choices.empty() ? 0.0 : total_energy(impl_->problem, impl_->problem.levels[0], impl_->choices[0]);
}

std::size_t Synthesizer::memory_bytes() const {
    const SynthesisProblem& p = impl_->problem;
    std::size_t bytes = impl_->frames.capacity() * sizeof(TexelFrame);
    for (const Choices& c : impl_->choices) bytes += c.capacity() * sizeof(Choice);
    for (const std::vector<std::uint32_t>& t : p.stack.levels) bytes += t.capacity() * sizeof(std::uint32_t);
    for (const ProblemLevel& level : p.levels)
        bytes += level.size() * (sizeof(FixedPoint) + sizeof(PlaneIndex) + sizeof(Vec3f) + 3 * sizeof(float));
    return bytes;
}

}  // namespace fretwork
