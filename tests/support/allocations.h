#pragma once
#include <cstddef>

namespace palp {

/// Returns how often this thread has allocated memory since it began, by new, malloc() or related functions; under
/// sanitizers by new only. The program has to link allocations.cpp.
[[nodiscard]] std::size_t allocationsOfThisThread() noexcept;

} // namespace palp
