#pragma once
#include <optional>

#include <glm/vec3.hpp>

#include "engine/cloud/soft_object.h"

namespace palp {

/// A hand in free space.
struct FreeHand {
    glm::dvec3 position{}; ///< [m]
    glm::dvec3 velocity{}; ///< [m/s]
};

/// A place of the surface that a hand may touch next.
struct Landing {
    glm::dvec3 place{};   ///< [m]
    glm::dvec3 outward{}; ///< [1] unit normal there, towards the hand
};

/// Returns where on the surface a hand in free space will be a lead from now, in the middle of the time during which
/// a table that is solved for now will be in use: it goes on straight to the surface and then along it.
///
/// Empty if the surface is farther away than 15 mm and than the hand goes in one and a half leads: a table made now
/// will be replaced before the hand is there.
/// \param lead  [s] see PatchSolver
/// \thread any, one at a time for each object; asks the index three times and allocates
[[nodiscard]] std::optional<Landing> landingOf(const SoftObject& object, const FreeHand& hand, double lead);

} // namespace palp
