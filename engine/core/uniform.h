#pragma once
#include <cstdint>
#include <random>

namespace palp {

/// A source of random numbers that are the same on every machine: the standard fixes the bits of mt19937_64 but not of
/// its distributions.
class Uniform {
public:
    explicit Uniform(std::uint64_t seed) : bits_(seed) {}
    double operator()() { return double(bits_() >> 11) * 0x1p-53; } ///< in [0, 1)
    double operator()(double low, double high) { return low + (high - low) * (*this)(); }

private:
    std::mt19937_64 bits_;
};

} // namespace palp
