// The model that readers and writers of 3MF are timed with: a coloured ball with voxel data.
#pragma once

#include <cstdint>
#include <vector>

#include "core/exemplar/image.h"
#include "core/mesh/triangle_mesh.h"
#include "core/shell/surface_voxels.h"

namespace fretwork::bench {

struct SpeedModel {
    TriangleMesh mesh;
    std::vector<Rgb8> colors;  ///< one per triangle, 4096 different ones at most
    SurfaceVoxels shell;       ///< grid and places alone
    SolidStates solid;
    std::vector<std::uint8_t> reinforced;
    std::vector<Rgb8> voxel_colors;
    std::vector<float> stress_mpa;
    std::vector<std::uint16_t> labels;
};

/// The ball alone: 2 * 10^6 triangles for `side` = 1000, 2 side^2 for others. Colours in patches of some triangles, as
/// a pattern gives them.
SpeedModel make_speed_model(int side);

/// The shell of the ball in a cube of `cells` voxels along each axis, with a chequered pattern.
void add_voxels(SpeedModel& model, int cells);

}  // namespace fretwork::bench
