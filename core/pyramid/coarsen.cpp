#include "core/pyramid/coarsen.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>

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

// Groups the children in [begin, end), which are all those below one coarse layer.
class LayerGrouper {
  public:
    LayerGrouper(const PyramidLevel& fine, VoxelIndex begin, VoxelIndex end) : fine_(fine), begin_(begin), end_(end) {}

    CoarseLayer group() {
        join_children();
        sort_by_cell_and_group();
        CoarseLayer layer;
        for (std::size_t i = 0; i < order_.size(); ++i) {
            const VoxelIndex child = begin_ + order_[i].child;
            if (i == 0 || order_[i].cell != order_[i - 1].cell || order_[i].group != order_[i - 1].group) {
                layer.coords.push_back(cell_above(fine_.coords[child]));
                layer.first_child.push_back(static_cast<std::uint32_t>(i));
            }
            layer.children.push_back(child);
        }
        return layer;
    }

  private:
    struct Member {
        std::uint64_t cell;   // (y, x) of the coarse cell
        std::uint32_t group;  // lowest child of the group, relative to begin_
        std::uint32_t child;  // relative to begin_
    };

    std::uint32_t root(std::uint32_t child) {
        while (group_[child] != child) {
            group_[child] = group_[group_[child]];
            child = group_[child];
        }
        return child;
    }

    void join_children() {
        group_.resize(end_ - begin_);
        for (std::uint32_t c = 0; c < group_.size(); ++c) group_[c] = c;
        for (VoxelIndex v = begin_; v < end_; ++v) {
            const VoxelCoord cell = cell_above(fine_.coords[v]);
            for (const VoxelIndex w : fine_.adjacency.of(v)) {
                if (w >= v) break;  // the link is met from its other end
                if (w < begin_ || !same_cell(cell_above(fine_.coords[w]), cell)) continue;
                const std::uint32_t a = root(v - begin_);
                const std::uint32_t b = root(w - begin_);
                group_[std::max(a, b)] = std::min(a, b);
            }
        }
    }

    void sort_by_cell_and_group() {
        order_.reserve(group_.size());
        for (std::uint32_t c = 0; c < group_.size(); ++c) {
            const VoxelCoord cell = cell_above(fine_.coords[begin_ + c]);
            order_.push_back(
                {static_cast<std::uint64_t>(cell[1]) << 32 | static_cast<std::uint32_t>(cell[0]), root(c), c});
        }
        std::sort(order_.begin(), order_.end(), [](const Member& a, const Member& b) {
            if (a.cell != b.cell) return a.cell < b.cell;
            return a.group != b.group ? a.group < b.group : a.child < b.child;
        });
    }

    const PyramidLevel& fine_;
    VoxelIndex begin_;
    VoxelIndex end_;
    std::vector<std::uint32_t> group_;
    std::vector<Member> order_;
};

std::vector<CoarseLayer> group_layers(const PyramidLevel& fine, const RunControl& run) {
    const int layers = cell_above(fine.coords.back())[2] + 1;
    std::vector<CoarseLayer> result(static_cast<std::size_t>(layers));
    const auto first_in_layer = [&](int z) {
        const auto at = std::lower_bound(fine.coords.begin(), fine.coords.end(), z,
                                         [](const VoxelCoord& c, int value) { return c[2] < value; });
        return static_cast<VoxelIndex>(at - fine.coords.begin());
    };
    parallel_for(result.size(), 1, [&](std::size_t z) {
        run.throw_if_stopped();
        const int fine_z = 2 * static_cast<int>(z);
        result[z] = LayerGrouper(fine, first_in_layer(fine_z), first_in_layer(fine_z + 2)).group();
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

float length_between(const VoxelCoord& a, const VoxelCoord& b) {
    constexpr std::array<float, 4> length = {0.0F, 1.0F, 1.41421356F, 1.73205081F};
    return length[static_cast<std::size_t>((a[0] != b[0]) + (a[1] != b[1]) + (a[2] != b[2]))];
}

// The parents that children of p are linked to, ascending. A cell tells the parent as long as none holds two of them.
void list_linked_parents(const PyramidLevel& fine, const PyramidLevel& coarse, VoxelIndex p,
                         std::vector<VoxelIndex>& row) {
    std::array<VoxelIndex, 27> in_cell;
    CellSet seen = 0;
    bool several = false;
    row.clear();
    for (std::uint32_t i = coarse.first_child[p]; i < coarse.first_child[p + 1]; ++i)
        for (const VoxelIndex w : fine.adjacency.of(coarse.children[i])) {
            const VoxelIndex q = fine.parent[w];
            if (q == p) continue;
            const auto code = static_cast<std::size_t>(touching_code(coarse.coords[p], coarse.coords[q]));
            if ((seen >> code & 1u) != 0 && in_cell[code] != q) {
                several = true;
                row.push_back(q);
            } else {
                seen |= CellSet{1} << code;
                in_cell[code] = q;
            }
        }
    for (; seen != 0; seen &= seen - 1) row.push_back(in_cell[static_cast<std::size_t>(std::countr_zero(seen))]);
    if (!several) return;
    std::sort(row.begin(), row.end());
    row.erase(std::unique(row.begin(), row.end()), row.end());
}

Adjacency link_parents(const PyramidLevel& fine, const PyramidLevel& coarse, const RunControl& run) {
    std::vector<std::vector<VoxelIndex>> chunks((coarse.size() + kGrain - 1) / kGrain);
    Adjacency links;
    links.first.assign(coarse.size() + 1, 0);
    parallel_chunks(coarse.size(), kGrain, [&](std::size_t begin, std::size_t end) {
        run.throw_if_stopped();
        std::vector<VoxelIndex>& all = chunks[begin / kGrain];
        std::vector<VoxelIndex> row;
        for (std::size_t p = begin; p < end; ++p) {
            list_linked_parents(fine, coarse, static_cast<VoxelIndex>(p), row);
            all.insert(all.end(), row.begin(), row.end());
            links.first[p + 1] = static_cast<std::uint32_t>(row.size());
        }
    });
    for (std::size_t p = 0; p < coarse.size(); ++p) links.first[p + 1] += links.first[p];
    links.neighbor.resize(links.first.back());
    links.length_voxels.resize(links.first.back());
    parallel_chunks(coarse.size(), kGrain, [&](std::size_t begin, std::size_t end) {
        std::copy(chunks[begin / kGrain].begin(), chunks[begin / kGrain].end(),
                  links.neighbor.begin() + links.first[begin]);
        for (std::size_t p = begin; p < end; ++p)
            for (std::uint32_t e = links.first[p]; e < links.first[p + 1]; ++e)
                links.length_voxels[e] = length_between(coarse.coords[p], coarse.coords[links.neighbor[e]]);
    });
    return links;
}

}  // namespace

WeightedLevel coarsen(WeightedLevel& fine, int level_index, const RunControl& run) {
    WeightedLevel coarse;
    join_layers(group_layers(fine.level, run), fine.level, coarse.level);
    average_children(fine, coarse, std::ldexp(1.0F, level_index));
    const Adjacency of_children = link_parents(fine.level, coarse.level, run);
    const CellRows rows(extent_of(coarse.level.coords), coarse.level.coords);
    coarse.level.adjacency =
        link_around_common_neighbors(rows, coarse.level.coords, coarse.level.normals, of_children, run);
    return coarse;
}

}  // namespace fretwork
