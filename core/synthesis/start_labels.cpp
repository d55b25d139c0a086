#include "core/synthesis/start_labels.h"

#include "core/base/counter_random.h"
#include "core/base/parallel.h"
#include "core/synthesis/candidates.h"

namespace fretwork {
namespace {

Choice random_choice(const SynthesisProblem& problem, const ProblemLevel& level, const RandomCandidates& random,
                     VoxelIndex v, std::uint64_t bits) {
    const Candidate c =
        random.candidate(v, random.plane(v, bits), RandomCandidates::texel(bits), level.points[v], bits);
    return {c.texel, c.part, problem.color_at(level, c.texel), c.label};
}

}  // namespace

Choices constant_labels(const SynthesisProblem& problem, const ProblemLevel& level) {
    Choices choices(level.size());
    const LinearPart part = problem.transforms.linear_part(0);
    parallel_for(level.size(), 1024,
                 [&](std::size_t v) { choices[v] = problem.make_choice(level, {}, part, level.points[v]); });
    return choices;
}

Choices random_labels(const SynthesisProblem& problem, const ProblemLevel& level) {
    Choices choices(level.size());
    const RandomCandidates random(problem, level);
    const auto epoch = static_cast<std::uint32_t>(level.height);
    parallel_for(level.size(), 1024, [&](std::size_t i) {
        const auto v = static_cast<VoxelIndex>(i);
        const std::uint64_t bits =
            counter_random(problem.settings.seed, RandomStream::kSynthesisInit, epoch, level.place(v), 0);
        choices[v] = random_choice(problem, level, random, v, bits);
    });
    return choices;
}

Choices upsample(const SynthesisProblem& problem, const ProblemLevel& level, const Choices& coarser) {
    Choices choices(level.size());
    parallel_for(level.size(), 2048, [&](std::size_t v) {
        const Choice& parent = coarser[level.shell->parent[v]];
        choices[v] = problem.make_choice(level, parent.label, parent.part, level.points[v]);
    });
    return choices;
}

void jitter(const SynthesisProblem& problem, const ProblemLevel& level, Choices& choices) {
    const SynthesisSettings& s = problem.settings;
    if (s.jitter <= 0.0 || level.rank < s.jitter_from_level) return;
    const RandomCandidates random(problem, level);
    const auto epoch = static_cast<std::uint32_t>(level.height);
    parallel_for(level.size(), 1024, [&](std::size_t i) {
        const auto v = static_cast<VoxelIndex>(i);
        const std::uint64_t place = level.place(v);
        if (unit_interval(counter_random(s.seed, RandomStream::kSynthesisJitter, epoch, place, 0)) >= s.jitter) return;
        const std::uint64_t bits = counter_random(s.seed, RandomStream::kSynthesisJitter, epoch, place, 1);
        choices[v] = random_choice(problem, level, random, v, bits);
    });
}

}  // namespace fretwork
