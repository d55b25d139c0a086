#include "core/exemplar/builtin/turing.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "core/exemplar/builtin/drawing.h"

namespace fretwork::drawing {
namespace {

std::vector<double> gaussian_kernel(double sigma) {
    const int reach = static_cast<int>(std::ceil(3 * sigma));
    std::vector<double> kernel;
    double sum = 0;
    for (int i = -reach; i <= reach; ++i) {
        kernel.push_back(std::exp(-0.5 * i * i / (sigma * sigma)));
        sum += kernel.back();
    }
    for (double& k : kernel) k /= sum;
    return kernel;
}

/// One axis of a periodic convolution; pixels of a line lie `stride` apart.
std::vector<double> blur_axis(const std::vector<double>& in, int side, bool along_y, double sigma) {
    const std::vector<double> kernel = gaussian_kernel(sigma);
    const int reach = static_cast<int>(kernel.size() / 2);
    std::vector<double> out(in.size());
    const auto at = [&](int line, int i) {
        const int w = (i % side + side) % side;
        const int index = along_y ? w * side + line : line * side + w;
        return static_cast<std::size_t>(index);
    };
    for (int line = 0; line < side; ++line)
        for (int i = 0; i < side; ++i) {
            double sum = 0;
            int k = i - reach;
            for (const double weight : kernel) sum += weight * in[at(line, k++)];
            out[at(line, i)] = sum;
        }
    return out;
}

}  // namespace

TuringField::TuringField(const TuringSettings& settings) : side_(settings.side) {
    const auto count = static_cast<std::size_t>(side_) * static_cast<std::size_t>(side_);
    value_.resize(count);
    for (std::size_t i = 0; i < count; ++i) value_[i] = 2 * random_unit(settings.seed, i, 0) - 1;
    // The difference of two Gaussians answers most to waves of the wanted period; growth saturates
    // through the hyperbolic tangent.
    const double narrow = settings.period_cells * 0.16, wide = settings.period_cells * 0.34;
    const auto blur = [&](const std::vector<double>& in, double sigma, double stretch) {
        return blur_axis(blur_axis(in, side_, false, sigma), side_, true, sigma * stretch);
    };
    for (int step = 0; step < settings.steps; ++step) {
        const std::vector<double> activator = blur(value_, narrow, settings.stretch);
        const std::vector<double> inhibitor = blur(activator, wide, 1.0);
        for (std::size_t i = 0; i < count; ++i)
            value_[i] = std::tanh(4.0 * (activator[i] - inhibitor[i] + settings.bias));
    }
    value_ = blur(value_, narrow * 0.6, 1.0);
}

double TuringField::at(double x, double y) const {
    const double gx = x * side_, gy = y * side_;
    const int ix = static_cast<int>(std::floor(gx)), iy = static_cast<int>(std::floor(gy));
    const auto weights = [](double t) -> std::array<double, 4> {
        const double s = 1 - t;
        return {s * s * s / 6, (3 * t * t * t - 6 * t * t + 4) / 6, (3 * s * s * s - 6 * s * s + 4) / 6, t * t * t / 6};
    };
    const std::array<double, 4> wx = weights(gx - ix), wy = weights(gy - iy);
    double sum = 0;
    for (int j = 0; j < 4; ++j)
        for (int i = 0; i < 4; ++i) {
            const int cx = ((ix + i - 1) % side_ + side_) % side_, cy = ((iy + j - 1) % side_ + side_) % side_;
            const int cell = cy * side_ + cx;
            sum += wx[static_cast<std::size_t>(i)] * wy[static_cast<std::size_t>(j)] *
                   value_[static_cast<std::size_t>(cell)];
        }
    return sum;
}

double TuringField::distance_px(const Vec2& p, double side_px) const {
    constexpr double kStep = 0.5;
    // Where the field is flat (the middle of a stripe) the quotient by the slope would run away.
    constexpr double kLeastSlope = 0.03;
    const auto value = [&](const Vec2& q) { return at(q.x() / side_px, q.y() / side_px); };
    const Vec2 slope((value(p + Vec2(kStep, 0)) - value(p - Vec2(kStep, 0))) / (2 * kStep),
                     (value(p + Vec2(0, kStep)) - value(p - Vec2(0, kStep))) / (2 * kStep));
    return -value(p) / std::max(slope.norm(), kLeastSlope);
}

}  // namespace fretwork::drawing
