#include "engine/cloud/neighbourhoods.h"

#include <algorithm>
#include <utility>

#include "engine/cloud/morton.h"

namespace palp {

std::vector<std::uint32_t> alongCurve(std::span<const glm::dvec3> positions)
{
    glm::dvec3 low = positions[0], high = positions[0];
    for (const glm::dvec3& p : positions) {
        low  = glm::min(low, p);
        high = glm::max(high, p);
    }
    const glm::dvec3 size  = high - low;
    const double     scale = (kMortonCells - 1) / std::max({size.x, size.y, size.z});
    std::vector<std::pair<std::uint64_t, std::uint32_t>> keys(positions.size());
    for (std::size_t i = 0; i < positions.size(); ++i) {
        const glm::dvec3 cell = scale * (positions[i] - low);
        keys[i] = {mortonCode(std::uint32_t(cell.x), std::uint32_t(cell.y), std::uint32_t(cell.z)), std::uint32_t(i)};
    }
    std::sort(keys.begin(), keys.end());
    std::vector<std::uint32_t> order(keys.size());
    std::transform(keys.begin(), keys.end(), order.begin(), [](const auto& key) { return key.second; });
    return order;
}

} // namespace palp
