#include "engine/session/marker.h"

#include <cstdint>

namespace palp {
namespace {

/// A character of UTF-8 at the beginning of a text.
struct Character {
    std::size_t   bytes = 0; ///< 0: none, the first byte begins no character
    std::uint32_t code  = 0;
};

/// Decodes the shortest form only, and no surrogates, as the standard demands.
Character firstOf(std::string_view text)
{
    const auto byte = [&](std::size_t at) { return std::uint32_t(static_cast<unsigned char>(text[at])); };
    if (byte(0) < 0x80) return {1, byte(0)};
    const std::size_t count = byte(0) >= 0xF0 ? 4 : byte(0) >= 0xE0 ? 3 : 2;
    if (byte(0) < 0xC2 || byte(0) > 0xF4 || text.size() < count) return {};
    std::uint32_t code = byte(0) & (0xFFU >> (count + 1));
    for (std::size_t k = 1; k < count; ++k) {
        if ((byte(k) & 0xC0U) != 0x80) return {};
        code = code << 6U | (byte(k) & 0x3FU);
    }
    constexpr std::uint32_t kLeast[] = {0, 0, 0x80, 0x800, 0x10000};
    const bool              good     = code >= kLeast[count] && code <= 0x10FFFF && (code < 0xD800 || code > 0xDFFF);
    return good ? Character{count, code} : Character{};
}

/// Returns true for C0, DEL and C1, and for the line separators and the marks that turn the direction of a text.
bool isControl(std::uint32_t code)
{
    return code < 0x20 || (code >= 0x7F && code < 0xA0) || (code >= 0x2028 && code <= 0x202E) ||
           (code >= 0x2066 && code <= 0x2069);
}

} // namespace

std::string markerText(std::string_view bytes)
{
    constexpr std::string_view kUnknown = "\xEF\xBF\xBD";
    std::string                text;
    while (!bytes.empty()) {
        const Character        next  = firstOf(bytes);
        const std::string_view piece = next.bytes == 0        ? kUnknown
                                       : isControl(next.code) ? std::string_view(" ")
                                                              : bytes.substr(0, next.bytes);
        if (text.size() + piece.size() > kMostOfMarker) break;
        if (!(text.empty() && piece == " ")) text += piece;
        bytes.remove_prefix(next.bytes == 0 ? 1 : next.bytes);
    }
    text.resize(text.find_last_not_of(' ') + 1);
    return text.empty() ? "marker" : text;
}

} // namespace palp
