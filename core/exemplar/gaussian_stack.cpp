#include "core/exemplar/gaussian_stack.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <string>

#include "core/base/error.h"
#include "core/base/parallel.h"

namespace fretwork {
namespace {

constexpr int kChannels = 4;
using Texel = std::array<float, kChannels>;
using Plane = std::vector<Texel>;

/// Half of a normalised Gaussian, weight[0] in the middle.
std::vector<float> gaussian_kernel(double sigma) {
    const int radius = std::max(1, static_cast<int>(std::ceil(3.0 * sigma)));
    std::vector<double> weight(static_cast<std::size_t>(radius) + 1);
    double sum = 0.0;
    for (int i = 0; i <= radius; ++i) {
        weight[static_cast<std::size_t>(i)] = std::exp(-0.5 * i * i / (sigma * sigma));
        sum += (i == 0 ? 1.0 : 2.0) * weight[static_cast<std::size_t>(i)];
    }
    std::vector<float> kernel;
    kernel.reserve(weight.size());
    for (const double w : weight) kernel.push_back(static_cast<float>(w / sum));
    return kernel;
}

/// Index of the pixel that continues a row of `size` pixels at position i.
int continued(int i, int size, bool tileable) {
    const int period = tileable ? size : 2 * size;
    const int folded = ((i % period) + period) % period;
    return folded < size ? folded : period - 1 - folded;
}

/// Blurs along y and writes the result transposed, so that calling it twice blurs both ways and
/// every pass walks whole rows.
Plane blur_and_transpose(const Plane& in, int width, int height, const std::vector<float>& kernel, bool tileable) {
    const int radius = static_cast<int>(kernel.size()) - 1;
    const auto w = static_cast<std::size_t>(width), h = static_cast<std::size_t>(height);
    Plane out(in.size());
    parallel_chunks(h, 4, [&](std::size_t begin, std::size_t end) {
        Plane row(w);
        for (std::size_t y = begin; y < end; ++y) {
            std::fill(row.begin(), row.end(), Texel{});
            for (int i = -radius; i <= radius; ++i) {
                const float weight = kernel[static_cast<std::size_t>(std::abs(i))];
                const auto source = static_cast<std::size_t>(continued(static_cast<int>(y) + i, height, tileable));
                const Texel* from = in.data() + source * w;
                for (std::size_t x = 0; x < w; ++x)
                    for (std::size_t c = 0; c < kChannels; ++c) row[x][c] += weight * from[x][c];
            }
            for (std::size_t x = 0; x < w; ++x) out[x * h + y] = row[x];
        }
    });
    return out;
}

/// Distance at which the feature channel saturates: the 95th percentile of its size.
float feature_reach(const std::vector<float>& distance) {
    std::vector<float> size;
    size.reserve(distance.size());
    for (const float d : distance) size.push_back(std::fabs(d));
    const auto nth = size.begin() + static_cast<std::ptrdiff_t>(size.size() * 95 / 100);
    std::nth_element(size.begin(), nth, size.end());
    return std::max(*nth, 0.5F);
}

Plane to_planes(const Exemplar& exemplar, double feature_weight) {
    const float reach = feature_reach(exemplar.feature_distance_px);
    const auto amplitude = static_cast<float>(127.0 * std::sqrt(feature_weight));
    Plane plane(exemplar.color.size());
    for (std::size_t i = 0; i < plane.size(); ++i) {
        for (std::size_t c = 0; c < 3; ++c) plane[i][c] = static_cast<float>(exemplar.color[i][c]);
        plane[i][3] = 128.0F + amplitude * std::clamp(exemplar.feature_distance_px[i] / reach, -1.0F, 1.0F);
    }
    return plane;
}

std::vector<std::uint32_t> pack(const Plane& plane) {
    std::vector<std::uint32_t> texels(plane.size());
    for (std::size_t i = 0; i < plane.size(); ++i)
        for (std::size_t c = 0; c < kChannels; ++c) {
            const auto value = static_cast<std::uint32_t>(std::clamp(plane[i][c] + 0.5F, 0.0F, 255.0F));
            texels[i] |= value << (8 * c);
        }
    return texels;
}

double contrast_of(const std::vector<std::uint32_t>& texels) {
    double sum[kChannels] = {}, squares[kChannels] = {};
    for (const std::uint32_t t : texels)
        for (std::size_t c = 0; c < kChannels; ++c) {
            const double value = (t >> (8 * c) & 0xFFu) / 255.0;
            sum[c] += value;
            squares[c] += value * value;
        }
    const auto n = static_cast<double>(texels.size());
    double variance = 0.0;
    for (std::size_t c = 0; c < kChannels; ++c) variance += std::max(0.0, squares[c] / n - sum[c] * sum[c] / (n * n));
    return std::sqrt(variance / kChannels);
}

}  // namespace

GaussianStack build_gaussian_stack(const Exemplar& exemplar, const GaussianStackSettings& settings) {
    if (settings.levels < 1)
        throw InvalidSetting("Gaussian stack: levels is " + std::to_string(settings.levels) + ", expected at least 1");
    if (!(settings.pixels_per_voxel > 0.0) || !std::isfinite(settings.pixels_per_voxel))
        throw InvalidSetting("Gaussian stack: pixels_per_voxel is " + std::to_string(settings.pixels_per_voxel) +
                             ", expected a positive number");
    if (!(settings.feature_weight >= 0.0 && settings.feature_weight <= 1.0))
        throw InvalidSetting("Gaussian stack: feature_weight is " + std::to_string(settings.feature_weight) +
                             ", expected a number in [0, 1]");

    GaussianStack stack{exemplar.width, exemplar.height, {}, {}};
    const Plane sharp = to_planes(exemplar, settings.feature_weight);
    // Beyond a third of the picture a wider kernel changes nothing but the time it takes.
    const double widest = std::max(exemplar.width, exemplar.height) / 3.0;
    const double flat = settings.flat_contrast * contrast_of(pack(sharp));
    for (int l = 0; l < settings.levels; ++l) {
        const double footprint = std::ldexp(settings.pixels_per_voxel, l);
        const double sigma = std::min(widest, 0.35 * std::sqrt(std::max(0.0, footprint * footprint - 1.0)));
        if (sigma < 0.2) {
            stack.levels.push_back(pack(sharp));
        } else {
            const std::vector<float> kernel = gaussian_kernel(sigma);
            const Plane half = blur_and_transpose(sharp, exemplar.width, exemplar.height, kernel, exemplar.tileable);
            stack.levels.push_back(
                pack(blur_and_transpose(half, exemplar.height, exemplar.width, kernel, exemplar.tileable)));
        }
        stack.contrast.push_back(contrast_of(stack.levels.back()));
        if (settings.flat_contrast > 0.0 && stack.contrast.back() <= flat) break;
    }
    return stack;
}

}  // namespace fretwork
