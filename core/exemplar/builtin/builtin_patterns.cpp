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
    Entry{{"hexagons", "Honeycomb with rounded openings", true, false, true, 55, 5.0}, drawing::draw_hexagons},
    Entry{{"bubbles", "Round openings of many sizes", true, false, true, 48, 5.0}, drawing::draw_bubbles},
    Entry{{"bricks", "Joints of a brick wall around open bricks", true, true, true, 48, 5.0}, drawing::draw_bricks},
    Entry{{"branches", "Boughs and twigs between open fields", true, true, true, 48, 6.0}, drawing::draw_branches},
    Entry{{"leafveins", "Midribs, side veins and fine veins", true, true, true, 48, 5.0}, drawing::draw_leafveins},
    Entry{{"lace", "Flowers in rings of petals", true, false, true, 32, 4.5}, drawing::draw_lace},
    Entry{{"celtic", "Plaited strands that turn back", true, true, true, 48, 6.0}, drawing::draw_celtic},
    Entry{{"girih", "Strapwork of eight-pointed stars and crosses", true, true, true, 60, 4.0}, drawing::draw_girih},
    Entry{{"animalskin", "Coat with the rosettes of a leopard cut out", true, false, true, 48, 6.0},
          drawing::draw_animalskin},
    Entry{{"coral", "Winding ridges of a brain coral", true, false, false, 48, 5.5}, drawing::draw_coral},
    Entry{{"scales", "Overlapping fans with golden arches", true, true, true, 48, 4.8}, drawing::draw_scales},
    Entry{{"spirals", "Running double spirals", true, true, false, 48, 4.7}, drawing::draw_spirals},
    Entry{{"hooks", "Wrought-iron canes in columns", true, true, false, 54, 5.0}, drawing::draw_hooks},
    Entry{{"waves", "Flowing ribbons that swell and narrow", true, true, false, 48, 6.5}, drawing::draw_waves},
    Entry{{"zebra", "Forking stripes", true, true, false, 48, 6.5}, drawing::draw_zebra},
    Entry{{"keyboard", "Separate rounded keys", true, true, false, 50, 10.0}, drawing::draw_keyboard},
    Entry{{"dots", "Separate discs of several sizes and colours", true, false, false, 48, 6.0}, drawing::draw_dots},
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
