#include "formats/plain_elements.h"

#include <charconv>
#include <cmath>
#include <cstring>

#include "formats/mesh_data.h"
#include "formats/threemf_values.h"

namespace fretwork::threemf {

/// A place further on, which becomes the scanner's own once the element is whole.
struct PlainElements::Cursor {
    const char* at;
    const char* end;
    std::size_t lines = 0;

    bool skip_blanks() {
        const char* const begin = at;
        for (; at != end && (*at == ' ' || *at == '\n' || *at == '\t' || *at == '\r'); ++at)
            lines += *at == '\n' ? 1 : 0;
        return at != begin;
    }

    bool skip(std::string_view text) {
        if (static_cast<std::size_t>(end - at) < text.size() || std::memcmp(at, text.data(), text.size()) != 0)
            return false;
        at += text.size();
        return true;
    }

    /// Blanks, then `name="number"`, with either kind of quotes.
    template <class Number>
    bool attribute(std::string_view name, Number& value) {
        if (!skip_blanks() || !skip(name) || !skip("=") || at == end) return false;
        const char quote = *at;
        if (quote != '"' && quote != '\'') return false;
        const auto [stop, error] = std::from_chars(at + 1, end, value);
        if (error != std::errc() || stop == end || *stop != quote) return false;
        at = stop + 1;
        return true;
    }

    /// The same where the attribute may be missing: nothing is taken then.
    template <class Number>
    bool maybe_attribute(std::string_view name, Number& value) {
        const Cursor before = *this;
        if (attribute(name, value)) return true;
        *this = before;
        return false;
    }

    bool end_of_element() {
        skip_blanks();
        return skip("/>");
    }
};

std::optional<Vec3> PlainElements::vertex() {
    Cursor cursor{at_, end_};
    cursor.skip_blanks();
    Vec3 p;
    if (!cursor.skip("<vertex") || !cursor.attribute("x", p[0]) || !cursor.attribute("y", p[1]) ||
        !cursor.attribute("z", p[2]) || !cursor.end_of_element())
        return std::nullopt;
    for (int k = 0; k < 3; ++k)
        if (!(std::abs(p[k]) <= kMaxCoordinate)) return std::nullopt;
    at_ = cursor.at;
    lines_ += cursor.lines;
    return p;
}

std::optional<TriangleElement> PlainElements::triangle() {
    Cursor cursor{at_, end_};
    cursor.skip_blanks();
    TriangleElement triangle;
    if (!cursor.skip("<triangle") || !cursor.attribute("v1", triangle.corners[0]) ||
        !cursor.attribute("v2", triangle.corners[1]) || !cursor.attribute("v3", triangle.corners[2]))
        return std::nullopt;
    for (const std::uint32_t corner : triangle.corners)
        if (corner > kMaxVertexIndex) return std::nullopt;
    if (cursor.maybe_attribute("pid", triangle.group) && (triangle.group < 1 || triangle.group > kMaxId))
        return std::nullopt;
    static constexpr std::array<std::string_view, 3> kNames = {"p1", "p2", "p3"};
    while (triangle.properties < 3) {
        std::int64_t& property = triangle.property[triangle.properties];
        if (!cursor.maybe_attribute(kNames[triangle.properties], property)) break;
        if (property < 0 || property > kMaxId) return std::nullopt;
        ++triangle.properties;
    }
    if (!cursor.end_of_element()) return std::nullopt;
    at_ = cursor.at;
    lines_ += cursor.lines;
    return triangle;
}

}  // namespace fretwork::threemf
