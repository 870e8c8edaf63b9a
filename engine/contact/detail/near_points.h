#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include <glm/vec3.hpp>

#include "engine/contact/detail/contact_points.h"
#include "engine/contact/detail/point_tree.h"

namespace palp {

/// The points about a place that moves slowly: one search in the tree serves many ticks.
///
/// Invariant: `inside` calls back for the same points in the same order, whatever was asked before (unless kMost forces
/// a coarser level) and whatever instructions the processor has. Sums over them thus have the same bits on every run.
/// \thread one; allocates nothing after construction
class NearPoints {
public:
    /// \param points  copied
    explicit NearPoints(const ContactPoints& points);

    /// Calls visit(const NearPoint&, squared distance [m^2]) for the points within `radius` [m] of `centre` [m], as a
    /// search with a spacing of `scale` [m] sees them: where points are many times closer, some stand for the others
    /// and have the spacing that these have among themselves.
    template <class Visit>
    void inside(const glm::dvec3& centre, double radius, double scale, Visit&& visit)
    {
        for (const NearPoint& point : cover(centre, radius, tree_.level(scale))) {
            const glm::dvec3 d  = point.position - centre;
            const double     d2 = d.x * d.x + d.y * d.y + d.z * d.z;
            if (d2 <= radius * radius) visit(point, d2);
        }
    }

    /// Calls visit(const NearPoint&, squared distance [m^2]) for all points in whose own ball `place` [m] lies.
    template <class Visit>
    void holding(const glm::dvec3& place, Visit&& visit) const
    {
        tree_.holding(place, visit);
    }

    /// Returns the share [1] of the way after which it first enters a ball that `from` is not in; 1 if there is none.
    [[nodiscard]] double firstTouch(const glm::dvec3& from, const glm::dvec3& to) const noexcept
    {
        return tree_.firstTouch(from, to);
    }

    [[nodiscard]] bool   mixed() const noexcept { return tree_.mixed(); } ///< the density varies by more than chance
    [[nodiscard]] double largestSpacing() const noexcept { return tree_.largestSpacing(); } ///< [m]
    [[nodiscard]] double usualSpacing() const noexcept { return spacing_; }                 ///< [m]

    /// Most points that are held; a coarser level is taken if need be. A ball usually holds 100, and 500 about a hole.
    static constexpr std::size_t kMost = 4096;

private:
    /// The points of one level in a ball.
    struct Ball {
        std::vector<NearPoint> points;
        glm::dvec3             centre{};    ///< [m]
        double                 radius = -1; ///< [m]; negative: none
        int                    level  = 0;  ///< that was asked for
    };

    [[nodiscard]] std::span<const NearPoint> cover(const glm::dvec3& centre, double radius, int level);

    double              spacing_; ///< [m]
    PointTree           tree_;
    std::array<Ball, 4> balls_; ///< by the level, modulo their number: beside a step in density several are in use
};

} // namespace palp
