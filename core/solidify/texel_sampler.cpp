#include "core/solidify/texel_sampler.h"

#include <algorithm>
#include <cmath>

namespace fretwork {
namespace {

/// Solid pixels closer to the border than this are mixed with the colour of what is empty.
constexpr float kMixedPx = 1.25F;

}  // namespace

TexelSampler::TexelSampler(const Exemplar& exemplar) : exemplar_(&exemplar) {
    // Rings of pixels around the solid, nearest in steps; ties by index. Exact Euclid would change no colour visibly.
    const std::size_t count = exemplar.solid.size();
    constexpr std::uint32_t none = ~std::uint32_t{0};
    nearest_solid_.assign(count, none);
    std::vector<std::uint32_t> ring, next;
    const bool has_core = std::any_of(exemplar.feature_distance_px.begin(), exemplar.feature_distance_px.end(),
                                      [](float f) { return f <= -kMixedPx; });
    for (std::uint32_t p = 0; p < count; ++p)
        if (exemplar.solid[p] != 0 && (!has_core || exemplar.feature_distance_px[p] <= -kMixedPx)) {
            nearest_solid_[p] = p;
            ring.push_back(p);
        }
    while (!ring.empty()) {
        next.clear();
        for (const std::uint32_t p : ring) {
            const long x = static_cast<long>(p) % exemplar.width, y = static_cast<long>(p) / exemplar.width;
            for (const auto& [dx, dy] : {std::pair{1L, 0L}, {-1L, 0L}, {0L, 1L}, {0L, -1L}}) {
                const std::size_t q = index(x + dx, y + dy);
                if (nearest_solid_[q] != none) continue;
                nearest_solid_[q] = nearest_solid_[p];
                next.push_back(static_cast<std::uint32_t>(q));
            }
        }
        ring.swap(next);
    }
}

std::size_t TexelSampler::index(long x, long y) const {
    const long w = exemplar_->width, h = exemplar_->height;
    if (x >= 0 && x < w && y >= 0 && y < h) return static_cast<std::size_t>(y * w + x);
    if (exemplar_->tileable) {
        x = (x % w + w) % w;
        y = (y % h + h) % h;
    } else {
        x = std::clamp(x, 0L, w - 1);
        y = std::clamp(y, 0L, h - 1);
    }
    return static_cast<std::size_t>(y * w + x);
}

TexelSampler::Corners TexelSampler::corners(double u, double v) const {
    const double x = u - 0.5, y = v - 0.5;
    const double x0 = std::floor(x), y0 = std::floor(y);
    const double s = x - x0, t = y - y0;
    const long i = static_cast<long>(x0), j = static_cast<long>(y0);
    return {{index(i, j), index(i + 1, j), index(i, j + 1), index(i + 1, j + 1)},
            {(1.0 - s) * (1.0 - t), s * (1.0 - t), (1.0 - s) * t, s * t}};
}

double TexelSampler::feature_distance(double u, double v) const {
    const Corners c = corners(u, v);
    double sum = 0.0;
    for (std::size_t k = 0; k < 4; ++k)
        sum += c.weight[k] * static_cast<double>(exemplar_->feature_distance_px[c.pixel[k]]);
    return sum;
}

Vec3 TexelSampler::solid_color(double u, double v) const {
    const Corners c = corners(u, v);
    Vec3 sum = Vec3::Zero();
    for (std::size_t k = 0; k < 4; ++k) {
        const std::uint32_t nearest = nearest_solid_[c.pixel[k]];
        const Rgb8& color = exemplar_->color[nearest < exemplar_->color.size() ? nearest : c.pixel[k]];
        sum += c.weight[k] * Vec3(color[0], color[1], color[2]);
    }
    return sum;
}

}  // namespace fretwork
