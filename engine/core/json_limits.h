#pragma once
#include <cstddef>
#include <optional>
#include <string_view>

namespace palp {

/// Levels that lists and objects may have in JSON from outside [1]; ours have six at most. The library reads any
/// number, but copies, compares and prints by recursion: 200 kB of brackets overflowed the stack.
inline constexpr int kDeepestJson = 100;

/// Memory that JSON from outside may take once it is read: so many times its own size, and so many bytes beside it.
/// Objects with names and numbers take about 7 times their size; a list of empty objects took 57, 900 MB for a file of
/// 16 MiB.
inline constexpr std::size_t kMostPerByteOfJson = 8, kMostBesideJson = std::size_t(8) << 20;

/// What is too much about a text of JSON.
struct JsonExcess {
    std::size_t      at;   ///< the byte at which it gets too much
    std::string_view what; ///< "expected ..., found ..."
};

/// Returns where a text opens a level beyond kDeepestJson, or takes more memory than the above; nothing if it never
/// does. The memory is counted as nlohmann::json takes it to read the text and to free it. Comments, /* */ and //, are
/// skipped. Text that is no JSON may be judged wrongly, but only behind the byte where a parser stops.
/// \param input  size of what the text is a part of, such as a file [bytes]; 0: the text is all of it
[[nodiscard]] std::optional<JsonExcess> excessOf(std::string_view json, std::size_t input = 0) noexcept;

} // namespace palp
