#pragma once
#include <optional>
#include <string>

#include "engine/cloud/soft_object.h"
#include "engine/pipeline/patch.h"

namespace palp {

/// Widths of a patch window in lengths of a dent, from which its edges change 1 % or less of what a dome feels [1]; of
/// what is curved unequally both ways see DentReach.
inline constexpr double kLocalWindow = 8;

/// Cells of a grid that the fingertip's radius spans at least [1]: what is felt is then right to 2 %.
inline constexpr double kFewestCells = 1.25;

/// Sag of a surface over the width of its patch window up to which the theory of shallow shells holds [1].
inline constexpr double kMostSag = 0.25;

/// The same of what bulges both ways, where a dent dies away before the surface is steep [1]: spheres that sag by a
/// half are felt within 1 % of shallow ones, sides of ellipsoids by 0.28 within 2.4 % of whole bodies, cigars by 0.57
/// and 0.72 within 5.1.
inline constexpr double kMostSagOfDome = 0.4;

/// Thickness over the smaller radius of curvature up to which a sheet counts as thin [1].
inline constexpr double kMostThick = 0.1;

/// The lesser principal curvature over the larger up to which a surface counts as curved one way: dents then reach far
/// [1].
inline constexpr double kOneWay = 0.02;

/// The same from which on it surely bulges both ways [1]: bodies down to it were compared with solids.
inline constexpr double kBothWays = 0.1;

/// Returns the sag that a surface of these principal curvatures may have, the larger by size first [1].
[[nodiscard]] constexpr double mostSag(double most, double least) noexcept
{
    return least / most > kBothWays ? kMostSagOfDome : kMostSag;
}

/// Returns the width beyond which the edges of a plate's window on a foundation are not felt, in lengths l =
/// (D/k)^(1/4) [1].
///
/// 10 hold the compliance to 0.1 %, and 12 where D varies by more than 10; measured against windows of 24 l for warts.
/// \param least, most  rigidity [N m]
[[nodiscard]] constexpr double foundationWindow(double least, double most) noexcept
{
    constexpr double kVaried = 10.001; // a law from 1 to 10 is rounded at the nodes [1]
    return most > kVaried * least ? 12 : 10;
}

/// Returns the length over which a dent of a shell dies away, times the root of its curvature [m^(1/2)]: l sqrt(k) =
/// sqrt(h) / (12 (1 - nu^2))^(1/4).
[[nodiscard]] double shellLengthRoot(const Material& material) noexcept;

/// How far a dent reaches about a place of a shell.
struct DentReach {
    double length = 0; ///< over which it dies away [m]; infinite where neither the shell nor a foundation ends it
    /// Width of a patch window that it hardly feels the edges of, in these lengths [1]: kLocalWindow, and more where
    /// one curvature is more than 1.35 times the other. Constant curvatures in ratios of 1, 1.5, 2, 3, 5 and 8 are felt
    /// within 1.5 % of their limit of wide windows from 8, 8, 10.5, 13.5, 20 and 26 lengths on, the window's corners
    /// along the principal directions. Without a foundation it is no wider than five of the smallest radii of
    /// curvature, and than two where the other one is next to nothing.
    double window = kLocalWindow;
};

/// Finds that by l^-4 = 12 (1 - nu^2) K / h^2 + k / D, K the Gaussian curvature where the surface bulges both ways.
/// \param most, least  principal curvatures, the larger by size first [1/m]
/// \param below        foundation over rigidity, k / D [1/m^4]
[[nodiscard]] DentReach dentReach(double most, double least, const Material& material, double below) noexcept;

/// Lengths over which dents die away by themselves on an object, at places spread evenly over it.
struct DentLengths {
    double least = 0, typical = 0, most = 0; ///< the median and the extremes [m]
    double window = 0; ///< width of a patch window, one for all of the object, see dentWindow() [m]
};

/// Finds how far dents reach where the sheet's own stiffness, or what lies below it, ends them, see dentReach(). Places
/// count by the area around them, so that it does not matter where the points are dense.
/// \param settings  the foundation; the membrane counts only where the theory is a shell's
/// \return empty if at most places nothing ends them: the object's supports, or the window's edges, then decide
/// \note takes milliseconds, and longer on dense clouds
/// \thread pure
/// \source the shallow shell's l of Reissner 1946, with a foundation added to the membrane's
[[nodiscard]] std::optional<DentLengths> dentLengths(const SoftObject& object, const PatchSettings& settings);

/// Shares of a shell's surface about which a touch leaves its theory, and warns [1].
struct BeyondShell {
    double deep  = 0; ///< the patch window sags by more than mostSag()
    double thick = 0; ///< the sheet is thicker than kMostThick of its smaller radius of curvature
};

/// Finds those, with the curvature at places spread evenly over the object.
/// \param window  width of the patch window [m]
/// \note as dentLengths()
[[nodiscard]] BeyondShell beyondShell(const SoftObject& object, const PatchSettings& settings, double window);

/// A patch window, and the grid in it.
struct DentWindow {
    double width = 0; ///< [m]
    int    cells = 0; ///< along it
};

/// Returns the patch window of WindowOf::dent. It is as wide as nearly all places of the object ask for where dents
/// end by themselves, but no wider than the object fills in its middle and its cells carry the fingertip, and at least
/// four radii of it. Where nothing ends a dent it is as the settings say, but of shells no wider than kMostSag allows
/// at most places. What places ask for is averaged by their area, so that it goes over gradually from the one to the
/// other, and hangs neither on how the object is turned nor on which of its points are looked at.
///
/// A window of more than 16 lengths of dents, as what is curved unequally both ways has, gets at least five cells to a
/// length, if these are no more than twice the settings': what is felt is then right to 1 %.
/// \note as dentLengths()
[[nodiscard]] DentWindow dentWindow(const SoftObject& object, const PatchSettings& settings);

/// Returns in one sentence how wide that is and why; empty if the settings do not leave the window to the object.
/// \note as dentLengths()
[[nodiscard]] std::string whyDentWindow(const SoftObject& object, const PatchSettings& settings);

} // namespace palp
