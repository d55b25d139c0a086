#include "formats/text_pieces.h"

#include <utility>

namespace fretwork {

void TextPieces::add(std::string_view text) {
    if (pieces_.empty() || pieces_.back().make || !pieces_.back().kept.empty()) pieces_.emplace_back();
    pieces_.back().text += text;
}

void TextPieces::add_kept(std::string_view text) {
    constexpr std::size_t kMostAtOnce = 1 << 20;
    for (; !text.empty(); text.remove_prefix(std::min(kMostAtOnce, text.size())))
        pieces_.push_back({{}, text.substr(0, kMostAtOnce), {}});
}

void TextPieces::add_made(std::function<std::string()> make) {
    pieces_.push_back({{}, {}, std::move(make)});
}

DeflatedPart TextPieces::deflated(const RunControl& run) const {
    return deflate_pieces(
        pieces_.size(),
        [&](std::size_t i) {
            const Piece& piece = pieces_[i];
            if (piece.make) return piece.make();
            return piece.kept.empty() ? piece.text : std::string(piece.kept);
        },
        run);
}

}  // namespace fretwork
