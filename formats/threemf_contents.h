// 3MF -> what the package holds beside its triangles: for people who ask what a file is before they use it.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/base/run_control.h"
#include "core/base/vec.h"
#include "formats/threemf_build.h"

namespace fretwork {

struct PackagePartInfo {
    std::string path;          ///< "3D/3dmodel.model"
    std::string content_type;  ///< as the package says; empty: it says nothing
    std::uint64_t bytes = 0;   ///< unpacked
};

/// An extension that a model part names as required or recommended.
struct ThreemfExtension {
    std::string space;  ///< its namespace
    bool required = false;
    bool understood = false;
};

/// Base materials, a colour group, a texture group ...
struct MaterialGroupInfo {
    std::string part;  ///< model part that holds it
    threemf::ResourceId id = 0;
    std::string kind;  ///< name of its element: "colorgroup"
    std::size_t entries = 0;
    std::vector<std::string> first;  ///< names and colours of the first 16
};

/// An attribute by which slicers mark triangles.
struct SlicerPaintInfo {
    std::string attribute;  ///< "slic3rpe:mmu_segmentation", "paint_color" ...
    std::size_t triangles = 0;
    std::map<int, std::size_t> extruders;  ///< triangles that are painted as a whole, per extruder
};

struct VoxelPropertyInfo {
    std::string name;  ///< "color" or that of the property: "fw:solid"
    std::int64_t columns = 0, rows = 0, sheets = 0;
    Vec3 voxel_mm = Vec3::Zero();  ///< size of a voxel along columns, rows and sheets
};

struct VoxelDataInfo {
    threemf::ObjectKey object;
    std::string object_name;
    std::vector<VoxelPropertyInfo> properties;
};

/// Elements that are carried along but not looked into, with all that they hold.
struct CarriedElements {
    std::string space, name;
    std::size_t count = 0;
};

struct ThreemfContents {
    std::string model_part;
    std::vector<PackagePartInfo> parts;  ///< in the order of the package, without the sheets of image stacks
    std::size_t image_sheets = 0;
    std::vector<std::pair<std::string, std::string>> metadata;  ///< of the root model
    std::vector<ThreemfExtension> extensions;
    std::vector<MaterialGroupInfo> materials;
    std::vector<SlicerPaintInfo> paint;
    std::vector<VoxelDataInfo> voxel_data;
    std::vector<CarriedElements> carried;
    std::string thumbnail;  ///< part that holds it; empty: none
};

/// Looks once more at every model part that the build refers to; extensions that are not known are listed.
/// \param build  of the same bytes
/// \throws InvalidInput  a part that cannot be read. \throws Cancelled
ThreemfContents threemf_contents(const threemf::Build& build, std::string_view bytes, std::string_view source,
                                 const RunControl& run = {});

}  // namespace fretwork
