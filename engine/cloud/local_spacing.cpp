#include "engine/cloud/local_spacing.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>

#include "engine/cloud/neighbourhoods.h"
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

/// Points that follow the one of a median along the curve share it: this many, within its guess, with a guess like it [1].
/// Their own medians would be over nearly the same points.
constexpr std::size_t kSharing = 8;
constexpr double      kLike    = 1.6;

/// A point this many times further from its neighbours than they are among themselves [1] is a stray, or belongs to the
/// sparse side of a step in density; a random sheet has none, also at its corners. Then the area decides and not the
/// number of points: a stray takes the others' spacing, as all the area around is theirs.
constexpr double kAlone = 3;

/// Share of the disc around such a point that the others' areas cover if it is a stray over a sheet [1]: 0.8, wherever
/// it is. Just outside a dense half of a sheet it is 0.4.
constexpr double kCovered = 0.6;

/// A stray far from everything is known by its company [1]: of the points around the sparse side of a step, ten and more
/// are as far from their neighbours. It takes the others' spacing too, or its ball would reach them and hold every hand.
constexpr std::ptrdiff_t kFewStrays = 3;

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

/// Returns the seventh smallest squared distance [m^2] of at least seven. Each passes along the seven least so far, which
/// has no branch to foresee: of some fifteen it takes less than half the time of std::nth_element.
double seventhSquare(std::span<const NearCandidate> near)
{
    std::array<double, kNeighbours + 1> least; // ascending
    least.fill(std::numeric_limits<double>::infinity());
    for (const NearCandidate& candidate : near) {
        double passing = candidate.distance2;
        for (double& kept : least) {
            const double further = std::max(kept, passing);
            kept                 = std::min(kept, passing);
            passing              = further;
        }
    }
    return least.back();
}

/// Finds the first guess of the spacing around the points of a run, from the distance to the sixth neighbour.
class GuessingSpacings {
public:
    GuessingSpacings(const NeighbourIndex& index, std::span<double> guess)
        : index_(index), guess_(guess), neighbourhoods_(index)
    {
    }

    void operator()(const RankRun& run)
    {
        const double usual  = index_.spacing();
        double       sixth  = usual * std::sqrt(kNeighbours / std::numbers::pi); // [m] of the point before
        const auto   radius = [&](std::uint32_t) { return kLikelyReach * sixth; };
        neighbourhoods_.each(run, radius, [&](std::uint32_t rank, std::span<const NearCandidate> near) {
            if (near.size() > kNeighbours) {
                sixth = std::sqrt(seventhSquare(near));
            } else {
                sixth = index_.nearest(index_.positionsByRank()[rank], kNeighbours + 1).back().distance;
            }
            guess_[rank] = std::max(sixth * std::sqrt(std::numbers::pi / kNeighbours), kLeast * usual);
        });
    }

private:
    const NeighbourIndex& index_;
    std::span<double>     guess_; ///< [m] by rank
    Neighbourhoods        neighbourhoods_;
};

/// Settles the spacing around the points of a run by the median of the guesses near them.
class SettlingSpacings {
public:
    SettlingSpacings(const NeighbourIndex& index, std::span<const double> guess, std::span<double> spacings)
        : index_(index), positions_(index.positionsByRank()), guess_(guess), spacings_(spacings)
    {
    }

    void operator()(const RankRun& run)
    {
        for (std::uint32_t first = run.begin, end = 0; first < run.end; first = end) {
            const double mine = guess_[first];
            index_.gatherRanks(positions_[first], kMedianReach * mine, near_);
            values_.clear();
            for (const std::uint32_t other : near_) values_.push_back(guess_[other]);
            spacings_[first] = median(values_);
            const bool alone = mine > kAlone * spacings_[first];
            if (alone && !isStray(mine)) spacings_[first] = std::min(mine, medianOfArea(values_, kMedianReach * mine));
            for (end = first + 1; end < run.end && end - first < kSharing && !alone && shares(first, end); ++end)
                spacings_[end] = spacings_[first];
        }
    }

private:
    /// Returns whether hardly any other of the points in values_ is as far from its neighbours.
    [[nodiscard]] bool isStray(double mine) const
    {
        return std::ranges::count_if(values_, [&](double its) { return kAlone * its > mine; }) <= kFewStrays;
    }
    [[nodiscard]] bool shares(std::uint32_t first, std::uint32_t other) const
    {
        const glm::dvec3 d    = positions_[other] - positions_[first];
        const double     mine = guess_[first], its = guess_[other];
        return glm::dot(d, d) <= mine * mine && its < kLike * mine && mine < kLike * its;
    }

    const NeighbourIndex&       index_;
    std::span<const glm::dvec3> positions_; ///< [m] all by rank
    std::span<const double>     guess_;     ///< [m]
    std::span<double>           spacings_;  ///< [m]
    std::vector<std::uint32_t>  near_;
    std::vector<double>         values_; ///< [m]
};

} // namespace

std::vector<double> localSpacingsByRank(const NeighbourIndex& index)
{
    if (!(index.spacing() > 0))
        throw Error("the cloud has fewer than seven points or most of them coincide, so there is no surface "
                    "to touch; are there duplicates?");
    std::vector<double> guess(index.size()), spacings(index.size());
    inCurveRuns(index.size(), [&] { return GuessingSpacings(index, guess); });
    inCurveRuns(index.size(), [&] { return SettlingSpacings(index, guess, spacings); });
    return spacings;
}

std::vector<double> localSpacings(const NeighbourIndex& index)
{
    const std::vector<double>        byRank = localSpacingsByRank(index);
    const std::vector<std::uint32_t> points = index.pointsByRank();
    std::vector<double>              spacings(points.size());
    for (std::size_t rank = 0; rank < points.size(); ++rank) spacings[points[rank]] = byRank[rank];
    return spacings;
}

} // namespace palp
