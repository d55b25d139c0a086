// Names that the 3MF specifications fix.
#pragma once

#include <algorithm>
#include <array>
#include <string_view>
#include <utility>

namespace fretwork::threemf {

inline constexpr std::string_view kCore = "http://schemas.microsoft.com/3dmanufacturing/core/2015/02";
inline constexpr std::string_view kMaterial = "http://schemas.microsoft.com/3dmanufacturing/material/2015/02";
inline constexpr std::string_view kVolumetric = "http://schemas.3mf.io/3dmanufacturing/volumetric/2022/01";
inline constexpr std::string_view kProduction = "http://schemas.microsoft.com/3dmanufacturing/production/2015/06";
inline constexpr std::string_view kTriangleSets = "http://schemas.microsoft.com/3dmanufacturing/trianglesets/2021/07";
inline constexpr std::string_view kSlice = "http://schemas.microsoft.com/3dmanufacturing/slice/2015/07";
inline constexpr std::string_view kFretwork = "http://fretwork.dev/3mf/2026/11";

/// Whether a model may require the extension: what it says is read, or does not change the shape.
constexpr bool is_understood(std::string_view space) {
    constexpr std::array known = {kCore, kMaterial, kVolumetric, kProduction, kTriangleSets, kFretwork};
    return std::ranges::find(known, space) != known.end();
}

/// What the specifications call an extension that is carried along and not read; empty where it is none of theirs.
constexpr std::string_view name_of_carried(std::string_view space) {
    constexpr std::pair<std::string_view, std::string_view> kCarried[] = {
        {"/beamlattice/", "beam lattice"},     {"/slice/", "slice"},
        {"/displacement/", "displacement"},    {"/booleanoperations/", "boolean operations"},
        {"/securecontent/", "secure content"}, {"/implicit/", "implicit functions"},
    };
    for (const auto& [mark, name] : kCarried)
        if (space.find(mark) != space.npos) return name;
    return {};
}

inline constexpr std::string_view kSlic3r = "http://schemas.slic3r.org/3mf/2017/06";
/// Metadata without which PrusaSlicer does not read what is painted; both "1".
inline constexpr std::string_view kSlic3rVersions[] = {"slic3rpe:Version3mf", "slic3rpe:MmPaintingVersion"};

inline constexpr std::string_view kModelRelation = "http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel";
inline constexpr std::string_view kTextureRelation = "http://schemas.microsoft.com/3dmanufacturing/2013/01/3dtexture";
inline constexpr std::string_view kThumbnailRelation =
    "http://schemas.openxmlformats.org/package/2006/relationships/metadata/thumbnail";
inline constexpr std::string_view kSpecRelation = "http://fretwork.dev/3mf/2026/11/spec";
inline constexpr std::string_view kReportRelation = "http://fretwork.dev/3mf/2026/11/report";
inline constexpr std::string_view kRunRelation = "http://fretwork.dev/3mf/2026/11/run";
inline constexpr std::string_view kRequestRelation = "http://fretwork.dev/3mf/2026/11/request";
inline constexpr std::string_view kSourceRelation = "http://fretwork.dev/3mf/2026/11/source";
inline constexpr std::string_view kMaterialsRelation = "http://fretwork.dev/3mf/2026/11/materials";
inline constexpr std::string_view kPictureRelation = "http://fretwork.dev/3mf/2026/11/picture";

inline constexpr std::string_view kContentTypesPart = "[Content_Types].xml";
inline constexpr std::string_view kRootRelationsPart = "_rels/.rels";
inline constexpr std::string_view kModelPart = "3D/3dmodel.model";
inline constexpr std::string_view kModelRelationsPart = "3D/_rels/3dmodel.model.rels";

}  // namespace fretwork::threemf
