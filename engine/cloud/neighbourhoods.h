#pragma once
#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include "engine/cloud/neighbour_index.h"
#include "engine/core/parallel.h"

namespace palp {

/// Points along the curve of an index that are looked at together.
inline constexpr std::size_t kCurveRun = 256;

/// Some points that follow each other along the curve of an index, by their ranks: [begin, end).
struct RankRun {
    std::uint32_t begin = 0, end = 0;
};

/// Runs work(RankRun) for all runs of kCurveRun points, on all cores. The runs do not depend on the number of cores, so
/// what the points of a run share does not either.
/// \param points    how many there are
/// \param makeWork  called once a thread
template <class MakeWork>
void inCurveRuns(std::size_t points, MakeWork&& makeWork)
{
    constexpr std::size_t kLeast = 16; // runs of a thread
    inParallel((points + kCurveRun - 1) / kCurveRun, kLeast, [&](std::size_t begin, std::size_t end) {
        auto work = makeWork();
        for (std::size_t run = begin; run < end; ++run)
            work(RankRun{std::uint32_t(run * kCurveRun), std::uint32_t(std::min(points, (run + 1) * kCurveRun))});
    });
}

/// A point near another one.
struct NearCandidate {
    std::uint32_t rank = 0;
    glm::dvec3    away{};        ///< [m] from the other one
    double        distance2 = 0; ///< [m^2] squared length of `away`
};

/// Visits the neighbourhoods of many points, one search for several points that lie together.
/// \thread one; allocates
class Neighbourhoods {
public:
    explicit Neighbourhoods(const NeighbourIndex& index) : index_(index), positions_(index.positionsByRank()) {}

    /// Calls visit(rank, near) for the points of a run; `near` are those within its radius, itself too.
    /// \param radius  of a rank [m], > 0; it may change with every visit
    template <class Radius, class Visit>
    void each(const RankRun& run, Radius&& radius, Visit&& visit)
    {
        constexpr std::uint32_t kMost   = 16;  // points a search
        constexpr double        kApart  = 0.8; // farthest of them from the first, over its radius [1]
        constexpr double        kUnlike = 1.5; // ratio of their radii [1]
        for (std::uint32_t begin = run.begin, end = 0; begin < run.end; begin = end) {
            const glm::dvec3 middle = positions_[begin];
            const double     first  = radius(begin);
            double           reach  = first;
            for (end = begin + 1; end < run.end && end - begin < kMost; ++end) {
                const double away = glm::length(positions_[end] - middle), own = radius(end);
                if (away > kApart * first || own > kUnlike * first) break;
                reach = std::max(reach, away + own);
            }
            if (!search(middle, reach)) { // of a single point the ball is the smallest
                end   = begin + 1;
                reach = first;
                index_.gatherRanks(middle, reach * (1 + 1e-9), found_);
            }
            takeFound(middle);
            for (std::uint32_t k = begin; k < end; ++k) {
                // What is out of reach of the search is out of the radius too, unless a visit has enlarged it.
                const glm::dvec3 place = positions_[k] - middle;
                const double     most = reach - glm::length(place), wanted = radius(k);
                keepNear(place, wanted <= most * (1 + 1e-9) ? wanted : most);
                visit(k, std::span<const NearCandidate>(near_));
            }
        }
    }

private:
    /// Finds the points of a search, unless they are so many that it must have reached into a part far denser.
    [[nodiscard]] bool search(const glm::dvec3& middle, double reach);
    void               takeFound(const glm::dvec3& middle);
    void               keepNear(const glm::dvec3& place, double radius);

    const NeighbourIndex&       index_;
    std::span<const glm::dvec3> positions_; ///< [m] by rank
    std::vector<std::uint32_t>  found_;
    std::vector<std::uint32_t>  kept_;                  ///< numbers of those in found_ that are near
    std::vector<double>         x_, y_, z_, distance2_; ///< of the found ones: from the middle of the search [m]; [m^2]
    std::vector<NearCandidate>  near_;
};

} // namespace palp
