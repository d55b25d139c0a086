#include "core/reinforce/force_profile_score.h"

#include <algorithm>
#include <cstddef>
#include <vector>

#include "core/base/nearest_rank.h"

namespace fretwork {
ScoreSummary summarize_solid_scores(std::span<const double> scores_pa, std::span<const EdgeState> states) {
    std::vector<double> solid;
    for (std::size_t e = 0; e < scores_pa.size(); ++e)
        if (states[e] == EdgeState::kSolid) solid.push_back(scores_pa[e]);
    ScoreSummary summary;
    if (solid.empty()) return summary;
    std::ranges::sort(solid);
    double sum = 0.0;
    for (const double score : solid) sum += score;
    summary.max_pa = solid.back();
    summary.p99_pa = solid[nearest_rank(solid.size(), 0.99)];
    summary.median_pa = solid[nearest_rank(solid.size(), 0.5)];
    summary.average_pa = sum / static_cast<double>(solid.size());
    return summary;
}

double highest_score_pa(std::span<const double> scores_pa) {
    return scores_pa.empty() ? 0.0 : *std::ranges::max_element(scores_pa);
}

}  // namespace fretwork
