#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include <glm/vec3.hpp>

#include "engine/cloud/neighbour_index.h"

namespace palp {

/// A point of the cloud and the spacing around it.
struct NearPoint {
    glm::dvec3 position{};  ///< [m]
    double     spacing = 0; ///< [m]
};

/// The points about a place that wanders slowly: one search in the tree serves many ticks.
///
/// Invariant: `inside` calls back for exactly the points of the ball, by rising index, whatever was asked before and
/// whatever instructions the processor has. So sums over them have the same bits on every run.
/// \thread one; allocates nothing after construction
class NearPoints {
public:
    /// \param positions  [m] those of the index; both outlive this
    NearPoints(std::span<const glm::dvec3> positions, const NeighbourIndex& index);

    /// Calls visit(const NearPoint&, squared distance [m^2]) for the points within `radius` [m] of `centre` [m].
    template <class Visit>
    void inside(const glm::dvec3& centre, double radius, Visit&& visit)
    {
        cover(centre, radius);
        for (const NearPoint& point : held_) {
            const glm::dvec3 d  = point.position - centre;
            const double     d2 = d.x * d.x + d.y * d.y + d.z * d.z;
            if (d2 <= radius * radius) visit(point, d2);
        }
    }

    /// Calls visit(const NearPoint&) for the points within `radius` in any order, without keeping them.
    template <class Visit>
    void insideOnce(const glm::dvec3& centre, double radius, Visit&& visit)
    {
        index_.gather(centre, radius, found_);
        for (const std::uint32_t p : found_) visit(NearPoint{positions_[p], spacings_[p]});
    }

    [[nodiscard]] double largestSpacing() const noexcept { return largest_; }       ///< [m]
    [[nodiscard]] double usualSpacing() const noexcept { return index_.spacing(); } ///< [m]

    /// As many points are held at most; of more, every second, third and so on. Bounds the time of a tick where the
    /// density jumps by orders of magnitude: a ball usually holds 100.
    static constexpr std::size_t kMost = 16384;

private:
    void cover(const glm::dvec3& centre, double radius);

    std::span<const glm::dvec3> positions_;
    const NeighbourIndex&       index_;
    std::vector<double>         spacings_; ///< [m] by point
    double                      largest_;  ///< [m]
    std::vector<std::uint32_t>  found_;    ///< capacity: the whole cloud
    std::vector<NearPoint>      held_;
    glm::dvec3                  centre_{};    ///< [m] of the ball that is held
    double                      radius_ = -1; ///< [m] of it; negative: none
};

} // namespace palp
