#include "core/graph/poisson_disk.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/base/counter_random.h"
#include "core/base/error.h"
#include "core/base/parallel.h"
#include "core/graph/shortest_path_forest.h"

namespace fretwork {
namespace {

/// Solid voxels of each component of the shell, in the order in which they are offered as samples.
std::vector<std::vector<VoxelIndex>> shuffled_by_component(const ShellComponents& shell_components,
                                                           const SolidStates& solid, std::uint64_t seed) {
    using Card = std::pair<std::uint64_t, VoxelIndex>;
    std::vector<std::vector<Card>> cards(shell_components.count());
    for (VoxelIndex v = 0; v < solid.size(); ++v)
        if (solid[v] == SolidState::kSolid) cards[shell_components.of[v]].emplace_back(0, v);
    std::vector<std::vector<VoxelIndex>> order(cards.size());
    for (std::size_t c = 0; c < cards.size(); ++c) {
        std::vector<Card>& pack = cards[c];
        parallel_for(pack.size(), 4096, [&](std::size_t i) {
            pack[i].first = counter_random(seed, RandomStream::kSamples, 0, pack[i].second, 0);
        });
        std::ranges::sort(pack);
        for (const Card& card : pack) order[c].push_back(card.second);
    }
    return order;
}

/// Throws darts in the given order: a voxel farther than `radius` from every sample becomes one. Ends
/// early, with more than `most` samples, when there are that many.
std::vector<VoxelIndex> throw_darts(ForestGrower& grower, const std::vector<VoxelIndex>& order, GraphDistance radius,
                                    std::size_t most, const RunControl& run) {
    grower.forget(order);
    std::vector<VoxelIndex> samples;
    for (const VoxelIndex v : order) {
        if (grower.forest().distance[v] != kUnreached) continue;
        grower.plant(v, static_cast<std::uint32_t>(samples.size()));
        grower.grow(radius);
        samples.push_back(v);
        if (samples.size() > most) break;
        if (samples.size() % 64 == 0) run.throw_if_stopped();
    }
    return samples;
}

struct ComponentSamples {
    std::vector<VoxelIndex> voxels;
    double radius_voxels = 0.0;
};

/// Bisection on the radius; while one side is open, the count is taken to fall with the power 1.5 of
/// the radius, between that of a strand (1) and that of a surface (2).
ComponentSamples sample_component(ForestGrower& grower, const std::vector<VoxelIndex>& order, std::size_t target,
                                  const SampleSettings& settings, double start_radius, const RunControl& run) {
    constexpr int kTries = 14;
    const std::size_t most = target + target / 2 + 8;
    const auto miss = [&](std::size_t count) {
        return std::abs(static_cast<double>(count) / static_cast<double>(target) - 1.0);
    };
    double low = 0.0;
    double high = 0.0;  // 0: no radius is known yet that gives too few
    // Random sequential discs of distance r hold 0.7 / r^2 centres per unit area.
    double radius = std::sqrt(0.7 * static_cast<double>(order.size()) / static_cast<double>(target));
    radius = std::max(radius, 0.5);
    if (start_radius > 0.0) radius = start_radius;
    ComponentSamples best;
    for (int attempt = 0; attempt < kTries; ++attempt) {
        std::vector<VoxelIndex> samples = throw_darts(grower, order, to_distance(radius), most, run);
        const std::size_t count = samples.size();
        const bool whole = count <= most;
        if (whole && (best.voxels.empty() || miss(count) < miss(best.voxels.size())))
            best = {std::move(samples), radius};
        const bool is_start = start_radius > 0.0 && attempt == 0;
        if (whole && miss(count) <= (is_start ? settings.start_tolerance : settings.tolerance)) break;
        (count > target ? low : high) = radius;
        if (high > 0.0 && high - low < 0.02 * high) break;
        const double guess = radius * std::pow(static_cast<double>(count) / static_cast<double>(target), 1.0 / 1.5);
        if (high == 0.0)
            radius = std::max(guess, 1.1 * radius);
        else if (guess > low + 0.1 * (high - low) && guess < high - 0.1 * (high - low))
            radius = guess;
        else
            radius = 0.5 * (low + high);
        if (radius < 0.5) break;  // shorter than any link: every voxel is a sample already
    }
    if (best.voxels.empty() || best.voxels.size() > most) {
        // More pieces than samples were asked for: one for each of them.
        const double beyond_any_path = to_voxels(kUnreached / 2);
        best = {throw_darts(grower, order, kUnreached / 2, order.size(), run), beyond_any_path};
    }
    return best;
}

}  // namespace

Samples poisson_samples(const Adjacency& graph, const ShellComponents& shell_components, const SolidStates& solid,
                        const SampleSettings& settings, const RunControl& run) {
    if (settings.target == 0) throw InvalidSetting("poisson_samples: target is 0; at least 1 sample is needed");
    const std::vector<std::vector<VoxelIndex>> order = shuffled_by_component(shell_components, solid, settings.seed);
    std::size_t solid_voxels = 0;
    for (const std::vector<VoxelIndex>& voxels : order) solid_voxels += voxels.size();

    std::vector<std::uint8_t> included(solid.size());
    for (std::size_t v = 0; v < solid.size(); ++v) included[v] = solid[v] == SolidState::kSolid ? 1 : 0;
    ForestGrower grower(graph, std::move(included));

    Samples result;
    result.radius_voxels.assign(order.size(), 0.0);
    for (std::size_t c = 0; c < order.size(); ++c) {
        if (order[c].empty()) continue;
        const std::size_t share = settings.target * order[c].size() / solid_voxels;
        const std::size_t target = std::min(std::max({share, settings.least, std::size_t{1}}), order[c].size());
        const double start_radius = settings.start_radius_voxels.empty() ? 0.0 : settings.start_radius_voxels[c];
        ComponentSamples part = sample_component(grower, order[c], target, settings, start_radius, run);
        result.voxels.insert(result.voxels.end(), part.voxels.begin(), part.voxels.end());
        result.radius_voxels[c] = part.radius_voxels;
    }
    std::ranges::sort(result.voxels);
    return result;
}

}  // namespace fretwork
