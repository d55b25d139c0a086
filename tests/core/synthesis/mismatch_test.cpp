#include "core/synthesis/mismatch.h"

#include <catch2/catch.hpp>
#include <cstdint>
#include <limits>
#include <random>
#include <vector>

#include "core/base/avx2.h"

namespace fretwork {
namespace {

/// Random choices, neighbours and texels; all bits are used.
struct MismatchCase {
    MismatchCase(std::uint32_t width, std::uint32_t height, std::uint32_t neighbors, unsigned seed)
        : rng(seed), texels(width * height), choices(97), blocks((neighbors + 7) / 8), count(neighbors) {
        for (auto& t : texels) t = draw();
        for (auto& c : choices) {
            c.texel = {draw(), draw()};
            c.part = {signed_draw(), signed_draw(), signed_draw()};
            c.color = draw();
            c.label = {draw() % 4, draw() % 2};  // few, so that neighbours agree
        }
        for (auto& b : blocks)
            for (int lane = 0; lane < 8; ++lane) {
                b.out_xy[lane] = offsets(), b.back_xy[lane] = offsets(), b.z[lane] = offsets();
                b.neighbor[lane] = draw() % 97;
            }
        const auto shift = [&] { return static_cast<int>(draw() % 12); };
        level = {texels.data(), width, height, shift(), shift(), shift(), shift()};
    }
    std::uint32_t draw() { return static_cast<std::uint32_t>(rng()); }
    std::int32_t signed_draw() { return pack16(component(23000), component(23000)); }
    std::int32_t offsets() { return pack16(component(21000), component(21000)); }
    std::int32_t component(int reach) {
        return static_cast<std::int32_t>(draw() % static_cast<unsigned>(2 * reach)) - reach;
    }

    std::mt19937 rng;
    std::vector<std::uint32_t> texels;
    Choices choices;
    std::vector<NeighborBlock> blocks;
    std::uint32_t count;
    TexelLevel level;
};

struct Size {
    std::uint32_t width, height, neighbors;
};

TEST_CASE("mismatch: both instruction sets give the same integers", "[synthesis][property]") {
    if (!machine_has_avx2()) return;
    const Size size = GENERATE(Size{128, 128, 39}, Size{37, 91, 1}, Size{1024, 5, 8}, Size{200, 300, 124},
                               Size{64, 64, Neighborhoods::kMost});
    const unsigned seed = GENERATE(range(1u, 6u));
    CAPTURE(size.width, size.height, size.neighbors, seed);
    MismatchCase c(size.width, size.height, size.neighbors, seed);

    NeighborView plain, fast;
    kPortableMismatch.view_neighbors(c.level, c.choices.data(), c.blocks.data(), c.count, plain);
    kAvx2Mismatch.view_neighbors(c.level, c.choices.data(), c.blocks.data(), c.count, fast);
    for (int i = 0; i < 4; ++i) CHECK(plain.expected_sum[i] == fast.expected_sum[i]);
    CHECK(plain.expected_squares == fast.expected_squares);
    for (std::uint32_t i = 0; i < c.count; ++i) {
        REQUIRE(plain.color[i] == fast.color[i]);
        REQUIRE(plain.linear[i] == fast.linear[i]);
        REQUIRE(plain.origin[i] == fast.origin[i]);
        REQUIRE(plain.u_xy[i] == fast.u_xy[i]);
        REQUIRE(plain.v_xy[i] == fast.v_xy[i]);
        REQUIRE(plain.uv_z[i] == fast.uv_z[i]);
    }

    std::vector<CoherentLabel> a(c.count), b(c.count);
    a.resize(kPortableMismatch.distinct_labels(plain, c.count, a.data()));
    b.resize(kAvx2Mismatch.distinct_labels(fast, c.count, b.data()));
    REQUIRE(a.size() == b.size());
    std::uint32_t votes = 0;
    for (std::size_t i = 0; i < a.size(); ++i) {
        CHECK(a[i].label == b[i].label);
        CHECK(a[i].votes == b[i].votes);
        CHECK(a[i].first_seen == b[i].first_seen);
        votes += a[i].votes;
    }
    CHECK(votes == c.count);

    const auto labels = static_cast<std::uint32_t>(a.size());
    const FixedPoint point{c.signed_draw(), c.signed_draw(), c.signed_draw()};
    ScreenedTexels by_plain, by_fast;
    kPortableMismatch.project_labels(c.level, plain, point, a.data(), labels, by_plain);
    kPortableMismatch.first_halves(c.level, plain, c.count, labels, by_plain);
    kAvx2Mismatch.project_labels(c.level, fast, point, b.data(), labels, by_fast);
    kAvx2Mismatch.first_halves(c.level, fast, c.count, labels, by_fast);
    for (std::uint32_t i = 0; i < labels; ++i) {
        REQUIRE(by_plain.u[i] == by_fast.u[i]);
        REQUIRE(by_plain.v[i] == by_fast.v[i]);
        REQUIRE(by_plain.first_half[i] == by_fast.first_half[i]);
        REQUIRE(by_plain.first_half[i] >= 0);
    }

    for (int trial = 0; trial < 20; ++trial) {
        const TexelPosition texel{c.draw(), c.draw()};
        const LinearPart part{c.signed_draw(), c.signed_draw(), c.signed_draw()};
        const auto sum = [&](const MismatchKernels& k, const NeighborView& view, std::int32_t limit) {
            return k.disagreement(c.level, c.blocks.data(), c.count, view, texel, part, limit);
        };
        constexpr std::int32_t kNone = std::numeric_limits<std::int32_t>::max() / 2;
        const std::int32_t full = sum(kPortableMismatch, plain, kNone);
        REQUIRE(sum(kAvx2Mismatch, fast, kNone) == full);
        // Giving up early never changes what is accepted.
        for (const std::int32_t limit : {0, full / 2, full - 1, full}) {
            CHECK((sum(kPortableMismatch, plain, limit) <= limit) == (full <= limit));
            CHECK((sum(kAvx2Mismatch, fast, limit) <= limit) == (full <= limit));
        }
    }
}

}  // namespace
}  // namespace fretwork
