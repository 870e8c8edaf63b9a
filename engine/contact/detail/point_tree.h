#pragma once
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <glm/vec3.hpp>

namespace palp {

/// Which way a point faces, small enough to be kept with every point.
struct Facing {
    std::int16_t x = 0, y = 0, z = 0; ///< [1/32767] unit normal that points outward; 0: no side is known

    Facing() = default;
    explicit Facing(const glm::dvec3& outward) noexcept
        : x(std::int16_t(kUnit * outward.x)), y(std::int16_t(kUnit * outward.y)), z(std::int16_t(kUnit * outward.z))
    {
    }
    [[nodiscard]] glm::dvec3 normal() const noexcept { return glm::dvec3(x, y, z) / kUnit; } ///< [1]
    [[nodiscard]] bool       known() const noexcept { return x != 0 || y != 0 || z != 0; }
    [[nodiscard]] double     along(const glm::dvec3& direction) const noexcept
    {
        return (x * direction.x + y * direction.y + z * direction.z) / kUnit;
    }

private:
    static constexpr double kUnit = 32767;
};

/// What else is known of a point.
struct PointMark {
    Facing        facing;       ///< its side
    std::uint16_t smoothed = 0; ///< 1: it stands for noisy points and has little noise itself
};

/// A point of the surface that is touched.
struct NearPoint {
    glm::dvec3 position{};  ///< [m]
    double     spacing = 0; ///< [m] around it
    PointMark  mark{};
};

/// Radius of a point's own ball in its spacings [1]: the largest empty circle in a random cloud of 10^4 points has a
/// radius of 1.9. The balls of a sheet overlap, so that every way through the sheet passes through a ball.
inline constexpr double kBall = 2.5;

/// The points of a cloud whose density varies, for searches whose work does not depend on how much it varies.
///
/// A box tree over the points, halved along the longest axis. Each node knows the largest ball of its points, so that
/// the balls about a place are found wherever they end, by double arithmetic, exactly. Each point has a level, up to
/// which it is shown: with h the least spacing of the cloud,
///
///     level m:  every point whose spacing is at least 2^m h, and of the closer ones one per cube of that side.
///
/// A search with a spacing of s thus finds the surface covered by points no closer than about s / 4.
/// Where points are stacked, more than 32 in a box that is smaller than their spacing, 32 of them stay.
/// \thread  const calls from any number of threads at once; they allocate nothing
class PointTree {
public:
    /// \param positions  [m] copied
    /// \param spacings   [m] around each, > 0
    /// \param marks      of each; empty: none is marked
    PointTree(std::span<const glm::dvec3> positions, std::span<const double> spacings,
              std::span<const PointMark> marks = {});

    /// Returns the level for a search with the spacing `scale` [m]; 0, all points, where the density hardly varies.
    [[nodiscard]] int    level(double scale) const noexcept;
    [[nodiscard]] double cell(int level) const noexcept; ///< [m] side of its cubes; 0 for level 0
    [[nodiscard]] bool   mixed() const noexcept;         ///< the density varies by more than that of a random sheet
    [[nodiscard]] int    levels() const noexcept { return levels_; }
    [[nodiscard]] double largestSpacing() const noexcept { return largest_; } ///< [m]

    /// Calls visit(const NearPoint&) for the points shown at `level` within `radius` [m] of `centre` [m], always in the
    /// same order, until it returns false.
    template <class Visit>
    void inside(const glm::dvec3& centre, double radius, int level, Visit&& visit) const
    {
        const double r2 = radius * radius;
        walk([&](const Node& node) { return node.level >= level && distance2(node, centre) <= r2; },
             [&](std::size_t i) {
                 return shownUntil_[i] < level || distance2(points_[i], centre) > r2 || visit(points_[i]);
             });
    }

    /// Calls visit(const NearPoint&, squared distance [m^2]) for all points in whose own ball `place` [m] lies, in any
    /// order.
    template <class Visit>
    void holding(const glm::dvec3& place, Visit&& visit) const
    {
        walk([&](const Node& node) { return distance2(node, place) <= node.ball * node.ball; },
             [&](std::size_t i) {
                 const NearPoint& point  = points_[i];
                 const double     radius = kBall * point.spacing, d2 = distance2(point, place);
                 if (d2 < radius * radius) visit(point, d2);
                 return true;
             });
    }

    /// Returns the share [1] of the way between two places [m] after which it first enters a ball that `from` is not
    /// in; 1 if there is none.
    [[nodiscard]] double firstTouch(const glm::dvec3& from, const glm::dvec3& to) const noexcept;

private:
    static constexpr std::size_t kLeaf = 8; ///< most points of a leaf

    /// A node. They lie in the order of a walk from the root, near half first: node i + 1 is the first child of node i.
    struct Node {
        glm::dvec3    low{}, high{}; ///< [m] of the points
        double        ball  = 0;     ///< [m] largest radius of their balls
        std::uint32_t next  = 0;     ///< the node after this one's children
        std::uint32_t first = 0;     ///< of the points of a leaf
        std::uint16_t count = 0;     ///< of the points of a leaf; 0: not a leaf
        std::uint8_t  level = 0;     ///< highest of its points
    };

    [[nodiscard]] static double distance2(const Node& node, const glm::dvec3& place) noexcept
    {
        double sum = 0;
        for (int k = 0; k < 3; ++k) {
            const double d = std::max({node.low[k] - place[k], place[k] - node.high[k], 0.0});
            sum += d * d;
        }
        return sum;
    }
    [[nodiscard]] static double distance2(const NearPoint& point, const glm::dvec3& place) noexcept
    {
        const glm::dvec3 d = point.position - place;
        return d.x * d.x + d.y * d.y + d.z * d.z;
    }

    /// Calls visit(index) for the points of all leaves that `enter`, as their parents do, until it returns false.
    template <class Enter, class Visit>
    void walk(Enter&& enter, Visit&& visit) const
    {
        for (std::size_t n = 0; n < nodes_.size();) {
            const Node& node = nodes_[n];
            if (!enter(node)) {
                n = node.next;
                continue;
            }
            for (std::size_t i = node.first; i < std::size_t(node.first) + node.count; ++i)
                if (!visit(i)) return;
            ++n;
        }
    }

    struct Builder;

    std::vector<Node>         nodes_;
    std::vector<NearPoint>    points_;      ///< leaf by leaf; those that are in no leaf are stacked
    std::vector<std::uint8_t> shownUntil_;  ///< level, by point
    double                    least_   = 0; ///< [m] spacing
    double                    largest_ = 0; ///< [m] spacing
    int                       levels_  = 1;
};

} // namespace palp
