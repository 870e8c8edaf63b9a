#include "engine/core/json_limits.h"

#include <algorithm>
#include <array>
#include <bit>
#include <utility>

namespace palp {
namespace {

// What nlohmann::json takes on a machine of 64 bits, with what the allocator rounds up [bytes].
constexpr std::size_t kValue    = 16;          // in the memory of its list
constexpr std::size_t kList     = 24;          // a std::vector of values
constexpr std::size_t kObject   = 48 + 8;      // a std::map
constexpr std::size_t kMember   = 32 + 16 + 8; // a node of the map with its value; its name is a text
constexpr std::size_t kText     = 32 + 8;      // a std::string; with memory of its own from 16 bytes on
constexpr std::size_t kRounding = 16;          // of an allocation of any size, at most

constexpr std::string_view kNoValue = " \t\r\n]/"; // what may stand before the first value of a list, or in its place

/// What is read is kept twice until the next text or number begins, in memory that doubles [1]; and if it is no JSON,
/// the library complains of all that, with eight letters for each control character, which is copied several times
/// [bytes].
constexpr std::size_t kOfReading = 4, kOfControl = 40;

constexpr std::string_view kTooDeep =
    "expected lists and objects of JSON in at most 100 levels, found more; is it damaged, or is a bracket missing?";
constexpr std::string_view kTooMuch =
    "expected JSON that takes at most 8 times the file's size in memory and 8 MiB beside it, found so many lists, "
    "objects, texts or numbers of a few bytes that it takes more; is it damaged?";
static_assert(kDeepestJson == 100 && kMostPerByteOfJson == 8 && kMostBesideJson == std::size_t(8) << 20);

/// Returns the byte behind a text or a comment that begins at `i`, behind the end where it has none; `i` where none
/// begins.
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
    }
    void close() noexcept
    {
        waiting_ -= std::exchange(open_[std::size_t(depth_)].values, 0);
        depth_ = std::max(depth_ - 1, 0);
    }
    [[nodiscard]] bool areInList() const noexcept { return open_[std::size_t(depth_)].list; }
    [[nodiscard]] bool areInEmptyList() const noexcept { return areInList() && open_[std::size_t(depth_)].values == 0; }
    /// One more value of the list or object that is open. The memory of a list doubles when it is full.
    void next() noexcept
    {
        Level&            level  = open_[std::size_t(depth_)];
        const std::size_t before = level.values++;
        ++waiting_;
        const std::size_t open =
            std::min(waiting_, std::size_t(std::max(depth_ - 1, 0))); // fewer wait in what is no JSON
        mostWaiting_ = std::max(mostWaiting_, waiting_ - open);
        if (depth_ == 1) ofAll_ = std::max(ofAll_, level.values);
        if (!level.list || (before > 0 && !std::has_single_bit(before))) return;
        most_ = std::max(most_, taken_ + 2 * before * kValue + kRounding); // both are there while the old one is moved
        take(before > 0 ? before * kValue : kValue + kRounding);
    }
    void take(std::size_t bytes) noexcept { most_ = std::max(most_, taken_ += bytes); }

    /// What the library takes to free all values: it puts them on a stack, level by level and the last ones first, that
    /// has room for the values of the outermost level, and doubles when it is full [bytes].
    [[nodiscard]] std::size_t mostToFree() const noexcept
    {
        std::size_t room = std::max<std::size_t>(ofAll_, 1), most = room * kValue;
        for (; room < mostWaiting_; room *= 2) most = 3 * room * kValue; // the old one and the new one
        return taken_ + most;
    }

private:
    struct Level {
        bool        list   = false;
        std::size_t values = 0;
    };
    std::array<Level, kDeepestJson + 1> open_{};
    int                                 depth_ = 0;
    std::size_t                         taken_ = 1024, most_ = 0; // buffers come first [bytes]
    std::size_t waiting_ = 0, mostWaiting_ = 0; // values of the open levels, but for those that are open
    std::size_t ofAll_ = 0;                     // values of the outermost level
};

} // namespace

std::optional<JsonExcess> excessOf(std::string_view json, std::size_t input) noexcept
{
    const std::size_t limit = kMostPerByteOfJson * std::max(input, json.size()) + kMostBesideJson;
    Levels            levels;
    std::size_t       began    = 0;              // the last text or number [bytes]
    std::size_t       controls = 0, longest = 0; // control characters since then; memory that this took at most [bytes]
    bool              inNumber = false;
    for (std::size_t i = 0; i < json.size();) {
        const std::size_t next = behindText(json, i);
        const char        c    = json[i];
        if (levels.areInEmptyList() && kNoValue.find(c) == std::string_view::npos) levels.next();
        if (c == '[' || c == '{') levels.open(c == '[');
        if (c == ']' || c == '}') levels.close();
        if (c == ',' && levels.areInList()) levels.next();
        if (c == ':') {
            levels.take(kMember);
            levels.next();
        }
        if (c == '"') levels.take(kText + (next - i > 17 ? next - i + kRounding : 0));
        const bool isDigit = c == '-' || (c >= '0' && c <= '9');
        if (c == '"' || (isDigit && !inNumber)) {
            began    = i;
            controls = 0;
        }
        controls += std::size_t(std::ranges::count_if(json.substr(i, std::max(next, i + 1) - i),
                                                      [](char of) { return of >= 0 && of < ' '; }));
        inNumber = isDigit || (inNumber && (c == '.' || c == '+' || c == 'e' || c == 'E'));
        longest  = std::max(longest, kOfReading * (next - began) + kOfControl * controls);
        if (levels.areTooMany()) return JsonExcess{i, kTooDeep};
        if (levels.most() + longest > limit) return JsonExcess{i, kTooMuch};
        i = std::max(next, i + 1); // perhaps beyond the end, where a comment has none
    }
    if (levels.mostToFree() > limit) return JsonExcess{json.size(), kTooMuch};
    return {};
}

} // namespace palp
