// Tables in Markdown, and sections of a document that a program writes anew.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace fretwork::bench {

class MarkdownTable {
  public:
    explicit MarkdownTable(const std::vector<std::string>& heads);
    /// As many cells as heads.
    void add(const std::vector<std::string>& cells);
    [[nodiscard]] const std::string& text() const { return text_; }

  private:
    std::string text_;
};

/// `document` with what stands between the lines `<!-- name: begin -->` and `<!-- name: end -->` replaced by `text`.
/// \throws InvalidInput  the lines are not there.
std::string with_section(std::string_view document, std::string_view name, std::string_view text);

/// The end of a benchmark's main: what `measure` returns goes to stdout, or into a section of `document` where one is
/// named. \return the exit code; an exception is told on stderr after the name of the program
int publish(const char* program, const std::string& document, std::string_view section,
            const std::function<std::string()>& measure);

/// The same in a file, whole or not at all.
/// \throws FileError, InvalidInput
void write_section(const std::filesystem::path& document, std::string_view name, std::string_view text);

}  // namespace fretwork::bench
