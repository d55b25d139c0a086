#include "core/fem/material.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <string>

#include "core/base/error.h"

namespace fretwork {
namespace {

// Name, E (MPa), nu, density (kg/m^3), strength in the layer and across layers (MPa). See docs/materials.md.
constexpr std::array<Material, 5> kMaterials{{
    {"PLA", 3300.0, 0.36, 1240.0, 55.0, 40.0},
    {"PETG", 2100.0, 0.38, 1270.0, 48.0, 30.0},
    {"ABS", 2000.0, 0.35, 1040.0, 34.0, 20.0},
    {"PA12", 1400.0, 0.40, 1010.0, 43.0, 40.0},
    {"resin", 2500.0, 0.40, 1150.0, 50.0, 50.0},
}};

bool same_name(std::string_view a, std::string_view b) {
    return std::ranges::equal(a, b,
                              [](unsigned char x, unsigned char y) { return std::tolower(x) == std::tolower(y); });
}

}  // namespace

std::span<const Material> known_materials() {
    return kMaterials;
}

Material material_by_name(std::string_view name) {
    std::string names;
    for (const Material& material : kMaterials) {
        if (same_name(material.name, name)) return material;
        names += (names.empty() ? "" : ", ") + std::string(material.name);
    }
    throw InvalidSetting("material: found \"" + std::string(name) + "\", expected one of " + names);
}

}  // namespace fretwork
