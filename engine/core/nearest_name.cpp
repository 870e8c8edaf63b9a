#include "engine/core/nearest_name.h"

#include <algorithm>
#include <array>
#include <vector>

namespace palp {
namespace {

/// Longest word that is compared [bytes]; the table below grows with the product of two lengths.
constexpr std::size_t kLongest = 64;

char plain(char c)
{
    if (c >= 'A' && c <= 'Z') return char(c - 'A' + 'a');
    return c == '-' ? '_' : c;
}

/// Counts the slips between two words row by row: least[i][j] turns the first i letters of `a` into the first j of `b`.
std::size_t slips(std::string_view a, std::string_view b)
{
    std::vector<std::vector<std::size_t>> least(a.size() + 1, std::vector<std::size_t>(b.size() + 1));
    for (std::size_t i = 0; i <= a.size(); ++i)
        for (std::size_t j = 0; j <= b.size(); ++j) {
            if (i == 0 || j == 0) {
                least[i][j] = i + j;
                continue;
            }
            const bool same = plain(a[i - 1]) == plain(b[j - 1]);
            least[i][j]     = std::min({least[i - 1][j] + 1, least[i][j - 1] + 1, least[i - 1][j - 1] + !same});
            if (i > 1 && j > 1 && plain(a[i - 1]) == plain(b[j - 2]) && plain(a[i - 2]) == plain(b[j - 1]))
                least[i][j] = std::min(least[i][j], least[i - 2][j - 2] + 1);
        }
    return least[a.size()][b.size()];
}

} // namespace

std::optional<std::string_view> nearestName(std::string_view name, std::span<const std::string_view> known)
{
    std::optional<std::string_view> nearest;
    std::size_t                     fewest = kLongest;
    if (name.size() > kLongest) return nearest;
    for (const std::string_view candidate : known) {
        const std::size_t count = slips(name, candidate.substr(0, kLongest));
        if (3 * count > std::max(name.size(), candidate.size()) || count >= fewest) continue;
        fewest  = count;
        nearest = candidate;
    }
    return nearest;
}

} // namespace palp
