#pragma once
#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>

namespace palp {

/// One value of an enumeration, and the word for it that users type and files spell.
template <class Enum>
struct NamedValue {
    Enum        value;
    const char* name;
};

/// An enumeration whose names stand in a table right below it. That table is the only place where they are spelled; its
/// order is that of help texts:
///
///     constexpr auto namesOf(ForceLaw)
///     {
///         using enum ForceLaw;
///         return std::to_array<NamedValue<ForceLaw>>({{series, "series"}, {paper, "paper"}});
///     }
template <class Enum>
concept NamedEnum = std::is_enum_v<Enum> && requires(Enum value)
{
    namesOf(value);
};

/// Returns the word for a value; "unknown" for one that the table lacks.
template <NamedEnum Enum>
[[nodiscard]] constexpr const char* name(Enum value) noexcept
{
    for (const auto& entry : namesOf(value))
        if (entry.value == value) return entry.name;
    return "unknown";
}

/// Returns the value that a word names; empty if no value has that name.
template <NamedEnum Enum>
[[nodiscard]] constexpr std::optional<Enum> valueNamed(std::string_view word) noexcept
{
    for (const auto& entry : namesOf(Enum{}))
        if (entry.name == word) return entry.value;
    return {};
}

/// Returns all the words as one phrase: "table, hold or blend".
template <NamedEnum Enum>
[[nodiscard]] std::string wordsOf()
{
    constexpr auto names = namesOf(Enum{});
    std::string    phrase;
    for (std::size_t n = 0; n < names.size(); ++n)
        phrase += std::string(n == 0 ? "" : n + 1 == names.size() ? " or " : ", ") + names[n].name;
    return phrase;
}

} // namespace palp
