#pragma once
#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <iosfwd>
#include <span>
#include <string>

#include "engine/core/grid.h"

namespace palp {

/// Reads a two-dimensional .npy array (versions 1 to 3; float64 or float32, little endian, C order).
/// \throws Error naming the file and what was expected and found: another shape, type or order, a short file, or a
///         value that is not finite (with its index)
[[nodiscard]] NodeField readNpy(const std::filesystem::path& path);

/// Reads the same from a stream that holds exactly `size` bytes. It allocates no more than these bytes can fill.
/// \param name  name of the stream in errors
[[nodiscard]] NodeField parseNpy(std::istream& in, std::uint64_t size, const std::string& name);

/// What readNpyRows() tells its caller.
struct NpyRows {
    std::function<void(std::size_t rows, std::size_t columns)> begin; ///< once, before anything is allocated for rows
    std::function<void(std::span<const double> row)>           row;   ///< each row; its values need not be finite
    /// Once, last, if bytes follow the last row; without it they are refused.
    std::function<void(std::uint64_t from, std::uint64_t bytes)> tail{};
};

/// Reads the same row by row, for arrays that are no field of a grid.
/// \throws Error as parseNpy does, but for values that are not finite; and what the caller throws
void readNpyRows(std::istream& in, std::uint64_t size, const std::string& name, const NpyRows& to);

/// What readNpyVolume() tells its caller.
struct NpyVolume {
    /// Once, before anything is allocated: the sizes, and whether the first axis runs fastest instead of the last.
    std::function<void(const std::array<int, 3>& shape, bool firstIsFastest)> begin;
    std::function<void(std::span<const double> values)> values; ///< some that follow each other in the file
};

/// Reads an array of three dimensions, in C or Fortran order.
/// \throws Error as readNpyRows does
void readNpyVolume(std::istream& in, std::uint64_t size, const std::string& name, const NpyVolume& to);

/// Writes a field as a float64 .npy array of shape (nodesX, nodesZ), whole or not at all.
void writeNpy(const std::filesystem::path& path, const NodeField& field);

} // namespace palp
