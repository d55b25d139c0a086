#include "core/strength/coarse_level.h"

#include <algorithm>
#include <map>
#include <utility>

#include "core/base/disjoint_sets.h"
#include "core/strength/cell_index.h"

namespace fretwork {
namespace {

using Matrix24 = Eigen::Matrix<double, 24, 24>;

/// Weight of each corner of a cell at each of its 27 places.
const std::array<std::array<double, 8>, 27>& weights() {
    static const auto table = [] {
        std::array<std::array<double, 8>, 27> w{};
        for (std::size_t place = 0; place < 27; ++place)
            for (std::size_t corner = 0; corner < 8; ++corner) {
                const std::array<std::size_t, 3> at{place % 3, place / 3 % 3, place / 9};
                double weight = 1.0;
                for (std::size_t k = 0; k < 3; ++k) {
                    const double high = 0.5 * static_cast<double>(at[k]);
                    weight *= (corner >> k & 1) != 0 ? high : 1.0 - high;
                }
                w[place][corner] = weight;
            }
        return w;
    }();
    return table;
}

std::size_t place_of(const VoxelCoord& node, const VoxelCoord& cell) {
    const auto at = [&](std::size_t k) { return static_cast<std::size_t>(node[k] - 2 * cell[k]); };
    return at(0) + 3 * at(1) + 9 * at(2);
}

VoxelCoord cell_of(const VoxelCoord& voxel) {
    return {voxel[0] / 2, voxel[1] / 2, voxel[2] / 2};
}

struct Cells {
    std::vector<VoxelCoord> at;
    std::vector<std::uint32_t> of_voxel;
};

Cells gather_cells(const VoxelModel& model) {
    CellIndex index(cell_of({model.grid.extent[0] + 1, model.grid.extent[1] + 1, model.grid.extent[2] + 1}));
    for (const VoxelCoord& v : model.voxels) index.take(cell_of(v));
    index.number();
    Cells cells;
    cells.at = index.cells();
    cells.of_voxel.reserve(model.voxels.size());
    for (const VoxelCoord& v : model.voxels) cells.of_voxel.push_back(index.find(cell_of(v)));
    return cells;
}

/// Corners (8 cell + bits) of two cells are one where a node that both hold is interpolated from them.
class CornerSets {
  public:
    CornerSets(const VoxelModel& model, const Cells& cells)
        : sets_(8 * cells.at.size()), first_(model.nodes.size(), CellIndex::kNone) {
        for (std::uint32_t v = 0; v < model.voxels.size(); ++v)
            for (const NodeIndex n : model.corners[v]) {
                const std::uint32_t cell = cells.of_voxel[v];
                if (first_[n] == CellIndex::kNone)
                    first_[n] = cell;
                else if (first_[n] != cell)
                    join(cells, first_[n], cell, model.nodes[n]);
            }
    }

    /// One of the cells that hold a node.
    [[nodiscard]] std::uint32_t cell_of_node(NodeIndex n) const { return first_[n]; }

    /// Numbers the corners of all cells; returns how many there are.
    std::uint32_t number(std::vector<std::array<NodeIndex, 8>>& corners) {
        std::uint32_t count = 0;
        for (std::uint32_t i = 0; i < 8 * corners.size(); ++i) {
            const std::uint32_t root = sets_.find(i);  // the lowest member, numbered before
            corners[i / 8][i % 8] = root == i ? count++ : corners[root / 8][root % 8];
        }
        return count;
    }

  private:
    void join(const Cells& cells, std::uint32_t a, std::uint32_t b, const VoxelCoord& node) {
        const auto& weight = weights()[place_of(node, cells.at[a])];
        for (std::uint32_t corner = 0; corner < 8; ++corner) {
            if (weight[corner] == 0.0) continue;
            std::uint32_t other = 0;  // the same place as a corner of b
            for (std::size_t k = 0; k < 3; ++k) {
                const std::int32_t at = cells.at[a][k] + static_cast<std::int32_t>(corner >> k & 1);
                other |= static_cast<std::uint32_t>(at - cells.at[b][k]) << k;
            }
            sets_.unite(8 * a + corner, 8 * b + other);
        }
    }

