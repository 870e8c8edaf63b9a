#pragma once
#include <bit>
#include <cstdint>
#include <cstdio>
#include <string>

namespace palp {

/// Sixteen hexadecimal digits that tell data apart: FNV-1a over their bits. They do not protect against malice.
class Fingerprint {
public:
    void add(std::uint64_t bits) noexcept
    {
        for (int k = 0; k < 8; ++k, bits >>= 8U) hash_ = (hash_ ^ (bits & 0xFFU)) * 1099511628211U;
    }
    void add(double value) noexcept { add(std::bit_cast<std::uint64_t>(value)); }

    [[nodiscard]] std::string text() const
    {
        char digits[17];
        std::snprintf(digits, sizeof digits, "%016llx", static_cast<unsigned long long>(hash_));
        return digits;
    }

private:
    std::uint64_t hash_ = 14695981039346656037U;
};

} // namespace palp
