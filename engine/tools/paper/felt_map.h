#pragma once
#include <cstdint>
#include <functional>
#include <vector>

#include "engine/pipeline/deform.h"

namespace palp::report {

/// The felt stiffness of an object from place to place.
struct FeltMap {
    std::vector<std::uint32_t> places;      ///< points of the cloud that were touched
    std::vector<double>        stiffness;   ///< felt there [N/m]
    double                     typical = 0; ///< the median of them [N/m]
    std::size_t                leftOut = 0; ///< omitted places: their window holds too few points, or no surface
    std::vector<double>        atPoints;    ///< felt at every point of the cloud, between the places [N/m]
};

/// Touches about `wanted` places spread evenly over the cloud, one in each cube of a lattice.
/// \param wanted  at least 8; fewer are touched if the cloud has fewer points
/// \param onStep  (done, total); may be empty
/// \throws as deform() if no place can be touched
/// \source places: our own; between them the logarithm's mean with Gaussian weights, as wide as half an edge of the
///         lattice
[[nodiscard]] FeltMap feltMap(const SoftObject& object, const PatchSettings& settings, std::size_t wanted,
                              PlateSolver& solver, const std::function<void(std::size_t, std::size_t)>& onStep = {});

/// Returns, at every point, the share of right answers when the place is compared with the object's typical one [1]:
/// 0.5 to 1.
/// \param weber  smallest relative change that is noticed [1]
[[nodiscard]] std::vector<double> detectability(const FeltMap& map, double weber);

} // namespace palp::report
