#include "markdown.h"

#include <cstdio>
#include <exception>

#include "core/base/error.h"
#include "formats/atomic_write.h"
#include "formats/read_file.h"

namespace fretwork::bench {

MarkdownTable::MarkdownTable(const std::vector<std::string>& heads) {
    add(heads);
    for (std::size_t i = 0; i < heads.size(); ++i) text_ += "|---";
    text_ += "|\n";
}

void MarkdownTable::add(const std::vector<std::string>& cells) {
    text_ += "|";
    for (const std::string& cell : cells) text_ += " " + cell + " |";
    text_ += "\n";
}

std::string with_section(std::string_view document, std::string_view name, std::string_view text) {
    const std::string begin = "<!-- " + std::string(name) + ": begin -->\n";
    const std::string end = "<!-- " + std::string(name) + ": end -->";
    const std::size_t from = document.find(begin);
    const std::size_t to = from == std::string_view::npos ? from : document.find(end, from);
    if (to == std::string_view::npos)
        throw InvalidInput("the document has no section between the lines '<!-- " + std::string(name) +
                           ": begin -->' and '" + end + "'");
    return std::string(document.substr(0, from + begin.size())) + std::string(text) + std::string(document.substr(to));
}

void write_section(const std::filesystem::path& document, std::string_view name, std::string_view text) {
    atomic_write(document, with_section(read_file(document), name, text));
}

int publish(const char* program, const std::string& document, std::string_view section,
            const std::function<std::string()>& measure) {
    try {
        const std::string text = measure();
        if (document.empty())
            std::fwrite(text.data(), 1, text.size(), stdout);
        else
            write_section(document, section, text);
    } catch (const std::exception& error) {
        std::fprintf(stderr, "%s: %s\n", program, error.what());
        return 1;
    }
    return 0;
}

}  // namespace fretwork::bench
