#pragma once
#include <cstddef>

namespace palp {

/// Returns how many locks were taken and waits begun on the calling thread so far, of any mutex, read-write lock,
/// condition or semaphore.
/// \return always 0 under ThreadSanitizer, which has to see these calls itself
[[nodiscard]] std::size_t locksOfThisThread() noexcept;

/// Returns true if locks are counted in this build.
[[nodiscard]] bool locksAreCounted() noexcept;

} // namespace palp
