#pragma once
#include "engine/tools/bench/direct_solver.h"

namespace palp::bench {

/// Returns the largest difference over the largest deflection of the truth [1]. NaN and infinity in `found` make it
/// infinite.
[[nodiscard]] double errorOf(const NodeField& found, const NodeField& truth);

/// Returns the 2-norm of the nodal forces that remain on nodes that can move, over that of the load [1], computed in
/// doubles and moment form.
[[nodiscard]] double residualOf(const Plate& plate, const NodeField& force, const NodeField& w);

/// The answer against which algebraic errors on a grid are measured.
struct Truth {
    NodeField w;          ///< [m]
    double    correction; ///< the last step of refinement, over w [1]: errors near it are not to be trusted
};

/// Finds the answer of the grid's equations by a direct solver and iterative refinement until that stagnates. The
/// residuals are those of the energy, in moment form, and not of the assembled matrix, so that the answer does not
/// depend on the solver whose factors are used. Factorises anew.
[[nodiscard]] Truth refinedTruth(Direct& direct, const Plate& plate, const NodeField& force);

/// Returns the grid's own error, by Richardson: the method is of second order for smooth rigidities and loads, so
///
///     w_2h - w_h = 3 C h^2 + ..., hence  w_h - w = (w_2h - w_h) / 3
///
/// and this is the largest |w_2h - w_h| / 3 on the nodes that the two grids share, over the largest |w_h| [1]. A solve
/// has "discretisation accuracy" if errorOf() is at most that: more work would bring it closer to the grid's answer but
/// hardly to the plate's.
/// \param coarse  on every second node of `fine`
[[nodiscard]] double discretisationError(const NodeField& fine, const NodeField& coarse);

} // namespace palp::bench
