#include "core/render/light_filter.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "core/base/parallel.h"

namespace fretwork {

std::vector<Vec3f> filter_light(const std::vector<LightPixel>& pixels, int width, int height, float pixel_tangent,
                                const RunControl& run) {
    constexpr int kReach = 4;
    std::vector<Vec3f> out(pixels.size());
    parallel_for(static_cast<std::size_t>(height), 8, [&](std::size_t row) {
        run.throw_if_stopped();
        const int y = static_cast<int>(row);
        for (int x = 0; x < width; ++x) {
            const std::size_t i = row * static_cast<std::size_t>(width) + static_cast<std::size_t>(x);
            const LightPixel& here = pixels[i];
            out[i] = here.light;
            if (here.depth <= 0) continue;
            Vec3f sum = Vec3f::Zero();
            float total = 0;
            for (int dy = std::max(-kReach, -y); dy <= std::min(kReach, height - 1 - y); ++dy)
                for (int dx = std::max(-kReach, -x); dx <= std::min(kReach, width - 1 - x); ++dx) {
                    const int at = (y + dy) * width + x + dx;
                    const LightPixel& there = pixels[static_cast<std::size_t>(at)];
                    if (there.depth <= 0) continue;
                    const float turn = std::max(0.0f, here.normal.dot(there.normal));
                    // Depth may change along a slanted surface by a few pixel widths per pixel.
                    const float step = std::abs(there.depth - here.depth) / (4.0f * pixel_tangent * here.depth);
                    const float near = 1.0f / (1.0f + step * step / (1.0f + static_cast<float>(dx * dx + dy * dy)));
                    const float turn4 = turn * turn * turn * turn;
                    const float weight = turn4 * turn4 * near * near + (dx == 0 && dy == 0 ? 1e-3f : 0.0f);
                    sum += weight * there.light;
                    total += weight;
                }
            out[i] = sum / total;
        }
    });
    return out;
}

}  // namespace fretwork
