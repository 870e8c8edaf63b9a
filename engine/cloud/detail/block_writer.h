#pragma once
#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstring>
#include <ostream>
#include <string>
#include <string_view>

namespace palp {

/// Hands small pieces to a stream in large blocks.
/// \thread one
class BlockWriter {
public:
    explicit BlockWriter(std::ostream& stream) : stream_(stream) {}

    void append(std::string_view bytes)
    {
        block_ += bytes;
        if (block_.size() >= kBlock) flush();
    }

    /// Appends the bytes of a number in the given order.
    template <class Number>
    void appendNumber(Number value, std::endian order)
    {
        std::array<char, sizeof(Number)> bytes;
        std::memcpy(bytes.data(), &value, sizeof value);
        if (order != std::endian::native) std::reverse(bytes.begin(), bytes.end());
        append({bytes.data(), bytes.size()});
    }

    /// Writes everything appended so far to the stream. The destructor does not flush, so that nothing is written while
    /// an exception unwinds.
    void flush()
    {
        stream_.write(block_.data(), std::streamsize(block_.size()));
        block_.clear();
    }

private:
    static constexpr std::size_t kBlock = std::size_t(1) << 18; ///< [bytes] so that the stream's calls cost nothing

    std::ostream& stream_;
    std::string   block_;
};

} // namespace palp
