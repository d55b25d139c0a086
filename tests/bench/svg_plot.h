// Curves on logarithmic axes as a picture that a browser shows.
#pragma once

#include <string>
#include <vector>

#include "core/base/vec.h"

namespace fretwork::bench {

struct PlotSeries {
    std::string name;
    std::vector<Vec2> points;  ///< both coordinates above 0; others are left out
};

struct PlotLabels {
    std::string title, x, y;
};

/// An SVG document. A dashed line of slope 1 shows what linear growth looks like.
/// \throws InvalidInput  no point at all.
std::string log_log_plot(const PlotLabels& labels, const std::vector<PlotSeries>& series);

/// The exponent p of the power law y = c x^p that fits best: least squares on logarithms.
/// \throws InvalidInput  fewer than two points with both coordinates above 0.
double fitted_exponent(const std::vector<Vec2>& points);

}  // namespace fretwork::bench
