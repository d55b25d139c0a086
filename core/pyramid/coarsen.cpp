#include "core/pyramid/coarsen.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>

#include "core/base/parallel.h"
#include "core/shell/cell_rows.h"
#include "core/shell/links.h"

namespace fretwork {
namespace {

constexpr std::size_t kGrain = 2048;

VoxelCoord cell_above(const VoxelCoord& c) {
    return {c[0] >> 1, c[1] >> 1, c[2] >> 1};
}

// Entries of one layer of the coarser grid, with their children one after the other.
struct CoarseLayer {
    std::vector<VoxelCoord> coords;
    std::vector<std::uint32_t> first_child;
    std::vector<VoxelIndex> children;
};

// Groups the children in two layers of the finer grid, which are all those below one coarse layer.
class LayerGrouper {
  public:
    // \param z  of the lower layer
    LayerGrouper(const PyramidLevel& fine, const CellRows& rows, int z, VoxelIndex begin, VoxelIndex end)
        : fine_(fine), rows_(rows), z_(z), begin_(begin), cell_of_(end - begin) {}

    CoarseLayer group() {
        layer_.children.reserve(cell_of_.size());
        layer_.coords.reserve(cell_of_.size() / 2);
        layer_.first_child.reserve(cell_of_.size() / 2);
        for (int y = 0; y < rows_.extent()[1]; y += 2) group_row(y);
        return std::move(layer_);
    }

  private:
    // Cells of one coarse row, by going through the four rows below it at once. Children of a cell come out ascending.
    void group_row(int y) {
        std::array<CellRows::Row, 4> row = {rows_.row(y, z_), rows_.row(y + 1, z_), rows_.row(y, z_ + 1),
                                            rows_.row(y + 1, z_ + 1)};
        constexpr int none = std::numeric_limits<int>::max();
        for (;;) {
            int x = none;
            for (const CellRows::Row& r : row)
                if (r.begin < r.end) x = std::min(x, rows_.x_of(r.begin) >> 1);
            if (x == none) return;
            members_.clear();
            for (CellRows::Row& r : row)
                for (; r.begin < r.end && rows_.x_of(r.begin) >> 1 == x; ++r.begin) {
                    members_.push_back({r.begin, r.begin});
                    cell_of_[r.begin - begin_] = cells_;
                }
            add_cell({x, y >> 1, z_ >> 1});
            ++cells_;
        }
    }

    // Groups follow each other in the order of their lowest child.
    void add_cell(const VoxelCoord& coord) {
        if (members_.size() > 1 && join_members() > 1)
            std::sort(members_.begin(), members_.end(), [](const Member& a, const Member& b) {
                return a.group != b.group ? a.group < b.group : a.child < b.child;
            });
        for (std::size_t i = 0; i < members_.size(); ++i) {
            if (i == 0 || members_[i].group != members_[i - 1].group) {
                layer_.coords.push_back(coord);
                layer_.first_child.push_back(static_cast<std::uint32_t>(layer_.children.size()));
            }
            layer_.children.push_back(members_[i].child);
        }
    }

    struct Member {
        VoxelIndex child;
        VoxelIndex group;  // lowest child of the group
    };

    // Joins what is linked inside the cell; returns the number of groups.
    std::size_t join_members() {
        std::size_t groups = members_.size();
        for (const Member& m : members_) {
            for (const VoxelIndex w : fine_.adjacency.of(m.child)) {
                if (w >= m.child || groups == 1) break;  // later links are met from their other end
                if (w < members_.front().child || cell_of_[w - begin_] != cells_) continue;
                const VoxelIndex a = group_of(m.child), b = group_of(w);
                if (a == b) continue;
                for (Member& other : members_)
                    if (other.group == std::max(a, b)) other.group = std::min(a, b);
                --groups;
            }
        }
        return groups;
    }

    [[nodiscard]] VoxelIndex group_of(VoxelIndex child) const {
        const auto at = std::lower_bound(members_.begin(), members_.end(), child,
                                         [](const Member& m, VoxelIndex value) { return m.child < value; });
        return at->group;
    }

