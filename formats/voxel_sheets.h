// Shell with states -> PNG sheets of an image3d.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "core/base/run_control.h"
#include "core/exemplar/image.h"
#include "core/shell/surface_voxels.h"

namespace fretwork {

/// What is known of one object's shell; everything refers to the entries of `shell`. References must
/// outlive the call.
struct VoxelData {
    const SurfaceVoxels& shell;
    std::span<const SolidState> solid;
    std::span<const std::uint8_t> reinforced = {};  ///< 1 where the structural steps forced solid; may be empty
    std::span<const Rgb8> colors = {};              ///< sRGB; may be empty
    std::span<const float> stress_mpa = {};         ///< negative where none is known; may be empty
    std::span<const std::uint16_t> labels = {};     ///< pieces of the exemplar, from 1; may be empty
};

/// Sheet k holds the cells with z = k, row 0 those with the highest y; made on several threads.
struct VoxelSheets {
    VoxelGrid grid;
    bool colored = false;                 ///< the colours mean something
    std::vector<std::string> field;       ///< 16-bit RGBA: linear colour, alpha 65535 in solid cells, else 0
    std::vector<std::string> reinforced;  ///< 8-bit grey, 255 in reinforced cells; empty when not known

    /// Facts that need not be as fine: 16-bit RGB over cells of two voxels each way. Red is the highest stress, one
    /// being `most_stress_mpa` and 0 not known, green the label of the first voxel. Empty when neither is known.
    std::vector<std::string> facts;
    VoxelGrid facts_grid;
    double most_stress_mpa = 0.0;  ///< 0: no stress is known
};

/// \throws InvalidInput  data whose number differs from the voxels; voxels outside of the grid; a grid
///                       beyond what an image3d may have.
VoxelSheets make_voxel_sheets(const VoxelData& data, const RunControl& run = {});

}  // namespace fretwork
