#pragma once
#include "engine/pipeline/compliance_table_solve.h"
#include "engine/pipeline/patch.h"

namespace palp {

/// Returns whether a node lies on the sheet, not beyond a border of an object that the window spans.
[[nodiscard]] bool isOnSheet(const Patch& patch, std::size_t node);

/// Leaves of a patch's plate what the object covers: beyond its border the rigidity is next to nothing, so that the border
/// is free. Fills in patch.covered.
/// \param spacing  of the points where they are farthest apart [m]
/// \pre the plate's rigidity is that of the sheet, also beyond its border
void cutOut(Patch& patch, double spacing);

/// Lets those nodes of a patch's plate that are held stand on a foundation so firm that they stay where they are: with
/// 100 D / cell^4 a dent dies away within a cell.
/// \param held        share of each node that is held [1], see SoftObject::withHeld
/// \param foundation  of the scene [Pa/m]
void holdNodes(Patch& patch, const NodeField& held, double foundation);

/// Returns the rigidity of the sheet at the nodes [N m], also where cutOut() has taken it away.
[[nodiscard]] NodeField sheetRigidity(const Patch& patch);

/// Returns the footprint's load on the sheet alone, of the same force: none lies beyond the border.
/// \param covered   share of the sheet at the nodes [1]
/// \param instead   taken, as one that does not move, where hardly any of the footprint is on the sheet
[[nodiscard]] Footprint onSheet(const Footprint& footprint, const NodeField& covered, const Footprint& instead);

/// Returns the lattice with the loads that lie on the patch's sheet.
[[nodiscard]] FootprintLattice onSheet(const FootprintLattice& lattice, const Patch& patch);

} // namespace palp
