// Which voxels show one piece of the exemplar: what the synthesizer's labels amount to.
#pragma once

#include <cstdint>
#include <vector>

#include "core/exemplar/exemplar.h"
#include "core/shell/surface_voxels.h"
#include "core/synthesis/labels.h"

namespace fretwork {

/// One number per voxel, from 1: neighbours have the same where the picture goes on from one to the other without a
/// seam. Numbered in the order of the shell; after 65535 they begin anew.
/// Cost  linear in the links of the shell
std::vector<std::uint16_t> label_patches(const SurfaceVoxels& shell, const TexelFrames& frames,
                                         const Exemplar& exemplar);

}  // namespace fretwork
