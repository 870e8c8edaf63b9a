#pragma once
#include <cstddef>

namespace palp {

/// How many times this program has asked for memory by `new`, from any thread.
[[nodiscard]] std::size_t allocations() noexcept;

} // namespace palp
