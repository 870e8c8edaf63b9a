#pragma once

namespace palp {

/// Whether this program is checked by AddressSanitizer or ThreadSanitizer: then it is some ten times as slow, its shadow
/// memory is outside of every limit, and what would be a signal may end it with a report instead.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
inline constexpr bool kSanitized = true;
#else
inline constexpr bool kSanitized = false;
#endif

} // namespace palp
