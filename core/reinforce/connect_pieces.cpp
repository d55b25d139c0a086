#include "core/reinforce/connect_pieces.h"

#include <algorithm>
#include <tuple>

#include "core/base/disjoint_sets.h"
#include "core/graph/shortest_path_forest.h"
#include "core/graph/tree_crossings.h"
#include "core/reinforce/repair_contacts.h"

namespace fretwork {
namespace {

/// Shortest crossings over `graph` that join all pieces that can be joined: Kruskal's least spanning
/// tree on the borders between the pieces' nearest regions, which hold the tree of all gaps.
std::vector<std::vector<VoxelIndex>> spanning_gaps(const Adjacency& graph, const ShellComponents& pieces,
                                                   const SolidStates& solid) {
    ForestGrower grower(graph);
    for (VoxelIndex v = 0; v < solid.size(); ++v)
        if (solid[v] == SolidState::kSolid) grower.plant(v, pieces.of[v]);
    grower.grow();
    std::vector<TreeCrossing> gaps = shortest_crossings(graph, grower.forest(), solid, CrossingLinks::kAny);
    std::ranges::sort(gaps, [](const TreeCrossing& x, const TreeCrossing& y) {
        return std::tie(x.length, x.a, x.b) < std::tie(y.length, y.a, y.b);
    });
    DisjointSets joined(pieces.count());
    std::vector<std::vector<VoxelIndex>> paths;
    for (const TreeCrossing& gap : gaps)
        if (joined.unite(gap.a, gap.b)) paths.push_back(path_over(grower.forest(), gap));
    return paths;
}

/// No component of the shell carries more than one piece.
bool nothing_to_join(const ShellComponents& pieces, const ShellComponents& shell_components) {
    std::vector<std::uint32_t> piece_of(shell_components.count(), kNoComponent);
    for (std::size_t v = 0; v < pieces.of.size(); ++v) {
        if (pieces.of[v] == kNoComponent) continue;
        std::uint32_t& piece = piece_of[shell_components.of[v]];
        if (piece == kNoComponent) piece = pieces.of[v];
        if (piece != pieces.of[v]) return false;
    }
    return true;
}

void make_solid(const std::vector<VoxelIndex>& voxels, SolidStates& solid, std::vector<VoxelIndex>& covered) {
    for (const VoxelIndex v : voxels) solid[v] = SolidState::kSolid;
    covered.insert(covered.end(), voxels.begin(), voxels.end());
}

}  // namespace

ConnectedPieces connect_pieces(const SurfaceVoxels& shell, const Adjacency& firm,
                               const ShellComponents& shell_components, BridgePainter& painter, DilatedPart part,
                               SolidStates& solid, const RunControl& run) {
    ConnectedPieces result;
    constexpr int kAttempts = 2;
    for (int attempt = 0;; ++attempt) {
        const ShellComponents pieces = connected_components(firm, solid, SolidState::kSolid);
        run.throw_if_stopped();
        result.pieces = pieces.count();
        if (attempt == kAttempts || nothing_to_join(pieces, shell_components)) break;
        // The second time every path follows firm links, so that its voxels alone make the connection.
        const bool along_firm_links = attempt > 0;
        const auto paths = spanning_gaps(along_firm_links ? firm : shell.adjacency, pieces, solid);
        run.throw_if_stopped();
        if (paths.empty()) break;
        for (const std::vector<VoxelIndex>& path : paths) {
            const bool contact = path.size() == 2;
            if (contact) {
                const auto filling = contact_filling(shell, firm, solid, path.front(), path.back());
                if (filling) make_solid(*filling, solid, result.covered);
            } else {
                const PaintedVoxels bridge = painter.paint(path, part, solid);
                result.covered.insert(result.covered.end(), bridge.covered.begin(), bridge.covered.end());
            }
            // The ends too: where the bridge sits on the pattern, the pattern must stay.
            make_solid(path, solid, result.covered);
            ++(contact ? result.contacts : result.bridges);
        }
    }
    std::ranges::sort(result.covered);
    result.covered.erase(std::unique(result.covered.begin(), result.covered.end()), result.covered.end());
    return result;
}

std::vector<VoxelIndex> seed_empty_components(const ShellComponents& shell_components, BridgePainter& painter,
                                              double radius_voxels, SolidStates& solid) {
    std::vector<VoxelIndex> lowest(shell_components.count(), kNoVoxel);
    std::vector<std::uint8_t> has_solid(shell_components.count(), 0);
    for (VoxelIndex v = 0; v < solid.size(); ++v) {
        // Voxels are sorted by height first.
        if (lowest[shell_components.of[v]] == kNoVoxel) lowest[shell_components.of[v]] = v;
        if (solid[v] == SolidState::kSolid) has_solid[shell_components.of[v]] = 1;
    }
    std::vector<VoxelIndex> painted;
    for (std::size_t c = 0; c < lowest.size(); ++c) {
        if (has_solid[c] != 0) continue;
        const PaintedVoxels disc = painter.paint_disc(lowest[c], radius_voxels, solid);
        painted.insert(painted.end(), disc.covered.begin(), disc.covered.end());
    }
    std::ranges::sort(painted);
    return painted;
}

}  // namespace fretwork
