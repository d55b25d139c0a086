// 3MF -> its mesh objects, each on its own and in its own coordinates.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "core/base/run_control.h"
#include "core/exemplar/image.h"
#include "core/mesh/triangle_mesh.h"
#include "formats/threemf_build.h"

namespace fretwork {

struct ThreemfObject {
    threemf::ObjectKey key;
    std::string name;  ///< where the model gives none, the one that a slicer has noted
    std::string part_number;
    std::string type;                         ///< "model", "support", ...
    std::vector<threemf::ObjectKey> parents;  ///< assemblies that hold it, directly or not
    std::vector<std::string> parent_names;    ///< names and part numbers of those
    std::size_t instances = 0;                ///< how often the build places it; at most 16384
    bool printable = false;                   ///< placed by an item that is not marked as left out
    double least_scale = 1.0;                 ///< smallest and largest factor by which it is placed
    double most_scale = 1.0;
    TriangleMesh mesh;                  ///< mm, before the transforms of components and build
    std::vector<Rgb8> triangle_colors;  ///< sRGB, one per triangle, or empty
};

struct ThreemfObjects {
    std::vector<ThreemfObject> objects;  ///< in the order in which the build first places them
    double unit_mm = 1.0;                ///< of the numbers in the file
    std::vector<std::string> warnings;
};

/// Mesh objects that the build refers to. An object that is placed several times is listed once.
/// \throws InvalidInput  see read_threemf. \throws Cancelled
ThreemfObjects read_threemf_objects(std::string_view bytes, std::string_view source,
                                    const ThreemfReadOptions& options = {}, const RunControl& run = {});

}  // namespace fretwork
