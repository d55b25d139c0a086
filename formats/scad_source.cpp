#include "formats/scad_source.h"

#include <algorithm>
#include <cctype>
#include <regex>

#include "formats/parse_error.h"

namespace fretwork {
namespace {

bool is_word(char c) {
    return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_' || c == '$';
}

/// Walks over the file and knows code from comments and strings.
class ScadScanner {
  public:
    explicit ScadScanner(std::string_view text) : text_(text) {}

    /// Calls `comment(begin, end)` for the inside of block comments and `code(position)` for everything else that is
    /// not a comment or a string. `end` is npos where a comment does not end.
    template <class Comment, class Code>
    void walk(const Comment& comment, const Code& code) const {
        for (std::size_t at = 0; at < text_.size();) {
            if (text_.compare(at, 2, "//") == 0) {
                at = std::min(text_.find('\n', at), text_.size());
            } else if (text_.compare(at, 2, "/*") == 0) {
                const std::size_t end = text_.find("*/", at + 2);
                comment(at + 2, end);
                at = end == text_.npos ? text_.size() : end + 2;
            } else if (text_[at] == '"') {
                at = behind_string(at + 1);
            } else {
                code(at++);
            }
        }
    }

  private:
    [[nodiscard]] std::size_t behind_string(std::size_t at) const {
        while (at < text_.size() && text_[at] != '"') at += text_[at] == '\\' ? 2 : 1;
        return std::min(at + 1, text_.size());
    }

    std::string_view text_;
};

std::size_t lines_before(std::string_view text, std::size_t at) {
    return static_cast<std::size_t>(std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(at), '\n'));
}

bool is_spec(std::string_view comment) {
    const std::string_view line = comment.substr(0, comment.find('\n'));
    constexpr std::string_view kBlanks = " \t\r*";
    const std::size_t first = line.find_first_not_of(kBlanks);
    if (first == line.npos) return false;
    return line.substr(first, line.find_last_not_of(kBlanks) - first + 1) == "fretwork";
}

}  // namespace

std::optional<std::string> spec_in_scad(std::string_view text, std::string_view source) {
    std::optional<std::string> spec;
    const auto take = [&](std::size_t begin, std::size_t end) {
        const std::string_view comment = text.substr(begin, end == text.npos ? end : end - begin);
        if (!is_spec(comment)) return;
        const std::string place = place_of_line(lines_before(text, begin) + 1);
        if (end == text.npos) fail_parse(source, place, "a comment without an end", "*/ behind the spec");
        if (spec) fail_parse(source, place, "a second spec in a comment", "one");
        const std::size_t body = std::min(comment.find('\n'), comment.size() - 1) + 1;
        spec = std::string(lines_before(text, begin + body), '\n') + std::string(comment.substr(body));
    };
    ScadScanner(text).walk(take, [](std::size_t) {});
    return spec;
}

std::set<std::string, std::less<>> variables_of_scad(std::string_view text) {
    std::set<std::string, std::less<>> names;
    int depth = 0;
    std::string word;      // the last one outside of all braces
    bool ended = false;    // something stood behind it
    std::size_t last = 0;  // position in code
    const auto read = [&](std::size_t at) {
        const char c = text[at];
        if (c == '{' || c == '(' || c == '[') ++depth;
        if (c == '}' || c == ')' || c == ']') --depth;
        if (depth != 0) word.clear();
        const bool adjacent = at == last + 1;
        last = at;
        if (depth != 0) return;
        if (is_word(c)) {
            if (ended || !adjacent) word.clear();
            ended = false;
            word += c;
        } else if (c == '=' && !word.empty() && text.substr(at + 1, 1) != "=") {
            names.insert(word);
            word.clear();
        } else if (std::isspace(static_cast<unsigned char>(c)) != 0) {
            ended = true;
        } else {
            word.clear();
        }
    };
    ScadScanner(text).walk([](std::size_t, std::size_t) {}, read);
    return names;
}

std::vector<std::string> included_by_scad(std::string_view text) {
    std::string code;
    ScadScanner(text).walk([&](std::size_t, std::size_t) { code += ' '; }, [&](std::size_t at) { code += text[at]; });
    const std::regex statement("\\binclude\\s*<([^>]*)>");
    std::vector<std::string> paths;
    for (std::sregex_iterator it(code.begin(), code.end(), statement), end; it != end; ++it) paths.push_back((*it)[1]);
    return paths;
}

}  // namespace fretwork
