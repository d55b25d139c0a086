#include "core/shell/links.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "core/base/parallel.h"

namespace fretwork {
namespace {

constexpr std::size_t kGrain = 2048;

// Finds the entries in the 26 cells around each entry by moving nine cursors along the rows of cells.
class TouchingCells {
  public:
    TouchingCells(const VoxelGrid& grid, std::span<const VoxelCoord> coords) : extent_(grid.extent), coords_(coords) {
        const std::size_t rows = static_cast<std::size_t>(extent_[1]) * static_cast<std::size_t>(extent_[2]);
        row_first_.resize(rows + 1, 0);
        for (const VoxelCoord& c : coords) ++row_first_[row_of(c[1], c[2]) + 1];
        for (std::size_t r = 0; r < rows; ++r) row_first_[r + 1] += row_first_[r];
    }

    /// Calls `visit(v, w)` for v ascending in [begin, end) and w ascending over the entries in touching cells.
    template <class Visit>
    void sweep(std::size_t begin, std::size_t end, const Visit& visit) const {
        std::array<Cursor, 9> cursors;
        for (std::size_t v = begin; v < end; ++v) {
            const VoxelCoord& c = coords_[v];
            if (v == begin || c[1] != coords_[v - 1][1] || c[2] != coords_[v - 1][2]) cursors = cursors_around(c);
            for (Cursor& cursor : cursors) {
                while (cursor.at < cursor.end && coords_[cursor.at][0] < c[0] - 1) ++cursor.at;
                for (std::uint32_t w = cursor.at; w < cursor.end && coords_[w][0] <= c[0] + 1; ++w)
                    if (coords_[w] != c) visit(static_cast<VoxelIndex>(v), w);
            }
        }
    }

  private:
    struct Cursor {
        std::uint32_t at;
        std::uint32_t end;
    };

    [[nodiscard]] std::size_t row_of(int y, int z) const {
        return static_cast<std::size_t>(z) * static_cast<std::size_t>(extent_[1]) + static_cast<std::size_t>(y);
    }

    [[nodiscard]] std::array<Cursor, 9> cursors_around(const VoxelCoord& c) const {
        std::array<Cursor, 9> cursors;
        std::size_t k = 0;
        for (int z = c[2] - 1; z <= c[2] + 1; ++z)
            for (int y = c[1] - 1; y <= c[1] + 1; ++y) {
                const bool exists = y >= 0 && y < extent_[1] && z >= 0 && z < extent_[2];
                cursors[k++] = exists ? Cursor{row_first_[row_of(y, z)], row_first_[row_of(y, z) + 1]} : Cursor{0, 0};
            }
        return cursors;
    }

    VoxelCoord extent_;
    std::span<const VoxelCoord> coords_;
    std::vector<std::uint32_t> row_first_;
};

float distance_between(const VoxelCoord& a, const VoxelCoord& b) {
    const int differing = (a[0] != b[0]) + (a[1] != b[1]) + (a[2] != b[2]);
    constexpr std::array<float, 4> length = {0.0F, 1.0F, 1.41421356F, 1.73205081F};
    return length[static_cast<std::size_t>(differing)];
}

bool have_common_element(std::span<const std::uint32_t> a, std::span<const std::uint32_t> b) {
    auto i = a.begin();
    auto j = b.begin();
    while (i != a.end() && j != b.end()) {
        if (*i == *j) return true;
        if (*i < *j)
            ++i;
        else
            ++j;
    }
    return false;
}

// Keeps the pairs of touching entries for which `linked(v, w)` holds. Chunks are filled on their own and
// joined in order.
template <class Linked>
Adjacency keep_links(const VoxelGrid& grid, std::span<const VoxelCoord> coords, const Linked& linked,
                     const RunControl& run) {
    const TouchingCells touching(grid, coords);
    std::vector<std::vector<VoxelIndex>> chunks((coords.size() + kGrain - 1) / kGrain);
    Adjacency links;
    links.first.assign(coords.size() + 1, 0);
    parallel_chunks(coords.size(), kGrain, [&](std::size_t begin, std::size_t end) {
        run.throw_if_stopped();
        std::vector<VoxelIndex>& kept = chunks[begin / kGrain];
        kept.reserve(10 * (end - begin));
        touching.sweep(begin, end, [&](VoxelIndex v, VoxelIndex w) {
            if (!linked(v, w)) return;
            kept.push_back(w);
            ++links.first[v + 1];
        });
    });
    for (std::size_t v = 0; v < coords.size(); ++v) links.first[v + 1] += links.first[v];
    links.neighbor.resize(links.first.back());
    links.length_voxels.resize(links.first.back());
    parallel_chunks(coords.size(), kGrain, [&](std::size_t begin, std::size_t end) {
        std::copy(chunks[begin / kGrain].begin(), chunks[begin / kGrain].end(),
                  links.neighbor.begin() + links.first[begin]);
        for (std::size_t v = begin; v < end; ++v)
            for (std::uint32_t e = links.first[v]; e < links.first[v + 1]; ++e)
                links.length_voxels[e] = distance_between(coords[v], coords[links.neighbor[e]]);
    });
    return links;
}

}  // namespace

Adjacency link_shared_triangles(const VoxelGrid& grid, std::span<const VoxelCoord> coords,
                                const EntryTriangles& triangles, const RunControl& run) {
    return keep_links(
        grid, coords, [&](VoxelIndex v, VoxelIndex w) { return have_common_element(triangles.of(v), triangles.of(w)); },
        run);
}

Adjacency link_around_common_neighbors(const VoxelGrid& grid, std::span<const VoxelCoord> coords,
                                       std::span<const Vec3f> normals, const Adjacency& direct, const RunControl& run) {
    return keep_links(
        grid, coords,
        [&](VoxelIndex v, VoxelIndex w) {
            const auto of_v = direct.of(v);
            if (std::binary_search(of_v.begin(), of_v.end(), w)) return true;
            return normals[v].dot(normals[w]) >= kOpposingCosine && have_common_element(of_v, direct.of(w));
        },
        run);
}

}  // namespace fretwork
