// PNG and JPEG files of kinds that the project reads but does not write.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace fretwork::testing {

struct PngKind {
    int bits = 8;
    int color_type = 2;  ///< 0 grey, 2 RGB, 3 palette, 4 grey + alpha, 6 RGBA
    bool interlaced = false;
    double gamma = 0.0;         ///< of a gAMA chunk; 0 for none
    int transparent_grey = -1;  ///< of a tRNS chunk of grey pictures; -1 for none
};

/// `samples[(y * width + x) * channels + c]`, each in [0, 2^bits - 1]; indices for a palette, whose colour i
/// is (i, 2 i, 3 i) modulo 256 with alpha 255 - i.
std::string make_png(int width, int height, const PngKind& kind, const std::vector<std::uint16_t>& samples);

enum class JpegKind { kGrey, kRgb, kProgressive, kCmykAdobe, kCmykPlain, kYcck };

/// `samples[(y * width + x) * channels + c]` with 1, 3 or 4 channels, quality 100 without subsampling.
/// \param orientation  of an EXIF marker; 0 for none
std::string make_jpeg(int width, int height, JpegKind kind, const std::vector<std::uint8_t>& samples,
                      int orientation = 0);

}  // namespace fretwork::testing
