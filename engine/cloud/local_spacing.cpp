#include "engine/cloud/local_spacing.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>

#include <glm/geometric.hpp>

#include "engine/cloud/detail/local_shape.h"
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

/// Points that follow the one of a median along the curve share it: this many, within its guess, with a guess like it
/// [1]. Their own medians would be over nearly the same points.
constexpr std::size_t kSharing = 8;
constexpr double      kLike    = 1.6;

/// A point this many times further from its neighbours than they are among themselves [1] is a stray, or belongs to the
/// sparse side of a step in density; a random sheet has none, also at its corners. A stray takes the others' spacing,
/// or its ball would reach them and hold every hand; on a sparse side the area decides and not the number of points.
constexpr double kAlone = 3;

/// Share of the disc around such a point that the others' areas cover if it lies among them [1]. Just outside a dense
/// half of a sheet it is 0.4.
constexpr double kCovered = 0.6;

/// As many points or fewer that are about as far from their neighbours make no surface [1].
constexpr std::size_t kFewStrays = 3;
constexpr double      kCompany   = 2.5; ///< they are at most this many times closer to their neighbours [1]

/// As many or fewer may lie in a plane by chance [1]. They are a surface if the dense points beside them lie in it too:
/// those of a narrow sparse strip do.
constexpr std::size_t kByChance = 9;

/// Points are strays if they deviate from the best plane by more than this [their spacings]: they lie in the air every
/// way. The second one holds where no dense side is near, so that all of a rough surface would be lost.
constexpr double kScatter = 0.15, kSureScatter = 0.5;

/// They are a surface after all if it goes on: this share of them stands among its like and scatters less [1].
constexpr double kGoesOn = 0.1;

/// The spacing of points that coincide over that of the cloud [1]: radii must stay above zero. Points that are only
/// near each other have their own: within this share of the cloud's there may be half of all.
constexpr double kCoinciding = 0.05;

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

/// Returns the seventh smallest squared distance [m^2] of at least seven. Each passes along the seven least so far,
/// which has no branch to foresee: of some fifteen it takes less than half the time of std::nth_element.
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
            const double own = sixth * std::sqrt(std::numbers::pi / kNeighbours);
            guess_[rank]     = own > 0 ? own : kCoinciding * usual;
        });
    }

private:
    const NeighbourIndex& index_;
    std::span<double>     guess_; ///< [m] by rank
    Neighbourhoods        neighbourhoods_;
};

/// Tells strays from the points of a surface.
class StrayTest {
public:
    StrayTest(const NeighbourIndex& index, std::span<const double> guess)
        : positions_(index.positionsByRank()), guess_(guess)
    {
    }

    /// Takes the points `near` a point, by rank.
    void take(std::uint32_t point, std::span<const std::uint32_t> near)
    {
        mine_ = guess_[point];
        like_.clear();
        for (const std::uint32_t other : near)
            if (kCompany * guess_[other] > mine_) like_.push_back(other);
        away_.clear();
        for (const std::uint32_t other : like_.size() <= kByChance ? near : like_)
            away_.push_back(positions_[other] - positions_[point]);
    }
    /// Returns those that are about as far from their neighbours as the point, or further, by rank.
    [[nodiscard]] std::span<const std::uint32_t> like() const { return like_; }

    /// Returns whether those make no surface: they are few, or scatter by more than that [their spacings].
    [[nodiscard]] bool scatter(double most)
    {
        if (like_.size() <= kFewStrays) return true;
        const LocalShape shape    = fitter_.fit(away_, kMedianReach * mine_, mine_);
        const bool       byChance = like_.size() <= kByChance;
        if (shape.sided && !byChance) return false;
        double sum = 0, square = 0;
        for (const glm::dvec3& away : away_) {
            const double height = glm::dot(shape.normal, away);
            sum += height;
            square += height * height;
        }
        constexpr double kUnknowns = 3;
        const auto       count     = double(away_.size());
        const double     variance  = (square - sum * sum / count) / (count - kUnknowns);
        const double     raised    = byChance ? std::abs(sum / count) : 0; // of the point itself [m]
        return std::max(raised, std::sqrt(std::max(0.0, variance))) > most * mine_;
    }

private:
    std::span<const glm::dvec3> positions_; ///< [m] all by rank
    std::span<const double>     guess_;     ///< [m]
    double                      mine_ = 0;  ///< [m] guess of the point
    std::vector<std::uint32_t>  like_;
    std::vector<glm::dvec3>     away_; ///< [m]
    ShapeFitter                 fitter_;
};

