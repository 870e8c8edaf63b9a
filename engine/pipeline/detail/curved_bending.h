#pragma once
#include "engine/pipeline/patch.h"

namespace palp {

/// Returns how far a curved object gives way over what the shallow theory says [1]: what bends it is not w'' alone but
/// w'' + k^2 w, because a circle that shrinks is curved more.
///
/// The work of the shallow theory's moments along k^2 w is what their energy changes by, to the first order. It counts
/// where a sheet bends over as much of its length as it is curved by: an arch of radius 50 mm and a span of 64 mm is
/// felt 2 to 4 % softer, one of 40 mm and 68 mm 5 to 8 %. What else the theory of such shells has, the strain of the
/// middle and the rotation about the normal times k, changed those, gutters and caps by 0.7 % at most.
///
/// k is the mean over the sheet: how far its normals turn as a whole. A lump that goes up and down with a panel is no
/// more bent by that, though w'' + k^2 w of it is large while w is taken for the same all over it (with its own k four
/// lumps were felt 2 to 11 % softer).
///
/// Where a sheet is curved both ways, terms of the Gaussian curvature are missing in what its stretching must be
/// compatible with as well, and these of bending alone make caps softer and cups stiffer than they are, by 2 to 4 %: so
/// k^2 counts by 1 - |k1 k2| / (mean of k1 and k2)^2, and on spheres and saddles not at all.
/// \param compliance  of the patch's response [m/N]
/// \return 1 where the window does not span the object: dents die away in it
/// \source  Morley 1959, an improvement on Donnell's approximation for thin-walled circular cylinders; Koiter 1960
/// \differs the energy's change at a given w, not an operator: c / (1 + q), Rayleigh's quotient, with q kept from -1/4 to
///          1, beyond which a first order says nothing
/// \pre patch.response is that of 1 N
[[nodiscard]] double curvedBending(const Patch& patch, double compliance);

} // namespace palp
