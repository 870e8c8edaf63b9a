#pragma once
#include <optional>
#include <span>
#include <string_view>

namespace palp {

/// Returns the known name that a user who typed `name` most likely meant: the one at the fewest slips (a letter too
/// many, too few, wrong, or two swapped), and the first of equally near ones. It is empty if more than a third of the
/// letters are slips. Capitals count as their small letters, and '-' as '_'.
/// \thread pure
/// \source Damerau 1964, "A technique for computer detection and correction of spelling errors" (each pair of letters
/// is swapped at most once)
[[nodiscard]] std::optional<std::string_view> nearestName(std::string_view                  name,
                                                          std::span<const std::string_view> known);

} // namespace palp
