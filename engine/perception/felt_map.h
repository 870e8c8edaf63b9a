#pragma once
#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "engine/contact/contact.h"
#include "engine/pipeline/deform.h"

namespace palp {

/// The felt stiffness of an object from place to place.
struct FeltMap {
    std::vector<std::uint32_t> places;      ///< points of the cloud that were touched
    std::vector<double>        stiffness;   ///< felt there [N/m]
    double                     typical = 0; ///< the median of them [N/m]
    std::size_t                leftOut = 0; ///< omitted places: their window holds too few points, or no surface
    std::vector<double>        atPoints;    ///< felt at every point of the cloud, between the places [N/m]
    std::string                takeover;    ///< as FeltTouches has it; empty where the solver is the caller's
};

/// Touches about `wanted` places spread evenly over the cloud, one in each cube of a lattice, or one on each side of an
/// object that is thinner than a cube.
/// \param wanted  at least 8; fewer are touched if the cloud has fewer points
/// \param onStep  (done, total); may be empty
/// \throws as deform() if no place can be touched
/// \source places: our own; between them the logarithm's mean with Gaussian weights, as wide as half an edge of the
///         lattice
[[nodiscard]] FeltMap feltMap(const SoftObject& object, const PatchSettings& settings, std::size_t wanted,
                              PlateSolver& solver, const std::function<void(std::size_t, std::size_t)>& onStep = {});

/// Does the same on all cores, with one place in each cube of this edge [m] that holds points, or one on each side.
/// \param solver  as PlateSolver takes it; every thread opens its own
/// \throws Error if no place can be touched
/// \thread any; starts threads
[[nodiscard]] FeltMap feltMapEvery(const SoftObject& object, const PatchSettings& settings, double edge,
                                   std::string_view solver);

/// The felt stiffness of many touches.
struct FeltTouches {
    std::vector<double> stiffness;   ///< [N/m], in the order of the touches; NaN where nothing can be touched
    std::size_t         leftOut = 0; ///< of them
    std::string         why;         ///< of one that was left out
    std::string         takeover;    ///< who took over on one of the threads, see PlateSolver::takeoverSince()
};

/// Touches an object many times, on all cores.
/// \param contact  makes the n-th contact; throws Error where there is none; called from several threads
/// \param solver   as PlateSolver takes it; every thread opens its own
/// \thread any; starts threads
[[nodiscard]] FeltTouches feltTouches(const SoftObject& object, const PatchSettings& settings, std::size_t count,
                                      const std::function<Contact(std::size_t)>& contact, std::string_view solver);

/// Returns, at every point, the share of right answers when the place is compared with the object's typical one [1]:
/// 0.5 to 1.
/// \param weber  smallest relative change that is noticed [1]
[[nodiscard]] std::vector<double> detectability(const FeltMap& map, double weber);

} // namespace palp
