#include "engine/core/json_depth.h"

#include <algorithm>

namespace palp {
namespace {

/// Returns the byte behind a text or a comment that begins at `i`, behind the end where it has none; `i` where none begins.
std::size_t behindText(std::string_view json, std::size_t i) noexcept
{
    constexpr std::string_view kLineEnds("\n\r\0", 3); // as the library has them
    const auto behind = [&](std::size_t found, std::size_t size) { return std::min(json.size(), found) + size; };
    const std::string_view two = json.substr(i, 2);
    if (two == "//") return behind(json.find_first_of(kLineEnds, i + 2), 1);
    if (two == "/*") return behind(json.find("*/", i + 2), 2);
    if (two[0] != '"') return i;
    for (++i; i < json.size() && json[i] != '"'; ++i)
        if (json[i] == '\\') ++i;
    return i + 1;
}

} // namespace

std::optional<std::size_t> tooDeepAt(std::string_view json) noexcept
{
    int depth = 0;
    for (std::size_t i = 0; i < json.size();) {
        const std::size_t next = behindText(json, i);
        if (next == i) {
            if (json[i] == '[' || json[i] == '{') ++depth;
            if (json[i] == ']' || json[i] == '}') --depth;
            if (depth > kDeepestJson) return i;
        }
        i = std::max(next, i + 1); // perhaps beyond the end, where a comment has none
    }
    return {};
}

} // namespace palp
