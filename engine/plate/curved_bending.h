#pragma once
#include "engine/core/grid.h"
#include "engine/plate/footprint.h"
#include "engine/plate/shell.h"

namespace palp {

/// What bends a curved object besides w'': the circle that shrinks is curved more, by k^2 w, which the shallow theory
/// leaves out.
///
/// The work of the shallow theory's moments along k^2 w is what their energy changes by, to the first order. It counts
/// where a sheet bends over as much of its length as it is curved by: an arch of radius 50 mm and a span of 64 mm is
/// felt 2 to 4 % softer, one of 40 mm and 68 mm 5 to 8 %. What else the theory of such shells has, the strain of the
/// middle and the rotation about the normal times k, changed those, gutters and caps by 0.7 % at most.
///
/// k is the mean over the free sheet: how far its normals turn as a whole. A lump that goes up and down with a panel is
/// no more bent by that, though w'' + k^2 w of it is large while w is taken for the same all over it (with its own k
/// four lumps were felt 2 to 11 % softer). A strip that is in part flat and in part curved is served badly by a mean.
///
/// Where a sheet is curved both ways, terms of the Gaussian curvature are missing in what its stretching must be
/// compatible with as well, and these of bending alone make caps softer and cups stiffer than they are, by 2 to 4 %: so
/// k^2 counts by 1 - |k1 k2| / (mean of k1 and k2)^2, and on spheres and saddles not at all.
/// \source  Morley 1959, an improvement on Donnell's approximation for thin-walled circular cylinders; Koiter 1960
/// \differs the energy's change at a given w, not an operator: see givesWay()
class CurvedBending {
public:
    /// \param shell  whose bending outlives this. Without a border, Shell::stretched, nothing counts: dents die away
    ///          within
    explicit CurvedBending(const Shell& shell);

    /// Returns the work of the moments of w along k^2 w [N m].
    /// \param w  of the load [m]
    [[nodiscard]] double workOf(const NodeField& w) const;

private:
    const Plate& plate_;
    double       xx_ = 0, zz_ = 0, xz_ = 0; ///< of k^2 [1/m^2]
};

/// Returns how far a footprint gives way over what the shallow theory says [1]: 1 / (1 + q), Rayleigh's quotient, where
/// q is the change of energy over the energy, from -1/4 to 1 at most, beyond which a first order says nothing.
[[nodiscard]] double givesWay(const FootprintResponse& response) noexcept;

} // namespace palp
