// 3MF packages, sound and hostile, made part by part.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/mesh/triangle_mesh.h"

namespace fretwork::testing {

using Parts = std::vector<std::pair<std::string, std::string>>;

/// A ZIP with these parts, packed.
std::string make_zip(const Parts& parts);

/// A package with content types, root relationships and this model part.
std::string make_package(const std::string& model_xml, const Parts& more = {});

/// A package whose model part unpacks to so many megabytes of blanks; made without holding them.
std::string make_zip_bomb(std::size_t megabytes);

/// `<model>` with the core, m, v, p and fw prefixes declared; `attributes` go into the start tag.
std::string make_model(const std::string& resources, const std::string& build, const std::string& attributes = "");

/// `<object>` with a tetrahedron of volume 1/6 at the origin.
std::string make_tetrahedron(int id, const std::string& attributes = "", const std::string& triangle_attributes = "");

/// `<object>` with a mesh, in millimetres.
std::string make_mesh_object(int id, const TriangleMesh& mesh, const std::string& attributes = "");

/// What carving may write into the root model of `make_project`: nothing by default.
struct ProjectGaps {
    std::string model;              ///< attributes at the end of <model>
    std::string recommended = "x";  ///< value of recommendedextensions
    std::string before_object;      ///< text before <object id="5">
    std::string object;             ///< attributes of that object
    std::string mesh;               ///< attributes of its mesh
    std::string mesh_content;       ///< empty: a tetrahedron
};

/// A project with a bit of everything: metadata with a group, materials and a texture, unknown elements, attributes
/// and parts, paint, slicer settings, assemblies, a second model part, comments, odd blanks and quotes. Objects with
/// meshes: "wall" (5, W-1, twice through the assembly "pair"), "spare" (6, not printable), "post" (7, a support),
/// and "far" (1 of /3D/Objects/other.model). Its prefix m means something else, and its ids end at 61.
std::string make_project(const ProjectGaps& gaps = {});

/// A tetrahedron with voxel data, and what may be wrong with them.
struct Volumetric {
    std::vector<std::string> sheets;            ///< PNG; an empty one is missing from the package
    std::string stack;                          ///< attributes of the image stack, which must agree with the sheets
    std::string function;                       ///< further attributes of the function
    std::string image_attribute = "image3did";  ///< by which the function names the stack
    /// Content of the volume data.
    std::string volume = "<v:property name=\"fw:solid\" required=\"true\" functionid=\"3\" channel=\"red\"/>";
    std::string mesh = "v:volumeid=\"4\"";  ///< attributes of the mesh
    std::string model;                      ///< attributes of the model
};
std::string make_volumetric(const Volumetric& volumetric);

/// Replaces every occurrence; both have the same length. For names within finished archives.
std::string patched(std::string bytes, std::string_view from, std::string_view to);

/// Overwrites `value`, little endian, at `offset` within every central directory record.
std::string with_central_field(std::string bytes, std::size_t offset, std::uint32_t value, int size);

}  // namespace fretwork::testing
