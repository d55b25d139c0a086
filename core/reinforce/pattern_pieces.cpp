#include "core/reinforce/pattern_pieces.h"

#include <algorithm>
#include <string>

#include "core/base/error.h"
#include "core/graph/firm_links.h"
#include "core/shell/components.h"

namespace fretwork {
namespace {

std::vector<std::size_t> count_on_each(const SurfaceVoxels& shell, const ShellComponents& pieces,
                                       std::size_t mesh_components) {
    std::vector<std::size_t> count(mesh_components, 0);
    std::vector<std::uint8_t> seen(pieces.count(), 0);
    for (std::size_t v = 0; v < shell.size(); ++v) {
        const std::uint32_t piece = pieces.of[v];
        if (piece == kNoComponent || seen[piece] != 0) continue;
        seen[piece] = 1;
        ++count[shell.components[v]];
    }
    return count;
}

}  // namespace

bool PatternPieces::one_each() const {
    return std::ranges::all_of(firm, [](std::size_t pieces) { return pieces == 1; });
}

PatternPieces pattern_pieces(const SurfaceVoxels& shell, const SolidStates& solid) {
    if (solid.size() != shell.size())
        throw InvalidInput("pattern_pieces: " + std::to_string(solid.size()) + " states for a shell of " +
                           std::to_string(shell.size()) + " voxels");
    std::size_t mesh_components = 0;
    for (const std::uint32_t c : shell.components) mesh_components = std::max<std::size_t>(mesh_components, c + 1);
    PatternPieces result;
    result.touching =
        count_on_each(shell, connected_components(shell.adjacency, solid, SolidState::kSolid), mesh_components);
    result.firm = count_on_each(shell, connected_components(firm_links(shell.adjacency), solid, SolidState::kSolid),
                                mesh_components);
    return result;
}

}  // namespace fretwork
