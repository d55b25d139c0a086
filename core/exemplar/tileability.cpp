#include "core/exemplar/tileability.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace fretwork {
namespace {

/// One axis: `lines` lines of `length` pixels; pixels of a line lie `stride` apart. A "step" is the
/// mean over all lines of the difference between position i and the next.
struct Axis {
    std::size_t lines, line_stride, length, stride;
};

template <class Difference>
WrapStep measure_axis(const Axis& axis, const Difference& difference) {
    const auto step_after = [&](std::size_t i) {
        const std::size_t a = i * axis.stride, b = (i + 1) % axis.length * axis.stride;
        double sum = 0;
        for (std::size_t l = 0; l < axis.lines; ++l)
            sum += difference(l * axis.line_stride + a, l * axis.line_stride + b);
        return sum / static_cast<double>(axis.lines);
    };
    double mean = 0, largest = 0;
    for (std::size_t i = 0; i + 1 < axis.length; ++i) {
        const double step = step_after(i);
        mean += step / static_cast<double>(axis.length - 1);
        largest = std::max(largest, step);
    }
    const double border = step_after(axis.length - 1);
    // Half a grey level: a constant picture tiles, and noise of rounding is no step.
    constexpr double kRounding = 0.5 / 255;
    return {(border + kRounding) / (mean + kRounding), (border + kRounding) / (largest + kRounding)};
}

template <class Difference>
WrapStep measure(std::size_t width, std::size_t height, const Difference& difference) {
    const WrapStep x = measure_axis({height, width, width, 1}, difference);
    const WrapStep y = measure_axis({width, 1, height, width}, difference);
    return {std::max(x.to_mean, y.to_mean), std::max(x.to_largest, y.to_largest)};
}

}  // namespace

WrapStep measure_wrap_step(std::span<const Rgb8> color, std::span<const std::uint8_t> solid, int width, int height) {
    const auto w = static_cast<std::size_t>(width), h = static_cast<std::size_t>(height);
    const WrapStep c = measure(w, h, [&](std::size_t a, std::size_t b) {
        int sum = 0;
        for (std::size_t k = 0; k < 3; ++k) sum += std::abs(color[a][k] - color[b][k]);
        return sum / (3.0 * 255.0);
    });
    const WrapStep m = measure(w, h, [&](std::size_t a, std::size_t b) { return solid[a] != solid[b] ? 1.0 : 0.0; });
    return {std::max(c.to_mean, m.to_mean), std::max(c.to_largest, m.to_largest)};
}

bool is_tileable(const WrapStep& step) {
    return step.to_mean <= 1.25 || (step.to_mean <= 2.0 && step.to_largest <= 1.15);
}

}  // namespace fretwork
