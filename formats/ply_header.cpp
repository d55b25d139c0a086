#include "formats/ply_header.h"

#include <array>
#include <utility>

#include "formats/parse_error.h"
#include "formats/text_scanner.h"

namespace fretwork {
namespace {

constexpr std::array<std::pair<std::string_view, PlyType>, 16> kTypeNames = {{
    {"char", PlyType::kInt8},
    {"int8", PlyType::kInt8},
    {"uchar", PlyType::kUint8},
    {"uint8", PlyType::kUint8},
    {"short", PlyType::kInt16},
    {"int16", PlyType::kInt16},
    {"ushort", PlyType::kUint16},
    {"uint16", PlyType::kUint16},
    {"int", PlyType::kInt32},
    {"int32", PlyType::kInt32},
    {"uint", PlyType::kUint32},
    {"uint32", PlyType::kUint32},
    {"float", PlyType::kFloat32},
    {"float32", PlyType::kFloat32},
    {"double", PlyType::kFloat64},
    {"float64", PlyType::kFloat64},
}};

class HeaderReader {
  public:
    HeaderReader(std::string_view bytes, std::string_view source)
        : bytes_(bytes), source_(source), scanner_(bytes, source, {.comment = 0}) {}

    PlyHeader read() {
        if (const auto word = scanner_.word_in_line(); word != "ply") scanner_.fail(word, "\"ply\"");
        scanner_.next_line();
        for (bool open = true; open;) {
            const std::string_view keyword = scanner_.word_in_line();
            if (keyword == "format") {
                read_format();
            } else if (keyword == "element") {
                read_element();
            } else if (keyword == "property") {
                read_property();
            } else if (keyword == "end_header") {
                open = false;
            } else if (keyword != "comment" && keyword != "obj_info") {
                scanner_.fail(keyword, "format, element, property, comment or end_header");
            }
            scanner_.next_line();
        }
        if (!format_seen_) fail_parse(source_, place_of_line(scanner_.line()), "no format", "a format line");
        header_.data_offset = bytes_.size() - scanner_.bytes_left();
        header_.data_line = scanner_.line();
        check_counts();
        return std::move(header_);
    }

  private:
    void read_format() {
        const std::string_view word = scanner_.word_in_line();
        if (word == "binary_little_endian") {
            header_.ascii = false;
        } else if (word == "binary_big_endian") {
            header_.ascii = false;
            header_.order = std::endian::big;
        } else if (word != "ascii") {
            scanner_.fail(word, "ascii, binary_little_endian or binary_big_endian");
        }
        format_seen_ = true;
    }

    void read_element() {
        PlyElement element;
        element.name = scanner_.word_in_line();
        const std::string_view word = scanner_.word_in_line();
        const std::int64_t count = scanner_.to_integer(word, "a number of elements");
        if (count < 0 || count > 0xFFFFFFFFLL) scanner_.fail(word, "a number of elements below 2^32");
        element.count = static_cast<std::size_t>(count);
        header_.elements.push_back(std::move(element));
        if (header_.elements.size() > 64) scanner_.fail("element", "at most 64 elements");
    }

    PlyType read_type() {
        const std::string_view word = scanner_.word_in_line();
        for (const auto& [name, type] : kTypeNames)
            if (name == word) return type;
        scanner_.fail(word, "a PLY type such as uchar, int or float");
    }

    void read_property() {
        if (header_.elements.empty()) scanner_.fail("property", "an element line before it");
        PlyProperty property;
        std::string_view ahead = peek_word();
        if (ahead == "list") {
            scanner_.word_in_line();
            property.is_list = true;
            property.count_type = read_type();
            if (property.count_type == PlyType::kFloat32 || property.count_type == PlyType::kFloat64)
                scanner_.fail("float", "an integer type for the length of a list");
        }
        property.type = read_type();
        property.name = scanner_.word_in_line();
        if (property.name.empty()) scanner_.fail({}, "a name of the property");
        header_.elements.back().properties.push_back(std::move(property));
        if (header_.elements.back().properties.size() > 256) scanner_.fail("property", "at most 256 properties");
    }

    std::string_view peek_word() const {
        TextScanner ahead = scanner_;
        return ahead.word_in_line();
    }

    void check_counts() const {
        const std::size_t left = bytes_.size() - header_.data_offset;
        std::size_t needed = 0;
        for (const PlyElement& element : header_.elements) {
            std::size_t row = 0;  // Least bytes of one row: a digit and a blank per number in ASCII.
            for (const PlyProperty& p : element.properties)
                row += header_.ascii ? 2 : size_of(p.is_list ? p.count_type : p.type);
            needed += element.count * row;
            if (needed > left + 1)
                fail_parse(source_, place_of_byte(bytes_.size()), "the end of the file",
                           "at least " + std::to_string(needed) + " bytes for " + std::to_string(element.count) +
                               " rows of element " + in_quotes(element.name));
        }
    }

    std::string_view bytes_;
    std::string_view source_;
    TextScanner scanner_;
    PlyHeader header_;
    bool format_seen_ = false;
};

}  // namespace

std::size_t size_of(PlyType type) {
    switch (type) {
        case PlyType::kInt8:
        case PlyType::kUint8:
            return 1;
        case PlyType::kInt16:
        case PlyType::kUint16:
            return 2;
        case PlyType::kInt32:
        case PlyType::kUint32:
        case PlyType::kFloat32:
            return 4;
        case PlyType::kFloat64:
            break;
    }
    return 8;
}

std::size_t PlyElement::find(std::string_view property) const {
    std::size_t i = 0;
    while (i < properties.size() && properties[i].name != property) ++i;
    return i;
}

PlyHeader read_ply_header(std::string_view bytes, std::string_view source) {
    return HeaderReader(bytes, source).read();
}

}  // namespace fretwork
