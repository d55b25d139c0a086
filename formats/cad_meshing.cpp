#include "formats/cad_meshing.h"

namespace fretwork {

CadMeshing meshing_for(const Settings& settings) {
    constexpr double kVoxelShare = 0.1;
    CadMeshing meshing;
    const ShellOptions& shell = settings.shell;
    if (!shell.voxel_mm)
        meshing.deviation_share = kVoxelShare / shell.resolution.value_or(kDefaultResolution);
    else if (settings.input.size_mm)
        meshing.deviation_share = kVoxelShare * *shell.voxel_mm / *settings.input.size_mm;
    else
        meshing.deviation_mm = kVoxelShare * *shell.voxel_mm / settings.input.scale;
    return meshing;
}

}  // namespace fretwork
