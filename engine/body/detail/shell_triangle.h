#pragma once
#include <array>

#include <glm/vec3.hpp>

namespace palp {

/// The stiffness of a triangle of a shell: of corner k the displacement along x, y and z [m] at 6 k, and a small turn
/// about these axes [rad] at 6 k + 3. A rigid turn by t about the origin moves a corner at r by t x r.
using TriangleStiffness = std::array<std::array<double, 18>, 18>;

/// Returns the stiffness of a flat triangle of a thin sheet.
///
/// Its membrane is the optimal triangle with drilling freedoms, its bending the discrete Kirchhoff triangle: along each
/// side the slope is a quadric, from the deflections and slopes of its ends, across it linear.
/// \param corners    [m] not in a line
/// \param modulus    E [Pa]
/// \param thickness  [m]
/// \thread pure; allocates nothing
/// \source  Felippa 2003, a study of optimal membrane triangles with drilling freedoms (OPT); Batoz, Bathe and Ho 1980,
///          a study of three-node triangular plate bending elements (DKT)
[[nodiscard]] TriangleStiffness shellTriangle(const std::array<glm::dvec3, 3>& corners, double modulus,
                                              double poissonRatio, double thickness);

} // namespace palp
