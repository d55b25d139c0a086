#include "core/strength/solid_cells.h"

#include <algorithm>
#include <cmath>

#include "core/base/parallel.h"

namespace fretwork {
namespace {

constexpr std::int64_t kUnit = std::int64_t{1} << 18;  // differences below 2^30, their products below 2^61

/// A corner in the plane across the scan lines, exact; and where it is along them, in cells.
struct Corner {
    std::int64_t y, z;
    double x;
};

struct Crossing {
    double x;
    int winds;  ///< what passing it in the direction of x adds to the winding number
    friend bool operator<(const Crossing& a, const Crossing& b) { return a.x != b.x ? a.x < b.x : a.winds < b.winds; }
};

/// Twice the area of (a, b, p). Where p lies on the line the sign is that of a point moved by (e, e^2) for an
/// infinitely small e; it changes when a and b are exchanged, so that both triangles at an edge agree.
struct Side {
    std::int64_t area;
    bool left;
    Side(const Corner& a, const Corner& b, std::int64_t y, std::int64_t z)
        : area((b.y - a.y) * (z - a.z) - (b.z - a.z) * (y - a.y)),
          left(area != 0 ? area > 0 : (b.z != a.z ? b.z < a.z : b.y > a.y)) {}
};

class Scanner {
  public:
    Scanner(const TriangleMesh& mesh, const VoxelGrid& grid) : mesh_(mesh), extent_(grid.extent) {
        corners_.reserve(mesh.positions_mm.size());
        for (const Vec3& p : mesh.positions_mm) {
            const Vec3 q = (p - grid.origin_mm) / grid.voxel_mm;
            corners_.push_back({std::llround(q[1] * static_cast<double>(kUnit)),
                                std::llround(q[2] * static_cast<double>(kUnit)), q[0]});
        }
        sort_by_layer();
    }

    void scan_layer(std::size_t layer, CellIndex& cells) const {
        std::vector<std::vector<Crossing>> rows(static_cast<std::size_t>(extent_[1]));
        const std::int64_t z = center_of(static_cast<std::int64_t>(layer));
        for (std::size_t i = first_[layer]; i < first_[layer + 1]; ++i) cross(mesh_.triangles[triangle_[i]], z, rows);
        for (std::size_t j = 0; j < rows.size(); ++j)
            fill_row({0, static_cast<std::int32_t>(j), static_cast<std::int32_t>(layer)}, rows[j], cells);
    }

  private:
    static std::int64_t center_of(std::int64_t cell) { return cell * kUnit + kUnit / 2; }
    /// Cells whose centres lie in [low, high], clipped to `count`: first and one past the last.
    static std::pair<std::size_t, std::size_t> centers_in(std::int64_t low, std::int64_t high, std::int32_t count) {
        const std::int64_t most = count;
        const std::int64_t from = std::clamp((low - kUnit / 2 + kUnit - 1) >> 18, std::int64_t{0}, most);
        const std::int64_t to = std::clamp(((high - kUnit / 2) >> 18) + 1, from, most);
        return {static_cast<std::size_t>(from), static_cast<std::size_t>(to)};
    }

    [[nodiscard]] std::pair<std::size_t, std::size_t> layers_of(const Triangle& t) const {
        const auto [low, high] = std::minmax({corners_[t[0]].z, corners_[t[1]].z, corners_[t[2]].z});
        return centers_in(low, high, extent_[2]);
    }

    void sort_by_layer() {
        first_.assign(static_cast<std::size_t>(extent_[2]) + 2, 0);
        const auto each = [&](const auto& visit) {
            for (std::uint32_t t = 0; t < mesh_.triangles.size(); ++t) {
                const auto [from, to] = layers_of(mesh_.triangles[t]);
                for (std::size_t layer = from; layer < to; ++layer) visit(layer, t);
            }
        };
        each([&](std::size_t layer, std::uint32_t) { ++first_[layer + 2]; });
        for (std::size_t i = 2; i < first_.size(); ++i) first_[i] += first_[i - 1];
        triangle_.resize(first_.back());
        each([&](std::size_t layer, std::uint32_t t) { triangle_[first_[layer + 1]++] = t; });
    }

    void cross(const Triangle& t, std::int64_t z, std::vector<std::vector<Crossing>>& rows) const {
        const Corner &a = corners_[t[0]], &b = corners_[t[1]], &c = corners_[t[2]];
        const auto [low, high] = std::minmax({a.y, b.y, c.y});
        const auto [from, to] = centers_in(low, high, extent_[1]);
        for (std::size_t j = from; j < to; ++j) {
            const std::int64_t y = center_of(static_cast<std::int64_t>(j));
            const Side ab(a, b, y, z), bc(b, c, y, z), ca(c, a, y, z);
            if (ab.left != bc.left || bc.left != ca.left) continue;
            const std::int64_t whole = ab.area + bc.area + ca.area;
            if (whole == 0) continue;
            const double x = (static_cast<double>(bc.area) * a.x + static_cast<double>(ca.area) * b.x +
                              static_cast<double>(ab.area) * c.x) /
                             static_cast<double>(whole);
            // Left of all sides: the normal runs along x, and the line leaves the solid there.
            rows[j].push_back({x, ab.left ? -1 : 1});
        }
    }

    void fill_row(VoxelCoord cell, std::vector<Crossing>& crossings, CellIndex& cells) const {
        std::sort(crossings.begin(), crossings.end());
        int winding = 0;
        std::size_t next = 0;
        for (cell[0] = 0; cell[0] < extent_[0]; ++cell[0]) {
            while (next < crossings.size() && crossings[next].x <= cell[0] + 0.5) winding += crossings[next++].winds;
            if (winding > 0) cells.take(cell);
        }
    }

    const TriangleMesh& mesh_;
    VoxelCoord extent_;
    std::vector<Corner> corners_;
    std::vector<std::size_t> first_;  ///< per layer, into triangle_
    std::vector<std::uint32_t> triangle_;
};

}  // namespace

CellIndex solid_cells(const TriangleMesh& mesh, const VoxelGrid& grid, const RunControl& run) {
    const Scanner scanner(mesh, grid);
    CellIndex cells(grid.extent);
    parallel_for(static_cast<std::size_t>(grid.extent[2]), 1, [&](std::size_t layer) {
        run.throw_if_stopped();
        scanner.scan_layer(layer, cells);
    });
    cells.number();
    return cells;
}

}  // namespace fretwork
