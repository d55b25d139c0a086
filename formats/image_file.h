// Picture files -> Image and back.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>

#include "core/exemplar/image.h"

namespace fretwork {

struct ImageLimits {
    int max_side_px = 20000;
    std::size_t max_pixels = std::size_t{64} << 20;  ///< 256 MB in memory
};

/// Reads PNG or JPEG, told apart by their first bytes. The first picture of an animation.
/// \throws InvalidInput  neither, broken, or beyond the limits; names the file, what was found, what was expected.
Image read_image(std::string_view bytes, std::string_view source, const ImageLimits& limits = {});

/// \throws FileError  cannot be opened.
Image read_image(const std::filesystem::path& path, const ImageLimits& limits = {});

/// PNG; appears whole or not at all.
void write_image(const std::filesystem::path& path, const Image& image);

}  // namespace fretwork
