// Carved meshes with colour, voxel data, spec and report -> 3MF.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "core/base/run_control.h"
#include "core/exemplar/image.h"
#include "core/mesh/triangle_mesh.h"
#include "formats/package_record.h"
#include "formats/slicer_paint.h"
#include "formats/voxel_sheets.h"

namespace fretwork {

/// References must outlive the call.
struct CarvedObject {
    const TriangleMesh& mesh;
    std::span<const Rgb8> triangle_colors = {};  ///< sRGB, one per triangle; may be empty
    std::string name = {};
    const VoxelData* voxels = nullptr;    ///< none: no volumetric data for this object
    const VoxelSheets* sheets = nullptr;  ///< the same, drawn before; instead of `voxels`
    TrianglePaint paint = {};
};

struct CarvedPackage : PackageRecord {
    std::vector<CarvedObject> objects;
    std::string title;
    std::string application = "Fretwork";
};

/// One package as DESIGN section 7 and the volumetric extension (0.8) ask for:
///  - `/3D/3dmodel.model`, core as default namespace, `recommendedextensions="m v"`, nothing required;
///  - per object a colour group without repeats, pid and p1..p3 on every triangle, pid and pindex on
///    the object; one mesh object and one build item per object, in millimetres;
///  - per object with voxel data an image3d of 16-bit RGBA sheets over the shell's grid (linear colour,
///    alpha = solid), nearest and clamped, and where given a second one of 8 bits for `fw:reinforced`;
///    linked by `v:volumeid`. Row 0 of a sheet is the highest y. A cell that holds several sheets of the surface
///    is solid (reinforced) when one of them is, and shows the colour of its first solid one;
///  - where painted, an extruder on every triangle as the named slicer stores it;
///  - `/Metadata/fretwork.toml` and `/Metadata/fretwork.json`, and the same texts as metadata; the further parts of
///    the record.
/// Coordinates are rounded to floats and printed so that they read back exactly.
///
/// The bytes depend on the arguments alone.
/// Cost  2 M triangles take two to three seconds of all cores together; memory is the packed size twice.
/// \throws InvalidInput  no object; see check_mesh_to_write; data whose number differs from the voxels;
///                       a grid of over 1024 cells along an axis; a metadata name without a known prefix.
/// \throws Cancelled
std::string write_carved_threemf(const CarvedPackage& package, const RunControl& run = {});

/// Whole or not at all. \throws FileError
void write_carved_threemf(const std::filesystem::path& path, const CarvedPackage& package, const RunControl& run = {});

}  // namespace fretwork
