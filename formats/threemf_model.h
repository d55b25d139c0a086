// What a model part of a 3MF package says, before references are followed.
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "core/exemplar/image.h"
#include "core/mesh/triangle_mesh.h"
#include "formats/length_unit.h"

namespace fretwork::threemf {

using ResourceId = std::uint32_t;

/// A placed object: of `<component>` or of `<item>`.
struct Instance {
    ResourceId object = 0;
    std::string part;  ///< model part that holds the object; empty for this one (production extension)
    Eigen::Affine3d transform = Eigen::Affine3d::Identity();
    bool printable = true;
    std::size_t line = 0;
};

struct Object {
    std::string name;
    std::string part_number;
    std::string type = "model";
    TriangleMesh mesh;                  ///< in the unit of the model
    std::vector<Rgb8> triangle_colors;  ///< one per triangle, or empty
    std::vector<Instance> components;
    ResourceId volume = 0;  ///< volumedata; 0 for none
    std::size_t line = 0;
};

/// `<v:image3d>` with an image stack.
struct Image3d {
    std::string name;
    std::int64_t rows = 0;
    std::int64_t columns = 0;
    std::vector<std::string> sheets;  ///< paths of the parts
};

enum class TileStyle { kWrap, kMirror, kClamp };

/// `<v:functionfromimage3d>`
struct ImageFunction {
    ResourceId image = 0;
    double offset = 0.0;
    double scale = 1.0;
    bool nearest = false;
    TileStyle tile[3] = {TileStyle::kWrap, TileStyle::kWrap, TileStyle::kWrap};
};

/// `<v:color>` (with an empty name) or `<v:property>`
struct VolumeProperty {
    std::string name;
    ResourceId function = 0;
    std::string channel;
    Eigen::Affine3d transform = Eigen::Affine3d::Identity();
};

struct Model {
    LengthUnit unit = LengthUnit::kMillimeter;
    std::vector<std::pair<std::string, std::string>> metadata;
    std::map<ResourceId, Object> objects;
    std::map<ResourceId, Image3d> images;
    std::map<ResourceId, ImageFunction> functions;
    std::map<ResourceId, std::vector<VolumeProperty>> volumes;
    std::vector<Instance> items;
    std::vector<std::string> warnings;
};

}  // namespace fretwork::threemf
