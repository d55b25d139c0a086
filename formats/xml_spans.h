// A well-formed XML text -> where its tags and attributes stand, so that some can be replaced and all else stays.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace fretwork {

/// A stretch of the text.
struct TextSpan {
    std::size_t begin = 0;
    std::size_t end = 0;
};

struct XmlTag {
    enum class Kind { kStart, kEnd, kEmpty };
    Kind kind = Kind::kStart;
    TextSpan span;          ///< from < to >
    std::string_view name;  ///< as written, with its prefix

    /// "m:" of "m:color"; empty without one.
    [[nodiscard]] std::string_view prefix() const;
    [[nodiscard]] std::string_view local_name() const;
};

struct XmlAttributeSpan {
    TextSpan span;          ///< from the blank before the name to the closing quote
    std::string_view name;  ///< as written, with its prefix
    std::string_view raw;   ///< the value as written
};

/// Walks the tags of a text in UTF-8 (or another superset of ASCII) in order; comments, instructions, character
/// data and CDATA are stepped over. The text must be well-formed and without document type: read it with XmlReader
/// first. On any other text the walk ends early and never leaves the text.
class XmlTagScanner {
  public:
    explicit XmlTagScanner(std::string_view text) : text_(text) {}

    /// Empty at the end of the text.
    std::optional<XmlTag> next();

  private:
    bool skip_past(std::string_view mark);

    std::string_view text_;
    std::size_t at_ = 0;
};

/// Attributes in the order of the text.
std::vector<XmlAttributeSpan> attribute_spans(std::string_view text, const XmlTag& tag);

/// Just before the > or /> of a start tag: where another attribute can be written.
std::size_t end_of_attributes(std::string_view text, const XmlTag& tag);

/// An attribute value with the predefined entities and character references replaced.
std::string xml_unescaped(std::string_view raw);

/// The text in UTF-8: UTF-16 with a byte order mark is turned to it, anything else is returned as it is.
std::string xml_as_utf8(std::string text);

/// One replacement within a text.
struct TextEdit {
    TextSpan span;  ///< empty: an insertion
    std::string text;
};

/// The text with all edits done. They must not overlap; insertions at one place keep their order.
std::string edited(std::string_view text, std::vector<TextEdit> edits);

}  // namespace fretwork
