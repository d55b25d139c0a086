// Sheets of an image3d, held without their empty parts.
#pragma once

#include <cstdint>
#include <vector>

#include "formats/png_reader.h"

namespace fretwork {

/// A sheet cut into tiles of 8 x 8 pixels, of which those of one value take a single pixel.
struct TiledSheet {
    int width = 0;
    int height = 0;
    std::size_t channels = 0;
    int bits = 8;
    std::vector<std::uint32_t> tiles;  ///< where in `samples` each begins, row by row; see VoxelStack
    std::vector<std::uint16_t> samples;
};
TiledSheet tiled(const RawPng& sheet);

/// Of a shell, which passes through one tile in ten or so, this keeps a tenth of the samples.
class VoxelStack {
  public:
    /// In order, row 0 at the highest y. All must be of one size, depth and number of channels.
    void add(const TiledSheet& sheet);

    [[nodiscard]] std::int64_t columns() const { return columns_; }
    [[nodiscard]] std::int64_t rows() const { return rows_; }
    [[nodiscard]] std::int64_t sheets() const { return sheets_; }
    [[nodiscard]] std::size_t stored_samples() const { return samples_.size(); }

    /// Whether a sheet is of the layout of those that are here.
    [[nodiscard]] bool takes(const TiledSheet& sheet) const;

    /// Channel 0..2 red, green, blue, 3 alpha, in [0, 1]. Grey stands for all three colours; a missing alpha is one.
    [[nodiscard]] double at(std::int64_t column, std::int64_t row, std::int64_t sheet, std::size_t channel) const;

  private:
    std::int64_t columns_ = 0, rows_ = 0, sheets_ = 0;
    std::size_t channels_ = 0;
    int bits_ = 8;
    std::vector<std::uint32_t> tiles_;  ///< sheet by sheet
    std::vector<std::uint16_t> samples_;
};

}  // namespace fretwork
