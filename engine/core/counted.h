#pragma once
#include <cstddef>
#include <string>

namespace palp {

/// Returns "1 trial", "2 trials".
[[nodiscard]] inline std::string counted(std::size_t number, const std::string& what)
{
    return std::to_string(number) + " " + what + (number == 1 ? "" : "s");
}

} // namespace palp
