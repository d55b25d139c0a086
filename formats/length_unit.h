// Units of length that mesh files name.
#pragma once

#include <optional>
#include <string_view>

namespace fretwork {

enum class LengthUnit { kMicron, kMillimeter, kCentimeter, kMeter, kInch, kFoot };

/// Millimetres in one unit; exact.
[[nodiscard]] double millimeters_per(LengthUnit unit);

/// The words of 3MF: micron, millimeter, centimeter, meter, inch, foot. Empty for any other word.
[[nodiscard]] std::optional<LengthUnit> length_unit_from_name(std::string_view name);

[[nodiscard]] std::string_view length_unit_name(LengthUnit unit);

}  // namespace fretwork
