#pragma once
#include <atomic>

namespace palp {

/// Makes Ctrl-C and a request to end, from now on, set the returned flag, so that a session ends in order: zero force
/// and a complete recording. A second one ends the program.
[[nodiscard]] const std::atomic<bool>& catchInterrupts();

} // namespace palp
