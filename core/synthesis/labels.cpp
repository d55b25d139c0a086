#include "core/synthesis/labels.h"

#include <cmath>
#include <cstddef>

#include "core/base/parallel.h"

namespace fretwork {
namespace {

std::size_t wrapped(std::int64_t i, int size) {
    const std::int64_t rest = i % size;
    return static_cast<std::size_t>(rest < 0 ? rest + size : rest);
}

/// Pixel i of a side, continued periodically or, where the picture does not tile, by its border.
std::size_t continued(std::int64_t i, int size, bool tileable) {
    if (tileable) return wrapped(i, size);
    return static_cast<std::size_t>(i < 0 ? 0 : i >= size ? size - 1 : i);
}

std::uint8_t blend(float a, float b, float c, float d, float x, float y) {
    const float low = a + (b - a) * x, high = c + (d - c) * x;
    // NOLINTNEXTLINE(bugprone-incorrect-roundings): never below zero, and in an inner loop
    return static_cast<std::uint8_t>(low + (high - low) * y + 0.5F);
}

}  // namespace

SolidStates read_solid(const Exemplar& exemplar, const TexelFrames& frames) {
    SolidStates solid(frames.size());
    parallel_for(frames.size(), 4096, [&](std::size_t v) {
        const std::size_t x = wrapped(static_cast<std::int64_t>(std::floor(frames[v].u)), exemplar.width);
        const std::size_t y = wrapped(static_cast<std::int64_t>(std::floor(frames[v].v)), exemplar.height);
        const bool is_solid = exemplar.solid[y * static_cast<std::size_t>(exemplar.width) + x] != 0;
        solid[v] = is_solid ? SolidState::kSolid : SolidState::kEmpty;
    });
    return solid;
}

std::vector<Rgb8> read_color(const Exemplar& exemplar, const TexelFrames& frames) {
    std::vector<Rgb8> colors(frames.size());
    const auto stride = static_cast<std::size_t>(exemplar.width);
    parallel_for(frames.size(), 4096, [&](std::size_t v) {
        // Pixel i covers [i, i + 1); its middle is at i + 1/2.
        const float u = frames[v].u - 0.5F, w = frames[v].v - 0.5F;
        const float left = std::floor(u), top = std::floor(w);
        const auto x = static_cast<std::int64_t>(left), y = static_cast<std::int64_t>(top);
        const std::size_t x0 = continued(x, exemplar.width, exemplar.tileable);
        const std::size_t x1 = continued(x + 1, exemplar.width, exemplar.tileable);
        const std::size_t y0 = continued(y, exemplar.height, exemplar.tileable) * stride;
        const std::size_t y1 = continued(y + 1, exemplar.height, exemplar.tileable) * stride;
        for (std::size_t c = 0; c < 3; ++c)
            colors[v][c] = blend(exemplar.color[y0 + x0][c], exemplar.color[y0 + x1][c], exemplar.color[y1 + x0][c],
                                 exemplar.color[y1 + x1][c], u - left, w - top);
    });
    return colors;
}

}  // namespace fretwork
