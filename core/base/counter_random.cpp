#include "core/base/counter_random.h"

namespace fretwork {
namespace {

// Finaliser of SplitMix64 (Steele, Lea and Flood 2014): a bijection whose outputs pass the usual tests.
std::uint64_t mix(std::uint64_t z) {
    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9ull;
    z = (z ^ (z >> 27)) * 0x94D049BB133111EBull;
    return z ^ (z >> 31);
}

constexpr std::uint64_t kGolden = 0x9E3779B97F4A7C15ull;

}  // namespace

std::uint64_t counter_random(std::uint64_t seed, RandomStream stream, std::uint32_t epoch, std::uint64_t item,
                             std::uint32_t draw) {
    std::uint64_t h = mix(seed + kGolden);
    h = mix(h ^ ((static_cast<std::uint64_t>(stream) << 32 | epoch) + kGolden));
    h = mix(h ^ (item + 2 * kGolden));
    return mix(h + (draw + 1ull) * kGolden);
}

}  // namespace fretwork
