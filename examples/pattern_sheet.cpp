// The built-in patterns on one sheet, each repeated a little beyond its border, with a part of its mask in a corner.
//   pattern_sheet OUT.png
#include <cstdio>
#include <exception>
#include <vector>

#include "core/exemplar/builtin/builtin_patterns.h"
#include "core/render/contact_sheet.h"
#include "formats/atomic_write.h"
#include "formats/png_writer.h"

namespace {

using namespace fretwork;

/// One swatch: the picture, continued across its borders to one size for all, and a quarter of the mask.
Image swatch(const PatternPictures& pattern) {
    constexpr int kSide = 208, kMask = 56;
    const int width = pattern.color.width, height = pattern.color.height;
    Image out{kSide, kSide, {}, false};
    for (int y = 0; y < kSide; ++y)
        for (int x = 0; x < kSide; ++x) {
            const bool in_mask = x >= kSide - kMask && y >= kSide - kMask;
            out.pixels.push_back((in_mask ? pattern.mask : pattern.color).at(x % width, y % height));
        }
    return out;
}

}  // namespace

int main(int count, char** arguments) {
    if (count != 2) {
        std::fprintf(stderr, "usage: pattern_sheet OUT.png\n");
        return 1;
    }
    try {
        std::vector<Image> swatches;
        for (const BuiltinPattern& pattern : builtin_patterns()) swatches.push_back(swatch(draw_builtin(pattern.name)));
        atomic_write(arguments[1], write_png(contact_sheet(swatches, 6)));
    } catch (const std::exception& error) {
        std::fprintf(stderr, "pattern_sheet: %s\n", error.what());
        return 2;
    }
}
