// float_pair.h - numbers of 48 binary digits as sums of two floats (GLSL and C++).
//
// For sums that need more than floats on processors whose doubles are slow, or that have none. Only sums, differences
// and products are used, each rounded on its own: the shaders say `precise`, because a compiler that fuses or reorders
// them would lose the lower part.
//
// Source   Dekker 1971 (products), Knuth 1969 (sums)
#ifndef PALPATE_FLOAT_PAIR_H
#define PALPATE_FLOAT_PAIR_H

#include "compute_shaders/shared/plate_level.h"

#ifdef __cplusplus
#define PALPATE_PRECISE
namespace palp::shared {
#else
#define PALPATE_PRECISE precise
#endif

struct FloatPair {
    float high;
    float low; // at most half a unit in the last place of the other
};

// What rounding a + b to a float loses.
PALPATE_INLINE float lostBySum(float a, float b, float sum)
{
    PALPATE_PRECISE float ofB = sum - a, ofA = sum - ofB;
    PALPATE_PRECISE float lost = (a - ofA) + (b - ofB);
    return lost;
}

// The upper 12 of a float's 24 digits. Not for numbers beyond 1e34.
PALPATE_INLINE float upperHalf(float a)
{
    PALPATE_PRECISE float c = 4097.0f * a, d = c - a;
    PALPATE_PRECISE float upper = c - d;
    return upper;
}

// What rounding a * b to a float loses.
PALPATE_INLINE float lostByProduct(float a, float b, float product)
{
    PALPATE_PRECISE float a1 = upperHalf(a), b1 = upperHalf(b), a2 = a - a1, b2 = b - b1;
    PALPATE_PRECISE float lost = ((a1 * b1 - product) + a1 * b2 + a2 * b1) + a2 * b2;
    return lost;
}

// sum + a b
PALPATE_INLINE FloatPair plusProduct(FloatPair sum, FloatPair a, float b)
{
    PALPATE_PRECISE float product = a.high * b, high = sum.high + product;
    PALPATE_PRECISE float low     = (sum.low + a.low * b) + lostByProduct(a.high, b, product);
    low                           = low + lostBySum(sum.high, product, high);
    PALPATE_PRECISE float rounded = high + low, rest = low - (rounded - high);
    FloatPair             result;
    result.high = rounded;
    result.low  = rest;
    return result;
}

#undef PALPATE_PRECISE
#ifdef __cplusplus
} // namespace palp::shared
#endif
#endif
