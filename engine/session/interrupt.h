#pragma once
#include <atomic>

namespace palp {

/// From now on Ctrl-C and a request to end make this true, so that a session ends in order: zero force, a recording
/// that is complete. A second one ends the program.
[[nodiscard]] const std::atomic<bool>& catchInterrupts();

} // namespace palp
