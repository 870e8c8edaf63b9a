#pragma once
#include <cstddef>
#include <functional>
#include <span>
#include <vector>

#include "engine/cloud/soft_object.h"
#include "engine/pipeline/patch.h"
#include "engine/plate/plate_solver.h"

namespace palp::fit {

struct FeltFitSettings {
    PatchSettings patch;           ///< the footprint is the probe's tip
    std::size_t   places    = 400; ///< approximate number of touches of a step
    int           mostSteps = 15;
    /// Returns (done, total); may be empty.
    std::function<void(std::size_t, std::size_t)> onStep{};
};

/// An object that feels as a map does, as far as anything could.
struct FeltFit {
    SoftObject          object;        ///< Young's modulus at each point
    std::vector<double> felt;          ///< at each point [N/m]
    std::vector<double> residual;      ///< felt per measured - 1 at each point [1]
    double              rest      = 0; ///< median of |ln(measured / felt)|: noise, and contrast finer than a touch [1]
    double              unsettled = 0; ///< the same of what was still to be corrected [1]
    int                 steps     = 0;
    std::size_t         leftOut   = 0; ///< places that could not be touched
    double              reach     = 0; ///< over which corrections are averaged: finer contrast is not recovered [m]
};

/// Finds the modulus of each point with which the program's own map of felt stiffness agrees with a measured one.
///
/// A step touches the object (feltMap()) and multiplies
///
///     E <- E (S[measured / felt])^(4/3)
///
/// where S is the mean of the logarithms over a Gaussian, its deviation twice the tip's radius. Felt stiffness goes as
/// E^(1/2) (the plate alone) to E^1 (the contact alone), so with that exponent an error loses two thirds in a step at
/// either end. What is finer than a touch S takes out: it cannot be told from noise and is left as residual. For the
/// same reason it ends when a step corrects less than half of what was left.
/// \param start     what was measured: its points, material, foundation and first guess of the modulus [Pa]
/// \param measured  felt stiffness at each of its points [N/m]
/// \throws Error if nothing can be touched
[[nodiscard]] FeltFit fitFeltMap(const SoftObject& start, std::span<const double> measured,
                                 const FeltFitSettings& settings, PlateSolver& solver);

} // namespace palp::fit
