// STEP, IGES and BREP -> mesh, through OpenCASCADE. Built with FRETWORK_STEP only.
#pragma once

#include <string_view>

#include "core/base/run_control.h"
#include "formats/cad_meshing.h"
#include "formats/mesh_data.h"

namespace fretwork {

enum class CadFormat { kStep, kIges, kBrep };

/// All faces of the file as one mesh; corners on shared edges become one vertex, so that a solid comes
/// out closed. STEP and IGES are converted to millimetres, BREP is taken to be in millimetres. Every
/// solid becomes a part. Faces keep the numbers that FreeCAD shows for the same shape: the order in which its
/// explorer meets them, faces shared by two solids once.
/// The same file always gives the same mesh. A stop is honoured between reading, meshing and collecting.
/// \throws InvalidInput  not readable, without faces, or with a face that cannot be broken into triangles.
/// \throws InvalidSetting  a deviation or angle that is not positive.
MeshFile read_cad(std::string_view bytes, CadFormat format, std::string_view source, const CadMeshing& meshing = {},
                  const RunControl& run = {});

}  // namespace fretwork
