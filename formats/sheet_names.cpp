#include "formats/sheet_names.h"

#include <algorithm>

#include "formats/lower_case.h"

namespace fretwork {
namespace {

constexpr std::string_view kFolder = "/3D/volumetric/";

}  // namespace

std::string sheet_path(std::string_view stack, std::size_t sheet) {
    std::string number = std::to_string(sheet);
    number.insert(0, 4 - std::min<std::size_t>(4, number.size()), '0');
    return std::string(kFolder).append(stack) + "/sheet" + number + ".png";
}

std::optional<std::string> stack_suffix_of(std::string_view path) {
    const std::string lower = lower_case(path);
    for (const std::string_view stack : kStacks) {
        const std::string begin = lower_case(kFolder).append(stack);
        if (!lower.starts_with(begin)) continue;
        const std::size_t slash = lower.find('/', begin.size());
        if (slash == lower.npos || lower.find('/', slash + 1) != lower.npos) continue;
        const std::string suffix = lower.substr(begin.size(), slash - begin.size());
        if (suffix.find_first_not_of("0123456789") == suffix.npos) return suffix;
    }
    return std::nullopt;
}

}  // namespace fretwork
