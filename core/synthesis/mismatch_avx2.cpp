#include "core/base/avx2.h"
#include "core/synthesis/mismatch.h"

#if defined(__x86_64__)

#include <bit>
#include <cstddef>

namespace fretwork {
namespace {

using avx2::first_lanes;
using avx2::load;

/// Constants of a level in registers.
struct Fetcher {
    const int* texels;
    __m256i size;    // width and height in the halves of each lane
    __m256i stride;  // 1 and width
    __m128i u_shift, v_shift;
};

FRETWORK_AVX2_INLINE Fetcher make_fetcher(const TexelLevel& level) {
    const auto pair = [](std::uint32_t low, std::uint32_t high) { return static_cast<int>(low | high << 16); };
    return {reinterpret_cast<const int*>(level.texels), _mm256_set1_epi32(pair(level.width, level.height)),
            _mm256_set1_epi32(pair(1, level.width)), _mm_cvtsi32_si128(level.u_shift),
            _mm_cvtsi32_si128(level.v_shift)};
}

/// Eight texels at (u, v).
FRETWORK_AVX2_INLINE __m256i fetch_at(const Fetcher& f, __m256i u, __m256i v) {
    const __m256i shares = _mm256_blend_epi16(_mm256_srli_epi32(u, 16), v, 0xAA);
    const __m256i column_row = _mm256_mulhi_epu16(shares, f.size);
    return _mm256_i32gather_epi32(f.texels, _mm256_madd_epi16(column_row, f.stride), 4);
}

/// Eight texels at (u, v) + linear part * offset. The offset's z comes twice: alone in the lower halves
/// of the lanes and alone in the upper ones.
FRETWORK_AVX2_INLINE __m256i fetch(const Fetcher& f, __m256i u, __m256i v, __m256i u_xy, __m256i v_xy, __m256i uv_z,
                                   __m256i xy, __m256i z_low, __m256i z_high) {
    const __m256i du = _mm256_add_epi32(_mm256_madd_epi16(u_xy, xy), _mm256_madd_epi16(uv_z, z_low));
    const __m256i dv = _mm256_add_epi32(_mm256_madd_epi16(v_xy, xy), _mm256_madd_epi16(uv_z, z_high));
    return fetch_at(f, _mm256_add_epi32(u, _mm256_sll_epi32(du, f.u_shift)),
                    _mm256_add_epi32(v, _mm256_sll_epi32(dv, f.v_shift)));
}

FRETWORK_AVX2_INLINE void store(void* to, __m256i lanes) {
    _mm256_store_si256(static_cast<__m256i*>(to), lanes);
}

FRETWORK_AVX2_INLINE std::int32_t add_lanes(__m256i x) {
    __m128i s = _mm_add_epi32(_mm256_castsi256_si128(x), _mm256_extracti128_si256(x, 1));
    s = _mm_add_epi32(s, _mm_shuffle_epi32(s, 0x4E));
    s = _mm_add_epi32(s, _mm_shuffle_epi32(s, 0xB1));
    return _mm_cvtsi128_si32(s);
}

/// Sums of squares of the 8-bit channels, spread over the lanes.
FRETWORK_AVX2_INLINE __m256i squares(__m256i bytes) {
    const __m256i low = _mm256_unpacklo_epi8(bytes, _mm256_setzero_si256());
    const __m256i high = _mm256_unpackhi_epi8(bytes, _mm256_setzero_si256());
    return _mm256_add_epi32(_mm256_madd_epi16(low, low), _mm256_madd_epi16(high, high));
}

FRETWORK_AVX2 void view_neighbors(const TexelLevel& level, const Choice* choices, const NeighborBlock* blocks,
                                  std::uint32_t count, NeighborView& view) {
    static_assert(sizeof(Choice) == 32);
    const Fetcher f = make_fetcher(level);
    const __m256i zero = _mm256_setzero_si256();
    __m256i channel_sums = zero, square_sums = zero;
    for (std::uint32_t i = 0; i < count; i += 8) {
        const NeighborBlock& b = blocks[i / 8];
        __m256i r[8];
        for (int lane = 0; lane < 8; ++lane) r[lane] = load(choices + b.neighbor[lane]);
        avx2::transpose(r);
        store(view.u_xy + i, r[2]);
        store(view.v_xy + i, r[3]);
        store(view.uv_z + i, r[4]);
        store(view.color + i, r[5]);
        store(view.linear + i, r[6]);
        store(view.origin + i, r[7]);
        const __m256i z = load(b.z);
        __m256i expected = fetch(f, r[0], r[1], r[2], r[3], r[4], load(b.back_xy), _mm256_srli_epi32(z, 16),
                                 _mm256_andnot_si256(_mm256_set1_epi32(0xFFFF), z));
        if (count - i < 8) expected = _mm256_and_si256(expected, first_lanes(count - i));
        square_sums = _mm256_add_epi32(square_sums, squares(expected));
        // 31 blocks of twice 255 stay below 2^16.
        channel_sums = _mm256_add_epi16(
            channel_sums, _mm256_add_epi16(_mm256_unpacklo_epi8(expected, zero), _mm256_unpackhi_epi8(expected, zero)));
    }
    alignas(32) std::uint16_t sums[16];
    _mm256_store_si256(reinterpret_cast<__m256i*>(sums), channel_sums);
    for (int c = 0; c < 4; ++c) view.expected_sum[c] = sums[c] + sums[c + 4] + sums[c + 8] + sums[c + 12];
    view.expected_squares = add_lanes(square_sums);
}

FRETWORK_AVX2 std::uint32_t distinct_labels(const NeighborView& view, std::uint32_t count, CoherentLabel* labels) {
    constexpr std::uint32_t kWords = (Neighborhoods::kMost + 63) / 64;
    std::uint64_t left[kWords] = {};  // one bit per neighbour whose label is not counted yet
    for (std::uint32_t w = 0; 64 * w < count; ++w)
        left[w] = count - 64 * w >= 64 ? ~std::uint64_t{0} : (std::uint64_t{1} << (count - 64 * w)) - 1;
    std::uint32_t distinct = 0;
    for (std::uint32_t word = 0; 64 * word < count; ++word)
        while (left[word] != 0) {
            const std::uint32_t i = 64 * word + static_cast<std::uint32_t>(std::countr_zero(left[word]));
            const __m256i linear = _mm256_set1_epi32(static_cast<int>(view.linear[i]));
            const __m256i origin = _mm256_set1_epi32(static_cast<int>(view.origin[i]));
            std::uint32_t votes = 0;
            for (std::uint32_t w = word; 64 * w < count; ++w) {
                std::uint64_t same = 0;
                for (std::uint32_t j = 64 * w; j < count && j < 64 * w + 64; j += 8) {
                    const __m256i equal = _mm256_and_si256(_mm256_cmpeq_epi32(load(view.linear + j), linear),
                                                           _mm256_cmpeq_epi32(load(view.origin + j), origin));
                    same |= static_cast<std::uint64_t>(_mm256_movemask_ps(_mm256_castsi256_ps(equal))) << (j % 64);
                }
                same &= left[w];
                left[w] ^= same;
                votes += static_cast<std::uint32_t>(std::popcount(same));
            }
            labels[distinct++] = {{view.linear[i], view.origin[i]}, votes, i};
        }
    return distinct;
}

FRETWORK_AVX2_INLINE __m256i low_halves(__m256i pairs) {
    return _mm256_srai_epi32(_mm256_slli_epi32(pairs, 16), 16);
}
FRETWORK_AVX2_INLINE __m256i high_halves(__m256i pairs) {
    return _mm256_srai_epi32(pairs, 16);
}

FRETWORK_AVX2_INLINE __m256i gather(const void* table, __m256i at) {
    return _mm256_i32gather_epi32(static_cast<const int*>(table), at, 4);
}

FRETWORK_AVX2 void project_labels(const TexelLevel& level, const NeighborView& view, const FixedPoint& point,
                                  const CoherentLabel* labels, std::uint32_t labels_count, ScreenedTexels& screened) {
    static_assert(sizeof(CoherentLabel) == 16 && offsetof(CoherentLabel, first_seen) == 12);
    const __m256i x = _mm256_set1_epi32(point.x), y = _mm256_set1_epi32(point.y), z = _mm256_set1_epi32(point.z);
    const __m128i u_shift = _mm_cvtsi32_si128(level.u_place_shift), v_shift = _mm_cvtsi32_si128(level.v_place_shift);
    for (std::uint32_t i = 0; i < labels_count; i += 8) {
        alignas(32) std::uint32_t seen[8] = {};
        for (std::uint32_t lane = 0; lane < 8 && i + lane < labels_count; ++lane)
            seen[lane] = labels[i + lane].first_seen;
        const __m256i w = load(seen);
        const __m256i u_xy = gather(view.u_xy, w), v_xy = gather(view.v_xy, w), uv_z = gather(view.uv_z, w);
        const __m256i origin = gather(view.origin, w);
        const __m256i u = _mm256_add_epi32(
            _mm256_add_epi32(_mm256_mullo_epi32(low_halves(u_xy), x), _mm256_mullo_epi32(high_halves(u_xy), y)),
            _mm256_mullo_epi32(low_halves(uv_z), z));
        const __m256i v = _mm256_add_epi32(
            _mm256_add_epi32(_mm256_mullo_epi32(low_halves(v_xy), x), _mm256_mullo_epi32(high_halves(v_xy), y)),
            _mm256_mullo_epi32(high_halves(uv_z), z));
        const __m256i upper = _mm256_andnot_si256(_mm256_set1_epi32(0xFFFF), origin);
        store(screened.u + i, _mm256_add_epi32(upper, _mm256_sll_epi32(u, u_shift)));
        store(screened.v + i, _mm256_add_epi32(_mm256_slli_epi32(origin, 16), _mm256_sll_epi32(v, v_shift)));
    }
}

FRETWORK_AVX2 void first_halves(const TexelLevel& level, const NeighborView& view, std::uint32_t count,
                                std::uint32_t texels, ScreenedTexels& screened) {
    const Fetcher f = make_fetcher(level);
    const __m256i neighbors = _mm256_set1_epi32(static_cast<int>(count));
    const __m256i expected_squares = _mm256_set1_epi32(view.expected_squares), byte = _mm256_set1_epi32(0xFF);
    for (std::uint32_t i = 0; i < texels; i += 8) {
        const __m256i color = fetch_at(f, load(screened.u + i), load(screened.v + i));
        __m256i square = _mm256_setzero_si256(), product = _mm256_setzero_si256();
        for (int c = 0; c < 4; ++c) {
            const __m256i value = _mm256_and_si256(_mm256_srl_epi32(color, _mm_cvtsi32_si128(8 * c)), byte);
            square = _mm256_add_epi32(square, _mm256_madd_epi16(value, value));
            product = _mm256_add_epi32(product, _mm256_mullo_epi32(value, _mm256_set1_epi32(view.expected_sum[c])));
        }
        const __m256i half = _mm256_sub_epi32(_mm256_mullo_epi32(neighbors, square), _mm256_slli_epi32(product, 1));
        store(screened.first_half + i, _mm256_add_epi32(half, expected_squares));
    }
}

FRETWORK_AVX2 std::int32_t disagreement(const TexelLevel& level, const NeighborBlock* blocks, std::uint32_t count,
                                        const NeighborView& view, const TexelPosition& texel, const LinearPart& part,
                                        std::int32_t limit) {
    const Fetcher f = make_fetcher(level);
    const __m256i u = _mm256_set1_epi32(static_cast<int>(texel.u)), v = _mm256_set1_epi32(static_cast<int>(texel.v));
    const __m256i u_xy = _mm256_set1_epi32(part.u_xy), v_xy = _mm256_set1_epi32(part.v_xy);
    const __m256i uv_z = _mm256_set1_epi32(part.uv_z);
    std::int32_t sum = 0;
    for (std::uint32_t i = 0; i < count && sum <= limit; i += 8) {
        const NeighborBlock& b = blocks[i / 8];
        const __m256i z = load(b.z);
        const __m256i seen = fetch(f, u, v, u_xy, v_xy, uv_z, load(b.out_xy),
                                   _mm256_and_si256(z, _mm256_set1_epi32(0xFFFF)), _mm256_slli_epi32(z, 16));
        const __m256i wanted = load(view.color + i);
        __m256i difference = _mm256_sub_epi8(_mm256_max_epu8(seen, wanted), _mm256_min_epu8(seen, wanted));
        if (count - i < 8) difference = _mm256_and_si256(difference, first_lanes(count - i));
        sum += add_lanes(squares(difference));
    }
    return sum;
}

}  // namespace

const MismatchKernels kAvx2Mismatch{view_neighbors, distinct_labels, project_labels, first_halves, disagreement};

}  // namespace fretwork

#else

namespace fretwork {
const MismatchKernels kAvx2Mismatch = kPortableMismatch;
}  // namespace fretwork

#endif
