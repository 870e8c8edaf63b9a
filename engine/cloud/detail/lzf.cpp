#include "engine/cloud/detail/lzf.h"

#include <algorithm>

namespace palp {
namespace {

constexpr std::size_t kFirstRepeat  = 32; ///< smallest control byte that is no literal run
constexpr std::size_t kLongForm     = 7;  ///< length to which the next byte is added
constexpr std::size_t kLeastRepeat  = 2;  ///< bytes beyond the length that is stored
constexpr std::size_t kBitsOfLength = 5;  ///< position of the length in the control byte

} // namespace

std::optional<std::string> unpackLzf(std::span<const std::byte> packed, std::span<std::byte> unpacked)
{
    std::size_t in = 0, out = 0;
    const auto  wrong = [&](const char* what) { return "packed byte " + std::to_string(in) + ": " + what; };
    const auto  next  = [&] { return std::size_t(packed[in++]); };
    while (in < packed.size()) {
        const std::size_t control = next();
        if (control < kFirstRepeat) {
            const std::size_t count = control + 1;
            if (count > packed.size() - in) return wrong("a run of bytes goes beyond the end");
            if (count > unpacked.size() - out) return wrong("unpacks to more bytes than the file states");
            std::copy_n(packed.begin() + std::ptrdiff_t(in), count, unpacked.begin() + std::ptrdiff_t(out));
            in += count;
            out += count;
            continue;
        }
        std::size_t length = control >> kBitsOfLength;
        if (packed.size() - in < (length == kLongForm ? 2U : 1U)) return wrong("a repetition lacks its distance");
        if (length == kLongForm) length += next();
        const std::size_t distance = ((control & (kFirstRepeat - 1)) << 8) + next() + 1;
        const std::size_t count    = length + kLeastRepeat;
        if (distance > out) return wrong("a repetition begins before the first byte");
        if (count > unpacked.size() - out) return wrong("unpacks to more bytes than the file states");
        for (std::size_t k = 0; k < count; ++k, ++out) unpacked[out] = unpacked[out - distance]; // may overlap itself
    }
    if (out < unpacked.size())
        return wrong("the packed bytes end early") + ": expected " + std::to_string(unpacked.size()) +
               " unpacked bytes, found " + std::to_string(out);
    return std::nullopt;
}

} // namespace palp
