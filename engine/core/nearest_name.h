#pragma once
#include <optional>
#include <span>
#include <string_view>

namespace palp {

/// The known name that someone who typed `name` most likely meant: the one that fewest slips turn it into (a letter
/// too many, too few, wrong, or two swapped), and the first of equally near ones. Empty if more than a third of the
/// letters are slips. Capitals count as their small letters, and '-' as '_'.
/// \thread pure
/// \source Damerau 1964, "A technique for computer detection and correction of spelling errors" (each pair of letters
/// is swapped at most once)
[[nodiscard]] std::optional<std::string_view> nearestName(std::string_view                  name,
                                                          std::span<const std::string_view> known);

} // namespace palp
