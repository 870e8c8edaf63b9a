#pragma once
#include <bit>
#include <cstdint>
#include <vector>

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

/// A sphere with the doubt from rounding to floats: squares of the radii inside which a point is certainly in the
/// sphere and outside which it is certainly not.
struct Shell {
    float x      = 0;
    float y      = 0;
    float z      = 0;
    float inner2 = -1; ///< negative: nothing is certain
    float outer2 = 0;
};

/// The fastest functions of a processor for one block.
struct BlockFilter {
    /// Writes the points that are certainly inside to `certain` (room for kBlockPoints), in the order of the block, and
    /// returns how many; sets one bit of `doubtful` for every point between the two radii.
    unsigned (*gather)(const PointBlock& block, const Shell& shell, std::uint32_t* certain, std::uint32_t& doubtful);

    /// Writes the squared distances of all points to `distance2` and returns one bit for every point that is not
    /// certainly outside.
    std::uint32_t (*measure)(const PointBlock& block, const Shell& shell, float* distance2);
};

namespace detail {

// Plain C++: the compiler vectorises it with the instructions of the function that it is inlined in.

[[gnu::always_inline]] inline std::uint32_t measureBlock(const PointBlock& block, const Shell& shell, float* distance2)
{
    std::uint32_t near = 0;
    for (int i = 0; i < kBlockPoints; ++i) {
        const float dx = block.x[i] - shell.x;
        const float dy = block.y[i] - shell.y;
        const float dz = block.z[i] - shell.z;
        distance2[i]   = dx * dx + dy * dy + dz * dz;
        near |= distance2[i] <= shell.outer2 ? std::uint32_t(1) << i : 0;
    }
    return near;
}

[[gnu::always_inline]] inline unsigned gatherBlock(const PointBlock& block, const Shell& shell, std::uint32_t* certain,
                                                   std::uint32_t& doubtful)
{
    float               distance2[kBlockPoints];
    const std::uint32_t near   = measureBlock(block, shell, distance2);
    std::uint32_t       inside = 0;
    for (int i = 0; i < kBlockPoints; ++i) inside |= distance2[i] <= shell.inner2 ? std::uint32_t(1) << i : 0;
    doubtful       = near & ~inside;
    unsigned count = 0;
    for (; inside != 0; inside &= inside - 1) certain[count++] = block.point[std::countr_zero(inside)];
    return count;
}

inline unsigned gatherPortable(const PointBlock& block, const Shell& shell, std::uint32_t* certain,
                               std::uint32_t& doubtful)
{
    return gatherBlock(block, shell, certain, doubtful);
}
inline std::uint32_t measurePortable(const PointBlock& block, const Shell& shell, float* distance2)
{
    return measureBlock(block, shell, distance2);
}

#if defined(__x86_64__)
__attribute__((target("avx2,fma,bmi,bmi2"))) inline unsigned gatherAvx2(const PointBlock& block, const Shell& shell,
                                                                        std::uint32_t* certain, std::uint32_t& doubtful)
{
    return gatherBlock(block, shell, certain, doubtful);
}
__attribute__((target("avx2,fma,bmi,bmi2"))) inline std::uint32_t measureAvx2(const PointBlock& block,
                                                                              const Shell& shell, float* distance2)
{
    return measureBlock(block, shell, distance2);
}

constexpr int kAvx512Lanes = 16;

__attribute__((target("avx512f"))) inline __m512 measure16(const PointBlock& block, const Shell& shell, int first)
{
    const __m512 dx = _mm512_sub_ps(_mm512_load_ps(block.x + first), _mm512_set1_ps(shell.x));
    const __m512 dy = _mm512_sub_ps(_mm512_load_ps(block.y + first), _mm512_set1_ps(shell.y));
    const __m512 dz = _mm512_sub_ps(_mm512_load_ps(block.z + first), _mm512_set1_ps(shell.z));
    return _mm512_fmadd_ps(dz, dz, _mm512_fmadd_ps(dy, dy, _mm512_mul_ps(dx, dx)));
}
__attribute__((target("avx512f,popcnt"))) inline unsigned gatherAvx512(const PointBlock& block, const Shell& shell,
                                                                       std::uint32_t* certain, std::uint32_t& doubtful)
{
    doubtful       = 0;
    unsigned count = 0;
    for (int first = 0; first < kBlockPoints; first += kAvx512Lanes) {
        const __m512    distance2 = measure16(block, shell, first);
        const __mmask16 inside    = _mm512_cmp_ps_mask(distance2, _mm512_set1_ps(shell.inner2), _CMP_LE_OQ);
        const __mmask16 near      = _mm512_cmp_ps_mask(distance2, _mm512_set1_ps(shell.outer2), _CMP_LE_OQ);
        const __m512i   points    = _mm512_load_si512(block.point + first);
        // Goes through a register: compressing straight into memory takes some hundred cycles on AMD Zen 4.
        _mm512_storeu_si512(certain + count, _mm512_maskz_compress_epi32(inside, points));
        count += static_cast<unsigned>(__builtin_popcount(inside));
        doubtful |= static_cast<std::uint32_t>(near & ~inside) << first;
    }
    return count;
}
__attribute__((target("avx512f"))) inline std::uint32_t measureAvx512(const PointBlock& block, const Shell& shell,
                                                                      float* distance2)
{
    std::uint32_t near = 0;
    for (int first = 0; first < kBlockPoints; first += kAvx512Lanes) {
        const __m512 d2 = measure16(block, shell, first);
        _mm512_storeu_ps(distance2 + first, d2);
        near |= static_cast<std::uint32_t>(_mm512_cmp_ps_mask(d2, _mm512_set1_ps(shell.outer2), _CMP_LE_OQ)) << first;
    }
    return near;
}
#endif

} // namespace detail

/// Returns the filters for each kind of processor, the fastest that this one runs first. The choice is made at run
/// time, so that one binary serves every x86-64, and not by target_clones, whose resolvers run before the sanitizers
/// start.
[[nodiscard]] inline std::vector<BlockFilter> blockFilters()
{
    std::vector<BlockFilter> filters;
#if defined(__x86_64__)
    if (__builtin_cpu_supports("avx512f")) filters.push_back({detail::gatherAvx512, detail::measureAvx512});
    if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") && __builtin_cpu_supports("bmi2"))
        filters.push_back({detail::gatherAvx2, detail::measureAvx2});
#endif
    filters.push_back({detail::gatherPortable, detail::measurePortable});
    return filters;
}

} // namespace palp
