#pragma once
#include <cmath>
#include <cstdint>

namespace palp::soak {

/// Random numbers that are the same on every machine.
/// \source Steele, Lea & Flood 2014, "Fast splittable pseudorandom number generators" (SplitMix64)
class Chance {
public:
    explicit Chance(std::uint64_t seed) : state_(seed) {}

    std::uint64_t bits() noexcept
    {
        std::uint64_t z = state_ += 0x9e3779b97f4a7c15U;
        z               = (z ^ (z >> 30U)) * 0xbf58476d1ce4e5b9U;
        z               = (z ^ (z >> 27U)) * 0x94d049bb133111ebU;
        return z ^ (z >> 31U);
    }

    double real() noexcept { return double(bits() >> 11U) * 0x1p-53; } ///< from 0 to below 1
    double from(double least, double most) noexcept { return least + (most - least) * real(); }
    /// A number whose logarithm is even between those of the limits.
    double scaleFrom(double least, double most) noexcept { return least * std::pow(most / least, real()); }
    int    below(int count) noexcept { return int(bits() % std::uint64_t(count)); } ///< from 0 to count - 1
    bool   is(double probability) noexcept { return real() < probability; }

private:
    std::uint64_t state_;
};

} // namespace palp::soak
