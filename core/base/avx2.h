// What code for AVX2 shares. Include it in files that are compiled for every x86-64 and choose at run time.
#pragma once

#include <cstdint>

namespace fretwork {

/// May functions marked FRETWORK_AVX2 be called on this machine?
[[nodiscard]] inline bool machine_has_avx2() {
#if defined(__x86_64__)
    return __builtin_cpu_supports("avx2") != 0;
#else
    return false;
#endif
}

}  // namespace fretwork

#if defined(__x86_64__)

#include <immintrin.h>

// Only functions with these marks may use AVX2; they are called after a look at the processor.
#define FRETWORK_AVX2 __attribute__((target("avx2")))
#define FRETWORK_AVX2_INLINE __attribute__((target("avx2"), always_inline)) inline

namespace fretwork::avx2 {

FRETWORK_AVX2_INLINE __m256i load(const void* p) {
    return _mm256_loadu_si256(static_cast<const __m256i*>(p));  // as fast as an aligned load where it is aligned
}

/// All ones in the first `lanes` lanes.
FRETWORK_AVX2_INLINE __m256i first_lanes(std::uint32_t lanes) {
    return _mm256_cmpgt_epi32(_mm256_set1_epi32(static_cast<int>(lanes)), _mm256_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7));
}

/// Eight records of eight 32-bit fields -> eight fields of eight records.
FRETWORK_AVX2_INLINE void transpose(__m256i (&r)[8]) {
    __m256i s[8], t[8];
    for (int i = 0; i < 4; ++i) {
        s[2 * i] = _mm256_unpacklo_epi32(r[2 * i], r[2 * i + 1]);
        s[2 * i + 1] = _mm256_unpackhi_epi32(r[2 * i], r[2 * i + 1]);
    }
    for (int i = 0; i < 2; ++i) {
        t[4 * i] = _mm256_unpacklo_epi64(s[4 * i], s[4 * i + 2]);
        t[4 * i + 1] = _mm256_unpackhi_epi64(s[4 * i], s[4 * i + 2]);
        t[4 * i + 2] = _mm256_unpacklo_epi64(s[4 * i + 1], s[4 * i + 3]);
        t[4 * i + 3] = _mm256_unpackhi_epi64(s[4 * i + 1], s[4 * i + 3]);
    }
    for (int i = 0; i < 4; ++i) {
        r[i] = _mm256_permute2x128_si256(t[i], t[i + 4], 0x20);
        r[i + 4] = _mm256_permute2x128_si256(t[i], t[i + 4], 0x31);
    }
}

}  // namespace fretwork::avx2

#endif
