#pragma once
#include "engine/pipeline/compliance_table_solve.h"
#include "engine/pipeline/patch.h"

namespace palp {

// Sections 2.5 and 2.6 of the paper: what a patch whose plate is made answers to a press.

/// Returns the load of 1 N on the footprint about a place in the chart, where there is a sheet.
/// \param covered  share of the sheet at the nodes [1]; empty: all
[[nodiscard]] NodeField unitLoad(const PlateGrid& grid, const PatchSettings& settings, const NodeField& covered,
                                 const ChartPoint& place = {});
/// Returns that of a patch's own fingertip.
[[nodiscard]] NodeField unitLoad(const Patch& patch, const PatchSettings& settings);

/// Bends the plate under the fingertip.
void bendPlate(Patch& patch, const PatchSettings& settings, PlateSolver& solver);
/// Bends it also under each footprint of a lattice.
void bendPlate(Patch& patch, const PatchSettings& settings, const FootprintLattice& lattice, PlateSolver& solver,
               ComplianceTable& table);

/// Interpolates the response of the points bilinearly; what follows no place in the window does not move.
void movePoints(Patch& patch);

/// \param finger  its footprint, as if the sheet had no border: also beyond it tables have a contact
void findStiffness(Patch& patch, const SoftObject& object, const PatchSettings& settings, const Footprint& finger);

/// Returns whether a grid of twice the spacing carries the fingertip.
[[nodiscard]] bool hasCoarseGrid(const Patch& patch, const PatchSettings& settings);

/// Finds how the plate's force goes on where the dent is as deep as the sheet is thick, if the settings ask for it.
/// \param quick  for a hand that moves
void pressDeeper(Patch& patch, const PatchSettings& settings, PlateSolver& solver, bool quick);

} // namespace palp