/// Settles the spacing around the points of a run by the median of the guesses near them; negative where the point is
/// alone, which remains to be settled.
class SettlingSpacings {
public:
    SettlingSpacings(const NeighbourIndex& index, std::span<const double> guess, std::span<double> spacings)
        : index_(index), positions_(index.positionsByRank()), guess_(guess), spacings_(spacings), strays_(index, guess)
    {
    }

    void operator()(const RankRun& run)
    {
        for (std::uint32_t first = run.begin, end = 0; first < run.end; first = end) {
            end               = first + 1;
            const double mine = guess_[first];
            index_.gatherRanks(positions_[first], kMedianReach * mine, near_);
            values_.clear();
            for (const std::uint32_t other : near_) values_.push_back(guess_[other]);
            spacings_[first] = median(values_);
            if (mine > kAlone * spacings_[first] || (mine > kAlone * index_.spacing() && isStray(first))) {
                spacings_[first] = -spacings_[first];
            } else {
                for (; end < run.end && end - first < kSharing && shares(first, end); ++end)
                    spacings_[end] = spacings_[first];
            }
        }
    }

private:
    /// Returns whether a point far from all that is dense is one of many strays.
    [[nodiscard]] bool isStray(std::uint32_t point)
    {
        strays_.take(point, near_);
        return strays_.scatter(kSureScatter);
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
    StrayTest                   strays_;
    std::vector<std::uint32_t>  near_;
    std::vector<double>         values_; ///< [m]
};

/// Settles the spacing around the points of a run that are alone.
class SettlingLonely {
public:
    /// \param settled   [m] as SettlingSpacings left it
    SettlingLonely(const NeighbourIndex& index, std::span<const double> guess, std::span<const double> settled,
                   std::span<double> spacings)
        : index_(index), guess_(guess), settled_(settled), spacings_(spacings), strays_(index, guess)
    {
    }

    void operator()(const RankRun& run)
    {
        for (std::uint32_t point = run.begin; point < run.end; ++point) {
            if (settled_[point] > 0) continue;
            const double mine = guess_[point];
            index_.gatherRanks(index_.positionsByRank()[point], kMedianReach * mine, near_);
            strays_.take(point, near_);
            const auto like = strays_.like();
            const auto good =
                std::ranges::count_if(like, [&](std::uint32_t other) { return kLike * settled_[other] > mine; });
            if (double(good) < kGoesOn * double(like.size()) && strays_.scatter(kScatter)) {
                spacings_[point] = std::min(-settled_[point], index_.spacing());
                continue;
            }
            values_.clear();
            for (const std::uint32_t other : near_) values_.push_back(guess_[other]);
            spacings_[point] = std::min(mine, medianOfArea(values_, kMedianReach * mine));
        }
    }

private:
    const NeighbourIndex&      index_;
    std::span<const double>    guess_;    ///< [m]
    std::span<const double>    settled_;  ///< [m]
    std::span<double>          spacings_; ///< [m]
    StrayTest                  strays_;
    std::vector<std::uint32_t> near_;
    std::vector<double>        values_; ///< [m]
};

} // namespace

std::vector<double> localSpacingsByRank(const NeighbourIndex& index)
{
    if (!(index.spacing() > 0))
        throw Error("the cloud has fewer than seven points or most of them coincide, so there is no surface "
                    "to touch; are there duplicates, or is the length unit another?");
    std::vector<double> guess(index.size()), spacings(index.size());
    inCurveRuns(index.size(), [&] { return GuessingSpacings(index, guess); });
    inCurveRuns(index.size(), [&] { return SettlingSpacings(index, guess, spacings); });
    const std::vector<double> settled = spacings;
    inCurveRuns(index.size(), [&] { return SettlingLonely(index, guess, settled, spacings); });
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
