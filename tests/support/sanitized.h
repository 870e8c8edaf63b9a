#pragma once

namespace palp {

/// Whether this program is checked by AddressSanitizer or ThreadSanitizer: then it is some ten times as slow, its
/// shadow memory is outside of every limit, and what would be a signal may end it with a report instead.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__) // GCC
inline constexpr bool kSanitized = true;
#elif defined(__has_feature) // clang
inline constexpr bool kSanitized = __has_feature(address_sanitizer) || __has_feature(thread_sanitizer);
#else
inline constexpr bool kSanitized = false;
#endif

} // namespace palp
