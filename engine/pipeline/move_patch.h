#pragma once
#include <optional>

#include "engine/pipeline/compliance_table_solve.h"
#include "engine/pipeline/patch.h"

namespace palp {

/// Presses a patch whose window spans the object at another contact, for a hand that moves: chart, grid, rigidity and
/// curvature stay, and with them the factor of a shell, so that only the loads are solved for. That takes a fifth to a
/// third of the time of a new patch.
///
/// The contact has a chart of its own, which the table is about. How that one lies in the patch's is found from the
/// points around, which have a place in both.
/// \param from      deformWithTable(), windowAbout() or this has made it; `gathered` and the warnings stay its
/// \param lattice   of the table there, whose loads do not count
/// \param settings, solver, carried  as deformWithTable() has them
/// \param table     of the patch there; of none it is anything
/// \return the patch there; nothing where it takes a new one: the window is of the contact alone; the patch's chart has
///         lengths there that are off by more than 3 %, or shows another side, layer or piece of the object; the
///         contact is farther than a fingertip beside it, or the points around are too few
/// \throws Error as deform()
/// \thread that of the solver
[[nodiscard]] std::optional<Patch> movePatch(const Patch& from, const SoftObject& object, const Contact& contact,
                                             const PatchSettings& settings, const FootprintLattice& lattice,
                                             PlateSolver& solver, const std::optional<Frame>& carried,
                                             ComplianceTable& table);

} // namespace palp
