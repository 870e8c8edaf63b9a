#pragma once
#include <bit>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "engine/cloud/detail/byte_reader.h"
#include "engine/cloud/detail/cloud_rows.h"
#include "engine/cloud/detail/scalar_type.h"

namespace palp {

struct PlyProperty {
    std::string               name;
    ScalarType                type{};
    std::optional<ScalarType> listCount;           ///< type of a list's length; empty: a single number
    std::size_t               slot       = kSlots; ///< RowSlot that it fills; kSlots: none
    bool                      holdsFaces = false;  ///< lists of points that make up a face
};

struct PlyElement {
    std::string              name;
    std::uint64_t            count = 0;
    std::vector<PlyProperty> properties;

    [[nodiscard]] bool hasList() const noexcept;
};

/// The declarations of a PLY file's header.
struct PlyHeader {
    CloudHeader             cloud;
    bool                    ascii = false;
    std::endian             order = std::endian::little;
    std::vector<PlyElement> elements;
    std::size_t             vertex = 0; ///< index of the element that holds the points

    /// Returns the fewest bytes that a row can take; in a text a number takes a digit and a separator.
    [[nodiscard]] std::uint64_t leastBytes(const PlyElement& element) const noexcept;
};

/// Reads the header of a file, up to and with the line end_header.
/// \throws Error naming the line, what was expected and what was found
[[nodiscard]] PlyHeader parsePlyHeader(ByteReader& reader);

/// Sets the slot that each property of a point fills.
void assignSlots(PlyElement& vertex, const CloudRows& rows);

/// Returns the length of a list whose bytes or word the reader has just passed.
/// \throws Error if it is no whole number from 0 up, or if a binary file has no room for as many items
[[nodiscard]] std::uint64_t listLength(const ByteReader& reader, const PlyProperty& list, const std::byte* bytes,
                                       std::endian order);
[[nodiscard]] std::uint64_t listLength(const ByteReader& reader, const PlyProperty& list, std::string_view word);

} // namespace palp