    DisjointSets sets_;
    std::vector<std::uint32_t> first_;
};

/// P^T K P of one cell: which of its voxels are solid, and which of its 27 places are held, tell all.
Matrix24 cell_matrix(const CubeElement& cube, std::uint32_t solid, std::uint32_t held) {
    Matrix24 sum = Matrix24::Zero();
    for (std::size_t child = 0; child < 8; ++child) {
        if ((solid >> child & 1) == 0) continue;
        Matrix24 follow = Matrix24::Zero();
        for (std::size_t c = 0; c < 8; ++c) {
            std::size_t place = 0, step = 1;
            for (std::size_t k = 0; k < 3; ++k, step *= 3)
                place += step * ((child >> k & 1) + (kCornerBits[c] >> k & 1));
            if ((held >> place & 1) != 0) continue;
            for (std::size_t corner = 0; corner < 8; ++corner)
                for (std::size_t axis = 0; axis < 3; ++axis)
                    follow(static_cast<int>(3 * c + axis), static_cast<int>(3 * corner + axis)) =
                        weights()[place][corner];
        }
        sum += follow.transpose() * cube.stiffness * follow;
    }
    return sum;
}

FactoredSystem::Elements elements_of(const VoxelModel& model, const CubeElement& cube, const Cells& cells,
                                     const std::vector<std::array<NodeIndex, 8>>& corners, std::uint32_t corner_count,
                                     const std::vector<std::uint8_t>& fixed) {
    std::vector<std::uint32_t> solid(cells.at.size(), 0), held(cells.at.size(), 0), freed(cells.at.size(), 0);
    for (std::size_t v = 0; v < model.voxels.size(); ++v) {
        const VoxelCoord& at = model.voxels[v];
        const std::uint32_t cell = cells.of_voxel[v];
        solid[cell] |= 1u << ((at[0] & 1) + 2 * (at[1] & 1) + 4 * (at[2] & 1));
        for (const NodeIndex n : model.corners[v])
            (fixed[n] != 0 ? held : freed)[cell] |= 1u << place_of(model.nodes[n], cells.at[cell]);
    }
    FactoredSystem::Elements elements;
    // Above a held layer in the middle of a cell, both layers of corners do the same.
    elements.diagonal_factor = 1.0 + 1e-7;
    elements.fixed.assign(corner_count, 1);
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> kinds;
    for (std::size_t c = 0; c < cells.at.size(); ++c) {
        const auto [kind, is_new] =
            kinds.emplace(std::pair{solid[c], held[c]}, static_cast<std::uint32_t>(elements.kinds.size()));
        if (is_new) elements.kinds.push_back(cell_matrix(cube, solid[c], held[c]));
        elements.kind.push_back(kind->second);
        elements.nodes.add(corners[c]);
        for (std::size_t place = 0; place < 27; ++place)
            for (std::size_t corner = 0; corner < 8; ++corner)
                if ((freed[c] >> place & 1) != 0 && weights()[place][corner] > 0.0)
                    elements.fixed[corners[c][corner]] = 0;
    }
    return elements;
}

}  // namespace

CoarseLevel::CoarseLevel(const VoxelModel& model, const CubeElement& cube, const std::vector<std::uint8_t>& fixed,
                         const std::vector<Slab>& slabs, std::size_t most_bytes, const RunControl& run)
    : slabs_(slabs) {
    const Cells cells = gather_cells(model);
    corners_.resize(cells.at.size());
    CornerSets sets(model, cells);
    const std::uint32_t corner_count = sets.number(corners_);
    follow_.resize(model.nodes.size());
    for (NodeIndex n = 0; n < model.nodes.size(); ++n) {
        const std::uint32_t cell = sets.cell_of_node(n);
        const auto place = static_cast<std::uint8_t>(place_of(model.nodes[n], cells.at[cell]));
        follow_[n] = {cell, fixed[n] != 0 ? kHeld : place};
    }
    run.throw_if_stopped();
    system_ = std::make_unique<FactoredSystem>(elements_of(model, cube, cells, corners_, corner_count, fixed),
                                               most_bytes, run);
}

Eigen::VectorXd CoarseLevel::restricted(const NodeValues<float>& r) const {
    Eigen::VectorXd sum = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(system_->rows()));
    // Slabs begin at even layers: what two neighbours share is one layer of corners.
    for_each_slab(slabs_, [&](const Slab& slab) {
        for (std::size_t n = slab.first_node; n < slab.end_node; ++n) {
            const Follow& at = follow_[n];
            if (at.place == kHeld) continue;
            for (std::size_t corner = 0; corner < 8; ++corner) {
                const double weight = weights()[at.place][corner];
                const std::int64_t row = system_->row(corners_[at.cell][corner]);
                if (weight == 0.0 || row == StiffnessPattern::kFixed) continue;
                for (std::size_t axis = 0; axis < 3; ++axis)
                    sum[row + static_cast<Eigen::Index>(axis)] += weight * static_cast<double>(r[3 * n + axis]);
            }
        }
    });
    return sum;
}

void CoarseLevel::prolonged(const Eigen::Ref<const Eigen::VectorXd>& e, NodeValues<float>& d) const {
    parallel_for(follow_.size(), 4096, [&](std::size_t n) {
        const Follow& at = follow_[n];
        Eigen::Vector3d sum = Eigen::Vector3d::Zero();
        for (std::size_t corner = 0; corner < 8 && at.place != kHeld; ++corner) {
            const double weight = weights()[at.place][corner];
            const std::int64_t row = system_->row(corners_[at.cell][corner]);
            if (weight != 0.0 && row != StiffnessPattern::kFixed) sum += weight * e.segment<3>(row);
        }
        for (std::size_t axis = 0; axis < 3; ++axis) d[3 * n + axis] = static_cast<float>(sum[static_cast<int>(axis)]);
    });
}

}  // namespace fretwork
