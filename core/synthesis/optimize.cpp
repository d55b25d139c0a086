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
        probe_ = forced_.probe(v);
        const Choice& current = choices_[v];
        best_ = {current.label, current.part, current.texel};
        energy_.look_at(v, choices_);
        best_energy_ = admissible(best_) ? energy_.of(best_, kNoEnergy) : kNoEnergy;

        collect_labels();
        const int tried = try_neighbors();
        try_random(tried);
        return {best_.texel, best_.part, problem_.color_at(level_, best_.texel), best_.label};
    }

  private:
    [[nodiscard]] bool admissible(const Candidate& c) const {
        return probe_ == nullptr || problem_.solid_at(texel_at(problem_.map, c.part, c.label.origin, *probe_));
    }

    void collect_labels() {
        labels_.resize(energy_.neighbors());
        labels_.resize(problem_.kernels.distinct_labels(energy_.view(), energy_.neighbors(), labels_.data()));
    }

    /// Most votes first, then by label.
    void sort_labels() {
        std::sort(labels_.begin(), labels_.end(), [](const CoherentLabel& a, const CoherentLabel& b) {
            return a.votes != b.votes ? a.votes > b.votes : a.label < b.label;
        });
    }

    /// Brings the label with the most votes to the front, so that a good one is known early.
    void most_votes_first() {
        if (labels_.empty()) return;
        std::swap(labels_.front(),
                  *std::max_element(labels_.begin(), labels_.end(),
                                    [](const CoherentLabel& a, const CoherentLabel& b) { return a.votes < b.votes; }));
    }

    [[nodiscard]] const Choice& neighbor(std::uint32_t i) const { return choices_[energy_.block(i).neighbor[i % 8]]; }

    void consider(const Candidate& c) {
        if (c.label == best_.label || !admissible(c)) return;
        take_if_better(c, energy_.of(c, best_energy_));
    }

    void take_if_better(const Candidate& c, Energy e) {
        if (e < best_energy_ || (e == best_energy_ && c.label < best_.label)) {
            best_energy_ = e;
            best_ = c;
        }
    }

    /// The first `count` labels as they stand: the energy that their texel alone costs is found for all at once, and
    /// most get no further.
    void try_coherent(std::size_t count) {
        const auto labels = static_cast<std::uint32_t>(count);
        const NeighborView& view = energy_.view();
        problem_.kernels.project_labels(level_.texels, view, level_.points[v_], labels_.data(), labels, screened_);
        problem_.kernels.first_halves(level_.texels, view, energy_.neighbors(), labels, screened_);
        for (std::uint32_t i = 0; i < labels; ++i) {
            if (screened_.first_half[i] > best_energy_ || labels_[i].label == best_.label) continue;
            const std::uint32_t seen = labels_[i].first_seen;
            const Candidate c{labels_[i].label,
                              {view.u_xy[seen], view.v_xy[seen], view.uv_z[seen]},
                              {screened_.u[i], screened_.v[i]}};
            if (admissible(c)) take_if_better(c, energy_.of(c, screened_.first_half[i], best_energy_));
        }
    }

    /// A label that shows solid at the probe as it stands has been tried.
    void try_snapped(const Choice& seen) {
        if (problem_.solid_at(texel_at(problem_.map, seen.part, seen.label.origin, *probe_))) return;
        consider(snapped_candidate(problem_, level_, v_, *probe_, seen));
    }

    /// \return how many of the candidates that takes up
    int try_neighbors() {
        const SynthesisSettings& s = problem_.settings;
        const bool transports = level_.rank >= kFineLevels || probe_ != nullptr;
        const auto most = static_cast<std::size_t>(s.candidates);
        // The order of the candidates never matters, only which of them are tried.
        if (labels_.size() > most || (transports && s.transported > 0))
            sort_labels();
        else
            most_votes_first();
        const std::size_t coherent = std::min(labels_.size(), most);
        try_coherent(coherent);
        if (probe_ != nullptr)
            for (std::size_t i = 0; i < coherent; ++i) try_snapped(neighbor(labels_[i].first_seen));

        std::size_t transported = 0;
        if (transports) transported = std::min(labels_.size(), static_cast<std::size_t>(s.transported));
        for (std::size_t i = 0; i < transported; ++i) {
            const std::uint32_t seen = labels_[i].first_seen;
            const NeighborBlock& b = energy_.block(seen);
            const LevelOffset offset{b.out_xy[seen % 8], low16(b.z[seen % 8])};
            consider(transported_candidate(problem_, level_, v_, neighbor(seen), offset));
        }
        return static_cast<int>((s.count_repeated ? energy_.neighbors() : coherent) + transported);
    }

    void try_random(int tried) {
        const SynthesisSettings& s = problem_.settings;
        int count = std::max(0, s.candidates - tried);
        if (level_.rank < kFineLevels) count = std::min(count, s.fine_random_candidates);
        if (probe_ != nullptr) count = std::max(count, kLeastRandomWhenForced);
        const ItemRandom random(s.seed, RandomStream::kSynthesisCandidates, epoch_, level_.place(v_));
        // With steps of translation the label's origin is rounded and moves the texel. A probe elsewhere than at the
        // voxel says which texel is seen there, not which one the voxel shows.
        if (s.translations == 0 && (probe_ == nullptr || *probe_ == level_.points[v_])) {
            try_random_texels(random, static_cast<std::uint32_t>(count));
            return;
        }
        for (int i = 0; i < count; ++i) {
            const std::uint64_t bits = random.draw(static_cast<std::uint32_t>(i));
            const FixedPoint& seen_at = probe_ != nullptr ? *probe_ : level_.points[v_];
            consider(random_.candidate(v_, random_.plane(v_, bits), random_texel(bits), seen_at, bits));
        }
    }

    [[nodiscard]] TexelPosition random_texel(std::uint64_t bits) const {
        return probe_ != nullptr ? random_.solid_texel(bits) : RandomCandidates::texel(bits);
    }

    /// Texel first, for all at once: most fail by it.
    void try_random_texels(const ItemRandom& random, std::uint32_t count) {
        for (std::uint32_t i = 0; i < count; ++i) {
            const TexelPosition texel = random_texel(random.draw(i));
            screened_.u[i] = texel.u;
            screened_.v[i] = texel.v;
        }
        problem_.kernels.first_halves(level_.texels, energy_.view(), energy_.neighbors(), count, screened_);
        for (std::uint32_t i = 0; i < count; ++i) {
            if (screened_.first_half[i] > best_energy_) continue;
            const TexelPosition texel{screened_.u[i], screened_.v[i]};
            if (energy_.bound(texel, screened_.first_half[i]) > best_energy_) continue;
            const std::uint64_t bits = random.draw(i);
            const PlaneIndex plane = random_.plane(v_, bits);
            if (energy_.bound(texel, screened_.first_half[i], plane) > best_energy_) continue;
            consider(random_.candidate(v_, plane, texel, level_.points[v_], bits));
        }
    }

    const SynthesisProblem& problem_;
    const ProblemLevel& level_;
    const ForcedSolid& forced_;
    std::uint32_t epoch_;
    const Choices& choices_;
    const RandomCandidates& random_;
    VoxelEnergy energy_;
    std::vector<CoherentLabel> labels_;
    ScreenedTexels screened_;

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
