#include "likeness/pattern_picture.h"

#include <algorithm>
#include <cmath>

namespace fretwork::likeness {
namespace {

int continued(int i, int size, bool wraps) {
    if (!wraps) return std::clamp(i, 0, size - 1);
    const int rest = i % size;
    return rest < 0 ? rest + size : rest;
}

PatternPixel pixel_of(const Exemplar& e, int x, int y) {
    const auto i = static_cast<std::size_t>(y) * static_cast<std::size_t>(e.width) + static_cast<std::size_t>(x);
    const auto share = [](std::uint8_t value) { return static_cast<float>(value) / 255.0F; };
    return {share(e.color[i][0]), share(e.color[i][1]), share(e.color[i][2]), e.solid[i] != 0 ? 1.0F : 0.0F};
}

/// Mean over the part of the exemplar in [x0, x1) x [y0, y1).
PatternPixel mean_over(const Exemplar& e, double x0, double x1, double y0, double y1) {
    PatternPixel sum{};
    for (int y = static_cast<int>(y0); y < e.height && y < y1; ++y)
        for (int x = static_cast<int>(x0); x < e.width && x < x1; ++x) {
            const double covered = (std::min(x + 1.0, x1) - std::max<double>(x, x0)) *
                                   (std::min(y + 1.0, y1) - std::max<double>(y, y0)) / ((x1 - x0) * (y1 - y0));
            const PatternPixel pixel = pixel_of(e, x, y);
            for (std::size_t c = 0; c < 4; ++c) sum[c] += static_cast<float>(covered) * pixel[c];
        }
    return sum;
}

}  // namespace

PatternPixel PatternPicture::read(double x, double y) const {
    const double left = std::floor(x - 0.5), top = std::floor(y - 0.5);
    const auto fx = static_cast<float>(x - 0.5 - left), fy = static_cast<float>(y - 0.5 - top);
    const int x0 = continued(static_cast<int>(left), width, wraps);
    const int x1 = continued(static_cast<int>(left) + 1, width, wraps);
    const int y0 = continued(static_cast<int>(top), height, wraps);
    const int y1 = continued(static_cast<int>(top) + 1, height, wraps);
    PatternPixel result;
    for (std::size_t c = 0; c < 4; ++c) {
        const float high = at(x0, y0)[c] + fx * (at(x1, y0)[c] - at(x0, y0)[c]);
        const float low = at(x0, y1)[c] + fx * (at(x1, y1)[c] - at(x0, y1)[c]);
        result[c] = high + fy * (low - high);
    }
    return result;
}

double PatternPicture::solid_fraction() const {
    double sum = 0.0;
    for (const PatternPixel& p : pixels) sum += static_cast<double>(p[3]);
    return sum / static_cast<double>(pixels.size());
}

PatternPicture picture_of(const Exemplar& exemplar, int width) {
    const double step_x = static_cast<double>(exemplar.width) / width;
    const int height = std::max(1, static_cast<int>(std::lround(exemplar.height / step_x)));
    const double step_y = static_cast<double>(exemplar.height) / height;
    PatternPicture picture{width, height, exemplar.tileable, {}};
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            picture.pixels.push_back(mean_over(exemplar, x * step_x, (x + 1) * step_x, y * step_y, (y + 1) * step_y));
    return picture;
}

PatternPicture halved(const PatternPicture& picture, int dx, int dy) {
    const int cut_x = picture.wraps ? 0 : dx, cut_y = picture.wraps ? 0 : dy;
    PatternPicture half{(picture.width - cut_x) / 2, (picture.height - cut_y) / 2, picture.wraps, {}};
    for (int y = 0; y < half.height; ++y)
        for (int x = 0; x < half.width; ++x) {
            PatternPixel sum{};
            for (int j = 0; j < 2; ++j)
                for (int i = 0; i < 2; ++i) {
                    const PatternPixel& p =
                        picture.at((2 * x + dx + i) % picture.width, (2 * y + dy + j) % picture.height);
                    for (std::size_t c = 0; c < 4; ++c) sum[c] += 0.25F * p[c];
                }
            half.pixels.push_back(sum);
        }
    return half;
}

}  // namespace fretwork::likeness
