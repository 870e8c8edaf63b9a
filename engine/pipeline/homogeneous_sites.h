#pragma once
#include "engine/cloud/soft_object.h"
#include "engine/force/homogeneous_law.h"
#include "engine/pipeline/compliance_table_solve.h"

namespace palp {

/// Makes the law that answers until the first table: for each piece of the surface, half a footprint's radius wide, or
/// a spacing where points are sparse, the compliance of a homogeneous window, from the lattice's ladder of rigidities,
/// and the contact's stiffness.
///
/// To first order c changes with ln D by the bending energy that a place holds, which a load leaves within some
/// footprints: D is the geometric mean over that reach, FootprintLattice::feltRadius, by area. Over and beside a wart
/// of ten times the rigidity, 3 mm wide, that is right to 15 %. A shell is as curved everywhere as at a typical place
/// of it. Points of the other face of a thin body count as well.
///
/// Where windows are cut from a body, see isCutFromBody(), a place gives way by what its coarse shell does under a
/// fingertip there, where that is more: it is pressed at some 64 places, in half a second of one core, and between them
/// ln c goes over smoothly. Its mesh does not show the dent itself well, so that this is right to a fourth or so.
/// \thread any; uses all cores, some tenths of a second of one for a million points
/// \param lattice  of the same object and settings
[[nodiscard]] HomogeneousLaw homogeneousLaw(const SoftObject& object, const FootprintLattice& lattice,
                                            const PatchSettings& settings);

} // namespace palp
