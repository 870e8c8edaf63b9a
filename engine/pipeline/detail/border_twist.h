#pragma once
#include "engine/pipeline/patch.h"

namespace palp {

/// Returns by how much more a sheet that ends in its window gives way because it does not resist twist up to its free
/// borders [m/N]; 0 where there are none.
///
/// Kirchhoff's plate twists as stiffly at a border as anywhere. In a sheet of thickness h the shear of twist turns
/// round there, within a thickness, so that a strip of width b resists twist by G b h^3/3 (1 - 0.63 h/b): as if each
/// border lay 0.315 h further in. To the first order that adds the work of Kirchhoff's twist w_nt on so wide a rim,
/// 0.315 h 2 (1 - nu) D w_nt^2 along it. Without it U-shaped bands of ten thicknesses were felt 1 % stiffer, hairpins
/// of four 5 %.
/// \source Timoshenko & Goodier 1970, section 109 (torsion of a rectangle); Friedrichs 1950 and Reissner 1945 have the
///         layer at a plate's border
/// \pre patch.response is that of 1 N
[[nodiscard]] double borderTwist(const Patch& patch);

} // namespace palp
