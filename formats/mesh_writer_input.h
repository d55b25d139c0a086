// What every mesh writer takes.
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "core/exemplar/image.h"
#include "core/mesh/triangle_mesh.h"

namespace fretwork {

/// How coordinates are rounded on the way out. All writers print text that reads back as the rounded number, into a
/// float or a double.
enum class CoordinatePrecision {
    kFloat,   ///< 24 bits, what slicers and viewers keep anyway
    kDouble,  ///< as they are; formats that hold floats only (STL) round all the same
};

/// References must outlive the call.
struct MeshToWrite {
    const TriangleMesh& mesh;
    std::span<const Rgb8> triangle_colors = {};  ///< one per triangle, or empty
    std::string_view name = {};
    CoordinatePrecision precision = CoordinatePrecision::kFloat;
    /// Name of the file that holds the materials of an OBJ; empty: its colours are left out.
    std::string_view obj_materials = {};
};

/// Checks what all writers need. \throws InvalidInput  an index past the end, a coordinate that is not
/// finite, colours whose number differs from that of the triangles.
void check_mesh_to_write(const MeshToWrite& input);

/// One coordinate as text.
void append_coordinate(std::string& out, double value, CoordinatePrecision precision);

}  // namespace fretwork
