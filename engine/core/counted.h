#pragma once
#include <cstddef>
#include <string>

namespace palp {

/// Returns "1 trial", "2 trials".
/// \param ending  of the plural: "es" for a patch
[[nodiscard]] inline std::string counted(std::size_t number, const std::string& what, const char* ending = "s")
{
    return std::to_string(number) + " " + what + (number == 1 ? "" : ending);
}

/// Returns "1 point lies", "2 points lie".
[[nodiscard]] inline std::string counted(std::size_t number, const std::string& what, const char* ofOne,
                                         const char* ofMore)
{
    return counted(number, what) + " " + (number == 1 ? ofOne : ofMore);
}

} // namespace palp
