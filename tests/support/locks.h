#pragma once
#include <cstddef>

namespace palp {

/// Locks taken and waits begun on the calling thread so far, of any mutex, read-write lock, condition or semaphore.
/// \return 0 always under ThreadSanitizer, which has to see these calls itself
[[nodiscard]] std::size_t locksOfThisThread() noexcept;

/// Whether locks are counted in this build.
[[nodiscard]] bool locksAreCounted() noexcept;

} // namespace palp
