#include "core/exemplar/builtin/builtin_patterns.h"

#include <algorithm>
#include <array>
#include <string>

#include "core/base/error.h"
#include "core/exemplar/builtin/families.h"

namespace fretwork {
namespace {

struct Entry {
    BuiltinPattern pattern;
    PatternPictures (*draw)();
};

// tileable, anisotropic, connected; width in mm; stroke radius in px.
constexpr std::array kEntries = {
    Entry{{"cells", "Rounded cells between even walls", true, false, true, 48, 5.0}, drawing::draw_cells},
    Entry{{"waves", "Flowing ribbons that swell and narrow", true, true, false, 48, 6.5}, drawing::draw_waves},
    Entry{{"hooks", "Wrought-iron canes in columns", true, true, false, 48, 5.0}, drawing::draw_hooks},
    Entry{{"zebra", "Forking stripes", true, true, false, 48, 6.5}, drawing::draw_zebra},
    Entry{{"hexagons", "Honeycomb with rounded openings", true, false, true, 55, 5.0}, drawing::draw_hexagons},
    Entry{{"dots", "Separate discs of several sizes; everything must be joined", true, false, false, 48, 6.0},
          drawing::draw_dots},
};

constexpr auto kPatterns = [] {
    std::array<BuiltinPattern, kEntries.size()> patterns{};
    for (std::size_t i = 0; i < patterns.size(); ++i) patterns[i] = kEntries[i].pattern;
    return patterns;
}();

const Entry& find_entry(std::string_view name) {
    const auto entry = std::ranges::find(kEntries, name, [](const Entry& e) { return e.pattern.name; });
    if (entry != kEntries.end()) return *entry;
    std::string known;
    for (const BuiltinPattern& p : kPatterns) known += (known.empty() ? "" : ", ") + std::string(p.name);
    throw InvalidSetting("there is no built-in pattern \"" + std::string(name) + "\"; known are " + known);
}

}  // namespace

std::span<const BuiltinPattern> builtin_patterns() {
    return kPatterns;
}

const BuiltinPattern& find_builtin(std::string_view name) {
    return find_entry(name).pattern;
}

PatternPictures draw_builtin(std::string_view name) {
    return find_entry(name).draw();
}

Exemplar make_builtin(std::string_view name) {
    const Entry& entry = find_entry(name);
    const PatternPictures pictures = entry.draw();
    return make_exemplar(pictures.color, &pictures.mask,
                         {.mask = MaskSource::kImage, .tileable = entry.pattern.tileable});
}

}  // namespace fretwork
