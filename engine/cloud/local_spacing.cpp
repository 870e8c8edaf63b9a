#include "engine/cloud/local_spacing.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <utility>

#include <glm/geometric.hpp>

#include "engine/cloud/morton.h"
#include "engine/core/contract.h"

namespace palp {
namespace {

constexpr std::size_t kNeighbours = 6; ///< besides the point itself

/// Search radius over the distance of the sixth neighbour of the point before, a near one [1]: holds 15 points where
/// the density does not vary. Where it holds fewer than seven the exact, slower search follows. (The cloud's usual
/// spacing would not do: where points are a hundred times closer it holds a hundred thousand of them.)
constexpr double kLikelyReach = 1.6;

/// Radius of the median over the point's own first guess [1]: 28 points of a regular sheet.
constexpr double kMedianReach = 3;

/// A point this many times further from its neighbours than they are among themselves [1] is a stray, or belongs to the
/// sparse side of a step in density; a random sheet has none, also at its corners. Then the area decides and not the
/// number of points: a stray takes the others' spacing, as all the area around is theirs.
constexpr double kAlone = 3;

/// Share of the disc around such a point that the others' areas cover if it is a stray over a sheet [1]: 0.8, wherever
/// it is. Just outside a dense half of a sheet it is 0.4.
constexpr double kCovered = 0.6;

/// Where points coincide no spacing falls below this share of the cloud's [1]: radii must stay above zero.
constexpr double kLeast = 0.05;

/// Returns the points in an order in which neighbours follow each other, so that what a search reads is in the cache.
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

/// Returns the value that half of the others do not exceed; reorders.
double median(std::vector<double>& values)
{
    const auto middle = values.begin() + std::ptrdiff_t(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

/// Returns the value that half of the area does not exceed, each value standing for an area of its square; reorders.
/// Infinite if together they cover less than kCovered of a disc.
double medianOfArea(std::vector<double>& values, double radius)
{
    std::sort(values.begin(), values.end());
    double all = 0, sum = 0;
    for (const double value : values) all += value * value;
    if (all < kCovered * std::numbers::pi * radius * radius) return std::numeric_limits<double>::infinity();
    for (const double value : values)
        if (sum += value * value; sum >= 0.5 * all) return value;
    return values.back();
}

} // namespace

std::vector<double> localSpacings(std::span<const glm::dvec3> positions, const NeighbourIndex& index)
{
    PALP_EXPECT(positions.size() == index.size(), "the index is over other points");
    const double usual = index.spacing();
    if (!(usual > 0))
        throw Error("the cloud has fewer than seven points or most of them coincide, so there is no surface "
                    "to touch; are there duplicates?");

    std::vector<std::uint32_t> near;
    std::vector<double>        values;
    std::vector<double>        guess(positions.size());
    const auto                 order = alongCurve(positions);
    double                     sixth = usual * std::sqrt(kNeighbours / std::numbers::pi); // [m] of the point before
    for (const std::uint32_t i : order) {
        index.gather(positions[i], kLikelyReach * sixth, near);
        values.clear();
        for (const std::uint32_t p : near) values.push_back(glm::length(positions[p] - positions[i]));
        if (values.size() > kNeighbours) {
            std::nth_element(values.begin(), values.begin() + kNeighbours, values.end());
            sixth = values[kNeighbours];
        } else {
            sixth = index.nearest(positions[i], kNeighbours + 1).back().distance;
        }
        guess[i] = std::max(sixth * std::sqrt(std::numbers::pi / kNeighbours), kLeast * usual);
    }

    std::vector<double> spacings(positions.size());
    for (const std::uint32_t i : order) {
        index.gather(positions[i], kMedianReach * guess[i], near);
        values.clear();
        for (const std::uint32_t p : near) values.push_back(guess[p]);
        spacings[i] = median(values);
        if (guess[i] > kAlone * spacings[i])
            spacings[i] = std::min(guess[i], medianOfArea(values, kMedianReach * guess[i]));
    }
    return spacings;
}

} // namespace palp
