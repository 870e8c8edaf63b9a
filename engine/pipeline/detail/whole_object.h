#pragma once
#include "engine/pipeline/compliance_table_solve.h"
#include "engine/pipeline/patch.h"

namespace palp {

/// Returns whether the scene holds a node.
[[nodiscard]] bool isHeld(const Patch& patch, std::size_t node);

/// Leaves of a patch's plate what the object covers: beyond its border the rigidity is next to nothing, so that the
/// border is free. Fills in patch.covered and patch.beyond.
/// \differs the paper's window is cut from the object and held at its sides
/// \param spacing  of the points where they are farthest apart [m]
/// \pre the plate's rigidity is that of the sheet, also beyond its border
void cutOut(Patch& patch, double spacing);

/// Does the same with the membrane, which carries no force beyond the border (patch.stressBed), and where nodes are
/// held hardly stretches: what surrounds a shell then stays where it is in its plane. Fills in patch.thrusts too.
///
/// Airy's function is held at 0 at a free border. Where these are in several pieces it is another linear function at
/// each, by the forces that the sheet carries between them, from one support to another or past a hole.
/// \pre its compliance is that of the sheet, also beyond its border
void cutOutMembrane(Patch& patch);

/// Lets those nodes of a patch's plate that are held stand on a foundation so firm that they stay where they are. What
/// is free is clamped where half of it is held. Fills in patch.held and patch.heldNodes.
/// \param shares      of each node that is held [1], see SoftObject::withHeld
/// \param width       of the Gaussian that made these of the points' [m]
/// \param foundation  of the scene [Pa/m]
/// \param load        of the fingertip, on the sheet: only its piece counts in heldNodes
void holdNodes(Patch& patch, const NodeField& shares, double width, double foundation, const NodeField& load);

/// Returns whether two loads press on one piece of the sheet.
[[nodiscard]] bool areOnOnePiece(const Patch& patch, const NodeField& a, const NodeField& b);

/// Returns how many nodes the scene holds of the pieces that a load presses on.
[[nodiscard]] std::size_t heldNodesUnder(const Patch& patch, const NodeField& load);

constexpr std::size_t kFewestHeld = 3; ///< nodes hold a sheet in space
/// Returns whether nothing holds what is touched, so that it would move off as a whole.
[[nodiscard]] bool isLoose(const Patch& patch, const PatchSettings& settings);

/// Finds how much of the sheet is in pieces that the fingertip's load does not touch. Fills in patch.apart.
void findApart(Patch& patch, const NodeField& load);

/// Finds where the sheet bends freely: neither at its border, nor where it is held. The moments jump there, over one
/// cell instead of none, and their slopes are no forces. Fills in patch.sheared.
void findSheared(Patch& patch);

/// Returns the rigidity of the sheet at a node [N m], also where cutOut() has taken it away.
[[nodiscard]] double sheetRigidity(const Patch& patch, std::size_t node);

/// Returns the footprint's load on the sheet alone, of the same force: none lies beyond the border. A fingertip of
/// which hardly anything is on the sheet presses on the nearest place of the border.
/// \param covered   share of the sheet at the nodes [1]
[[nodiscard]] Footprint onSheet(const Footprint& footprint, const NodeField& covered);

/// Returns that load on one piece of the sheet alone, the one that bears most of it. A fingertip that reaches across a
/// slit is felt as if it touched one side: on the other one, which nothing may hold, no part of it weighs.
[[nodiscard]] Footprint onPiece(const Footprint& footprint, const PlateGrid& grid, const NodeField& covered);

/// Returns the lattice with the loads that lie on the touched piece of the patch's sheet; of those of which hardly
/// anything does, the middle one instead.
[[nodiscard]] FootprintLattice onSheet(const FootprintLattice& lattice, const Patch& patch);

} // namespace palp
