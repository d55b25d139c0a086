// What the object is printed from.
#pragma once

#include <span>
#include <string_view>

namespace fretwork {

/// Isotropic linear elasticity; strength across layers is the lower one and the one designs use.
struct Material {
    std::string_view name;
    double youngs_modulus_mpa = 0.0;
    double poissons_ratio = 0.0;
    double density_kg_m3 = 0.0;
    double strength_xy_mpa = 0.0;
    double strength_z_mpa = 0.0;
};

/// PLA, PETG, ABS, PA12, resin. Sources in docs/materials.md.
std::span<const Material> known_materials();

/// Case does not matter. \throws InvalidSetting  naming the known ones.
Material material_by_name(std::string_view name);

}  // namespace fretwork
