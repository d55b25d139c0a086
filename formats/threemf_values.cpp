#include "formats/threemf_values.h"

#include <cmath>
#include <string>

#include "formats/mesh_data.h"
#include "formats/parse_error.h"
#include "formats/text_scanner.h"

namespace fretwork::threemf {
namespace {

/// 16 for anything that is no hexadecimal digit.
unsigned hex_digit(char c) {
    if (c >= '0' && c <= '9') return static_cast<unsigned>(c - '0');
    if (c >= 'a' && c <= 'f') return static_cast<unsigned>(c - 'a') + 10;
    if (c >= 'A' && c <= 'F') return static_cast<unsigned>(c - 'A') + 10;
    return 16;
}

}  // namespace

std::string_view ThreemfValues::need(const XmlElement& element, std::string_view attribute) const {
    const auto value = element.find(attribute);
    if (!value)
        xml_.fail("element " + in_quotes(element.name) + " without " + std::string(attribute), "that attribute");
    return *value;
}

std::int64_t ThreemfValues::whole(std::string_view text, std::string_view what, std::int64_t least,
                                  std::int64_t most) const {
    std::int64_t value = 0;
    if (!parse_integer(text, value) || value < least || value > most)
        xml_.fail(std::string(what) + " " + in_quotes(text),
                  "an integer from " + std::to_string(least) + " to " + std::to_string(most));
    return value;
}

double ThreemfValues::number(std::string_view text, std::string_view what) const {
    double value = 0.0;
    if (!parse_number(text, value) || std::abs(value) > kMaxCoordinate)
        xml_.fail(std::string(what) + " " + in_quotes(text), "a finite number of at most 1e9 in size");
    return value;
}

ResourceId ThreemfValues::id(const XmlElement& element, std::string_view attribute) const {
    return static_cast<ResourceId>(whole(need(element, attribute), attribute, 1, kMaxId));
}

Rgba8 ThreemfValues::color(std::string_view text) const {
    bool sound = (text.size() == 7 || text.size() == 9) && text.front() == '#';
    for (std::size_t i = 1; sound && i < text.size(); ++i) sound = hex_digit(text[i]) < 16;
    if (!sound) xml_.fail("colour " + in_quotes(text), "#RRGGBB or #RRGGBBAA");
    Rgba8 color = {0, 0, 0, 255};
    for (std::size_t k = 0; 2 * k + 2 < text.size(); ++k)
        color[k] = static_cast<std::uint8_t>(16 * hex_digit(text[1 + 2 * k]) + hex_digit(text[2 + 2 * k]));
    return color;
}

Eigen::Affine3d ThreemfValues::transform(std::string_view text) const {
    // Row vectors times matrix: the transpose of what Eigen stores.
    Eigen::Affine3d transform = Eigen::Affine3d::Identity();
    TextScanner words(text, "", {.comment = 0});
    for (int row = 0; row < 4; ++row)
        for (int column = 0; column < 3; ++column) {
            const std::string_view word = words.word();
            if (word.empty()) xml_.fail("transform " + in_quotes(text), "twelve numbers");
            transform.matrix()(column, row) = number(word, "transform");
        }
    if (!words.word().empty()) xml_.fail("transform " + in_quotes(text), "twelve numbers");
    const double size = transform.linear().norm();
    if (!(std::abs(transform.linear().determinant()) > 1e-12 * size * size * size))
        xml_.fail("the singular transform " + in_quotes(text), "one that keeps three dimensions");
    return transform;
}

TileStyle ThreemfValues::tile_style(const XmlElement& element, std::string_view attribute) const {
    const std::string_view text = element.find(attribute).value_or("wrap");
    if (text == "wrap") return TileStyle::kWrap;
    if (text == "mirror") return TileStyle::kMirror;
    if (text != "clamp") xml_.fail("tile style " + in_quotes(text), "wrap, mirror or clamp");
    return TileStyle::kClamp;
}

}  // namespace fretwork::threemf
