// Stage 6: the first score, from the stress under the force profile (section 5.2.1), in a few figures.
#pragma once

#include <span>

#include "core/graph/abstract_graph.h"

namespace fretwork {

/// Of the scores of solid edges, in Pa; zeros where there is none.
struct ScoreSummary {
    double max_pa = 0.0;
    double p99_pa = 0.0;  ///< the least score that 99 % of the edges do not exceed
    double median_pa = 0.0;
    double average_pa = 0.0;
};
ScoreSummary summarize_solid_scores(std::span<const double> scores_pa, std::span<const EdgeState> states);

/// Highest score of all edges, empty ones included: what the paper's rule looks at.
double highest_score_pa(std::span<const double> scores_pa);

}  // namespace fretwork
