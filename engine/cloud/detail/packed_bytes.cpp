#include "engine/cloud/detail/packed_bytes.h"

#include <algorithm>
#include <array>
#include <optional>

#include <zlib.h>

namespace palp {
namespace {

constexpr std::uint64_t kMostBlockSize = 1u << 30; ///< [bytes]; VTK's own are 32 KiB

/// Returns the six bits that a character of base 64 stands for.
std::optional<std::uint32_t> sixBits(char c)
{
    if (c >= 'A' && c <= 'Z') return c - 'A';
    if (c >= 'a' && c <= 'z') return c - 'a' + 26;
    if (c >= '0' && c <= '9') return c - '0' + 52;
    if (c == '+') return 62;
    if (c == '/') return 63;
    return std::nullopt;
}

} // namespace

PackedBytes::PackedBytes(const WholeFile& file, std::string_view text, Spelling spelling)
    : file_(file), text_(text), spelling_(spelling)
{
}

void PackedBytes::takeGroup()
{
    std::uint32_t bits   = 0;
    std::size_t   digits = 0, padding = 0;
    while (digits + padding < 4) {
        text_.remove_prefix(std::min(text_.find_first_not_of(" \t\r\n"), text_.size()));
        const char c = text_.empty() ? '<' : text_.front();
        if (c == '=') {
            bits <<= 6;
            ++padding;
        } else if (const auto six = sixBits(c); six && padding == 0) {
            bits = bits << 6 | *six;
            ++digits;
        } else {
            file_.failAtByte(text_.data(),
                             "expected more bytes in base 64, found " +
                                 (text_.empty() ? std::string("their end") : inQuotes(text_.substr(0, 1))));
        }
        text_.remove_prefix(1);
    }
    if (digits < 2) file_.failAtByte(text_.data() - 1, "expected bytes in base 64, found only \"=\"");
    for (std::size_t k = 0; k + 1 < digits; ++k) spare_.push_back(std::byte(bits >> (16 - 8 * k) & 0xFF));
}

std::vector<std::byte> PackedBytes::take(std::uint64_t count)
{
    const std::uint64_t room = spelling_ == Spelling::raw ? text_.size() : spare_.size() + text_.size() / 4 * 3;
    if (count > room)
        file_.failAtByte(text_.data(), "expected " + std::to_string(count) + " more bytes of an array, found at most " +
                                           std::to_string(room) + "; was the file cut short?");
    std::vector<std::byte> bytes;
    if (spelling_ == Spelling::raw) {
        const auto* const begin = reinterpret_cast<const std::byte*>(text_.data());
        bytes.assign(begin, begin + count);
        text_.remove_prefix(count);
        return bytes;
    }
    bytes.reserve(count);
    while (bytes.size() < count) {
        if (spare_.empty()) takeGroup();
        const std::size_t used = std::min<std::size_t>(spare_.size(), count - bytes.size());
        bytes.insert(bytes.end(), spare_.begin(), spare_.begin() + std::ptrdiff_t(used));
        spare_.erase(spare_.begin(), spare_.begin() + std::ptrdiff_t(used));
    }
    return bytes;
}

std::vector<std::byte> arrayBytes(const WholeFile& file, PackedBytes& packed, const BlockForm& form)
{
    const auto nextSize = [&]() -> std::uint64_t {
        const std::vector<std::byte> bytes = packed.take(form.sizeBytes);
        return form.sizeBytes == 8 ? loadAs<std::uint64_t>(bytes.data(), form.order)
                                   : loadAs<std::uint32_t>(bytes.data(), form.order);
    };
    if (!form.compressed) return packed.take(nextSize());

    const std::uint64_t blocks = nextSize(), blockSize = nextSize(), lastSize = nextSize();
    if (blocks == 0) return {};
    if (blockSize > kMostBlockSize || lastSize > blockSize || blocks > file.text.size())
        file.reader.fail("expected compressed blocks of up to 1 GiB, found " + std::to_string(blocks) + " of " +
                         std::to_string(blockSize) + " bytes, the last of " + std::to_string(lastSize));
    const std::uint64_t size = (blocks - 1) * blockSize + (lastSize > 0 ? lastSize : blockSize);
    file.reader.checkUnpacked(size);
    std::vector<std::uint64_t> packedSizes(blocks);
    for (std::uint64_t& packedSize : packedSizes) packedSize = nextSize();

    std::vector<std::byte> bytes(size);
    std::uint64_t          at = 0;
    for (std::uint64_t block = 0; block < blocks; ++block) {
        const std::vector<std::byte> data     = packed.take(packedSizes[block]);
        const std::uint64_t          expected = std::min(blockSize, size - at);
        uLongf                       found    = expected;
        const int                    status   = uncompress(reinterpret_cast<Bytef*>(bytes.data() + at), &found,
                                                           reinterpret_cast<const Bytef*>(data.data()), uLong(data.size()));
        if (status != Z_OK || found != expected)
            file.reader.fail("block " + std::to_string(block) + " of an array: expected " + std::to_string(expected) +
                             " bytes compressed by zlib, found " +
                             (status == Z_OK ? std::to_string(found) : std::string("damaged ones")));
        at += expected;
    }
    return bytes;
}

} // namespace palp
