#include "formats/weld_equal.h"

#include <bit>

namespace fretwork {
namespace {

std::uint64_t mix(std::uint64_t h) {
    h ^= h >> 32;
    h *= 0xd6e8feb86659fd93u;
    h ^= h >> 32;
    h *= 0xd6e8feb86659fd93u;
    return h ^ (h >> 32);
}

std::uint64_t hash_of(const Vec3& p) {
    std::uint64_t h = 0x9e3779b97f4a7c15u;
    for (int k = 0; k < 3; ++k) h = mix(h ^ std::bit_cast<std::uint64_t>(p[k]));
    return h;
}

}  // namespace

EqualPointWelder::EqualPointWelder(std::size_t corners_expected) {
    // A closed mesh has about six corners per vertex; the table stays at most half full.
    slots_.assign(std::bit_ceil(corners_expected / 3 + 16), 0);
    positions_.reserve(corners_expected / 6 + 8);
}

std::uint32_t EqualPointWelder::index_of(const Vec3& p) {
    const Vec3 key = p + Vec3::Zero();  // Minus zero plus zero is zero.
    const std::size_t mask = slots_.size() - 1;
    std::size_t slot = hash_of(key) & mask;
    while (slots_[slot] != 0) {
        if (positions_[slots_[slot] - 1] == key) return slots_[slot] - 1;
        slot = (slot + 1) & mask;
    }
    positions_.push_back(key);
    slots_[slot] = static_cast<std::uint32_t>(positions_.size());
    if (2 * positions_.size() > slots_.size()) grow();
    return static_cast<std::uint32_t>(positions_.size() - 1);
}

void EqualPointWelder::grow() {
    slots_.assign(2 * slots_.size(), 0);
    const std::size_t mask = slots_.size() - 1;
    for (std::size_t i = 0; i < positions_.size(); ++i) {
        std::size_t slot = hash_of(positions_[i]) & mask;
        while (slots_[slot] != 0) slot = (slot + 1) & mask;
        slots_[slot] = static_cast<std::uint32_t>(i + 1);
    }
}

}  // namespace fretwork
