// Lists that users write on one line.
#pragma once

#include <algorithm>
#include <string>
#include <string_view>
#include <vector>

namespace fretwork {

/// "a, b c,,d " -> "a", "b c", "d": blanks around words do not count, and empty words are left out.
[[nodiscard]] inline std::vector<std::string> words_between_commas(std::string_view text) {
    std::vector<std::string> words;
    for (std::size_t begin = 0; begin < text.size();) {
        const std::size_t end = std::min(text.find(',', begin), text.size());
        std::string_view word = text.substr(begin, end - begin);
        word.remove_prefix(std::min(word.find_first_not_of(' '), word.size()));
        word = word.substr(0, word.find_last_not_of(' ') + 1);
        if (!word.empty()) words.emplace_back(word);
        begin = end + 1;
    }
    return words;
}

}  // namespace fretwork
