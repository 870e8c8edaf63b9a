#pragma once
#include <cstddef>

namespace palp {

/// How often this thread has taken memory since it began, by new, malloc() or its kin [1]; the program that links
/// allocations.cpp counts. Under sanitizers by new only.
[[nodiscard]] std::size_t allocationsOfThisThread() noexcept;

} // namespace palp
