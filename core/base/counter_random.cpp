#include "core/base/counter_random.h"

namespace fretwork {

ItemRandom::ItemRandom(std::uint64_t seed, RandomStream stream, std::uint32_t epoch, std::uint64_t item)
    : state_(mix(seed + kGolden)) {
    state_ = mix(state_ ^ ((static_cast<std::uint64_t>(stream) << 32 | epoch) + kGolden));
    state_ = mix(state_ ^ (item + 2 * kGolden));
}

std::uint64_t counter_random(std::uint64_t seed, RandomStream stream, std::uint32_t epoch, std::uint64_t item,
                             std::uint32_t draw) {
    return ItemRandom(seed, stream, epoch, item).draw(draw);
}

}  // namespace fretwork
