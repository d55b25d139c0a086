// Stress -> colour: one logarithmic scale for everything that is to be compared.
#pragma once

#include <cstdint>

#include "core/exemplar/image.h"
#include "core/pipeline/carve_trace.h"

namespace fretwork {

/// From `low_mpa` to `high_mpa`, both above 0.
struct StressScale {
    double low_mpa = 1e-3;
    double high_mpa = 1.0;

    /// 0 at the low end and below, 1 at the high end and above; in between by the logarithm.
    [[nodiscard]] double place(double mpa) const;
};

/// Three decades that end at 1, 2 or 5 times a power of ten, just above every sample of both patterns.
StressScale stress_scale(const ShellStress& stress);

/// Viridis, the perceptually uniform map from dark blue to yellow, by a polynomial within 0.01 of its table.
/// \param place  in [0, 1]; clamped
Rgb8 stress_color(double place);

}  // namespace fretwork
