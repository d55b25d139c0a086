#include "likeness/windows.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "core/base/counter_random.h"
#include "core/base/error.h"
#include "core/base/parallel.h"

namespace fretwork::likeness {
namespace {

using Row = Eigen::Matrix<float, 1, kWindowSize>;

}  // namespace

PlacedWindows all_windows(const PatternPicture& picture) {
    const int columns = picture.wraps ? picture.width : picture.width - kWindowSide + 1;
    const int rows = picture.wraps ? picture.height : picture.height - kWindowSide + 1;
    if (columns < 1 || rows < 1) throw InvalidInput("a picture must hold a window of 7 x 7 pixels");
    PlacedWindows result;
    result.windows.resize(static_cast<Eigen::Index>(columns) * rows, kWindowSize);
    for (int y = 0; y < rows; ++y)
        for (int x = 0; x < columns; ++x) {
            float* out = result.windows.row(static_cast<Eigen::Index>(result.corner.size())).data();
            for (int j = 0; j < kWindowSide; ++j)
                for (int i = 0; i < kWindowSide; ++i, out += 4)
                    std::ranges::copy(picture.at((x + i) % picture.width, (y + j) % picture.height), out);
            result.corner.push_back(Vec2f(static_cast<float>(x), static_cast<float>(y)));
        }
    return result;
}

PlacedWindows rows_of(const PlacedWindows& windows, std::span<const std::uint32_t> rows) {
    PlacedWindows result;
    result.windows.resize(static_cast<Eigen::Index>(rows.size()), kWindowSize);
    for (const std::uint32_t row : rows) {
        result.windows.row(static_cast<Eigen::Index>(result.corner.size())) = windows.windows.row(row);
        result.corner.push_back(windows.corner[row]);
    }
    return result;
}

PlacedWindows some_windows(const PlacedWindows& windows, std::size_t count, std::uint64_t seed) {
    std::vector<std::uint32_t> rows(windows.size());
    std::iota(rows.begin(), rows.end(), 0u);
    count = std::min(count, rows.size());
    for (std::size_t i = 0; i < count; ++i) {
        const auto left = static_cast<std::uint32_t>(rows.size() - i);
        std::swap(rows[i], rows[i + index_below(counter_random(seed, RandomStream::kTest, 0, i, 0), left)]);
    }
    rows.resize(count);
    return rows_of(windows, rows);
}

WindowBasis principal_basis(const Windows& windows) {
    // A few thousand rows tell the covariance well enough: the basis is a matter of speed.
    const Eigen::Index step = std::max<Eigen::Index>(1, windows.rows() / 3000);
    const Eigen::Index count = (windows.rows() + step - 1) / step;
    Eigen::MatrixXf some(count, kWindowSize);
    for (Eigen::Index i = 0; i < count; ++i) some.row(i) = windows.row(i * step);
    WindowBasis basis;
    basis.mean = some.colwise().mean();
    some.rowwise() -= basis.mean;
    const Eigen::MatrixXf covariance = some.transpose() * some;
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXf> solver(covariance);
    basis.directions = solver.eigenvectors().rightCols<WindowBasis::kDirections>().rowwise().reverse();
    return basis;
}

NearestWindows::NearestWindows(const Windows& windows, const WindowBasis& basis)
    : windows_(windows), basis_(basis), order_(static_cast<std::size_t>(windows.rows())) {
    std::vector<Coordinates> unsorted(order_.size());
    parallel_for(order_.size(), 256, [&](std::size_t i) {
        unsorted[i] = coordinates_of(windows.row(static_cast<Eigen::Index>(i)).data());
    });
    std::iota(order_.begin(), order_.end(), 0u);
    std::ranges::sort(order_, [&](std::uint32_t a, std::uint32_t b) {
        return unsorted[a](0) != unsorted[b](0) ? unsorted[a](0) < unsorted[b](0) : a < b;
    });
    for (const std::uint32_t row : order_) coordinates_.push_back(unsorted[row]);
}

NearestWindows::Coordinates NearestWindows::coordinates_of(const float* window) const {
    const Row centered = Eigen::Map<const Row>(window) - basis_.mean;
    Coordinates c;
    c.head<WindowBasis::kDirections>() = centered * basis_.directions;
    const float rest = centered.squaredNorm() - c.head<WindowBasis::kDirections>().squaredNorm();
    c(WindowBasis::kDirections) = std::sqrt(std::max(0.0F, rest));
    return c;
}

Nearest NearestWindows::nearest(const float* window) const {
    const Eigen::Map<const Row> query(window);
    const Coordinates q = coordinates_of(window);
    // Rounding must not cut off the nearest one: lengths up to 14 are known to some 1e-5.
    constexpr float slack = 1e-3F;

    const auto count = static_cast<Eigen::Index>(order_.size());
    Eigen::Index above = 0;
    for (Eigen::Index length = count; length > 0;) {
        const Eigen::Index half = length / 2;
        if (coordinates_[static_cast<std::size_t>(above + half)](0) < q(0)) {
            above += half + 1;
            length -= half + 1;
        } else {
            length = half;
        }
    }
    Eigen::Index below = above - 1;
    float best = std::numeric_limits<float>::max();
    std::uint32_t best_row = 0;
    const auto look_at = [&](Eigen::Index i) {
        const auto at = static_cast<std::size_t>(i);
        if ((coordinates_[at] - q).squaredNorm() > best + slack) return;
        const std::uint32_t row = order_[at];
        const float distance = (windows_.row(row) - query).squaredNorm();
        if (distance < best || (distance == best && row < best_row)) best = distance, best_row = row;
    };
    const auto gap = [&](Eigen::Index i) {
        if (i < 0 || i >= count) return std::numeric_limits<float>::infinity();
        const float gap_to_first = coordinates_[static_cast<std::size_t>(i)](0) - q(0);
        return gap_to_first * gap_to_first;
    };
    while (true) {
        const float gap_below = gap(below), gap_above = gap(above);
        if (!(std::min(gap_below, gap_above) <= best + slack)) break;
        if (gap_below < gap_above)
            look_at(below--);
        else
            look_at(above++);
    }
    return {best_row, static_cast<double>(best)};
}

std::vector<Nearest> NearestWindows::nearest(const Windows& queries) const {
    std::vector<Nearest> result(static_cast<std::size_t>(queries.rows()));
    parallel_for(result.size(), 16,
                 [&](std::size_t i) { result[i] = nearest(queries.row(static_cast<Eigen::Index>(i)).data()); });
    return result;
}

}  // namespace fretwork::likeness
