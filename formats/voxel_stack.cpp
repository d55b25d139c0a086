#include "formats/voxel_stack.h"

#include <algorithm>

#include "core/base/error.h"

namespace fretwork {
namespace {

constexpr std::int64_t kSide = 8;  ///< of a tile, in pixels

/// Set in the place of a tile whose pixels are all alike, of which only one is there.
constexpr std::uint32_t kOnePixel = std::uint32_t{1} << 31;

std::int64_t tiles_along(std::int64_t pixels) {
    return (pixels + kSide - 1) / kSide;
}

/// The pixels of one tile, row by row; those beyond the sheet repeat its last ones.
void copy_tile(const RawPng& sheet, std::int64_t left, std::int64_t top, std::vector<std::uint16_t>& to) {
    const auto channels = static_cast<std::size_t>(sheet.channels);
    to.clear();
    for (std::int64_t y = top; y < top + kSide; ++y)
        for (std::int64_t x = left; x < left + kSide; ++x) {
            const std::int64_t row = std::min<std::int64_t>(y, sheet.height - 1);
            const std::int64_t column = std::min<std::int64_t>(x, sheet.width - 1);
            const auto pixel = sheet.samples.begin() + (row * sheet.width + column) * sheet.channels;
            to.insert(to.end(), pixel, pixel + static_cast<std::ptrdiff_t>(channels));
        }
}

}  // namespace

TiledSheet tiled(const RawPng& sheet) {
    TiledSheet result{sheet.width, sheet.height, static_cast<std::size_t>(sheet.channels), sheet.bits, {}, {}};
    std::vector<std::uint16_t> tile;
    for (std::int64_t top = 0; top < sheet.height; top += kSide)
        for (std::int64_t left = 0; left < sheet.width; left += kSide) {
            copy_tile(sheet, left, top, tile);
            const auto one_pixel = tile.begin() + sheet.channels;
            // All pixels are alike when each equals the one before it.
            const bool alike = std::equal(one_pixel, tile.end(), tile.begin());
            const auto at = static_cast<std::uint32_t>(result.samples.size());
            const bool same_as_before = alike && !result.tiles.empty() && (result.tiles.back() & kOnePixel) != 0 &&
                                        std::equal(tile.begin(), one_pixel, result.samples.end() - sheet.channels);
            result.tiles.push_back(same_as_before ? result.tiles.back() : alike ? at | kOnePixel : at);
            if (!same_as_before)
                result.samples.insert(result.samples.end(), tile.begin(), alike ? one_pixel : tile.end());
        }
    return result;
}

bool VoxelStack::takes(const TiledSheet& sheet) const {
    return sheets_ == 0 ||
           (sheet.width == columns_ && sheet.height == rows_ && sheet.channels == channels_ && sheet.bits == bits_);
}

void VoxelStack::add(const TiledSheet& sheet) {
    if (!takes(sheet)) throw InvalidInput("voxel stack: found a sheet of another layout than those before it");
    if (samples_.size() + sheet.samples.size() >= kOnePixel)
        throw InvalidInput("voxel stack: found more than 2^31 samples");
    columns_ = sheet.width;
    rows_ = sheet.height;
    channels_ = sheet.channels;
    bits_ = sheet.bits;
    ++sheets_;
    const auto base = static_cast<std::uint32_t>(samples_.size());
    for (const std::uint32_t tile : sheet.tiles) tiles_.push_back(tile + base);
    samples_.insert(samples_.end(), sheet.samples.begin(), sheet.samples.end());
}

double VoxelStack::at(std::int64_t column, std::int64_t row, std::int64_t sheet, std::size_t channel) const {
    const bool has_alpha = channels_ == 2 || channels_ == 4;
    if (channel == 3 && !has_alpha) return 1.0;
    const std::size_t c = channel == 3 ? channels_ - 1 : channels_ < 3 ? 0 : channel;
    const std::int64_t tile = (sheet * tiles_along(rows_) + row / kSide) * tiles_along(columns_) + column / kSide;
    const std::uint32_t place = tiles_[static_cast<std::size_t>(tile)];
    const auto pixel = static_cast<std::size_t>((row % kSide) * kSide + column % kSide);
    const std::size_t first = (place & ~kOnePixel) + ((place & kOnePixel) != 0 ? 0 : pixel * channels_);
    return samples_[first + c] / (bits_ == 16 ? 65535.0 : 255.0);
}

}  // namespace fretwork
