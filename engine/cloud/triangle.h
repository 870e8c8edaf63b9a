#pragma once
#include <array>
#include <cstdint>

namespace palp {

/// Three points of a cloud by their index, in the order of the file. The file's author chose which side is the outer
/// one.
using Triangle = std::array<std::uint32_t, 3>;

} // namespace palp
