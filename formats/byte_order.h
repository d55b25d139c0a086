// Numbers in and out of byte strings, whatever the machine's own byte order.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <string>

namespace fretwork {

/// Reads a T from `at`, which need not be aligned.
template <class T>
[[nodiscard]] T load(const char* at, std::endian order) {
    std::array<char, sizeof(T)> bytes;
    std::copy_n(at, sizeof(T), bytes.data());
    if (order != std::endian::native) std::reverse(bytes.begin(), bytes.end());
    return std::bit_cast<T>(bytes);
}

/// Appends the bytes of `value`, lowest first.
template <class T>
void append_little(std::string& out, T value) {
    auto bytes = std::bit_cast<std::array<char, sizeof(T)>>(value);
    if (std::endian::native != std::endian::little) std::reverse(bytes.begin(), bytes.end());
    out.append(bytes.data(), bytes.size());
}

}  // namespace fretwork
