#pragma once
#include <array>
#include <charconv>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>

namespace palp {

/// What spreadsheets and editors put before text in UTF-8.
inline constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";

/// Takes the next word off the front of `rest`: the text between blanks and tabs; empty if there is none.
[[nodiscard]] inline std::string_view nextWord(std::string_view& rest)
{
    const auto  blank = [](char c) { return c == ' ' || c == '\t'; };
    std::size_t begin = 0;
    while (begin < rest.size() && blank(rest[begin])) ++begin;
    std::size_t end = begin;
    while (end < rest.size() && !blank(rest[end])) ++end;
    const std::string_view word = rest.substr(begin, end - begin);
    rest.remove_prefix(end);
    return word;
}

/// Returns the text without blanks and tabs at either end.
[[nodiscard]] inline std::string_view trimmed(std::string_view text)
{
    const std::size_t first = text.find_first_not_of(" \t");
    if (first == std::string_view::npos) return {};
    return text.substr(first, text.find_last_not_of(" \t") - first + 1);
}

/// Returns the number that the whole word is, nan and inf included; nothing if it is none or a double cannot hold it.
[[nodiscard]] inline std::optional<double> parseNumber(std::string_view word)
{
    if (word.starts_with('+') && !word.starts_with("+-")) word.remove_prefix(1);
    double            number{};
    const char* const end        = word.data() + word.size();
    const auto [stopped, status] = std::from_chars(word.data(), end, number);
    if (status != std::errc() || stopped != end) return std::nullopt;
    return number;
}

/// Returns the non-negative whole number below 2^64 that the whole word is.
[[nodiscard]] inline std::optional<std::uint64_t> parseCount(std::string_view word)
{
    std::uint64_t     number{};
    const char* const end        = word.data() + word.size();
    const auto [stopped, status] = std::from_chars(word.data(), end, number);
    if (status != std::errc() || stopped != end) return std::nullopt;
    return number;
}

/// Returns the shortest text that reads back as the same float or double.
template <class Number>
[[nodiscard]] std::string shown(Number value)
{
    std::array<char, 32> text; // the longest is -2.2250738585072014e-308
    return {text.data(), std::to_chars(text.data(), text.data() + text.size(), value).ptr};
}

} // namespace palp
