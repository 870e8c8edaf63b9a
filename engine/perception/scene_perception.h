#pragma once
#include <algorithm>
#include <array>
#include <functional>
#include <optional>
#include <vector>

#include "engine/perception/felt_path.h"
#include "engine/perception/perception.h"

namespace palp {

/// The steps that one group of people would notice along a path.
struct NoticedSteps {
    double weber   = 0; ///< W [1]
    double whole   = 0; ///< J between the stiffest and the softest place of the path
    double passing = 0; ///< J within kPassing; NaN: no two places are so near
    double floor   = 0; ///< J of the whole path on the homogeneous object: an artefact
    double right   = 0; ///< rightAnswers() for `whole`: stiffest and softest place side by side [1]
};

/// The largest floor that is allowed: half a step for the keenest finger, which judges it right in 63 of 100 trials.
inline constexpr double kMostFloor = 0.5;

/// A prediction of what is noticed along a path over a scene's object: at rest, by the model alone, and sliding,
/// through all of a session, beside the same slide over the same points with one stiffness.
struct ScenePerception {
    FeltLine                    line;
    std::vector<FeltPlace>      places; ///< at rest
    std::vector<FeltTick>       stroke; ///< sliding
    std::vector<FeltTick>       floor;  ///< sliding over the homogeneous object
    std::array<NoticedSteps, 3> atRest; ///< by kWeberFractions; `floor` is that of places at rest
    std::array<NoticedSteps, 3> sliding;
    std::string                 takeover{}; ///< who took over in a slide's session, see PlateSolver::takeoverSince()

    /// Returns the share of the strokes in which the surface holds the hand [1]; steps are then not all that is
    /// noticed.
    [[nodiscard]] double held() const { return std::max(heldShare(stroke), heldShare(floor)); }
    [[nodiscard]] bool   floorIsLow() const noexcept { return sliding.front().floor < kMostFloor; }
};

/// Computes the stiffness felt on the scene's object and on its homogeneous copy.
/// \param places  number of places at rest along the path, at least 2
/// \param onStep  (done, total) of some seconds each; may be empty
/// \throws as windowsAlong() and strokeAlong()
[[nodiscard]] ScenePerception perceive(const Scene& scene, const SoftObject& object, const FeltLine& line, int places,
                                       PlateSolver&                                         solver,
                                       const std::function<void(std::size_t, std::size_t)>& onStep = {});

} // namespace palp
