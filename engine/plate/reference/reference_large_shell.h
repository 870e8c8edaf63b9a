#pragma once
#include <span>
#include <vector>

#include "engine/plate/shell.h"

namespace palp {

/// A shell that is pressed deep, in equilibrium.
struct LargeState {
    double    depth = 0;      ///< of the unit load, load . w / sum of the load [m]
    double    force = 0;      ///< [N]
    NodeField deflection;     ///< w [m]
    NodeField stressFunction; ///< phi [N m]
    int       steps = 0;      ///< of Newton's method from the state before
};

/// The oracle of large deflections: presses a shell as deep as told, one depth after the other, by Newton's method on
/// both fields with all of the energy's second derivative, factorised anew in each step. The depth is held and the
/// force is an unknown, so that a force that falls as the shell snaps through is followed too.
/// \param unitLoad  forces at the nodes, 1 N together
/// \param depths    [m] ascending, in steps of at most some thicknesses; below zero: pulled
/// \throws Error as ReferenceShellSolver, or if Newton's method does not converge within 40 steps
/// \source  von Karman 1910; Marguerre 1938; Batoz & Dhatt 1979, displacement control
[[nodiscard]] std::vector<LargeState> pressDeep(const Shell& shell, const NodeField& unitLoad,
                                                std::span<const double> depths);

} // namespace palp
