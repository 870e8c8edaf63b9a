#pragma once
#include <cstdint>

namespace palp {

/// Largest cell number along an axis that mortonCode takes: 21 bits for each of three axes.
inline constexpr std::uint32_t kMortonCells = std::uint32_t(1) << 21;

/// Moves bit i of a 21-bit number to bit 3 i.
[[nodiscard]] constexpr std::uint64_t spreadByThree(std::uint64_t bits) noexcept
{
    bits = (bits | bits << 32) & 0x001f00000000ffff;
    bits = (bits | bits << 16) & 0x001f0000ff0000ff;
    bits = (bits | bits << 8) & 0x100f00f00f00f00f;
    bits = (bits | bits << 4) & 0x10c30c30c30c30c3;
    return (bits | bits << 2) & 0x1249249249249249;
}

/// Returns the position along the Morton (Z-order) curve of a cell: its three numbers with their bits interleaved, so
/// that cells with near codes are near in space.
/// \param x, y, z  below kMortonCells
[[nodiscard]] constexpr std::uint64_t mortonCode(std::uint32_t x, std::uint32_t y, std::uint32_t z) noexcept
{
    return spreadByThree(x) << 2 | spreadByThree(y) << 1 | spreadByThree(z);
}

} // namespace palp
