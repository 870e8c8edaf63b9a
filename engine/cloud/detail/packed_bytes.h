#pragma once
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "engine/cloud/detail/numbers.h"

namespace palp {

/// Bytes in a part of a file, as they are or in base 64, taken one after the other.
/// \thread one
class PackedBytes {
public:
    enum class Spelling { raw, base64 };

    /// \param text  part of the file that begins with the bytes; more may follow them
    PackedBytes(const WholeFile& file, std::string_view text, Spelling spelling);

    /// Returns the next bytes. In base 64 padding in their midst is skipped: some writers spell a header and its data
    /// one after the other.
    /// \throws Error naming the place if the part ends before
    [[nodiscard]] std::vector<std::byte> take(std::uint64_t count);

private:
    void takeGroup();

    const WholeFile&       file_;
    std::string_view       text_; ///< what is left
    Spelling               spelling_;
    std::vector<std::byte> spare_; ///< of the last four characters, at most two bytes
};

/// The sizes before the bytes of an array, as VTK's XML files have them.
struct BlockForm {
    std::size_t sizeBytes  = 4; ///< of each size: 4 or 8
    std::endian order      = std::endian::little;
    bool        compressed = false; ///< by zlib, in blocks
};

/// Returns the bytes of an array: either its size and then the bytes; or compressed the number of blocks, the size of
/// a block, that of the last if it is smaller, the compressed sizes, and then the blocks.
/// \source VTK, "VTK XML formats": the header of compressed arrays
[[nodiscard]] std::vector<std::byte> arrayBytes(const WholeFile& file, PackedBytes& packed, const BlockForm& form);

} // namespace palp
