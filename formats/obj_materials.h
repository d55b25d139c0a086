// Material libraries of OBJ files (MTL): the colours of their triangles.
#pragma once

#include <map>
#include <span>
#include <string>
#include <string_view>

#include "core/exemplar/image.h"

namespace fretwork {

/// Name of the material that stands for a colour: "c" and six hexadecimal digits.
[[nodiscard]] std::string obj_material_name(const Rgb8& color);

/// A library with one material for each colour that occurs, in order of first use.
[[nodiscard]] std::string write_obj_materials(std::span<const Rgb8> triangle_colors);

/// Diffuse colours (`Kd`) of the materials, taken as sRGB as most programs write them. Materials with a texture have
/// the colour that stands beside it, all else is skipped.
/// \throws InvalidInput  with line, found and expected.
[[nodiscard]] std::map<std::string, Rgb8, std::less<>> read_obj_materials(std::string_view bytes,
                                                                          std::string_view source);

}  // namespace fretwork
