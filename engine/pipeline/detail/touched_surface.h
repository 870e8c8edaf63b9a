#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include <glm/vec3.hpp>

#include "engine/chart/sphere_fit.h"
#include "engine/cloud/soft_object.h"
#include "engine/contact/contact.h"

namespace palp {

/// The piece of the object's surface that a finger touches, without the other side of a thin body.
struct TouchedSurface {
    std::vector<std::uint32_t> inBall{};    ///< numbers of its points among those of the ball, in no order
    std::vector<glm::dvec3>    places{};    ///< of these points [m]
    std::vector<glm::dvec3>    normals{};   ///< the same, their signs as at the contact: towards the finger [1]
    glm::dvec3                 anchor{};    ///< [m] the contact, on the surface that the points around it have
    glm::dvec3                 normal{};    ///< [1] unit, of the surface there, towards the finger
    double                     spacing = 0; ///< [m] of the points there; the cloud's, where the density hardly varies
    double                     noise   = 0; ///< [m] standard deviation of the points there about the surface

    /// The sphere through the anchor. Points count (1 - d^2/r^2)^2, r the radius of the ball, and not where the surface
    /// has turned by 75 degrees: what lies around an edge is not what the finger lies on. Very many points that lie close to
    /// it take part by an even share.
    SphereFitResult sphere{};
};

/// Finds the piece around a contact. Where the points of the ball face alike and nowhere lie one over the other, they are
/// the piece; elsewhere a flood finds it, which costs some ten times as much.
/// \param ball    points of the object within `radius` [m] of the contact
/// \throws Error if the cloud has fewer than seven points or most of them coincide
[[nodiscard]] TouchedSurface touchedSurface(const SoftObject& object, const Contact& contact,
                                            std::span<const std::uint32_t> ball, double radius);

/// Returns the typical distance of neighbouring points at a place [m]: the cloud's, unless the density there is more
/// than twice or less than half as large. So nothing depends on chance where a cloud is even.
[[nodiscard]] double spacingAt(const SoftObject& object, const glm::dvec3& place);

} // namespace palp
