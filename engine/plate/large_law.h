#pragma once
#include <array>
#include <cstddef>

#include "engine/plate/plate_solver.h"
#include "engine/plate/shell.h"

namespace palp {

/// The force of a sheet over the depth of its load, beyond the linear theory: flat ones harden, domes give way.
///
/// It is given at depths 0, step, 2 step ... and trusted up to the last of them. Where the force would fall, as of a
/// dome that snaps through, its tangent is 0: a hand that is pulled in is no hand that feels.
struct LargeLaw {
    static constexpr int kSteps = 16;
    using Values                = std::array<double, std::size_t(kSteps) + 1>;

    double step = 0;  ///< [m]
    Values force{};   ///< [N]
    Values tangent{}; ///< [N/m], 0 or more; that at 0 is the linear theory's

    [[nodiscard]] double reach() const noexcept { return kSteps * step; } ///< [m]

    /// Returns the force at a depth of 0 or more [N]: cubic between the steps, straight beyond the last.
    [[nodiscard]] double forceAt(double depth) const noexcept;
    [[nodiscard]] double tangentAt(double depth) const noexcept; ///< [N/m], even between the steps
    /// Returns the depth of a force of 0 or more [m]; that of the last step if the force never comes so high.
    [[nodiscard]] double depthOf(double force) const noexcept;
};

/// Finds the law of a load by a reduced model of three shapes, or two where the sheet is flat: the linear one, and how
/// the linear shell answers to the forces that the best sum of the shapes before leaves over where the sheet is pressed
/// deep. phi follows exactly from any sum of them; so the energy is a polynomial of degree four in three numbers, and
/// is least at each depth.
///
/// Against all of the equations (pressDeep()) the force of plates, domes, ellipsoids, cylinders and saddles is right to
/// 0.2 % up to 0.8 thicknesses and to 0.8 % up to 1.8; on spots of stiffness to 1 % where the finger is on them, and
/// beside those of 10, 30 and 50 times to 2, 3 and 5 %. Beyond two, where domes may snap, it is not.
/// \param load      forces at the nodes, 1 N together
/// \param linear    deflection under that load [m]
/// \param reach     depth of the last step [m]
/// \throws Error as PlateSolver::solve()
/// \source  reduced bases of residuals, as by Noor & Peters 1980, "Reduced basis technique for nonlinear analysis of
///          structures", whose vectors are derivatives of the path; our own choice of these
[[nodiscard]] LargeLaw largeLaw(const Shell& shell, const NodeField& load, const NodeField& linear, double reach,
                                PlateSolver& solver, double tolerance = 1e-4);

} // namespace palp
