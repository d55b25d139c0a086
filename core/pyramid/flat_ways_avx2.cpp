#include "core/base/avx2.h"
#include "core/pyramid/flat_ways.h"

#if defined(__x86_64__)

namespace fretwork {
namespace {

using avx2::load;

struct Vectors {
    __m256 x, y, z;
};

FRETWORK_AVX2_INLINE __m256 dot(const Vectors& a, const Vectors& b) {
    return _mm256_add_ps(_mm256_mul_ps(a.x, b.x), _mm256_add_ps(_mm256_mul_ps(a.y, b.y), _mm256_mul_ps(a.z, b.z)));
}

struct Fixed {
    __m256i x, y, z;
};

FRETWORK_AVX2_INLINE __m256i to_fixed(__m256 coordinate, __m256 unit) {
    const __m256 least = _mm256_set1_ps(-32767.0F), most = _mm256_set1_ps(32767.0F);
    return _mm256_cvtps_epi32(_mm256_min_ps(_mm256_max_ps(_mm256_mul_ps(coordinate, unit), least), most));
}

// As in flat_ways_portable.cpp.
FRETWORK_AVX2_INLINE Fixed lay_flat(const Vectors& step, __m256 squared_step, const Vectors& normal, __m256 stretch,
                                    __m256 unit) {
    const __m256 along = dot(normal, step);
    const Vectors flat = {_mm256_sub_ps(step.x, _mm256_mul_ps(normal.x, along)),
                          _mm256_sub_ps(step.y, _mm256_mul_ps(normal.y, along)),
                          _mm256_sub_ps(step.z, _mm256_mul_ps(normal.z, along))};
    const __m256 squared = dot(flat, flat);
    const __m256 any = _mm256_cmp_ps(squared, _mm256_setzero_ps(), _CMP_GT_OQ);
    const __m256 keep_length = _mm256_and_ps(any, _mm256_sqrt_ps(_mm256_div_ps(squared_step, squared)));
    return {to_fixed(_mm256_mul_ps(stretch, _mm256_mul_ps(flat.x, keep_length)), unit),
            to_fixed(_mm256_mul_ps(stretch, _mm256_mul_ps(flat.y, keep_length)), unit),
            to_fixed(_mm256_mul_ps(stretch, _mm256_mul_ps(flat.z, keep_length)), unit)};
}

FRETWORK_AVX2_INLINE __m256i pack_pairs(__m256i low, __m256i high) {
    return _mm256_blend_epi16(low, _mm256_slli_epi32(high, 16), 0xAA);
}

FRETWORK_AVX2_INLINE void store(std::int32_t* to, __m256i lanes) {
    _mm256_store_si256(reinterpret_cast<__m256i*>(to), lanes);
}

}  // namespace

FRETWORK_AVX2 std::uint32_t lay_flat_avx2(const SurfaceFrame* frames, VoxelIndex v, float unit, NeighborBlock& block) {
    static_assert(sizeof(SurfaceFrame) == 32);
    __m256i r[8];
    for (int lane = 0; lane < 8; ++lane) r[lane] = load(frames + block.neighbor[lane]);
    avx2::transpose(r);
    const SurfaceFrame& a = frames[v];
    const Vectors own = {_mm256_set1_ps(a.normal[0]), _mm256_set1_ps(a.normal[1]), _mm256_set1_ps(a.normal[2])};
    const Vectors other = {_mm256_castsi256_ps(r[4]), _mm256_castsi256_ps(r[5]), _mm256_castsi256_ps(r[6])};
    const Vectors step = {_mm256_sub_ps(_mm256_castsi256_ps(r[0]), _mm256_set1_ps(a.position[0])),
                          _mm256_sub_ps(_mm256_castsi256_ps(r[1]), _mm256_set1_ps(a.position[1])),
                          _mm256_sub_ps(_mm256_castsi256_ps(r[2]), _mm256_set1_ps(a.position[2]))};
    const __m256 one = _mm256_set1_ps(1.0F), units = _mm256_set1_ps(unit);
    const __m256 cosine = dot(own, other);
    const __m256 stretch = _mm256_add_ps(one, _mm256_div_ps(_mm256_sub_ps(one, cosine), _mm256_set1_ps(12.0F)));
    const __m256 squared_step = dot(step, step);
    const Fixed out = lay_flat(step, squared_step, own, stretch, units);
    const Fixed back = lay_flat(step, squared_step, other, _mm256_xor_ps(stretch, _mm256_set1_ps(-0.0F)), units);
    store(block.out_xy, pack_pairs(out.x, out.y));
    store(block.back_xy, pack_pairs(back.x, back.y));
    store(block.z, pack_pairs(out.z, back.z));
    const __m256 bent = _mm256_cmp_ps(cosine, _mm256_set1_ps(kSmoothCosine), _CMP_LT_OQ);
    return static_cast<std::uint32_t>(_mm256_movemask_ps(bent));
}

}  // namespace fretwork

#else

namespace fretwork {
std::uint32_t lay_flat_avx2(const SurfaceFrame* frames, VoxelIndex v, float unit, NeighborBlock& block) {
    return lay_flat_portable(frames, v, unit, block);
}
}  // namespace fretwork

#endif
