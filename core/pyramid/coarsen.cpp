#include "core/pyramid/coarsen.h"

#include <algorithm>
#include <array>
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

void average_children(const WeightedLevel& fine, WeightedLevel& coarse) {
    // What is merely touched by the surface has no area but still a place.
    constexpr float kLeastWeight = 1e-3F;
    // Below this share of the weight, the sum of the normals says nothing about a side.
    constexpr float kCancelled = 1e-2F;
    PyramidLevel& level = coarse.level;
    level.positions.resize(level.size());
    level.normals.resize(level.size());
    coarse.area_voxels2.resize(level.size());
    parallel_for(level.size(), kGrain, [&](std::size_t p) {
        Vec3f position = Vec3f::Zero();
        Vec3f normal = Vec3f::Zero();
        float weight = 0.0F;
        float area = 0.0F;
        VoxelIndex largest = level.children[level.first_child[p]];
        for (std::uint32_t i = level.first_child[p]; i < level.first_child[p + 1]; ++i) {
            const VoxelIndex c = level.children[i];
            const float w = std::max(kLeastWeight, fine.area_voxels2[c]);
            position += w * fine.level.positions[c];
            normal += w * fine.level.normals[c];
            weight += w;
            area += fine.area_voxels2[c];
            if (fine.area_voxels2[c] > fine.area_voxels2[largest]) largest = c;
        }
        level.positions[p] = position / weight;
        level.normals[p] = normal.norm() > kCancelled * weight ? normal.normalized() : fine.level.normals[largest];
        coarse.area_voxels2[p] = area;
    });
}

float length_between(const VoxelCoord& a, const VoxelCoord& b) {
    constexpr std::array<float, 4> length = {0.0F, 1.0F, 1.41421356F, 1.73205081F};
    return length[static_cast<std::size_t>((a[0] != b[0]) + (a[1] != b[1]) + (a[2] != b[2]))];
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
            row.clear();
            for (std::uint32_t i = coarse.first_child[p]; i < coarse.first_child[p + 1]; ++i)
                for (const VoxelIndex w : fine.adjacency.of(coarse.children[i]))
                    if (fine.parent[w] != p && (row.empty() || row.back() != fine.parent[w]))
                        row.push_back(fine.parent[w]);
            std::sort(row.begin(), row.end());
            row.erase(std::unique(row.begin(), row.end()), row.end());
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

WeightedLevel coarsen(WeightedLevel& fine, const RunControl& run) {
    WeightedLevel coarse;
    join_layers(group_layers(fine.level, run), fine.level, coarse.level);
    average_children(fine, coarse);
    const Adjacency of_children = link_parents(fine.level, coarse.level, run);
    const CellRows rows(extent_of(coarse.level.coords), coarse.level.coords);
    coarse.level.adjacency =
        link_around_common_neighbors(rows, coarse.level.coords, coarse.level.normals, of_children, run);
    return coarse;
}

}  // namespace fretwork
