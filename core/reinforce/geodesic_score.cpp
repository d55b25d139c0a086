#include "core/reinforce/geodesic_score.h"

#include <algorithm>
#include <cstdint>
#include <queue>
#include <tuple>
#include <utility>

#include "core/base/parallel.h"

namespace fretwork {
namespace {

constexpr double kNoPath = std::numeric_limits<double>::infinity();

/// Edges of the abstract graph seen from its samples, in compressed rows.
class SampleLinks {
  public:
    explicit SampleLinks(const AbstractGraph& graph) : graph_(&graph), first_(graph.samples.size() + 1, 0) {
        for (const AbstractEdge& edge : graph.edges) {
            ++first_[edge.a + 1];
            ++first_[edge.b + 1];
        }
        for (std::size_t s = 1; s < first_.size(); ++s) first_[s] += first_[s - 1];
        edge_.resize(first_.back());
        std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
        for (EdgeIndex e = 0; e < graph.edges.size(); ++e) {
            edge_[next[graph.edges[e].a]++] = e;
            edge_[next[graph.edges[e].b]++] = e;
        }
    }

    [[nodiscard]] std::span<const EdgeIndex> of(SampleIndex s) const {
        return {edge_.data() + first_[s], edge_.data() + first_[s + 1]};
    }
    [[nodiscard]] SampleIndex other_end(EdgeIndex e, SampleIndex s) const {
        return graph_->edges[e].a == s ? graph_->edges[e].b : graph_->edges[e].a;
    }

    /// Dijkstra over solid edges; ends early once `until` is settled (kNoSample: never).
    void distances(std::span<const EdgeState> states, SampleIndex from, SampleIndex until,
                   std::vector<double>& distance) const {
        using Entry = std::pair<double, SampleIndex>;
        std::priority_queue<Entry, std::vector<Entry>, std::greater<>> open;
        distance.assign(graph_->samples.size(), kNoPath);
        distance[from] = 0.0;
        open.emplace(0.0, from);
        while (!open.empty()) {
            const auto [d, s] = open.top();
            open.pop();
            if (s == until) return;
            if (d > distance[s]) continue;
            for (const EdgeIndex e : of(s)) {
                if (states[e] != EdgeState::kSolid) continue;
                const SampleIndex t = other_end(e, s);
                const double next = d + static_cast<double>(graph_->edges[e].length_voxels);
                if (next >= distance[t]) continue;
                distance[t] = next;
                open.emplace(next, t);
            }
        }
    }

  private:
    const AbstractGraph* graph_;
    std::vector<std::uint32_t> first_;
    std::vector<EdgeIndex> edge_;
};

std::vector<double> scores_over(const SampleLinks& links, const AbstractGraph& graph, std::span<const EdgeState> states,
                                const RunControl& run) {
    std::vector<double> scores(graph.edges.size(), 0.0);
    parallel_chunks(graph.samples.size(), 16, [&](std::size_t begin, std::size_t end) {
        run.throw_if_stopped();
        std::vector<double> distance;
        for (auto s = static_cast<SampleIndex>(begin); s < end; ++s) {
            bool looked = false;
            for (const EdgeIndex e : links.of(s)) {
                if (states[e] == EdgeState::kSolid || graph.edges[e].a != s) continue;
                if (!looked) links.distances(states, s, kNoSample, distance);
                looked = true;
                scores[e] = distance[graph.edges[e].b];
            }
        }
    });
    return scores;
}

}  // namespace

std::vector<double> geodesic_scores(const AbstractGraph& graph, std::span<const EdgeState> states,
                                    const RunControl& run) {
    return scores_over(SampleLinks(graph), graph, states, run);
}

double select_by_geodesics(const AbstractGraph& graph, std::span<const double> limits, std::vector<EdgeState>& states,
                           const std::function<bool(EdgeIndex)>& build, const RunControl& run) {
    const SampleLinks links(graph);
    const std::vector<double> scores = scores_over(links, graph, states, run);
    // Largest ratio first, then lowest edge.
    using Entry = std::pair<double, EdgeIndex>;
    const auto later = [](const Entry& x, const Entry& y) {
        return x.first != y.first ? x.first < y.first : x.second > y.second;
    };
    std::priority_queue<Entry, std::vector<Entry>, decltype(later)> queue(later);
    double highest = 0.0;
    for (EdgeIndex e = 0; e < graph.edges.size(); ++e) {
        if (states[e] == EdgeState::kSolid) continue;
        const double ratio = scores[e] / limits[e];
        highest = std::max(highest, ratio);
        if (ratio > 1.0) queue.emplace(ratio, e);
    }
    std::vector<double> distance;
    while (!queue.empty()) {
        run.throw_if_stopped();
        const auto [old_ratio, e] = queue.top();
        queue.pop();
        if (states[e] == EdgeState::kSolid) continue;
        links.distances(states, graph.edges[e].a, graph.edges[e].b, distance);
        const double ratio = distance[graph.edges[e].b] / limits[e];
        if (ratio < old_ratio) {
            if (ratio > 1.0) queue.emplace(ratio, e);
            continue;
        }
        if (!build(e)) break;
        states[e] = EdgeState::kSolid;
    }
    return highest;
}

}  // namespace fretwork
