// PrusaSlicer's notes on the objects of a package, kept true for meshes that were carved.
#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "formats/threemf_model.h"

namespace fretwork {

inline constexpr std::string_view kPrusaConfigPart = "Metadata/Slic3r_PE_model.config";

/// The configuration names the triangles of each volume of an object as a run, "firstid" to "lastid". Of carved
/// objects the first volume gets all triangles and further ones go, as their triangles did; all else stays.
/// \param triangles  of each carved object
std::string with_carved_volumes(std::string_view config, const std::map<threemf::ResourceId, std::size_t>& triangles);

/// Of each object, the type of every volume: "ModelPart", "ParameterModifier" ... \param config  the text of the part
std::map<threemf::ResourceId, std::vector<std::string>> volume_types(std::string_view config);

}  // namespace fretwork
