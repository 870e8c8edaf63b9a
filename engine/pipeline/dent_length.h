#pragma once
#include <algorithm>
#include <optional>

#include "engine/cloud/soft_object.h"
#include "engine/pipeline/patch.h"

namespace palp {

/// Widths of a patch window in lengths of a dent, from which its edges change 1 % or less of what a dome feels [1].
inline constexpr double kLocalWindow = 8;

/// Sag of a surface over the width of its patch window up to which the theory of shallow shells holds [1].
inline constexpr double kMostSag = 0.25;

/// The lesser principal curvature over the larger up to which a surface counts as curved one way: dents then reach far [1].
inline constexpr double kOneWay = 0.1;

/// Lengths over which dents die away by themselves on an object, at places spread evenly over it.
struct DentLengths {
    double least = 0, typical = 0, most = 0; ///< the median and the extremes [m]

    /// Returns the width of a patch window whose edges are felt nowhere but on spots flatter than most [m].
    [[nodiscard]] double window() const noexcept { return kLocalWindow * std::min(most, 1.5 * typical); }
};

/// Finds how far dents reach where the sheet's own stiffness, or what lies below it, ends them:
/// l^-4 = 12 (1 - nu^2) K / h^2 + k / D, K the Gaussian curvature where the surface bulges both ways, k the foundation.
/// \param settings  the foundation; the membrane counts only where the theory is a shell's
/// \return empty if at most places nothing ends them: the object's supports, or the window's edges, then decide
/// \note takes milliseconds, and longer on dense clouds
/// \thread pure
/// \source the shallow shell's l of Reissner 1946, with a foundation added to the membrane's
[[nodiscard]] std::optional<DentLengths> dentLengths(const SoftObject& object, const PatchSettings& settings);

/// Returns how wide the patch window of WindowOf::dent is [m]: as most places of the object ask for, but no wider than the
/// object fills in its middle, and at least four radii of the fingertip. Where nothing ends a dent it is as the settings say, but of shells no wider than kMostSag allows at all
/// but a twentieth of the places.
/// \note as dentLengths()
[[nodiscard]] double dentWindow(const SoftObject& object, const PatchSettings& settings);

} // namespace palp
