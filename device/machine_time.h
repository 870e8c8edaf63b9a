#pragma once
#include <chrono>

namespace palp {

/// Returns the time by the machine's clock that never goes back [s].
[[nodiscard]] inline double machineTime() noexcept
{
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

} // namespace palp