    const PyramidLevel& fine_;
    const CellRows& rows_;
    int z_;
    VoxelIndex begin_;
    std::vector<std::uint32_t> cell_of_;  // cell of each child met so far, by a running number
    std::uint32_t cells_ = 1;
    std::vector<Member> members_;
    CoarseLayer layer_;
};

std::vector<CoarseLayer> group_layers(const PyramidLevel& fine, const CellRows& rows, const RunControl& run) {
    const int layers = cell_above(fine.coords.back())[2] + 1;
    std::vector<CoarseLayer> result(static_cast<std::size_t>(layers));
    parallel_for(result.size(), 1, [&](std::size_t z) {
        run.throw_if_stopped();
        const int fine_z = 2 * static_cast<int>(z);
        const VoxelIndex begin = rows.layer_begin(fine_z), end = rows.layer_begin(fine_z + 2);
        result[z] = LayerGrouper(fine, rows, fine_z, begin, end).group();
    });
    return result;
}

void join_layers(const std::vector<CoarseLayer>& layers, PyramidLevel& fine, PyramidLevel& coarse) {
    for (const CoarseLayer& layer : layers) {
        const auto first = static_cast<std::uint32_t>(coarse.children.size());
        coarse.coords.insert(coarse.coords.end(), layer.coords.begin(), layer.coords.end());
        for (const std::uint32_t f : layer.first_child) coarse.first_child.push_back(first + f);
        coarse.children.insert(coarse.children.end(), layer.children.begin(), layer.children.end());
    }
    coarse.first_child.push_back(static_cast<std::uint32_t>(coarse.children.size()));
    fine.parent.resize(fine.size());
    parallel_for(coarse.size(), kGrain, [&](std::size_t p) {
        for (std::uint32_t i = coarse.first_child[p]; i < coarse.first_child[p + 1]; ++i)
            fine.parent[coarse.children[i]] = static_cast<VoxelIndex>(p);
    });
}

// Sums over the same surface cut in other ways differ in their last bits; rounded well above them they are the same.
Vec3f rounded(const Vec3f& v, float step) {
    return {step * std::round(v.x() / step), step * std::round(v.y() / step), step * std::round(v.z() / step)};
}

void average_children(const WeightedLevel& fine, WeightedLevel& coarse, float voxels_per_cell) {
    // Below this share of the area, the sum of the areas says nothing about a side.
    constexpr float kCancelled = 1e-2F;
    constexpr float kPositionStep = 0x1p-12F;  // in cells
    constexpr float kNormalStep = 0x1p-14F;
    PyramidLevel& level = coarse.level;
    level.positions.resize(level.size());
    level.normals.resize(level.size());
    coarse.area_voxels2.resize(level.size());
    coarse.facing.resize(level.size());
    coarse.centroids.resize(level.size());
    parallel_for(level.size(), kGrain, [&](std::size_t p) {
        Vec3f moment = Vec3f::Zero(), place = Vec3f::Zero();
        Vec3f facing = Vec3f::Zero(), normal = Vec3f::Zero();
        float area = 0.0F;
        VoxelIndex largest = level.children[level.first_child[p]];
        for (std::uint32_t i = level.first_child[p]; i < level.first_child[p + 1]; ++i) {
            const VoxelIndex c = level.children[i];
            moment += fine.area_voxels2[c] * fine.centroids[c];
            place += fine.centroids[c];
            facing += fine.facing[c];
            normal += fine.level.normals[c];
            area += fine.area_voxels2[c];
            if (fine.area_voxels2[c] > fine.area_voxels2[largest]) largest = c;
        }
        // What is merely touched by the surface has no area but still a place and a side.
        const auto children = static_cast<float>(level.first_child[p + 1] - level.first_child[p]);
        coarse.centroids[p] = area > 0.0F ? moment / area : place / children;
        level.positions[p] = rounded(coarse.centroids[p], kPositionStep * voxels_per_cell);
        const Vec3f sum = area > 0.0F ? facing : normal;
        const float least = kCancelled * (area > 0.0F ? area : children);
        const Vec3f mean = sum.norm() > least ? sum.normalized() : fine.level.normals[largest];
        level.normals[p] = rounded(mean, kNormalStep).normalized();
        coarse.area_voxels2[p] = area;
        coarse.facing[p] = facing;
    });
}

// Links between the parents of linked children.
TouchingLinks link_parents(const PyramidLevel& fine, const PyramidLevel& coarse, const CellRows& rows,
                           const RunControl& run) {
    std::vector<std::vector<VoxelIndex>> chunks((coarse.size() + kGrain - 1) / kGrain);
    TouchingLinks links(coarse.size());
    parallel_chunks(coarse.size(), kGrain, [&](std::size_t begin, std::size_t end) {
        run.throw_if_stopped();
        std::vector<VoxelIndex>& listed = chunks[begin / kGrain];
        std::vector<VoxelIndex> row;
        for (auto p = static_cast<VoxelIndex>(begin); p < end; ++p) {
            row.clear();
            for (std::uint32_t i = coarse.first_child[p]; i < coarse.first_child[p + 1]; ++i)
                for (const VoxelIndex w : fine.adjacency.of(coarse.children[i])) {
                    const VoxelIndex q = fine.parent[w];
                    if (q == p) continue;
                    const CellSet cell = CellSet{1} << touching_code(coarse.coords[p], coarse.coords[q]);
                    (rows.shares_cell(q) ? links.several : links.single)[p] |= cell;
                    if (rows.shares_cell(q)) row.push_back(q);
                }
            std::sort(row.begin(), row.end());
            const auto row_end = std::unique(row.begin(), row.end());
            listed.insert(listed.end(), row.begin(), row_end);
            links.first[p + 1] = static_cast<std::uint32_t>(row_end - row.begin());
        }
    });
    links.take_lists(chunks);
    return links;
}

}  // namespace

WeightedLevel coarsen(WeightedLevel& fine, int level_index, const RunControl& run) {
    WeightedLevel coarse;
    const CellRows fine_rows(extent_of(fine.level.coords), fine.level.coords);
    join_layers(group_layers(fine.level, fine_rows, run), fine.level, coarse.level);
    average_children(fine, coarse, std::ldexp(1.0F, level_index));
    const CellRows rows(extent_of(coarse.level.coords), coarse.level.coords);
    const TouchingLinks of_children = link_parents(fine.level, coarse.level, rows, run);
    coarse.level.adjacency =
        link_around_common_neighbors(TouchingEntries(rows, run), coarse.level.normals, of_children, run);
    return coarse;
}

}  // namespace fretwork
