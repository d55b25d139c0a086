// Words and numbers of a text file, with the line they stand on.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace fretwork {

/// Splits text at blanks. Lines end with LF, CR or both. From the comment mark to the end of the
/// line nothing is seen. References the text; keeps no copy.
class TextScanner {
  public:
    struct Dialect {
        char comment = '#';                ///< 0 for none
        bool backslash_continues = false;  ///< a backslash at the end of a line joins it with the next (OBJ)
    };

    TextScanner(std::string_view text, std::string_view source, Dialect dialect);

    /// Next word on any line; empty at the end of the text.
    std::string_view word();

    /// Next word on this line; empty at its end.
    std::string_view word_in_line();

    /// What is left of this line, trimmed; moves to the next line.
    std::string_view rest_of_line();

    /// Moves behind the end of this line. False when the text ends there.
    bool next_line();

    /// A finite number of at most kMaxCoordinate in size. `what` names it in messages.
    double coordinate(std::string_view what) { return to_coordinate(word(), what); }
    double coordinate_in_line(std::string_view what) { return to_coordinate(word_in_line(), what); }
    std::int64_t integer(std::string_view what) { return to_integer(word(), what); }

    /// The same for a word already taken. \throws InvalidInput
    double to_coordinate(std::string_view word, std::string_view what) const;
    double to_number(std::string_view word, std::string_view what) const;
    std::int64_t to_integer(std::string_view word, std::string_view what) const;

    [[nodiscard]] std::size_t line() const { return line_; }
    [[nodiscard]] std::size_t bytes_left() const { return text_.size() - at_; }

    /// \throws InvalidInput  naming source and line; an empty word reads "the end of the file" or "... line".
    [[noreturn]] void fail(std::string_view found_word, std::string_view expected) const;

  private:
    bool skip_blanks_in_line();
    [[nodiscard]] bool at_line_end(std::size_t at) const;
    void step_over_line_end();

    std::string_view text_;
    std::string source_;
    Dialect dialect_;
    std::size_t at_ = 0;
    std::size_t line_ = 1;
};

/// The whole word as a number, read without regard to locale. A leading plus is fine, and a number
/// too small for a double is zero. False when anything is left over or the number is not finite.
bool parse_number(std::string_view word, double& value);

/// The whole word as a signed integer of 64 bits.
bool parse_integer(std::string_view word, std::int64_t& value);

}  // namespace fretwork
