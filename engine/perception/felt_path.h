#pragma once
#include <string>
#include <vector>

#include <glm/vec3.hpp>

#include "engine/pipeline/deform.h"
#include "engine/session/hand_path.h"
#include "engine/session/scene.h"

namespace palp {

/// A line over an object, along which a finger feels.
struct FeltLine {
    HandPlace  middle;
    glm::dvec3 direction{1, 0, 0}; ///< [1] unit vector, perpendicular to the middle's outward direction
    double     reach = 10e-3;      ///< to either side, measured in the plane through the middle [m]
};

/// Returns the line through the scene's place.
/// \param direction  approximate direction; empty: the chart's east there
/// \throws Error if the direction is zero, not finite, or runs along the outward one
[[nodiscard]] FeltLine feltLine(const Scene& scene, const SoftObject& object,
                                const std::optional<glm::dvec3>& direction, double reach);

/// A place of the line with a finger at rest on it.
struct FeltPlace {
    double     along = 0;            ///< from the middle [m]
    glm::dvec3 place{};              ///< on the surface [m]
    double     contactStiffness = 0; ///< k_c [N/m]
    double     compliance       = 0; ///< c [m/N]

    [[nodiscard]] double felt(ForceLaw law) const noexcept { return feltStiffness(law, contactStiffness, compliance); }
};

/// Runs deform() about evenly spread places of the line, with axes carried from one to the next. The direction of the
/// finger turns with the surface, as a hand's does.
/// \param places  at least 2
/// \throws as deform(), and Error where the points determine no surface
[[nodiscard]] std::vector<FeltPlace> windowsAlong(const SoftObject& object, const PatchSettings& settings,
                                                  const FeltLine& line, int places, PlateSolver& solver);

/// The stiffness that a sliding finger feels at one tick.
struct FeltTick {
    double along     = 0; ///< of the proxy, from the middle [m]
    double stiffness = 0; ///< force on the hand over its depth [N/m]
    /// The surface keeps the proxy from following the hand, as a wall across the path does: the hand is several times
    /// as deep as it is meant to be, or the force is limited. What is felt then is no stiffness along the path.
    bool held = false;
};

/// Returns the share of ticks in which the hand is held [1].
[[nodiscard]] double heldShare(const std::vector<FeltTick>& ticks);

/// What a sliding finger feels.
struct FeltStroke {
    std::vector<FeltTick> ticks;
    std::string           takeover; ///< who took over in its session, see PlateSolver::takeoverSince()
};

/// Moves a hand once to and fro along the line at constant depth, through all parts of a session: proxy, tables at the
/// scene's rate, hand-over, tank and governor, in virtual time. Ticks count from the moment when the force is fully on.
/// \throws as runVirtual(), and Error if the hand met nothing
[[nodiscard]] FeltStroke strokeAlong(const SoftObject& object, const Scene& scene, const FeltLine& line);

/// Returns the same points with one stiffness for all, the geometric mean, and one b, on an even foundation. A change
/// felt on it is an artefact.
[[nodiscard]] SoftObject homogeneous(const SoftObject& object);

/// The logarithm of the ratio of the stiffest to the softest place [1].
struct FeltRange {
    double whole   = 0; ///< along all of the path
    double passing = 0; ///< within kPassing: places that can be compared without memory; NaN: no two are so near
};
inline constexpr double kPassing = 5e-3; ///< about a fingertip's width [m]

[[nodiscard]] FeltRange rangeOf(const std::vector<FeltPlace>& places, ForceLaw law);
[[nodiscard]] FeltRange rangeOf(const std::vector<FeltTick>& ticks); ///< of those in which the hand is not held

} // namespace palp
