#include "core/synthesis/optimize.h"

#include <algorithm>
#include <vector>

#include "core/base/counter_random.h"
#include "core/base/parallel.h"
#include "core/synthesis/candidates.h"
#include "core/synthesis/energy.h"

namespace fretwork {
namespace {

constexpr std::size_t kGrain = 128;
constexpr int kFineLevels = 2;              // levels on which fewer random candidates are worth their time
constexpr int kLeastRandomWhenForced = 16;  // so that a forced voxel always finds a solid label

/// Finds the best label for one voxel after another; one object per chunk of voxels.
class Improver {
  public:
    Improver(const SynthesisProblem& problem, const ProblemLevel& level, const RandomCandidates& random,
             const ForcedSolid& forced, std::uint32_t epoch, const Choices& choices)
        : problem_(problem),
          level_(level),
          forced_(forced),
          epoch_(epoch),
          choices_(choices),
          random_(random),
          energy_(problem, level) {}

    Choice improve(VoxelIndex v) {
        v_ = v;
        probe_ = forced_.holds(v) ? &forced_.probe[v] : nullptr;
        const Choice& current = choices_[v];
        best_ = {current.label, current.part, current.texel};
        energy_.look_at(v, choices_);
        best_energy_ = admissible(best_) ? energy_.of(best_, kNoEnergy) : kNoEnergy;

        coherent_.collect(energy_.view(), energy_.neighbors());
        const int tried = try_neighbors();
        try_random(tried);
        return {best_.texel, best_.part, problem_.color_at(level_, best_.texel), best_.label};
    }

  private:
    [[nodiscard]] bool admissible(const Candidate& c) const {
        return probe_ == nullptr || problem_.solid_at(texel_at(problem_.map, c.part, c.label.origin, *probe_));
    }

    [[nodiscard]] const Choice& neighbor(std::uint32_t i) const { return choices_[energy_.block(i).neighbor[i % 8]]; }

    void consider(const Candidate& c) {
        if (c.label == best_.label || !admissible(c)) return;
        const Energy e = energy_.of(c, best_energy_);
        if (e < best_energy_ || (e == best_energy_ && c.label < best_.label)) {
            best_energy_ = e;
            best_ = c;
        }
    }

    /// \return how many of the candidates that takes up
    int try_neighbors() {
        const SynthesisSettings& s = problem_.settings;
        const auto& labels = coherent_.labels();
        const std::size_t coherent = std::min(labels.size(), static_cast<std::size_t>(s.candidates));
        for (std::size_t i = 0; i < coherent; ++i)
            consider(coherent_candidate(problem_, level_, v_, neighbor(labels[i].first_seen)));
        if (probe_ != nullptr)
            for (std::size_t i = 0; i < coherent; ++i)
                consider(snapped_candidate(problem_, level_, v_, *probe_, neighbor(labels[i].first_seen)));

        std::size_t transported = 0;
        if (level_.index >= kFineLevels || probe_ != nullptr)
            transported = std::min(labels.size(), static_cast<std::size_t>(s.transported));
        for (std::size_t i = 0; i < transported; ++i) {
            const std::uint32_t seen = labels[i].first_seen;
            const NeighborBlock& b = energy_.block(seen);
            const LevelOffset offset{b.out_xy[seen % 8], b.out_z[seen % 8]};
            consider(transported_candidate(problem_, level_, v_, neighbor(seen), offset));
        }
        return static_cast<int>((s.count_repeated ? energy_.neighbors() : coherent) + transported);
    }

    void try_random(int tried) {
        const SynthesisSettings& s = problem_.settings;
        int count = std::max(0, s.candidates - tried);
        if (level_.index < kFineLevels) count = std::min(count, s.fine_random_candidates);
        if (probe_ != nullptr) count = std::max(count, kLeastRandomWhenForced);
        const bool texel_known = s.translations == 0 && probe_ == nullptr;
        for (int i = 0; i < count; ++i) {
            const std::uint64_t bits =
                counter_random(s.seed, RandomStream::kSynthesisCandidates, epoch_, v_, static_cast<std::uint32_t>(i));
            if (probe_ != nullptr) {
                consider(random_.finish(v_, random_.draw_solid(v_, bits), *probe_));
                continue;
            }
            const RandomCandidates::Draw draw = random_.draw(v_, bits);
            if (texel_known && energy_.bound(draw.plane, draw.texel) > best_energy_) continue;
            consider(random_.finish(v_, draw, level_.points[v_]));
        }
    }

    const SynthesisProblem& problem_;
    const ProblemLevel& level_;
    const ForcedSolid& forced_;
    std::uint32_t epoch_;
    const Choices& choices_;
    const RandomCandidates& random_;
    VoxelEnergy energy_;
    CoherentLabels coherent_;

    VoxelIndex v_ = 0;
    const FixedPoint* probe_ = nullptr;
    Candidate best_;
    Energy best_energy_ = kNoEnergy;
};

}  // namespace

void optimize_pass(const SynthesisProblem& problem, const ProblemLevel& level, const Subpasses& voxels,
                   const ForcedSolid& forced, std::uint32_t epoch, Choices& choices, const RunControl& run) {
    const RandomCandidates random(problem, level);
    std::vector<Choice> found;
    for (std::size_t s = 0; s < kSubpasses; ++s) {
        const std::span<const VoxelIndex> list = voxels.of(s);
        found.resize(list.size());
        parallel_chunks(list.size(), kGrain, [&](std::size_t begin, std::size_t end) {
            run.throw_if_stopped();
            Improver improver(problem, level, random, forced, epoch, choices);
            for (std::size_t i = begin; i < end; ++i) found[i] = improver.improve(list[i]);
        });
        for (std::size_t i = 0; i < list.size(); ++i) choices[list[i]] = found[i];
    }
}

double total_energy(const SynthesisProblem& problem, const ProblemLevel& level, const Choices& choices) {
    std::vector<double> energy(level.size());
    parallel_chunks(level.size(), 1024, [&](std::size_t begin, std::size_t end) {
        VoxelEnergy at(problem, level);
        for (std::size_t v = begin; v < end; ++v) {
            at.look_at(static_cast<VoxelIndex>(v), choices);
            const Choice& c = choices[v];
            energy[v] = static_cast<double>(at.of({c.label, c.part, c.texel}, kNoEnergy)) / at.scale();
        }
    });
    double sum = 0.0;
    for (const double e : energy) sum += e;
    return sum;
}

}  // namespace fretwork
