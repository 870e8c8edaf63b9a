#pragma once
#include <cstddef>
#include <optional>
#include <string_view>

namespace palp {

/// Levels that lists and objects may have in JSON from outside [1]; ours have six at most. The library reads any number,
/// but copies, compares and prints by recursion: 200 kB of brackets overflowed the stack.
inline constexpr int kDeepestJson = 100;

/// Returns the byte at which a text opens a level beyond kDeepestJson; nothing if it never does. Comments, /* */ and
/// //, are skipped. Text that is no JSON may be judged wrongly, but only behind the byte where a parser stops.
[[nodiscard]] std::optional<std::size_t> tooDeepAt(std::string_view json) noexcept;

} // namespace palp
