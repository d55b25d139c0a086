// Integers in which every instruction set computes the same bits.
#pragma once

#include <bit>
#include <cstdint>

namespace fretwork {

/// Two 16-bit integers in one lane, the layout of the multiply-add instructions.
[[nodiscard]] inline std::int32_t pack16(std::int32_t low, std::int32_t high) {
    return static_cast<std::int32_t>((static_cast<std::uint32_t>(high) << 16) |
                                     (static_cast<std::uint32_t>(low) & 0xFFFFu));
}
[[nodiscard]] inline std::int32_t low16(std::int32_t pair) {
    return static_cast<std::int16_t>(static_cast<std::uint32_t>(pair) & 0xFFFFu);
}
[[nodiscard]] inline std::int32_t high16(std::int32_t pair) {
    return pair >> 16;
}

/// Nearest integer, to even on a tie, for |x| < 2^22. Adding 1.5 * 2^23 leaves it in the low bits; no
/// branch, as signs come at random.
[[nodiscard]] inline std::int32_t round_to_int(float x) {
    return std::bit_cast<std::int32_t>(x + 12582912.0F) - 0x4B400000;
}

}  // namespace fretwork
