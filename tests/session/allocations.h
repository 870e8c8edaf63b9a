#pragma once
#include <cstddef>

namespace palp {

/// How often this thread has called operator new since it began [1]; the program that links allocations.cpp counts.
[[nodiscard]] std::size_t allocationsOfThisThread() noexcept;

} // namespace palp
