#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include "engine/cloud/neighbour_index.h"

namespace palp {

/// Returns the points in an order in which neighbours follow each other, so that what a search reads is in the cache.
[[nodiscard]] std::vector<std::uint32_t> alongCurve(std::span<const glm::dvec3> positions);

/// A point near another one.
struct NearCandidate {
    std::uint32_t point = 0;
    glm::dvec3    away{};        ///< [m] from the other one
    double        distance2 = 0; ///< [m^2] squared length of `away`
};

/// Visits the neighbourhoods of many points, one search for several points that lie together.
/// \thread one; allocates
class Neighbourhoods {
public:
    Neighbourhoods(std::span<const glm::dvec3> positions, const NeighbourIndex& index)
        : positions_(positions), index_(index)
    {
    }

    /// Calls visit(point, near) for the points in `order`; `near` are those within its radius, itself too.
    /// \param radius  of a point [m], > 0; it may change with every visit
    template <class Radius, class Visit>
    void each(std::span<const std::uint32_t> order, Radius&& radius, Visit&& visit)
    {
        constexpr std::size_t kMost   = 16;  // points a search
        constexpr double      kApart  = 0.8; // farthest of them from the first, over its radius [1]
        constexpr double      kUnlike = 1.5; // ratio of their radii [1]
        for (std::size_t begin = 0, end = 0; begin < order.size(); begin = end) {
            const glm::dvec3 middle = positions_[order[begin]];
            const double     first  = radius(order[begin]);
            double           reach  = first;
            for (end = begin + 1; end < order.size() && end - begin < kMost; ++end) {
                const double away = glm::length(positions_[order[end]] - middle), own = radius(order[end]);
                if (away > kApart * first || own > kUnlike * first) break;
                reach = glm::max(reach, away + own);
            }
            index_.gather(middle, reach * (1 + 1e-9), found_);
            places_.clear();
            for (const std::uint32_t point : found_) places_.push_back(positions_[point]);
            for (std::size_t k = begin; k < end; ++k) {
                // What is out of reach of the search is out of the radius too, unless a visit has enlarged it.
                const glm::dvec3 place = positions_[order[k]];
                const double     most = reach - glm::length(place - middle), wanted = radius(order[k]);
                const double     own = wanted <= most * (1 + 1e-9) ? wanted : most;
                near_.clear();
                for (std::size_t n = 0; n < found_.size(); ++n) {
                    const glm::dvec3 d  = places_[n] - place;
                    const double     d2 = d.x * d.x + d.y * d.y + d.z * d.z;
                    if (d2 <= own * own) near_.push_back({found_[n], d, d2});
                }
                visit(order[k], std::span<const NearCandidate>(near_));
            }
        }
    }

private:
    std::span<const glm::dvec3> positions_; ///< [m]
    const NeighbourIndex&       index_;
    std::vector<std::uint32_t>  found_;
    std::vector<glm::dvec3>     places_; ///< of the found ones [m]
    std::vector<NearCandidate>  near_;
};

} // namespace palp
