// Windows of a picture as points in space, and the exact search for the nearest one.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "likeness/pattern_picture.h"

namespace fretwork::likeness {

inline constexpr int kWindowSide = 7;  ///< pixels
inline constexpr int kWindowSize = kWindowSide * kWindowSide * 4;

/// One window per row.
using Windows = Eigen::Matrix<float, Eigen::Dynamic, kWindowSize, Eigen::RowMajor>;

/// Windows and where they stand, in pixels of the picture.
struct PlacedWindows {
    Windows windows;
    std::vector<Vec2f> corner;  ///< upper left

    [[nodiscard]] std::size_t size() const { return corner.size(); }
};

/// All windows of a picture, row by row; of one that wraps also those across its borders.
/// \throws InvalidInput  a picture smaller than a window that does not wrap.
PlacedWindows all_windows(const PatternPicture& picture);

/// The given rows, in that order.
PlacedWindows rows_of(const PlacedWindows& windows, std::span<const std::uint32_t> rows);

/// `count` rows at random, fewer if there are fewer; depends on `seed` alone. Every row at most once.
PlacedWindows some_windows(const PlacedWindows& windows, std::size_t count, std::uint64_t seed);

struct Nearest {
    std::uint32_t row = 0;
    double squared_distance = 0.0;
};

/// The directions in which windows of one picture differ most: orthonormal, around their mean.
struct WindowBasis {
    static constexpr int kDirections = 23;
    Eigen::Matrix<float, 1, kWindowSize> mean;
    Eigen::Matrix<float, kWindowSize, kDirections> directions;
};
WindowBasis principal_basis(const Windows& windows);

/// Finds the exact nearest window. Each window is known by its coordinates in the basis and the length of what the
/// basis leaves out; the distance between two such lists is never above the true one, and spares most full comparisons.
/// Candidates are sorted by the first coordinate and searched outwards from the query's. Keeps references to windows
/// and basis. The basis decides the speed and never the result, but for ties.
class NearestWindows {
  public:
    NearestWindows(const Windows& windows, const WindowBasis& basis);

    [[nodiscard]] Nearest nearest(const float* window) const;
    /// For all rows, in parallel.
    [[nodiscard]] std::vector<Nearest> nearest(const Windows& queries) const;

  private:
    using Coordinates = Eigen::Matrix<float, 1, WindowBasis::kDirections + 1>;
    [[nodiscard]] Coordinates coordinates_of(const float* window) const;

    const Windows& windows_;
    const WindowBasis& basis_;
    std::vector<std::uint32_t> order_;
    std::vector<Coordinates> coordinates_;  ///< in that order
};

}  // namespace fretwork::likeness
