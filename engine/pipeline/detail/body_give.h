#pragma once
#include "engine/force/compliance_table.h"
#include "engine/pipeline/patch.h"

namespace palp {

/// Returns what a closed thin body gives way by beyond the dent, because its sheet is strained all around [m/N].
///
/// A window cut from it is a shallow shell, where a dent dies away. About a sphere the membrane carries the force to
/// where the body is held, over a surface that tilts, and gives way by (1 + nu) / (2 pi E h) (ln(2 R / rho) - 1) if
/// that is its equator: under a point force w goes as ln tan(theta / 2). A closed body is taken to be held just below
/// its widest, 78 degrees from the far end, as hands and tables do, which adds 0.4 to the logarithm: 4 % for a sphere
/// of h/R 0.02, 6 % for 0.04. R is of the mean Gaussian curvature across the window. A cap is held at its rim, which
/// takes some or all away; what lies on a foundation of k gives way by 1 + k R^2 / (E h) times less. A body that is
/// held at a small stem gives way more than this says.
///
/// rho^4 is (0.95 l)^4 and (0.43 a)^4 together, l the dent's length and a the footprint's radius. Solids by CalculiX
/// (axisymmetric, CAX8R, pressed on their faces) of h/R 0.01 and 0.03 and a of l to 6 l follow that to 0.1 of the
/// logarithm for nu of 0.3 to 0.49, and to 0.3 for nu of 0 and 0.15.
/// \return 0 where nothing bulges both ways, or where the window spans the object
/// \source  Membrane theory of a sphere under a point force, see Fluegge, Stresses in Shells, 1960
[[nodiscard]] double bodyCompliance(const Patch& patch, const SoftObject& object, const PatchSettings& settings);

/// Adds a compliance to what each footprint of a table feels.
/// \param more            in the middle of the table [m/N]
/// \param slopeX, slopeZ  how it grows along the table's axes [1/N]
void addToCompliances(ComplianceTable& table, double more, double slopeX = 0, double slopeZ = 0) noexcept;

} // namespace palp
