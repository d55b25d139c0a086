// STEP, IGES and BREP -> mesh, through OpenCASCADE. Built with FRETWORK_STEP only.
#pragma once

#include <string_view>

#include "core/base/run_control.h"
#include "formats/mesh_data.h"

namespace fretwork {

enum class CadFormat { kStep, kIges, kBrep };

/// How finely curved faces are broken into triangles.
struct CadMeshing {
    double deviation_share = 5e-4;  ///< largest distance from the true face, as a share of the box's diagonal
    double angle_rad = 0.2;         ///< largest turn of the normal along an edge
};

/// All faces of the file as one mesh; corners on shared edges become one vertex, so that a solid comes
/// out closed. STEP and IGES are converted to millimetres, BREP is taken to be in millimetres. Every
/// solid becomes a part.
/// The same file always gives the same mesh. A stop is honoured between reading, meshing and collecting.
/// \throws InvalidInput  not readable, without faces, or with a face that cannot be broken into triangles.
/// \throws InvalidSetting  a deviation or angle that is not positive.
MeshFile read_cad(std::string_view bytes, CadFormat format, std::string_view source, const CadMeshing& meshing = {},
                  const RunControl& run = {});

}  // namespace fretwork
