#include "core/exemplar/tileability.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace fretwork {
namespace {

/// Ratio of the wrap-around step to the mean interior step along the axis of `stride`, for a
/// distance between two pixels.
template <class Step>
double axis_ratio(std::size_t lines, std::size_t line_stride, std::size_t length, std::size_t stride,
                  const Step& step) {
    double interior = 0, border = 0;
    for (std::size_t l = 0; l < lines; ++l) {
        const std::size_t start = l * line_stride;
        for (std::size_t i = 0; i + 1 < length; ++i) interior += step(start + i * stride, start + (i + 1) * stride);
        border += step(start + (length - 1) * stride, start);
    }
    interior /= static_cast<double>(lines * (length - 1));
    border /= static_cast<double>(lines);
    // Half a grey level: a constant picture tiles, and noise of rounding is no step.
    constexpr double kRounding = 0.5 / 255;
    return (border + kRounding) / (interior + kRounding);
}

template <class Step>
double ratio(std::size_t width, std::size_t height, const Step& step) {
    return std::max(axis_ratio(height, width, width, 1, step), axis_ratio(width, 1, height, width, step));
}

}  // namespace

double wrap_step_ratio(std::span<const Rgb8> color, std::span<const float> level, int width, int height) {
    const auto color_step = [&](std::size_t a, std::size_t b) {
        double sum = 0;
        for (std::size_t k = 0; k < 3; ++k) sum += std::abs(static_cast<double>(color[a][k]) - color[b][k]);
        return sum / (3 * 255);
    };
    const auto level_step = [&](std::size_t a, std::size_t b) {
        return std::abs(static_cast<double>(std::clamp(level[a], -0.5f, 0.5f)) - std::clamp(level[b], -0.5f, 0.5f));
    };
    const auto w = static_cast<std::size_t>(width), h = static_cast<std::size_t>(height);
    return std::max(ratio(w, h, color_step), ratio(w, h, level_step));
}

}  // namespace fretwork
