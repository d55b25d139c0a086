// Random numbers without state: each is a hash of where it is used.
#pragma once

#include <cstdint>

namespace fretwork {

/// Names the use of a random number, so that two stages never share a sequence.
enum class RandomStream : std::uint32_t {
    kSynthesisInit = 1,
    kSynthesisJitter,
    kSynthesisCandidates,
    kSamples,
    kPattern,
    kTest,
    kRender,
    kMeshDistance,
    kPrintability,
    kStrength,
};

/// The same five numbers give the same 64 random bits on every machine and in any order of calls,
/// which is why results cannot depend on the number of threads.
///
/// \param seed    the user's seed
/// \param stream  who asks
/// \param epoch   level and pass, or any other coarse counter
/// \param item    voxel, sample or pixel
/// \param draw    how many numbers this item has drawn before
[[nodiscard]] std::uint64_t counter_random(std::uint64_t seed, RandomStream stream, std::uint32_t epoch,
                                           std::uint64_t item, std::uint32_t draw);

/// The numbers that one item draws from `counter_random`, for items that draw many.
class ItemRandom {
  public:
    ItemRandom(std::uint64_t seed, RandomStream stream, std::uint32_t epoch, std::uint64_t item);

    /// The same as `counter_random(seed, stream, epoch, item, n)`.
    [[nodiscard]] std::uint64_t draw(std::uint32_t n) const { return mix(state_ + (n + 1ull) * kGolden); }

  private:
    static constexpr std::uint64_t kGolden = 0x9E3779B97F4A7C15ull;
    // Finaliser of SplitMix64 (Steele, Lea and Flood 2014): a bijection whose outputs pass the usual tests.
    [[nodiscard]] static std::uint64_t mix(std::uint64_t z) {
        z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9ull;
        z = (z ^ (z >> 27)) * 0x94D049BB133111EBull;
        return z ^ (z >> 31);
    }

    std::uint64_t state_;
};

/// Uniform in [0, 1).
[[nodiscard]] inline double unit_interval(std::uint64_t bits) {
    return static_cast<double>(bits >> 11) * 0x1.0p-53;
}

/// Uniform in [0, n) up to a bias below n / 2^32. Requires n > 0.
[[nodiscard]] inline std::uint32_t index_below(std::uint64_t bits, std::uint32_t n) {
    return static_cast<std::uint32_t>(((bits >> 32) * n) >> 32);
}

}  // namespace fretwork
