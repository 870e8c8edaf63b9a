#pragma once
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include <glm/vec3.hpp>

#include "engine/chart/chart.h"
#include "engine/chart/resample.h"
#include "engine/cloud/curvature_notes.h"
#include "engine/core/grid.h"

namespace palp {

/// A piece of surface that is touched from one side.
struct SurfaceSheet {
    std::span<const glm::dvec3> places;  ///< [m]
    std::span<const glm::dvec3> normals; ///< [1] unit, roughly, towards the finger; one for each place
};

/// Error of a fit's tensor over noise spacing / radius^3, measured [1].
inline constexpr double kFitNoiseError = 9.5;

/// Fits a quadric to the points of a sheet about a place.
///
/// Points count (1 - r^2 / radius^2)^2, r their distance along the surface, and less the farther they lie from the
/// quadric (Tukey's weights), so that stray points do not matter. The frame is turned to the fitted normal and the fit
/// done again. Of noise it keeps an error of about kFitNoiseError noise spacing / radius^3, and of the shape's own
/// change one that grows as radius^2: 4 % of an ellipsoid of half axes 60, 45, 35 mm at 20 mm.
/// \param centre  on or near the surface [m]
/// \return empty if the points determine no quadric
[[nodiscard]] std::optional<LocalCurvature> fitCurvature(const SurfaceSheet& sheet, const glm::dvec3& centre,
                                                         double radius);

struct CurvatureSettings {
    double spacing    = 0;     ///< of the sheet's points [m], > 0
    double noise      = 0;     ///< their standard deviation about the surface [m]
    double mostRadius = 0;     ///< of a fit [m], at least five spacings are taken
    double lengthRoot = 0;     ///< length over which a shell of curvature k feels its edge, times sqrt k [m^(1/2)]
    bool   isWide     = false; ///< the window is far wider than what is curved in it may be, as that of an object
};

/// The curvature tensor of the surface at the nodes of a window, in the chart's axes, > 0 where it bulges to the
/// finger.
struct CurvatureField {
    NodeField x, z, xz;   ///< [1/m]
    double    radius = 0; ///< of the fits [m]
};

/// A fit, and where its place is in the chart.
struct CurvatureSite {
    ChartPoint     place; ///< [m]
    LocalCurvature here;
    double         share = 1; ///< of the surface that it stands for, among others of its radius
};

/// What fits are for: the field, or only the radius of its fits, for which a quarter as many do.
enum class FitsFor { field, survey };

/// Returns the fits of one rung in and around a window.
using CurvatureSites = std::function<std::vector<CurvatureSite>(int rung, FitsFor what)>;

/// Returns the radius of a rung of the ladder of radii [m]. Fits are made with these alone, so that those of other
/// windows can be taken; a window asks for the two rungs about its own radius.
[[nodiscard]] double rungRadius(int rung) noexcept;

/// Returns where a radius [m] is on the ladder, between two rungs.
[[nodiscard]] double rungOf(double radius) noexcept;

/// Finds the curvature at the nodes of a window from fits at sites that do not depend on where the window lies.
///
/// The fits of a window have one radius: as small as noise permits, which may change the tensor by 2.5 % of what is
/// typical in the window, but not below the length of a shell of that curvature, beyond which detail is not felt, nor
/// above half the smallest radius of curvature. Two rungs are blended to it, so that it changes smoothly as the window
/// moves; so does the field of a rung, linear regression over the sites within a radius. The tensors are turned into
/// the chart by carrying its axes along the shortest arc to each normal. Beyond the border of the surface that of the
/// border goes on.
///
/// In a wide window what is typical is not what counts: by the radius for a flat panel, a lump on it of 2 mm and half a
/// width of 10 mm was felt 40 % too soft. There the radius is no wider than is right for the most curved fiftieth of
/// the surface, to 6 % of that.
/// \return empty if nowhere in the window the points determine a quadric
/// \thread as `sites`
[[nodiscard]] std::optional<CurvatureField> curvatureField(const PatchWindow& window, const Frame& frame,
                                                           const CurvatureSites&    sites,
                                                           const CurvatureSettings& settings);

} // namespace palp
