// Shell with states -> PNG sheets of an image3d.
#pragma once

#include <string>
#include <vector>

#include "core/base/run_control.h"
#include "formats/carved_threemf_writer.h"

namespace fretwork {

/// Sheet k holds the cells with z = k, row 0 those with the highest y; made on several threads.
struct VoxelSheets {
    std::vector<std::string> field;       ///< 16-bit RGBA: linear colour, alpha 65535 in solid cells, else 0
    std::vector<std::string> reinforced;  ///< 8-bit grey, 255 in reinforced cells; empty when not known
};

/// \throws InvalidInput  data whose number differs from the voxels; voxels outside of the grid; a grid
///                       beyond what an image3d may have.
VoxelSheets make_voxel_sheets(const VoxelData& data, const RunControl& run = {});

}  // namespace fretwork
