#include "engine/cloud/local_spacing.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>

#include "engine/cloud/neighbourhoods.h"
#include "engine/core/contract.h"
#include "engine/core/parallel.h"

namespace palp {
namespace {

constexpr std::size_t kNeighbours = 6;    ///< besides the point itself
constexpr std::size_t kPiece      = 4096; ///< least points of a thread

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

/// Finds the first guess of the spacing around some points, from the distance to the sixth neighbour.
void guessSpacings(std::span<const glm::dvec3> positions, const NeighbourIndex& index,
                   std::span<const std::uint32_t> order, std::span<double> guess)
{
    const double        usual = index.spacing();
    double              sixth = usual * std::sqrt(kNeighbours / std::numbers::pi); // [m] of the point before
    std::vector<double> squares;
    Neighbourhoods      neighbourhoods(positions, index);
    const auto          radius = [&](std::uint32_t) { return kLikelyReach * sixth; };
    neighbourhoods.each(order, radius, [&](std::uint32_t i, std::span<const NearCandidate> near) {
        if (near.size() > kNeighbours) {
            squares.clear();
            for (const NearCandidate& candidate : near) squares.push_back(candidate.distance2);
            std::nth_element(squares.begin(), squares.begin() + kNeighbours, squares.end());
            sixth = std::sqrt(squares[kNeighbours]);
        } else {
            sixth = index.nearest(positions[i], kNeighbours + 1).back().distance;
        }
        guess[i] = std::max(sixth * std::sqrt(std::numbers::pi / kNeighbours), kLeast * usual);
    });
}

/// Settles the spacing around some points by the median of the guesses near them.
void settleSpacings(std::span<const glm::dvec3> positions, const NeighbourIndex& index,
                    std::span<const std::uint32_t> order, std::span<const double> guess, std::span<double> spacings)
{
    std::vector<double> values;
    Neighbourhoods      neighbourhoods(positions, index);
    const auto          radius = [&](std::uint32_t i) { return kMedianReach * guess[i]; };
    neighbourhoods.each(order, radius, [&](std::uint32_t i, std::span<const NearCandidate> near) {
        values.clear();
        for (const NearCandidate& candidate : near) values.push_back(guess[candidate.point]);
        spacings[i] = median(values);
        if (guess[i] > kAlone * spacings[i])
            spacings[i] = std::min(guess[i], medianOfArea(values, kMedianReach * guess[i]));
    });
}

} // namespace

std::vector<double> localSpacings(std::span<const glm::dvec3> positions, const NeighbourIndex& index)
{
    PALP_EXPECT(positions.size() == index.size(), "the index is over other points");
    const double usual = index.spacing();
    if (!(usual > 0))
        throw Error("the cloud has fewer than seven points or most of them coincide, so there is no surface "
                    "to touch; are there duplicates?");

    const std::vector<std::uint32_t> order = alongCurve(positions);
    std::vector<double>              guess(positions.size()), spacings(positions.size());
    inParallel(order.size(), kPiece, [&](std::size_t begin, std::size_t end) {
        guessSpacings(positions, index, std::span(order).subspan(begin, end - begin), guess);
    });
    inParallel(order.size(), kPiece, [&](std::size_t begin, std::size_t end) {
        settleSpacings(positions, index, std::span(order).subspan(begin, end - begin), guess, spacings);
    });
    return spacings;
}

} // namespace palp
