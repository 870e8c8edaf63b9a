#include "engine/core/json_limits.h"

#include <algorithm>
#include <array>
#include <bit>

namespace palp {
namespace {

// What nlohmann::json takes on a machine of 64 bits [bytes].
constexpr std::size_t kValue  = 16;      // in the memory of its list
constexpr std::size_t kList   = 24;      // a std::vector of values
constexpr std::size_t kObject = 48;      // a std::map
constexpr std::size_t kMember = 32 + 16; // a node of the map with its value; its name is a text
constexpr std::size_t kText   = 32;      // a std::string; with memory of its own from 16 bytes on

constexpr JsonExcess kTooDeep{
    0, "expected lists and objects of JSON in at most 100 levels, found more; is a bracket missing?"};
constexpr JsonExcess kTooMuch{
    0, "expected JSON that takes at most 8 times its own size in memory and 4 MiB beside it, found so "
       "many lists, objects or numbers of a few bytes that it takes more; is the file damaged?"};
static_assert(kDeepestJson == 100 && kMostPerByteOfJson == 8 && kMostBesideJson == std::size_t(4) << 20);

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

/// The lists and objects that are open, and the memory of all that was read.
class Levels {
public:
    [[nodiscard]] bool        areTooMany() const noexcept { return depth_ > kDeepestJson; }
    [[nodiscard]] std::size_t most() const noexcept { return most_; } ///< [bytes]

    void open(bool list) noexcept
    {
        ++depth_;
        if (areTooMany()) return;
        open_[std::size_t(depth_)] = {list, 0};
        take(list ? kList : kObject);
        if (list) next(); // as if every list had a value
    }
    void close() noexcept { depth_ = std::max(depth_ - 1, 0); }
    /// One more value of the list that is open, whose memory doubles when it is full.
    void next() noexcept
    {
        Level& level = open_[std::size_t(depth_)];
        if (!level.list) return;
        const std::size_t before = level.values++;
        if (before > 0 && !std::has_single_bit(before)) return;
        most_ = std::max(most_, taken_ + 2 * before * kValue); // both are there while the old one is moved
        take(std::max<std::size_t>(before, 1) * kValue);
    }
    void take(std::size_t bytes) noexcept { most_ = std::max(most_, taken_ += bytes); }

private:
    struct Level {
        bool        list   = false;
        std::size_t values = 0;
    };
    std::array<Level, kDeepestJson + 1> open_{};
    int                                 depth_ = 0;
    std::size_t                         taken_ = 0, most_ = 0; // [bytes]
};

} // namespace

std::optional<JsonExcess> excessOf(std::string_view json, std::size_t input) noexcept
{
    const std::size_t limit = kMostPerByteOfJson * std::max(input, json.size()) + kMostBesideJson;
    Levels            levels;
    for (std::size_t i = 0; i < json.size();) {
        const std::size_t next = behindText(json, i);
        if (json[i] == '[' || json[i] == '{') levels.open(json[i] == '[');
        if (json[i] == ']' || json[i] == '}') levels.close();
        if (json[i] == ',') levels.next();
        if (json[i] == ':') levels.take(kMember);
        if (json[i] == '"') levels.take(kText + (next - i > 17 ? next - i : 0));
        if (levels.areTooMany()) return JsonExcess{i, kTooDeep.what};
        if (levels.most() > limit) return JsonExcess{i, kTooMuch.what};
        i = std::max(next, i + 1); // perhaps beyond the end, where a comment has none
    }
    return {};
}

} // namespace palp
