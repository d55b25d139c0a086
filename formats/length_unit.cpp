#include "formats/length_unit.h"

#include <array>
#include <cstddef>

namespace fretwork {
namespace {

struct UnitRow {
    std::string_view name;
    double mm;
};

// In the order of the enumeration.
constexpr std::array<UnitRow, 6> kUnits = {
    {{"micron", 0.001}, {"millimeter", 1.0}, {"centimeter", 10.0}, {"meter", 1000.0}, {"inch", 25.4}, {"foot", 304.8}}};

}  // namespace

double millimeters_per(LengthUnit unit) {
    return kUnits[static_cast<std::size_t>(unit)].mm;
}

std::optional<LengthUnit> length_unit_from_name(std::string_view name) {
    for (std::size_t i = 0; i < kUnits.size(); ++i)
        if (kUnits[i].name == name) return static_cast<LengthUnit>(i);
    return std::nullopt;
}

std::string_view length_unit_name(LengthUnit unit) {
    return kUnits[static_cast<std::size_t>(unit)].name;
}

}  // namespace fretwork
