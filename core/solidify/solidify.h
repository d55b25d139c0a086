// Stage 8: surface + pattern -> closed mesh of the carved wall.
#pragma once

#include <cstddef>
#include <vector>

#include "core/base/run_control.h"
#include "core/exemplar/image.h"
#include "core/mesh/triangle_mesh.h"
#include "core/solidify/pattern_field.h"

namespace fretwork {

enum class WallSide {
    kInward,   ///< the outer face is the input surface
    kOutward,  ///< the inner face is the input surface
    kCentred,  ///< half to each side; also the only choice for open surfaces
};

struct SolidifySettings {
    double thickness_mm = 2.0;  ///< at least two voxels
    WallSide side = WallSide::kInward;
    double simplify_tolerance_voxels = 0.1;  ///< 0 keeps every triangle of the lattice
    /// 0: as few as the tolerance allows; else no more than this where validity allows.
    std::size_t target_triangles = 0;
    bool keep_colors = true;  ///< borders between the colours of the pattern become edges of the mesh
};

struct CarvedMesh {
    TriangleMesh mesh;
    std::vector<Rgb8> triangle_colors;           ///< one per triangle, sRGB
    std::vector<std::uint32_t> triangle_voxels;  ///< surface voxel whose pattern each triangle shows
    std::size_t islands_removed = 0;             ///< loose solid pieces dropped
    double islands_volume_mm3 = 0.0;
    std::size_t hollows_filled = 0;  ///< closed hollows too small to be meant
};

/// Marching tetrahedra over a band of the shell's grid around the surface, roots on the input
/// surface taken exactly, one solid piece per connected component of the input, simplified under a
/// validity check. See docs/decisions for the route and its alternatives.
///
/// Promise: closed, each edge in exactly two triangles, outward, no self-intersection, no degenerate
/// triangle, also after coordinates are rounded to seven significant digits.
/// Cost  time and memory grow with the surface voxels times the wall in voxels.
/// \param mesh   the (repaired) input from which `shell` was voxelised
/// \throws ConstraintsNotMet  thickness under two voxels (names the resolution that would do); an
///                            open surface with a side other than centred.
CarvedMesh solidify(const TriangleMesh& mesh, const SurfaceVoxels& shell, const PatternField& pattern,
                    const SolidifySettings& settings, const RunControl& run = {});

}  // namespace fretwork
