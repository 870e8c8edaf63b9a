#pragma once
#include <algorithm>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include "engine/chart/sphere_fit.h"
#include "engine/cloud/soft_object.h"
#include "engine/contact/contact.h"

namespace palp {

/// The points of a ball about the contact, in one order.
struct Ball {
    std::vector<std::uint32_t>
        ranks; ///< along the curve of the object's index, along which neighbours are side by side
    std::vector<std::uint32_t> points;     ///< of the object
    glm::dvec3                 centre{};   ///< [m]
    double                     radius = 0; ///< [m]
};

/// Gathers the points of an object within a radius of a place [m].
[[nodiscard]] Ball ballOf(const SoftObject& object, const glm::dvec3& centre, double radius);

/// Chooses an even share of an object's points, the same ones wherever the finger is. Ranks along the curve times the
/// golden ratio are spread evenly over the unit interval: so are, over the surface, those that fall into a part of it.
class EvenShare {
public:
    /// Returns a share of some `enough` of `count` points; all of them unless they are more than twice as many.
    [[nodiscard]] static EvenShare of(std::size_t count, std::size_t enough) noexcept
    {
        return count > 2 * enough ? EvenShare(double(enough) / double(count)) : EvenShare();
    }

    [[nodiscard]] bool has(std::uint32_t rank) const noexcept { return rank * kGolden <= last_; }

    /// Returns 1 for points of the share, and less at its limit, so that points come and go gently where the share
    /// changes [1].
    [[nodiscard]] double weightOf(std::uint32_t rank) const noexcept
    {
        return share_ < 1 ? std::min(1.0, (share_ - (rank * kGolden) * 0x1p-32) / (kLimit * share_)) : 1;
    }

private:
    static constexpr double        kLimit  = 0.1;         ///< of the share [1]
    static constexpr std::uint32_t kGolden = 2654435769U; ///< 2^32 over the golden ratio

    EvenShare() = default;
    explicit EvenShare(double share) : share_(share), last_(std::uint32_t(share * 0x1p32)) {}

    double        share_ = 1;          ///< [1]
    std::uint32_t last_  = 0xffffffff; ///< place of its last point
};

/// The piece of the object's surface that a finger touches, without the other side of a thin body.
class TouchedSurface {
public:
    glm::dvec3 anchor{};    ///< [m] the contact, on the surface that the points around it have
    glm::dvec3 normal{};    ///< [1] unit, of the surface there, towards the finger
    double     spacing = 0; ///< [m] of the points there; the cloud's, where the density hardly varies
    double     noise   = 0; ///< [m] standard deviation of the points there about the surface

    /// The sphere through the anchor. Points count (1 - d^2/r^2)^2, r the radius of the ball, and not where the surface
    /// has turned by 75 degrees: what lies around an edge is not what the finger lies on. Very many points take part
    /// by an even share.
    SphereFitResult sphere{};

    TouchedSurface() = default;
    /// Makes the surface of all points of a ball, whose normals are those of the survey with the sign that agrees with
    /// the first one. It reads what the object has: of 200 000 points nothing is copied.
    /// \param least  cosine of the largest angle between first and a normal [1]
    TouchedSurface(const SoftObject& object, const Ball& ball, const glm::dvec3& first, double least);
    /// Makes the surface of some points of a ball.
    /// \param inBall   their numbers in it
    /// \param normals  [1] their signs as at the contact: towards the finger
    TouchedSurface(const SoftObject& object, const Ball& ball, std::span<const std::uint32_t> inBall,
                   std::span<const glm::dvec3> normals);

    [[nodiscard]] std::size_t size() const noexcept { return whole_ ? ball_->ranks.size() : inBall_.size(); }
    [[nodiscard]] bool        whole() const noexcept { return whole_; } ///< all points of the ball, in its order
    /// Returns the number of a point among those of the ball.
    [[nodiscard]] std::size_t   inBall(std::size_t k) const noexcept { return whole_ ? k : inBall_[k]; }
    [[nodiscard]] std::uint32_t point(std::size_t k) const noexcept { return ball_->points[inBall(k)]; }
    [[nodiscard]] std::uint32_t rank(std::size_t k) const noexcept { return ball_->ranks[inBall(k)]; }
    [[nodiscard]] glm::dvec3    place(std::size_t k) const noexcept { return positions_[rank(k)]; } ///< [m]
    /// Returns the normal of a point [1], its sign as at the contact: towards the finger.
    [[nodiscard]] glm::dvec3 normalAt(std::size_t k) const noexcept
    {
        return whole_ ? normalOfRank(ball_->ranks[k]) : normals_[k];
    }
    /// Returns true if it is a whole ball all of whose normals are surely less than a right angle from `normal`.
    [[nodiscard]] bool allFace() const;
    /// Calls visit(place [m], normal [1]) for the points within `radius` [m] of `centre` [m].
    template <class Visit>
    void eachNear(const glm::dvec3& centre, double radius, Visit&& visit) const;
    /// Turns all normals to the other side.
    void turnOver();

private:
    [[nodiscard]] glm::dvec3 normalOfRank(std::uint32_t rank) const noexcept
    {
        const glm::dvec3 own = object_->survey().normalOfRank(rank);
        return glm::dot(own, first_) < 0 ? -own : own;
    }

    const SoftObject*           object_ = nullptr;
    const Ball*                 ball_   = nullptr;
    std::span<const glm::dvec3> positions_{}; ///< of the object, by rank [m]
    bool                        whole_ = false;
    glm::dvec3                  first_{};   ///< of the whole ball, see the constructor [1]
    double                      least_ = 0; ///< the same
    std::vector<std::uint32_t>  inBall_{};  ///< unless it is the whole ball
    std::vector<glm::dvec3>     normals_{}; ///< the same [1]
};

/// Finds the piece around a contact: its points and their normals. Where the points of the ball face alike and nowhere
/// lie one over the other, they are the piece; elsewhere a flood finds it, which costs some five times as much, and ten
/// times where it comes for the first time.
/// \param enough  points; where they are more than twice as many the flood takes an even share of them, but none so
///                sparse that a step could pass through the sheet
/// \param ball  of the object's points, about the contact; the answer reads it as long as it lives
/// \throws Error if the cloud has fewer than seven points or most of them coincide
[[nodiscard]] TouchedSurface pieceOf(const SoftObject& object, const Contact& contact, const Ball& ball,
                                     std::size_t enough = std::numeric_limits<std::size_t>::max() / 2);

/// Finds the piece and all that describes it.
[[nodiscard]] TouchedSurface touchedSurface(const SoftObject& object, const Contact& contact, const Ball& ball);

/// Returns the typical distance of neighbouring points at a place [m]: the cloud's, unless the density there is more
/// than twice or less than half as large. So nothing depends on chance where a cloud is even.
[[nodiscard]] double spacingAt(const SoftObject& object, const glm::dvec3& place);

} // namespace palp
