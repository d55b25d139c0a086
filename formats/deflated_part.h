// Large texts packed in parallel, piece by piece.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "core/base/run_control.h"

namespace fretwork {

/// Raw deflate data with what a ZIP record says about it.
struct DeflatedPart {
    std::vector<std::string> blocks;  ///< to be joined; apart, so that each can go as soon as it has been written
    std::uint64_t size = 0;           ///< unpacked
    std::uint32_t crc32 = 0;          ///< of the unpacked bytes

    [[nodiscard]] std::uint64_t packed_size() const;
};

/// A part as it lies in an archive.
struct PackedPart {
    DeflatedPart data;    ///< with the blocks as they are when `stored`
    bool stored = false;  ///< not packed at all
};

/// Joins `piece(0)`, ..., `piece(count - 1)` in order. Pieces are made and packed on several threads,
/// and only their packed form is kept, so the whole text is never in memory. The bytes depend on the
/// pieces alone.
/// \throws Cancelled
DeflatedPart deflate_pieces(std::size_t count, const std::function<std::string(std::size_t)>& piece,
                            const RunControl& run = {});

}  // namespace fretwork
