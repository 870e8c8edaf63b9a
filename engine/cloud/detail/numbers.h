#pragma once
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "engine/cloud/detail/byte_reader.h"
#include "engine/cloud/detail/scalar_type.h"

namespace palp {

/// A file that lies in memory whole, because its parts refer to each other.
struct WholeFile {
    const ByteReader& reader;
    std::string_view  text; ///< all of it

    /// Refuses the file at one of its characters.
    /// \throws Error "NAME: line N: MESSAGE"
    [[noreturn]] void failAtLine(const char* at, const std::string& message) const;

    /// Refuses the file at one of its characters.
    /// \throws Error "NAME: byte N: MESSAGE"
    [[noreturn]] void failAtByte(const char* at, const std::string& message) const;
};

/// The numbers of an array of a file, as words or as bytes, read once and in order.
/// \thread one
class Numbers {
public:
    /// \param what  describes the array in errors, such as "array \"E\""
    /// \param text  part of the file
    Numbers(const WholeFile& file, std::string what, std::string_view text);

    /// \param bytes  unpacked already
    Numbers(const WholeFile& file, std::string what, ScalarType type, std::endian order, std::vector<std::byte> bytes);

    /// \param bytes  part of the file
    Numbers(const WholeFile& file, std::string what, ScalarType type, std::endian order,
            std::span<const std::byte> bytes);

    Numbers(Numbers&&) = default;

    /// Returns the next number.
    /// \throws Error if there is none, or the word is no number
    [[nodiscard]] double next();

    /// Returns the next number, which must be whole and from 0 to below `end`.
    [[nodiscard]] std::uint64_t nextIndex(std::uint64_t end);

    /// Refuses an array that is too short for so many numbers, before memory is taken for what they are made to.
    void expectAtLeast(std::uint64_t tuples, std::uint64_t numbersPerTuple) const;

    /// Refuses an array with more numbers than were read.
    void expectEnd();

    /// Refuses the array at the next number.
    /// \throws Error naming the array and the place
    [[noreturn]] void fail(const std::string& message) const;

private:
    void skipBlanks() noexcept;

    const WholeFile&           file_;
    std::string                what_;
    bool                       isText_;
    std::string_view           text_; ///< what is left
    std::vector<std::byte>     own_;
    std::span<const std::byte> bytes_; ///< what is left
    ScalarType                 type_  = ScalarType::float64;
    std::endian                order_ = std::endian::little;
    std::uint64_t              read_  = 0;
};

} // namespace palp
