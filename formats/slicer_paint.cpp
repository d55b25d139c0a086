#include "formats/slicer_paint.h"

#include <string_view>

#include "core/base/error.h"

namespace fretwork {

std::string paint_state_text(int extruder) {
    constexpr std::string_view kDigits = "0123456789ABCDEF";
    if (extruder < 1 || extruder > 16)
        throw InvalidInput("paint: found extruder " + std::to_string(extruder) + ", expected 1 to 16");
    const auto number = static_cast<std::size_t>(extruder);
    if (number < 3) return {kDigits[4 * number]};
    return {kDigits[number - 3], 'C'};
}

}  // namespace fretwork
