#pragma once
#include <bit>
#include <cstdint>

#if defined(__x86_64__)
#include <immintrin.h>
#endif

namespace palp {

/// Points in one block: two full AVX-512 registers per coordinate, one bit of a mask each.
inline constexpr int kBlockPoints = 32;

/// Neighbouring points as vector registers take them. Coordinates are floats in the units of the index.
struct alignas(64) PointBlock {
    float         x[kBlockPoints];
    float         y[kBlockPoints];
    float         z[kBlockPoints];
    std::uint32_t point[kBlockPoints]; ///< index into the caller's positions
};

/// A sphere with the doubt that rounding to floats brings: squares of the radii inside which a point is certainly in
/// the sphere and outside which it is certainly not.
struct Shell {
    float x      = 0;
    float y      = 0;
    float z      = 0;
    float inner2 = -1; ///< negative: nothing is certain
    float outer2 = 0;
};

/// Writes the points of a block that are certainly inside to `certain` (room for kBlockPoints), in the order of the
/// block, and returns how many; sets one bit of `doubtful` for every point between the two radii.
using BlockFilter = unsigned (*)(const PointBlock& block, const Shell& shell, std::uint32_t* certain,
                                 std::uint32_t& doubtful);

namespace detail {

/// The filter in plain C++, for compilers to vectorise with whatever the function it is inlined in may use.
[[gnu::always_inline]] inline unsigned filterBlock(const PointBlock& block, const Shell& shell, std::uint32_t* certain,
                                                   std::uint32_t& doubtful)
{
    std::uint32_t inside = 0;
    std::uint32_t near   = 0;
    for (int i = 0; i < kBlockPoints; ++i) {
        const float         dx = block.x[i] - shell.x;
        const float         dy = block.y[i] - shell.y;
        const float         dz = block.z[i] - shell.z;
        const float         d2 = dx * dx + dy * dy + dz * dz;
        const std::uint32_t bit = std::uint32_t(1) << i;
        inside |= d2 <= shell.inner2 ? bit : 0;
        near |= d2 <= shell.outer2 ? bit : 0;
    }
    doubtful       = near & ~inside;
    unsigned count = 0;
    for (; inside != 0; inside &= inside - 1) certain[count++] = block.point[std::countr_zero(inside)];
    return count;
}

inline unsigned filterBlockPortable(const PointBlock& block, const Shell& shell, std::uint32_t* certain,
                                    std::uint32_t& doubtful)
{
    return filterBlock(block, shell, certain, doubtful);
}

#if defined(__x86_64__)
__attribute__((target("avx2,fma,bmi,bmi2"))) inline unsigned
filterBlockAvx2(const PointBlock& block, const Shell& shell, std::uint32_t* certain, std::uint32_t& doubtful)
{
    return filterBlock(block, shell, certain, doubtful);
}

__attribute__((target("avx512f,popcnt"))) inline unsigned
filterBlockAvx512(const PointBlock& block, const Shell& shell, std::uint32_t* certain, std::uint32_t& doubtful)
{
    constexpr int kLanes = 16;
    const __m512  x      = _mm512_set1_ps(shell.x);
    const __m512  y      = _mm512_set1_ps(shell.y);
    const __m512  z      = _mm512_set1_ps(shell.z);
    doubtful             = 0;
    unsigned count       = 0;
    for (int first = 0; first < kBlockPoints; first += kLanes) {
        const __m512    dx     = _mm512_sub_ps(_mm512_load_ps(block.x + first), x);
        const __m512    dy     = _mm512_sub_ps(_mm512_load_ps(block.y + first), y);
        const __m512    dz     = _mm512_sub_ps(_mm512_load_ps(block.z + first), z);
        const __m512    d2     = _mm512_fmadd_ps(dz, dz, _mm512_fmadd_ps(dy, dy, _mm512_mul_ps(dx, dx)));
        const __mmask16 inside = _mm512_cmp_ps_mask(d2, _mm512_set1_ps(shell.inner2), _CMP_LE_OQ);
        const __mmask16 near   = _mm512_cmp_ps_mask(d2, _mm512_set1_ps(shell.outer2), _CMP_LE_OQ);
        const __m512i   points = _mm512_load_si512(block.point + first);
        // Through a register: compressing straight into memory takes some hundred cycles on AMD Zen 4.
        _mm512_storeu_si512(certain + count, _mm512_maskz_compress_epi32(inside, points));
        count += static_cast<unsigned>(__builtin_popcount(inside));
        doubtful |= static_cast<std::uint32_t>(near & ~inside) << first;
    }
    return count;
}
#endif

} // namespace detail

/// The fastest filter that this processor runs. Chosen at run time, so that one binary serves every x86-64; written
/// out rather than by target_clones, whose resolvers run before the sanitizers do.
[[nodiscard]] inline BlockFilter fastestBlockFilter() noexcept
{
#if defined(__x86_64__)
    if (__builtin_cpu_supports("avx512f")) return detail::filterBlockAvx512;
    if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") && __builtin_cpu_supports("bmi2"))
        return detail::filterBlockAvx2;
#endif
    return detail::filterBlockPortable;
}

} // namespace palp
