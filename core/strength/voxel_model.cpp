#include "core/strength/voxel_model.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include "core/base/disjoint_sets.h"
#include "core/base/error.h"
#include "core/base/parallel.h"
#include "core/strength/solid_cells.h"

namespace fretwork {
namespace {

constexpr int kMostCells = 4096;

VoxelGrid grid_around(const TriangleMesh& mesh, double voxel_mm) {
    if (mesh.triangles.empty()) throw InvalidInput("strength: found no triangle, expected a closed mesh");
    Vec3 low = Vec3::Constant(std::numeric_limits<double>::infinity()), high = -low;
    for (const Vec3& p : mesh.positions_mm) {
        if (!p.allFinite()) throw InvalidInput("strength: found a coordinate that is not finite");
        low = low.cwiseMin(p);
        high = high.cwiseMax(p);
    }
    const double longest = (high - low).maxCoeff();
    if (!(voxel_mm > 0.0) || !(longest <= kMostCells * voxel_mm))
        throw InvalidSetting("strength: voxels of " + std::to_string(voxel_mm) + " mm; expected at least " +
                             std::to_string(longest / kMostCells) + " mm for a model of " + std::to_string(longest) +
                             " mm");
    VoxelGrid grid;
    grid.voxel_mm = voxel_mm;
    for (int k = 0; k < 3; ++k) {
        // What rounding adds to a box of whole voxels is no further layer.
        const double cells = std::max(1.0, std::ceil((high[k] - low[k]) / voxel_mm - 1e-6));
        grid.extent[static_cast<std::size_t>(k)] = static_cast<std::int32_t>(cells);
        grid.origin_mm[k] = 0.5 * (low[k] + high[k] - cells * voxel_mm);
    }
    return grid;
}

VoxelCoord moved(const VoxelCoord& c, const VoxelCoord& by) {
    return {c[0] + by[0], c[1] + by[1], c[2] + by[2]};
}

/// Half of the 26 directions, those by faces first.
constexpr std::array<VoxelCoord, 3> kFaces{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
constexpr std::array<VoxelCoord, 10> kHinges{{{1, 1, 0},
                                              {1, -1, 0},
                                              {1, 0, 1},
                                              {-1, 0, 1},
                                              {0, 1, 1},
                                              {0, -1, 1},
                                              {1, 1, 1},
                                              {-1, 1, 1},
                                              {1, -1, 1},
                                              {-1, -1, 1}}};

DisjointSets pieces_by_faces(const CellIndex& cells, const std::vector<VoxelCoord>& voxels) {
    DisjointSets pieces(voxels.size());
    for (std::uint32_t v = 0; v < voxels.size(); ++v)
        for (const VoxelCoord& step : kFaces)
            if (const std::uint32_t other = cells.find(moved(voxels[v], step)); other != CellIndex::kNone)
                pieces.unite(v, other);
    return pieces;
}

/// Cells that join pieces which meet in an edge or a corner: a way of faces from one to the other.
std::vector<VoxelCoord> cells_at_hinges(const CellIndex& cells, const std::vector<VoxelCoord>& voxels,
                                        DisjointSets& pieces) {
    std::vector<VoxelCoord> added;
    for (std::uint32_t v = 0; v < voxels.size(); ++v)
        for (const VoxelCoord& step : kHinges) {
            const std::uint32_t other = cells.find(moved(voxels[v], step));
            if (other == CellIndex::kNone || !pieces.unite(v, other)) continue;
            VoxelCoord at = voxels[v];
            for (std::size_t k = 0; k < 3; ++k) {
                at[k] += step[k];
                if (!cells.taken(at)) added.push_back(at);
            }
        }
    return added;
}

void add_corners(VoxelModel& model) {
    static constexpr std::array<VoxelCoord, 8> kCorner{
        {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}}};
    const VoxelCoord& extent = model.grid.extent;
    CellIndex nodes({extent[0] + 1, extent[1] + 1, extent[2] + 1});
    for (const VoxelCoord& v : model.voxels)
        for (const VoxelCoord& corner : kCorner) nodes.take(moved(v, corner));
    nodes.number();
    model.nodes = nodes.cells();
    model.corners.resize(model.voxels.size());
    parallel_for(model.voxels.size(), 4096, [&](std::size_t v) {
        for (std::size_t c = 0; c < 8; ++c) model.corners[v][c] = nodes.find(moved(model.voxels[v], kCorner[c]));
    });
}

VoxelModel model_of(const VoxelGrid& grid, CellIndex cells) {
    VoxelModel model;
    model.grid = grid;
    model.voxels = cells.cells();
    if (model.voxels.empty())
        throw InvalidInput("strength: found no voxel of " + std::to_string(grid.voxel_mm) +
                           " mm whose centre is inside, expected a closed mesh and smaller voxels");
    DisjointSets pieces = pieces_by_faces(cells, model.voxels);
    // What is added may touch further pieces.
    for (std::vector<VoxelCoord> more; !(more = cells_at_hinges(cells, model.voxels, pieces)).empty();) {
        const std::size_t before = cells.size();
        for (const VoxelCoord& c : more) cells.take(c);
        cells.number();
        model.joining_voxels += cells.size() - before;
        model.voxels = cells.cells();
        pieces = pieces_by_faces(cells, model.voxels);
    }
    model.piece.resize(model.voxels.size());
    for (std::uint32_t v = 0; v < model.voxels.size(); ++v) {
        const std::uint32_t root = pieces.find(v);  // the lowest member, numbered before
        model.piece[v] = root == v ? model.pieces++ : model.piece[root];
    }
    add_corners(model);
    return model;
}

}  // namespace

VoxelModel make_voxel_model(const TriangleMesh& mesh, double voxel_mm, const RunControl& run) {
    const VoxelGrid grid = grid_around(mesh, voxel_mm);
    return model_of(grid, solid_cells(mesh, grid, run));
}

VoxelModel make_voxel_model(const VoxelGrid& grid, const std::vector<VoxelCoord>& solid) {
    CellIndex cells(grid.extent);
    for (const VoxelCoord& c : solid) cells.take(c);
    cells.number();
    return model_of(grid, std::move(cells));
}

}  // namespace fretwork
