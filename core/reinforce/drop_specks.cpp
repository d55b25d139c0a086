#include "core/reinforce/drop_specks.h"

namespace fretwork {

DroppedSpecks drop_specks(const Adjacency& firm, const ShellComponents& shell_components,
                          const std::vector<std::uint8_t>& keep, const SpeckRules& rules, SolidStates& solid) {
    const ShellComponents pieces = connected_components(firm, solid, SolidState::kSolid);
    std::vector<std::uint32_t> home(pieces.count(), 0);
    std::vector<std::uint8_t> kept(pieces.count(), 0);
    for (VoxelIndex v = 0; v < solid.size(); ++v) {
        if (pieces.of[v] == kNoComponent) continue;
        home[pieces.of[v]] = shell_components.of[v];
        if (!keep.empty() && keep[v] != 0) kept[pieces.of[v]] = 1;
    }

    std::vector<std::uint32_t> largest(shell_components.count(), kNoComponent);
    std::vector<std::size_t> solid_voxels(shell_components.count(), 0);
    std::vector<std::size_t> speck_voxels(shell_components.count(), 0);
    for (std::uint32_t p = 0; p < pieces.count(); ++p) {
        std::uint32_t& first = largest[home[p]];
        if (first == kNoComponent || pieces.sizes[p] > pieces.sizes[first]) first = p;
    }
    const auto is_speck = [&](std::uint32_t p) {
        return pieces.sizes[p] < rules.least_voxels && kept[p] == 0 && largest[home[p]] != p;
    };
    for (std::uint32_t p = 0; p < pieces.count(); ++p) {
        solid_voxels[home[p]] += pieces.sizes[p];
        if (is_speck(p)) speck_voxels[home[p]] += pieces.sizes[p];
    }

    DroppedSpecks result;
    std::vector<std::uint8_t> dropped(pieces.count(), 0);
    for (std::uint32_t p = 0; p < pieces.count(); ++p) {
        const double share = static_cast<double>(speck_voxels[home[p]]) / static_cast<double>(solid_voxels[home[p]]);
        if (!is_speck(p) || share > rules.most_share) continue;
        dropped[p] = 1;
        ++result.pieces;
    }
    result.pieces_left = pieces.count() - result.pieces;
    for (VoxelIndex v = 0; v < solid.size(); ++v) {
        if (pieces.of[v] == kNoComponent || dropped[pieces.of[v]] == 0) continue;
        solid[v] = SolidState::kEmpty;
        result.voxels.push_back(v);
    }
    return result;
}

}  // namespace fretwork
