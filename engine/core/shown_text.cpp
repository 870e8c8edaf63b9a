#include "engine/core/shown_text.h"

#include <algorithm>

#include "engine/core/contract.h"

namespace palp {

Utf8Character firstCharacter(std::string_view text) noexcept
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
    return good ? Utf8Character{count, code} : Utf8Character{};
}

bool isControl(std::uint32_t code) noexcept
{
    return code < 0x20 || (code >= 0x7F && code < 0xA0) || (code >= 0x2028 && code <= 0x202E) ||
           (code >= 0x2066 && code <= 0x2069);
}

std::string shownText(std::string_view text, std::size_t most)
{
    std::string shown;
    while (!text.empty()) {
        const auto [bytes, code]     = firstCharacter(text);
        const std::string_view piece = bytes == 0 || isControl(code) ? "?" : text.substr(0, bytes);
        if (shown.size() + piece.size() > most) return shown + "...";
        shown += piece;
        text.remove_prefix(std::max<std::size_t>(bytes, 1));
    }
    return shown;
}

std::string shownPath(std::string_view path)
{
    constexpr std::size_t kMost = 200; // [bytes]
    std::string           shown = shownText(path);
    if (shown.size() <= kMost) return shown;
    std::size_t cut = shown.size() - kMost;
    while ((static_cast<unsigned char>(shown[cut]) & 0xC0U) == 0x80) ++cut; // to where a character begins
    return "..." + shown.substr(cut);
}

std::string inQuotes(std::string_view text)
{
    return '"' + shownText(text, kMostOfWord) + '"';
}

Error::Error(std::string_view sentence) : std::runtime_error(shownText(sentence)) {}

} // namespace palp
