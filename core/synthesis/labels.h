// What the synthesizer decides for each voxel, in the form that later stages read.
#pragma once

#include <cstdint>
#include <vector>

#include "core/base/vec.h"
#include "core/exemplar/exemplar.h"
#include "core/shell/surface_voxels.h"

namespace fretwork {

/// M(x, psi(v), tau(v)) of the paper, section 4.1, written around the voxel's own surface point: the
/// exemplar position of a point at distance d (in voxels of the finest level) from it is
/// (u + du.d, v + dv.d), in exemplar pixels, continued periodically or by its border. Pixel i covers
/// [i, i + 1). u and v themselves lie in [0, width) and [0, height); up to whole periods, neighbours
/// with equal du and dv that show one piece of the picture agree exactly at each other's points.
struct TexelFrame {
    float u = 0.0F;
    float v = 0.0F;
    Vec3f du = Vec3f::Zero();  ///< pixels per voxel; lies in the chosen plane psi
    Vec3f dv = Vec3f::Zero();
};

/// One frame per surface voxel.
using TexelFrames = std::vector<TexelFrame>;

/// s(v) through the projection: the solid mask at the texel of each voxel.
SolidStates read_solid(const Exemplar& exemplar, const TexelFrames& frames);

/// Colour through the projection, bilinear between pixels.
std::vector<Rgb8> read_color(const Exemplar& exemplar, const TexelFrames& frames);

}  // namespace fretwork
