#include "core/exemplar/resample_image.h"

#include <array>
#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

#include "core/base/error.h"
#include "core/base/parallel.h"
#include "core/exemplar/color_space.h"

namespace fretwork {
namespace {

using Texel = std::array<float, 4>;  // linear light, premultiplied

/// Which source pixels make up each target pixel: sources first[t] ... with weights that add to 1.
struct Filter {
    std::vector<int> first;
    std::vector<std::size_t> begin;  // CSR into weight, one more than targets
    std::vector<float> weight;
};

Filter area_filter(int source, int target) {
    Filter f;
    f.begin.push_back(0);
    const double scale = static_cast<double>(source) / target;
    for (int t = 0; t < target; ++t) {
        const double from = t * scale, to = (t + 1) * scale;
        const int first = static_cast<int>(from);
        const int last = std::min(source - 1, static_cast<int>(std::ceil(to)) - 1);
        f.first.push_back(first);
        for (int s = first; s <= last; ++s) {
            const double covered = std::min(to, s + 1.0) - std::max(from, static_cast<double>(s));
            f.weight.push_back(static_cast<float>(covered / scale));
        }
        f.begin.push_back(f.weight.size());
    }
    return f;
}

Filter linear_filter(int source, int target) {
    Filter f;
    f.begin.push_back(0);
    for (int t = 0; t < target; ++t) {
        const double x = std::clamp((t + 0.5) * source / target - 0.5, 0.0, source - 1.0);
        const int first = std::min(static_cast<int>(x), std::max(0, source - 2));
        const float share = static_cast<float>(x - first);
        f.first.push_back(first);
        f.weight.push_back(1.0f - share);
        if (source > 1) f.weight.push_back(share);
        f.begin.push_back(f.weight.size());
    }
    return f;
}

Filter make_filter(int source, int target) {
    return target < source ? area_filter(source, target) : linear_filter(source, target);
}

Texel decode(const Rgba8& c, const std::array<float, 256>& linear) {
    const float alpha = static_cast<float>(c[3]) / 255.0f;
    return {linear[c[0]] * alpha, linear[c[1]] * alpha, linear[c[2]] * alpha, alpha};
}

Rgba8 encode(const Texel& t) {
    if (t[3] <= 0) return {0, 0, 0, 0};
    const auto channel = [&](std::size_t k) { return to_byte(linear_to_srgb(t[k] / t[3])); };
    return {channel(0), channel(1), channel(2), to_byte(t[3])};
}

void check(const Image& picture, int width, int height) {
    if (width < 1 || height < 1 || picture.width < 1 || picture.height < 1)
        throw InvalidInput("resample_image: from " + std::to_string(picture.width) + " x " +
                           std::to_string(picture.height) + " to " + std::to_string(width) + " x " +
                           std::to_string(height) + " px; every side must be at least 1 px");
    if (picture.pixels.size() != static_cast<std::size_t>(picture.width) * static_cast<std::size_t>(picture.height))
        throw InvalidInput("resample_image: the picture holds " + std::to_string(picture.pixels.size()) +
                           " pixels, its size says " + std::to_string(picture.width) + " x " +
                           std::to_string(picture.height));
}

}  // namespace

Image resample_image(const Image& picture, int width, int height) {
    check(picture, width, height);
    if (width == picture.width && height == picture.height) return picture;

    std::array<float, 256> linear{};
    for (std::size_t v = 0; v < 256; ++v) linear[v] = srgb_to_linear(static_cast<float>(v) / 255.0f);
    const Filter across = make_filter(picture.width, width);
    const Filter down = make_filter(picture.height, height);
    const auto w = static_cast<std::size_t>(width);

    std::vector<Texel> rows(w * static_cast<std::size_t>(picture.height));
    parallel_for(static_cast<std::size_t>(picture.height), 16, [&](std::size_t y) {
        for (std::size_t x = 0; x < w; ++x) {
            Texel sum{};
            for (std::size_t k = across.begin[x]; k < across.begin[x + 1]; ++k) {
                const int s = across.first[x] + static_cast<int>(k - across.begin[x]);
                const Texel t = decode(picture.at(s, static_cast<int>(y)), linear);
                for (std::size_t c = 0; c < 4; ++c) sum[c] += across.weight[k] * t[c];
            }
            rows[y * w + x] = sum;
        }
    });

    Image out{width, height, {}, picture.has_alpha};
    out.pixels.resize(w * static_cast<std::size_t>(height));
    parallel_for(static_cast<std::size_t>(height), 16, [&](std::size_t y) {
        for (std::size_t x = 0; x < w; ++x) {
            Texel sum{};
            for (std::size_t k = down.begin[y]; k < down.begin[y + 1]; ++k) {
                const Texel& t = rows[(static_cast<std::size_t>(down.first[y]) + k - down.begin[y]) * w + x];
                for (std::size_t c = 0; c < 4; ++c) sum[c] += down.weight[k] * t[c];
            }
            out.pixels[y * w + x] = encode(sum);
        }
    });
    return out;
}

}  // namespace fretwork
