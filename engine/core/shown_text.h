#pragma once
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace palp {

/// A character of UTF-8 at the beginning of a text.
struct Utf8Character {
    std::size_t   bytes = 0; ///< 0: none, the first byte begins no character
    std::uint32_t code  = 0;
};

/// Decodes the shortest form only, and no surrogates, as the standard demands.
/// \pre the text is not empty
[[nodiscard]] Utf8Character firstCharacter(std::string_view text) noexcept;

/// Returns true for C0, DEL and C1, and for the line separators and the marks that turn the direction of a text.
[[nodiscard]] bool isControl(std::uint32_t code) noexcept;

/// Returns a text that comes from outside as one line that a terminal and a file of JSON can take: a question mark
/// stands for each control character, which a terminal would obey, and for each byte that is no UTF-8.
/// \param most  [bytes] if it is longer, its beginning and "..."
[[nodiscard]] std::string shownText(std::string_view text, std::size_t most = std::string_view::npos);

/// The most of a file's own word that an error repeats [bytes].
inline constexpr std::size_t kMostOfWord = 60;

/// Returns a path as shownText() does, and of a long one "..." and its end, which has the file's name.
[[nodiscard]] std::string shownPath(std::string_view path);

/// Returns a file's own word in quotes, at most kMostOfWord of it.
[[nodiscard]] std::string inQuotes(std::string_view text);

} // namespace palp
