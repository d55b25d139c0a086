#include "formats/xml_spans.h"

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <utility>

namespace fretwork {
namespace {

constexpr std::string_view kBlanks = " \t\r\n";

bool is_blank(char c) {
    return kBlanks.find(c) != kBlanks.npos;
}

void append_utf8(std::string& out, std::uint32_t code) {
    const auto byte = [&](std::uint32_t value) { out += static_cast<char>(value); };
    if (code < 0x80) {
        byte(code);
    } else if (code < 0x800) {
        byte(0xC0 | code >> 6);
        byte(0x80 | (code & 0x3F));
    } else if (code < 0x10000) {
        byte(0xE0 | code >> 12);
        byte(0x80 | (code >> 6 & 0x3F));
        byte(0x80 | (code & 0x3F));
    } else {
        byte(0xF0 | code >> 18);
        byte(0x80 | (code >> 12 & 0x3F));
        byte(0x80 | (code >> 6 & 0x3F));
        byte(0x80 | (code & 0x3F));
    }
}

/// The character that "#65" or "#x41" or "amp" stands for; empty for what is none.
std::optional<std::uint32_t> character_of(std::string_view reference) {
    static constexpr std::pair<std::string_view, char> kNamed[] = {
        {"amp", '&'}, {"lt", '<'}, {"gt", '>'}, {"quot", '"'}, {"apos", '\''}};
    for (const auto& [name, character] : kNamed)
        if (reference == name) return static_cast<unsigned char>(character);
    if (!reference.starts_with('#')) return std::nullopt;
    reference.remove_prefix(1);
    const int base = reference.starts_with('x') ? 16 : 10;
    if (base == 16) reference.remove_prefix(1);
    std::uint32_t code = 0;
    const char* end = reference.data() + reference.size();
    const auto [last, error] = std::from_chars(reference.data(), end, code, base);
    if (error != std::errc{} || last != end || code > 0x10FFFF) return std::nullopt;
    return code;
}

/// The declaration at the front names another encoding than the text now has.
std::string without_encoding(std::string text) {
    if (!text.starts_with("<?xml")) return text;
    const std::size_t end = text.find("?>");
    const std::size_t at = text.find("encoding");
    if (end == text.npos || at >= end) return text;
    const std::size_t open = text.find_first_of("\"'", at);
    const std::size_t close = open < end ? text.find(text[open], open + 1) : text.npos;
    if (close < end) text.replace(open + 1, close - open - 1, "UTF-8");
    return text;
}

}  // namespace

std::string_view XmlTag::prefix() const {
    const std::size_t colon = name.find(':');
    return colon == name.npos ? std::string_view{} : name.substr(0, colon + 1);
}

std::string_view XmlTag::local_name() const {
    return name.substr(prefix().size());
}

bool XmlTagScanner::skip_past(std::string_view mark) {
    const std::size_t found = text_.find(mark, at_);
    at_ = found == text_.npos ? text_.size() : found + mark.size();
    return found != text_.npos;
}

std::optional<XmlTag> XmlTagScanner::next() {
    while (true) {
        at_ = std::min(text_.find('<', at_), text_.size());
        const std::string_view rest = text_.substr(at_);
        if (rest.size() < 3) return std::nullopt;
        if (rest.starts_with("<!--")) {
            at_ += 4;
            skip_past("-->");
        } else if (rest.starts_with("<![CDATA[")) {
            skip_past("]]>");
        } else if (rest.starts_with("<?")) {
            skip_past("?>");
        } else {
            break;
        }
    }
    XmlTag tag;
    tag.span.begin = at_;
    const bool ending = text_[at_ + 1] == '/';
    const std::size_t name = at_ + (ending ? 2 : 1);
    tag.name = text_.substr(name, text_.find_first_of(" \t\r\n/>", name) - name);
    // A > within quotes ends no tag.
    at_ = name;
    while (true) {
        at_ = text_.find_first_of("\"'>", at_);
        if (at_ == text_.npos) return std::nullopt;
        if (text_[at_] == '>') break;
        at_ = text_.find(text_[at_], at_ + 1);
        if (at_ == text_.npos) return std::nullopt;
        ++at_;
    }
    tag.span.end = ++at_;
    const bool empty = text_[tag.span.end - 2] == '/';
    tag.kind = ending ? XmlTag::Kind::kEnd : empty ? XmlTag::Kind::kEmpty : XmlTag::Kind::kStart;
    return tag;
}

std::size_t end_of_attributes(std::string_view text, const XmlTag& tag) {
    std::size_t end = tag.span.end - (tag.kind == XmlTag::Kind::kEmpty ? 2 : 1);
    while (is_blank(text[end - 1])) --end;
    return end;
}

std::vector<XmlAttributeSpan> attribute_spans(std::string_view text, const XmlTag& tag) {
    std::vector<XmlAttributeSpan> attributes;
    const std::size_t end = end_of_attributes(text, tag);
    std::size_t at = tag.span.begin + 1 + tag.name.size();
    while (at < end) {
        XmlAttributeSpan attribute;
        attribute.span.begin = at;
        const std::size_t name = text.find_first_not_of(kBlanks, at);
        const std::size_t open = text.find_first_of("\"'", name);
        if (open >= end) break;
        const std::size_t close = text.find(text[open], open + 1);
        if (close >= end) break;
        attribute.name = text.substr(name, text.find_first_of(" \t\r\n=", name) - name);
        attribute.raw = text.substr(open + 1, close - open - 1);
        attribute.span.end = at = close + 1;
        attributes.push_back(attribute);
    }
    return attributes;
}

std::string xml_unescaped(std::string_view raw) {
    std::string out;
    while (!raw.empty()) {
        const std::size_t semicolon = raw.front() == '&' ? raw.find(';') : raw.npos;
        const auto code = semicolon == raw.npos ? std::nullopt : character_of(raw.substr(1, semicolon - 1));
        if (code)
            append_utf8(out, *code);
        else
            out += raw.front();
        raw.remove_prefix(code ? semicolon + 1 : 1);
    }
    return out;
}

std::string xml_as_utf8(std::string text) {
    const bool little = text.starts_with("\xFF\xFE"), big = text.starts_with("\xFE\xFF");
    if (!little && !big) return text;
    const auto unit = [&](std::size_t i) {
        const auto first = static_cast<unsigned char>(text[i]), second = static_cast<unsigned char>(text[i + 1]);
        return static_cast<std::uint32_t>(little ? second << 8 | first : first << 8 | second);
    };
    std::string out;
    out.reserve(text.size() / 2);
    for (std::size_t i = 2; i + 1 < text.size(); i += 2) {
        std::uint32_t code = unit(i);
        if (code >= 0xD800 && code < 0xDC00 && i + 3 < text.size()) {
            code = 0x10000 + ((code - 0xD800) << 10) + (unit(i + 2) - 0xDC00);
            i += 2;
        }
        append_utf8(out, code);
    }
    return without_encoding(std::move(out));
}

std::string edited(std::string_view text, std::vector<TextEdit> edits) {
    std::ranges::stable_sort(edits, {}, [](const TextEdit& e) { return std::pair(e.span.begin, e.span.end); });
    std::string out;
    std::size_t done = 0;
    for (const TextEdit& edit : edits) {
        out.append(text.substr(done, edit.span.begin - done)).append(edit.text);
        done = edit.span.end;
    }
    return out.append(text.substr(done));
}

}  // namespace fretwork
