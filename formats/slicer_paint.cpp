#include "formats/slicer_paint.h"

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

int extruder_of(std::string_view state_text) {
    if (state_text == "4") return 1;
    if (state_text == "8") return 2;
    if (state_text.size() != 2 || state_text[1] != 'C') return 0;
    const std::size_t digit = std::string_view("0123456789ABCD").find(state_text[0]);
    return digit == std::string_view::npos ? 0 : static_cast<int>(digit) + 3;
}

}  // namespace fretwork
