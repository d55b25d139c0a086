#include "formats/xml_reader.h"

#include <libxml/parser.h>

#include <exception>
#include <mutex>
#include <new>
#include <vector>

#include "formats/parse_error.h"

namespace fretwork {
namespace {

constexpr int kMaxDepth = 64;
constexpr int kMaxAttributes = 64;
constexpr std::size_t kMaxNameBytes = 256;
constexpr std::size_t kMaxValueBytes = 1 << 16;

std::string_view view(const xmlChar* text) {
    return text == nullptr ? std::string_view{} : std::string_view(reinterpret_cast<const char*>(text));
}

struct FreeParser {
    void operator()(xmlParserCtxt* parser) const { xmlFreeParserCtxt(parser); }
};

}  // namespace

struct XmlReader::Impl {
    XmlHandler& handler;
    std::string source;
    std::unique_ptr<xmlParserCtxt, FreeParser> parser;
    std::exception_ptr failure;  ///< from a callback; libxml2 is C and must not be left by throwing
    std::vector<XmlAttribute> attributes;
    int depth = 0;
    // Namespaces declared on the element being handed out, as libxml2 lists them: prefix, URI, ...
    const xmlChar** declared = nullptr;
    int declared_count = 0;

    Impl(XmlHandler& to, std::string_view from) : handler(to), source(from) {}

    [[noreturn]] void fail(std::string_view found, std::string_view expected) const {
        const auto line = parser && parser->input != nullptr ? static_cast<std::size_t>(parser->input->line) : 0;
        fail_parse(source, place_of_line(line), found, expected);
    }

    /// Runs `action` unless one has failed before; keeps what it throws and stops the parser.
    template <class Action>
    void guarded(const Action& action) {
        if (failure) return;
        try {
            action();
        } catch (...) {
            failure = std::current_exception();
            xmlStopParser(parser.get());
        }
    }

    void start(const XmlElement& plain, int count, const xmlChar** values) {
        if (++depth > kMaxDepth) fail("elements nested over 64 deep", "fewer");
        if (count > kMaxAttributes) fail("an element with over 64 attributes", "fewer");
        if (plain.name.size() > kMaxNameBytes) fail("an element name over 256 bytes", "a shorter one");
        attributes.clear();
        for (int i = 0; i < count; ++i) {
            const xmlChar** entry = values + 5 * i;  // Name, prefix, namespace, begin and end of the value.
            const auto size = static_cast<std::size_t>(entry[4] - entry[3]);
            if (size > kMaxValueBytes) fail("an attribute value over 64 KiB", "a shorter one");
            attributes.push_back({view(entry[2]), view(entry[0]), {reinterpret_cast<const char*>(entry[3]), size}});
        }
        handler.start({plain.space, plain.name, plain.prefix, attributes});
    }

    static Impl& self(void* user) { return *static_cast<Impl*>(user); }

    static void on_start(void* user, const xmlChar* name, const xmlChar* prefix, const xmlChar* space,
                         int declared_count, const xmlChar** declared, int count, int, const xmlChar** values) {
        Impl& me = self(user);
        me.declared = declared;
        me.declared_count = declared_count;
        me.guarded([&] { me.start({view(space), view(name), view(prefix), {}}, count, values); });
        me.declared_count = 0;
    }
    static void on_end(void* user, const xmlChar*, const xmlChar*, const xmlChar*) {
        Impl& me = self(user);
        me.guarded([&] {
            --me.depth;
            me.handler.end();
        });
    }
    static void on_text(void* user, const xmlChar* text, int size) {
        Impl& me = self(user);
        me.guarded([&] { me.handler.text({reinterpret_cast<const char*>(text), static_cast<std::size_t>(size)}); });
    }
    static void on_document_type(void* user, const xmlChar*, const xmlChar*, const xmlChar*) {
        Impl& me = self(user);
        me.guarded([&] { me.fail("a document type declaration", "none"); });
    }
    static void on_error(void*, xmlErrorPtr) {}

    static xmlSAXHandler make_callbacks() {
        xmlSAXHandler sax{};
        sax.initialized = XML_SAX2_MAGIC;
        sax.startElementNs = &Impl::on_start;
        sax.endElementNs = &Impl::on_end;
        sax.characters = &Impl::on_text;
        sax.cdataBlock = &Impl::on_text;
        sax.internalSubset = &Impl::on_document_type;
        sax.serror = &Impl::on_error;
        return sax;
    }

    void parse(std::string_view block, bool last) {
        constexpr std::size_t kMostAtOnce = 1 << 20;
        do {
            const std::string_view some = block.substr(0, kMostAtOnce);
            block.remove_prefix(some.size());
            const int result =
                xmlParseChunk(parser.get(), some.data(), static_cast<int>(some.size()), last && block.empty() ? 1 : 0);
            if (failure) std::rethrow_exception(failure);
            if (result != XML_ERR_OK || parser->wellFormed == 0) fail_parser();
        } while (!block.empty());
    }

    [[noreturn]] void fail_parser() const {
        const xmlError* error = xmlCtxtGetLastError(parser.get());
        std::string_view message = error != nullptr && error->message != nullptr ? error->message : "broken XML";
        while (!message.empty() && message.back() == '\n') message.remove_suffix(1);
        fail(in_quotes(message), "well-formed XML");
    }
};

std::optional<std::string_view> XmlElement::find(std::string_view attribute, std::string_view in_space) const {
    for (const XmlAttribute& a : attributes)
        if (a.name == attribute && a.space == in_space) return a.value;
    return std::nullopt;
}

XmlReader::XmlReader(XmlHandler& handler, std::string_view source) : impl_(std::make_unique<Impl>(handler, source)) {
    static std::once_flag once;
    std::call_once(once, [] { xmlInitParser(); });
    xmlSAXHandler sax = Impl::make_callbacks();
    impl_->parser.reset(xmlCreatePushParserCtxt(&sax, impl_.get(), nullptr, 0, nullptr));
    if (!impl_->parser) throw std::bad_alloc();
    // NOENT has the predefined entities of attribute values replaced; there can be no others without
    // a document type.
    xmlCtxtUseOptions(impl_->parser.get(), XML_PARSE_NONET | XML_PARSE_NOENT | XML_PARSE_NOERROR | XML_PARSE_NOWARNING);
}
XmlReader::~XmlReader() = default;

void XmlReader::feed(std::string_view block) {
    impl_->parse(block, false);
}

void XmlReader::finish() {
    impl_->parse({}, true);
}

std::size_t XmlReader::line() const {
    return impl_->parser->input == nullptr ? 0 : static_cast<std::size_t>(impl_->parser->input->line);
}

bool XmlReader::at_content() const {
    const xmlParserInput* input = impl_->parser->input;
    return impl_->depth > 0 && input != nullptr && input->cur == input->end && input->buf != nullptr &&
           input->buf->encoder == nullptr && impl_->parser->instate == XML_PARSER_CONTENT;
}

void XmlReader::skip_lines(std::size_t count) {
    impl_->parser->input->line += static_cast<int>(count);
}

std::string XmlReader::namespace_of(std::string_view prefix) const {
    for (int i = 0; i < impl_->declared_count; ++i)
        if (view(impl_->declared[2 * i]) == prefix) return std::string(view(impl_->declared[2 * i + 1]));
    return {};
}

void XmlReader::fail(std::string_view found, std::string_view expected) const {
    impl_->fail(found, expected);
}

void read_xml(std::string_view document, std::string_view source, XmlHandler& handler) {
    XmlReader reader(handler, source);
    reader.feed(document);
    reader.finish();
}

}  // namespace fretwork
