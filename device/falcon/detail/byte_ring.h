#pragma once
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace palp {

/// A ring of the newest `Size` bytes that came in and were not read yet.
/// \thread one; fixed memory
template <std::size_t Size>
class ByteRing {
public:
    [[nodiscard]] bool empty() const noexcept { return held_ == 0; }

    void put(std::span<const std::uint8_t> bytes) noexcept
    {
        for (const std::uint8_t byte : bytes) {
            bytes_[(oldest_ + held_) % Size] = byte;
            if (held_ < Size)
                ++held_;
            else
                oldest_ = (oldest_ + 1) % Size;
        }
    }

    /// Reads the oldest bytes first.
    /// \return how many of `bytes` were filled
    std::size_t take(std::span<std::uint8_t> bytes) noexcept
    {
        const std::size_t taken = std::min(bytes.size(), held_);
        for (std::size_t n = 0; n < taken; ++n) bytes[n] = bytes_[(oldest_ + n) % Size];
        oldest_ = (oldest_ + taken) % Size;
        held_ -= taken;
        return taken;
    }

private:
    std::array<std::uint8_t, Size> bytes_{};
    std::size_t                    oldest_ = 0, held_ = 0;
};

} // namespace palp
