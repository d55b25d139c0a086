#include "formats/text_scanner.h"

#include <charconv>
#include <cmath>

#include "formats/mesh_data.h"
#include "formats/parse_error.h"

namespace fretwork {
namespace {

bool is_blank(char c) {
    return c == ' ' || c == '\t' || c == '\v' || c == '\f';
}
bool is_line_end(char c) {
    return c == '\n' || c == '\r';
}

std::string_view without_plus(std::string_view word) {
    if (word.size() > 1 && word.front() == '+' && word[1] != '-') word.remove_prefix(1);
    return word;
}

}  // namespace

bool parse_number(std::string_view word, double& value) {
    word = without_plus(word);
    const char* end = word.data() + word.size();
    const auto [stop, error] = std::from_chars(word.data(), end, value);
    if (stop != end || word.empty()) return false;
    if (error == std::errc::result_out_of_range) {
        // Too large and too small look alike here; only a negative exponent or a leading zero can be small.
        const bool small = word.find("e-") != word.npos || word.find("E-") != word.npos || word.substr(0, 2) == "0." ||
                           word.substr(0, 3) == "-0.";
        if (!small) return false;
        value = 0.0;
        return true;
    }
    return error == std::errc() && std::isfinite(value);
}

bool parse_integer(std::string_view word, std::int64_t& value) {
    word = without_plus(word);
    const char* end = word.data() + word.size();
    const auto [stop, error] = std::from_chars(word.data(), end, value);
    return !word.empty() && stop == end && error == std::errc();
}

TextScanner::TextScanner(std::string_view text, std::string_view source, Dialect dialect)
    : text_(text), source_(source), dialect_(dialect) {
    constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
    if (text_.substr(0, 3) == kByteOrderMark) at_ = 3;
}

bool TextScanner::at_line_end(std::size_t at) const {
    return at >= text_.size() || is_line_end(text_[at]);
}

void TextScanner::step_over_line_end() {
    if (at_ >= text_.size()) return;
    if (text_[at_] == '\r' && at_ + 1 < text_.size() && text_[at_ + 1] == '\n') ++at_;
    ++at_;
    ++line_;
}

bool TextScanner::skip_blanks_in_line() {
    while (at_ < text_.size()) {
        const char c = text_[at_];
        if (is_blank(c)) {
            ++at_;
        } else if (dialect_.backslash_continues && c == '\\' && at_ + 1 < text_.size() && is_line_end(text_[at_ + 1])) {
            ++at_;
            step_over_line_end();
        } else if (dialect_.comment != 0 && c == dialect_.comment) {
            while (!at_line_end(at_)) ++at_;
        } else {
            return !is_line_end(c);
        }
    }
    return false;
}

std::string_view TextScanner::word_in_line() {
    if (!skip_blanks_in_line()) return {};
    const std::size_t begin = at_;
    while (at_ < text_.size()) {
        const char c = text_[at_];
        if (is_blank(c) || is_line_end(c) || (dialect_.comment != 0 && c == dialect_.comment)) break;
        if (dialect_.backslash_continues && c == '\\' && at_line_end(at_ + 1) && at_ + 1 < text_.size()) break;
        ++at_;
    }
    return text_.substr(begin, at_ - begin);
}

std::string_view TextScanner::word() {
    while (true) {
        const std::string_view found = word_in_line();
        if (!found.empty() || !next_line()) return found;
    }
}

std::string_view TextScanner::rest_of_line() {
    while (at_ < text_.size() && is_blank(text_[at_])) ++at_;
    const std::size_t begin = at_;
    while (!at_line_end(at_)) ++at_;
    std::size_t end = at_;
    while (end > begin && is_blank(text_[end - 1])) --end;
    step_over_line_end();
    return text_.substr(begin, end - begin);
}

bool TextScanner::next_line() {
    while (!at_line_end(at_)) ++at_;
    step_over_line_end();
    return at_ < text_.size();
}

double TextScanner::to_number(std::string_view word, std::string_view what) const {
    double value = 0.0;
    if (!parse_number(word, value)) fail(word, what);
    return value;
}

double TextScanner::to_coordinate(std::string_view word, std::string_view what) const {
    const double value = to_number(word, what);
    if (std::abs(value) > kMaxCoordinate) fail(word, std::string(what) + " of at most 1e9 in size");
    return value;
}

std::int64_t TextScanner::to_integer(std::string_view word, std::string_view what) const {
    std::int64_t value = 0;
    if (!parse_integer(word, value)) fail(word, what);
    return value;
}

void TextScanner::fail(std::string_view found_word, std::string_view expected) const {
    const std::string found = !found_word.empty()   ? in_quotes(found_word)
                              : at_ >= text_.size() ? "the end of the file"
                                                    : "the end of the line";
    fail_parse(source_, place_of_line(line_), found, expected);
}

}  // namespace fretwork
