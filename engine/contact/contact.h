#pragma once
#include <optional>

#include <glm/vec3.hpp>

#include "engine/cloud/soft_object.h"

namespace palp {

/// A touch, as the later stages need it.
struct Contact {
    glm::dvec3 point{};          ///< [m] a place on the cloud
    glm::dvec3 outward{0, 0, 1}; ///< [1] unit vector roughly from the surface to the hand; only its side counts
    /// The hand is there. If false, `outward` is a guess, and deform() overrules it where it lies along the surface.
    bool outwardKnown = true;
    /// `outward` is the normal of the surface as the proxy felt it. Where a fit of the neighbourhood disagrees by more
    /// than 60 degrees, as at the rim of a thin body, it stands in for the fit's.
    bool felt = false;
};

/// Finds the touch of a scripted finger: the foot of `place` on the surface, or the nearest point of the object where
/// the foot would lie beside all points, beyond a rim. The foot does not depend on where points happen to lie: beside a
/// wart the nearest one was felt up to 5 % stiffer or softer.
///
/// \param place  [m] where the finger goes; at most `reach` from the nearest point
/// \param from   [1] the side that the finger comes from; empty: away from the middle of the cloud's bounds, a guess
///               that is right for closed objects and for flat ones
/// \param reach  [m]
/// \throws Error naming the place, the distance and the nearest point, if it is farther than `reach`
[[nodiscard]] Contact touchAt(const SoftObject& object, const glm::dvec3& place, const std::optional<glm::dvec3>& from,
                              double reach);

} // namespace palp
