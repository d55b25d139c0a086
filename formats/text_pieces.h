// A long text put together from pieces that are made only when they are packed.
#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/run_control.h"
#include "formats/deflated_part.h"

namespace fretwork {

class TextPieces {
  public:
    void add(std::string_view text);

    /// A stretch of a text that outlives this.
    void add_kept(std::string_view text);

    /// What `make` returns, on any thread, once or more; the same every time.
    void add_made(std::function<std::string()> make);

    /// All of it, packed on several threads. \throws Cancelled
    [[nodiscard]] DeflatedPart deflated(const RunControl& run = {}) const;

  private:
    struct Piece {
        std::string text;
        std::string_view kept;
        std::function<std::string()> make;
    };
    std::vector<Piece> pieces_;
};

}  // namespace fretwork
