// What a mesh file holds beside its triangles.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "core/exemplar/image.h"
#include "core/mesh/triangle_mesh.h"
#include "formats/length_unit.h"

namespace fretwork {

/// A named run of triangles: a solid of an STL, an object or group of an OBJ, a build item of a 3MF, a face of a CAD
/// model.
struct MeshPart {
    std::string name;
    std::uint32_t first_triangle = 0;
    std::uint32_t triangle_count = 0;
};

/// Another file that a mesh was read from.
struct FileBeside {
    std::filesystem::path path;
    std::string bytes;
};

/// A mesh as it was read. Positions are in millimetres whatever the unit of the file.
struct MeshFile {
    TriangleMesh mesh;
    std::vector<Rgb8> triangle_colors;  ///< sRGB, one per triangle; empty when the file has no colours
    std::vector<MeshPart> parts;        ///< cover all triangles in order; empty when the file names none
    /// Faces of a CAD model, named as FreeCAD does: "Face1" is the first. They cover all triangles in order.
    std::vector<MeshPart> faces;
    std::vector<FileBeside> read_beside;  ///< other files that were read: materials of an OBJ
    LengthUnit unit = LengthUnit::kMillimeter;
    std::vector<std::string> warnings;  ///< what was skipped or had to be guessed
};

/// Coordinates beyond this are refused in every format: they are never meant, and their squares
/// would drown everything else.
inline constexpr double kMaxCoordinate = 1e9;

}  // namespace fretwork
