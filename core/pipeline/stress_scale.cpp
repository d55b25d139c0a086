#include "core/pipeline/stress_scale.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace fretwork {
namespace {

constexpr double kDecades = 3.0;

/// The least of 1, 2 and 5 times a power of ten that is not below `value`.
double rounded_up(double value) {
    const double power = std::pow(10.0, std::floor(std::log10(value)));
    for (const double step : {1.0, 2.0, 5.0})
        if (value <= step * power * (1.0 + 1e-9)) return step * power;
    return 10.0 * power;
}

}  // namespace

double StressScale::place(double mpa) const {
    if (!(mpa > low_mpa)) return 0.0;
    return std::min(1.0, std::log(mpa / low_mpa) / std::log(high_mpa / low_mpa));
}

StressScale stress_scale(const ShellStress& stress) {
    double most = 0.0;
    for (const StressField* field : {&stress.before, &stress.after})
        if (!field->samples_mpa.empty()) most = std::max(most, field->samples_mpa.back());
    const double high = most > 0.0 && std::isfinite(most) ? rounded_up(most) : 1.0;
    return {high * std::pow(10.0, -kDecades), high};
}

Rgb8 stress_color(double place) {
    // Coefficients of ascending powers, for red, green and blue.
    constexpr std::array<std::array<double, 7>, 3> kPolynomial = {
        {{0.27772733, 0.10509304, -0.33086183, -4.63423050, 6.22826994, 4.77638500, -5.43545586},
         {0.00540734, 1.40461353, 0.21484756, -5.79910097, 14.17993337, -13.74514538, 4.64585261},
         {0.33409981, 1.38459016, 0.09509516, -19.33244096, 56.69055260, -65.35303263, 26.31243525}}};
    const double t = std::clamp(place, 0.0, 1.0);
    Rgb8 color{};
    for (std::size_t k = 0; k < 3; ++k) {
        double value = 0.0;
        for (std::size_t power = 7; power-- > 0;) value = value * t + kPolynomial[k][power];
        color[k] = static_cast<std::uint8_t>(std::lround(255.0 * std::clamp(value, 0.0, 1.0)));
    }
    return color;
}

}  // namespace fretwork
