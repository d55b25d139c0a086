// What a pattern shows, at one pixel per voxel: the common form in which exemplar, baselines and our results are
// compared.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "core/base/vec.h"
#include "core/exemplar/exemplar.h"

namespace fretwork::likeness {

/// Red, green, blue (as the picture codes them) and solid, each in [0, 1].
using PatternPixel = std::array<float, 4>;

/// Row 0 on top.
struct PatternPicture {
    int width = 0;
    int height = 0;
    bool wraps = false;  ///< continues periodically; else by its border
    std::vector<PatternPixel> pixels;

    [[nodiscard]] const PatternPixel& at(int x, int y) const {
        return pixels[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x)];
    }
    /// Bilinear; pixel i covers [i, i + 1).
    [[nodiscard]] PatternPixel read(double x, double y) const;
    [[nodiscard]] double solid_fraction() const;
};

/// The exemplar at `width` pixels across, by area.
PatternPicture picture_of(const Exemplar& exemplar, int width);

/// A picture of the given size whose pixel (x, y) reads `source` at `place(x, y)`, its pixel units.
template <class Place>
PatternPicture read_picture(const PatternPicture& source, int width, int height, const Place& place) {
    PatternPicture result{width, height, false, {}};
    result.pixels.reserve(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            const Vec2 at = place(x, y);
            result.pixels.push_back(source.read(at.x(), at.y()));
        }
    return result;
}

/// Half the size, each pixel the mean of four; a last odd row or column is left out. `dx`, `dy`: where the first
/// pixel starts; a picture that wraps goes on past its border, another one is cut.
PatternPicture halved(const PatternPicture& picture, int dx = 0, int dy = 0);

}  // namespace fretwork::likeness
