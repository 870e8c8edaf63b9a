#pragma once
#include <array>
#include <cstdint>

namespace palp {

/// Three points of a cloud by their index, in the order of the file. Which side of it is the outer one depends on who
/// wrote the file.
using Triangle = std::array<std::uint32_t, 3>;

} // namespace palp
