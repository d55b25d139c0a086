// Stage 6: voxel paths -> bridges as wide as the pattern (end of section 5.2).
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/shell/surface_voxels.h"

namespace fretwork {

enum class DilatedPart {
    kWholePath,  ///< the paper
    kGap,        ///< the empty voxels of the path, on their own sheet: normals within 60 degrees
};

struct PaintedVoxels {
    std::vector<VoxelIndex> added;    ///< were empty; ascending
    std::vector<VoxelIndex> covered;  ///< all that the bridge is made of, `added` and voxels solid before; ascending
};

/// Turns paths solid and dilates them. Keeps scratch memory, so that a bridge costs its own voxels
/// only. References must outlive it.
class BridgePainter {
  public:
    /// \param firm           firm_links(shell.adjacency)
    /// \param radius_voxels  r_pattern, at least 1.5: less would leave a path that hangs together by
    ///                       edges and corners
    BridgePainter(const SurfaceVoxels& shell, const Adjacency& firm, double radius_voxels);

    /// Makes solid every voxel within the radius (between centres, in voxels) of the dilated part of
    /// `path` that can be reached from there over firm links without leaving the radius. Another
    /// sheet, however near, is never painted.
    PaintedVoxels paint(std::span<const VoxelIndex> path, DilatedPart part, SolidStates& solid);

    /// Makes the pattern along `path` at least `radius_voxels` wide to either side, on its own sheet.
    PaintedVoxels paint_strand(std::span<const VoxelIndex> path, double radius_voxels, SolidStates& solid);

    /// The same around one voxel, with a radius of its own.
    PaintedVoxels paint_disc(VoxelIndex center, double radius_voxels, SolidStates& solid);

  private:
    void flood(VoxelIndex center, double radius_voxels, float least_cosine, SolidStates& solid, PaintedVoxels& painted);

    const SurfaceVoxels* shell_;
    const Adjacency* firm_;
    double radius_voxels_;
    std::vector<std::uint32_t> seen_;  ///< number of the last flood that met the voxel
    std::uint32_t floods_ = 0;
    std::vector<VoxelIndex> open_;
};

}  // namespace fretwork
