#include "core/pipeline/output_color.h"

#include <algorithm>

#include "core/exemplar/color_space.h"

namespace fretwork {
namespace {

// The mean over the solid part, in linear light: the picture seen from far away.
Rgb8 mean_solid_color(const Exemplar& exemplar) {
    std::array<double, 3> sum = {0.0, 0.0, 0.0};
    double count = 0.0;
    for (std::size_t p = 0; p < exemplar.color.size(); ++p) {
        if (!exemplar.solid[p]) continue;
        count += 1.0;
        for (std::size_t c = 0; c < 3; ++c)
            sum[c] += static_cast<double>(srgb_to_linear(static_cast<float>(exemplar.color[p][c]) / 255.0F));
    }
    Rgb8 mean{};
    for (std::size_t c = 0; c < 3; ++c)
        mean[c] = to_byte(linear_to_srgb(static_cast<float>(sum[c] / std::max(count, 1.0))));
    return mean;
}

}  // namespace

std::vector<Rgb8> output_colors(std::vector<Rgb8> colors, OutputColor wanted, const Exemplar& exemplar) {
    if (wanted == OutputColor::kNone) colors.clear();
    if (wanted == OutputColor::kSolid) std::ranges::fill(colors, mean_solid_color(exemplar));
    return colors;
}

}  // namespace fretwork
