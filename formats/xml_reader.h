// XML text -> elements, one after the other, without ever holding the document.
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace fretwork {

struct XmlAttribute {
    std::string_view space;  ///< namespace; empty for attributes without a prefix
    std::string_view name;
    std::string_view value;
};

/// Valid during the call that hands it out.
struct XmlElement {
    std::string_view space;
    std::string_view name;
    std::string_view prefix;
    std::span<const XmlAttribute> attributes;

    /// Value of an attribute without a prefix (or of a namespace).
    [[nodiscard]] std::optional<std::string_view> find(std::string_view attribute,
                                                       std::string_view in_space = {}) const;
};

/// What to do with what is read. Exceptions come out of XmlReader::feed.
class XmlHandler {
  public:
    virtual ~XmlHandler() = default;
    virtual void start(const XmlElement& element) = 0;
    virtual void end() = 0;
    /// May come in several pieces.
    virtual void text(std::string_view characters) = 0;
};

/// Takes a document block by block. Allows neither a document type nor entities of its own, touches
/// neither network nor disk, and limits depth (64), attributes of an element (64), names (256 bytes)
/// and attribute values (64 KiB).
class XmlReader {
  public:
    XmlReader(XmlHandler& handler, std::string_view source);
    ~XmlReader();
    XmlReader(const XmlReader&) = delete;
    XmlReader& operator=(const XmlReader&) = delete;

    /// \throws InvalidInput  not well-formed, or beyond a limit; names the line.
    void feed(std::string_view block);

    /// \throws InvalidInput  the document is not closed.
    void finish();

    /// Line of what is being handed out.
    [[nodiscard]] std::size_t line() const;

    /// Whether all that was fed has been handed out and what comes next is content of the open element, in the bytes
    /// of UTF-8. A caller that knows what to do with elements in there may keep them from the reader.
    [[nodiscard]] bool at_content() const;

    /// Tells of lines that were kept from the reader.
    void skip_lines(std::size_t count);

    /// URI of a prefix on the element being handed out; empty if it has none there.
    [[nodiscard]] std::string namespace_of(std::string_view prefix) const;

    /// \throws InvalidInput  naming source and line.
    [[noreturn]] void fail(std::string_view found, std::string_view expected) const;

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

/// A whole document in memory.
void read_xml(std::string_view document, std::string_view source, XmlHandler& handler);

}  // namespace fretwork
