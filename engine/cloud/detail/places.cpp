#include "engine/cloud/detail/places.h"

#include <algorithm>
#include <bit>
#include <tuple>
#include <utility>

namespace palp {
namespace {

/// Returns a well-mixed 64-bit number of a position's bits.
std::uint64_t hashOf(const glm::dvec3& p)
{
    std::uint64_t hash = 0;
    for (int k = 0; k < 3; ++k) {
        hash ^= std::bit_cast<std::uint64_t>(p[k] + 0.0); // adding zero makes -0 and 0 the same
        hash *= 0x9E3779B97F4A7C15u;                      // 2^64 / golden ratio, an odd number without pattern
        hash ^= hash >> 32;
    }
    return hash;
}

} // namespace

std::vector<std::uint32_t> placesOf(std::span<const glm::dvec3> positions)
{
    // Sorting, unlike a hash table, stays fast for a hostile file.
    std::vector<std::pair<std::uint64_t, std::uint32_t>> order(positions.size());
    for (std::size_t i = 0; i < positions.size(); ++i) order[i] = {hashOf(positions[i]), std::uint32_t(i)};
    std::sort(order.begin(), order.end());

    const auto key = [&](const auto& entry) { // different positions may share a hash
        const glm::dvec3& p = positions[entry.second];
        return std::make_tuple(p.x, p.y, p.z, entry.second);
    };
    std::vector<std::uint32_t> firstOf; // the first position at the same place
    for (auto first = order.begin(); first != order.end();) {
        const auto last = std::find_if(first, order.end(), [&](const auto& e) { return e.first != first->first; });
        std::sort(first, last, [&](const auto& a, const auto& b) { return key(a) < key(b); });
        for (auto entry = first; entry + 1 < last; ++entry) {
            if (positions[entry->second] != positions[(entry + 1)->second]) continue;
            if (firstOf.empty()) {
                firstOf.resize(positions.size());
                for (std::size_t i = 0; i < positions.size(); ++i) firstOf[i] = std::uint32_t(i);
            }
            firstOf[(entry + 1)->second] = firstOf[entry->second];
        }
        first = last;
    }
    std::uint32_t places = 0;
    for (std::size_t i = 0; i < firstOf.size(); ++i) // a first position comes before the others of its place
        firstOf[i] = firstOf[i] == i ? places++ : firstOf[firstOf[i]];
    return firstOf;
}

} // namespace palp
