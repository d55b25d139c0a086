// What an AMF document says, before instances are placed.
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/run_control.h"
#include "core/exemplar/image.h"
#include "core/mesh/triangle_mesh.h"
#include "formats/length_unit.h"

namespace fretwork::amf {

struct Volume {
    std::string name;
    std::string material;
    std::optional<Rgb8> color;
    std::uint32_t first_triangle = 0;
    std::uint32_t triangle_count = 0;
};

struct Object {
    std::string name;
    std::optional<Rgb8> color;
    TriangleMesh mesh;  ///< in the unit of the document
    /// Nothing where there is none; shorter than the vertices or triangles while the last ones have none.
    std::vector<std::optional<Rgb8>> vertex_colors;
    std::vector<std::optional<Rgb8>> triangle_colors;
    std::vector<Volume> volumes;  ///< cover all triangles in order
};

/// A placed object or constellation.
struct Instance {
    std::string target;
    Eigen::Affine3d transform = Eigen::Affine3d::Identity();
    std::size_t line = 0;
};

struct Document {
    LengthUnit unit = LengthUnit::kMillimeter;
    std::vector<std::string> order;  ///< ids of the objects as they stand in the document
    std::map<std::string, Object> objects;
    std::map<std::string, std::vector<Instance>> constellations;
    std::map<std::string, Rgb8> materials;
    std::vector<std::string> warnings;
};

/// \throws InvalidInput  naming source and line.
Document read_document(std::string_view xml, std::string_view source, const RunControl& run);

}  // namespace fretwork::amf
