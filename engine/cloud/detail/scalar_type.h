#pragma once
#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>

namespace palp {

/// The types a number can have in a PLY or PCD file.
enum class ScalarType { int8, uint8, int16, uint16, int32, uint32, int64, uint64, float32, float64 };

/// Returns the size of a type [bytes].
[[nodiscard]] constexpr std::size_t sizeOf(ScalarType type) noexcept
{
    switch (type) {
    case ScalarType::int8:
    case ScalarType::uint8:
        return 1;
    case ScalarType::int16:
    case ScalarType::uint16:
        return 2;
    case ScalarType::int32:
    case ScalarType::uint32:
    case ScalarType::float32:
        return 4;
    default:
        return 8;
    }
}

[[nodiscard]] constexpr bool isFloat(ScalarType type) noexcept
{
    return type == ScalarType::float32 || type == ScalarType::float64;
}

/// Reads a number of type T that lies at any address in the given byte order.
template <class T>
[[nodiscard]] T loadAs(const std::byte* bytes, std::endian order) noexcept
{
    std::array<std::byte, sizeof(T)> copy;
    std::memcpy(copy.data(), bytes, sizeof(T));
    if (order != std::endian::native) std::reverse(copy.begin(), copy.end());
    return std::bit_cast<T>(copy);
}

/// Reads a number as a double; 64-bit integers beyond 2^53 are rounded.
[[nodiscard]] inline double loadScalar(ScalarType type, const std::byte* bytes, std::endian order) noexcept
{
    switch (type) {
    case ScalarType::int8:
        return loadAs<std::int8_t>(bytes, order);
    case ScalarType::uint8:
        return loadAs<std::uint8_t>(bytes, order);
    case ScalarType::int16:
        return loadAs<std::int16_t>(bytes, order);
    case ScalarType::uint16:
        return loadAs<std::uint16_t>(bytes, order);
    case ScalarType::int32:
        return loadAs<std::int32_t>(bytes, order);
    case ScalarType::uint32:
        return loadAs<std::uint32_t>(bytes, order);
    case ScalarType::int64:
        return double(loadAs<std::int64_t>(bytes, order));
    case ScalarType::uint64:
        return double(loadAs<std::uint64_t>(bytes, order));
    case ScalarType::float32:
        return double(loadAs<float>(bytes, order));
    case ScalarType::float64:
        return loadAs<double>(bytes, order);
    }
    return 0;
}

} // namespace palp
