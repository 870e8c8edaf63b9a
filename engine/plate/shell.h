#pragma once
#include <array>
#include <optional>
#include <string>
#include <vector>

#include "engine/plate/footprint.h"
#include "engine/plate/plate.h"

namespace palp {

/// A thin shallow shell: a plate whose surface at rest is curved, so that it resists by forces in its plane as well.
///
///     stationary point of  1/2 a(D, nu; w, w) - int w (kx phi_zz + kz phi_xx - 2 kxz phi_xz)
///                          - 1/2 a(C, -nu; phi, phi) + 1/2 int k s w^2 - int q w
///
/// a(D, nu; w, w) is the bending energy of Plate. Deflection w [m] is positive along the load, into the surface; phi
/// [N m] is Airy's function, whose second derivatives are the membrane forces Nx = phi_zz, Nz = phi_xx, Nxz = -phi_xz
/// [N/m], tension positive. C = 1/(E t) [m/N] is the compliance of the membrane: phi lies under the plate's operator.
///
/// An edge of phi is named as a plate's. Clamped: no force across the edge, the border of an object. Supported: no
/// normal force and no strain along the edge, as of a window cut from a larger body. Free: held in the plane.
/// \source  Marguerre 1938, linear part; Reissner 1946, stresses and small displacements of shallow spherical shells
struct Shell {
    Plate      bending;            ///< D, nu, foundation
    NodeField  membraneCompliance; ///< C [m/N], > 0
    PlateEdges stressEdges{Edge::supported, Edge::supported, Edge::supported, Edge::supported};
    NodeField  curvatureX, curvatureZ, curvatureXZ; ///< kx, kz, kxz [1/m], > 0 where the surface bulges to the finger
    NodeField  stressBed{}; ///< that holds phi at 0 where there is no sheet to carry a force [1/(N m^3)]: adds
                            ///< -1/2 int bed phi^2; empty: none
    /// Fields T [1] that phi may have besides, each times a number [N m] of its own, and that the bed does not hold:
    /// phi = psi + sum of y T, bed and sides hold psi, and the energy is stationary in each y too. Where free borders
    /// are in several pieces, Airy's function is another linear function at each, by the forces that the sheet carries
    /// between them, as an arch does. A T is linear where there is a bed.
    std::vector<NodeField> thrusts{};
    NodeField sheared{}; ///< share of shearWork() that counts at the nodes [1]: none where they stand for no free sheet
                         ///< or its sides; empty: all
    NodeField
        stretched{}; ///< whether slopes stretch a sheet at the nodes: 0 at the ground of what is held, else 1, where
                     ///< an object ends in the window; empty: everywhere
};

/// Returns in one sentence why a shell cannot be solved; empty if it can.
[[nodiscard]] std::optional<std::string> whyUnsolvable(const Shell& shell);

/// Returns the plate that Airy's function lies under: the membrane's compliance is its rigidity, and its Poisson's
/// ratio is -nu.
[[nodiscard]] Plate membraneOf(const Shell& shell);

/// Returns how much of a sheet there is at the nodes, where an object ends in the window [1]: D C, a length squared
/// that is the same all over a sheet of one thickness, over its largest value. Empty: it does not end there.
[[nodiscard]] NodeField sharesOfSheet(const Shell& shell);

/// Returns whether phi is held by no side and no bed: it is then known but for a linear function, which carries no
/// force.
[[nodiscard]] bool isStressFree(const Shell& shell) noexcept;

/// Returns the nodes at which such a function may be held: three corners.
[[nodiscard]] std::array<std::size_t, 3> pinsOfStress(const PlateGrid& grid) noexcept;

/// The work that a load does beyond that along w because the sheet is sheared across its thickness as well, to the
/// first order in thickness over length: the forces Q = div M across it, times Q / (5/6 G h).
///
/// Where a dent is only some thicknesses wide this matters: a dome of h/R 0.02 is 4 % softer by it, one of 0.04 7 %.
///
/// Where the rigidity changes from D1 to D2 within a width b, the twisting moment changes with it, by dM, and its slope
/// is a force along that rim whose work goes as dM^2 / b: without end as b vanishes, and with each finer grid. In
/// Reissner's theory it dies away over h / sqrt(10) to either side, which leaves dM^2 / (b + 4 h / sqrt(10)). So what
/// counts at a node is less by 1 + 0.55 h |grad ln D|: right for a change by ten. Solids by CalculiX, 2 mm thick with a
/// straight step or a disc ten and a hundred times as stiff, are felt within 3 % so at 128 cells, next to such a step
/// too.
/// \source  Reissner 1945; Castigliano's theorem
class Shear {
public:
    /// \param shell  whose bending outlives this
    explicit Shear(const Shell& shell);

    /// \param w  of the load [m]
    /// \return [N m]
    [[nodiscard]] double workOf(const NodeField& w) const;

private:
    const Plate& plate_;
    NodeField    alongX_, alongZ_; ///< area over 5/6 G h, between a node and the next [m^3/N]
};

/// Returns the same of one load [N m].
[[nodiscard]] double shearWork(const Shell& shell, const NodeField& w);

/// Returns the work that a load does less than that [N m] because it presses on the faces: they are squeezed towards
/// each other on one side of the middle and drawn apart on the other, and the sheet, which then widens there, bends
/// against the load by 6 nu q / (5 E h). Of a flat sheet this takes nu / 2 of the shear away, Reissner's (2 - nu) in
/// place of 2; a force that acts in the middle of the thickness would add to it.
/// \param load  that bends the shell by w [m]
/// \source  Reissner 1945
[[nodiscard]] double squeezeWork(const Shell& shell, const NodeField& w, const Footprint& load);

} // namespace palp
