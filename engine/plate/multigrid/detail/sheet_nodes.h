#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "engine/plate/shell.h"

namespace palp {

inline constexpr int kNone = -1; ///< number of what is no node and no unknown

using Which = std::vector<std::uint8_t>; ///< nodes of a grid: 1 for those that are meant

/// Returns the nodes at which the bed leaves something of Airy's function.
[[nodiscard]] Which withStress(const Shell& shell);

inline constexpr double kLeastSheet = 1e-5; ///< share of a sheet, ten times what the void has [1]

/// Returns the nodes at which there is more than a share of the sheet.
[[nodiscard]] Which onSheet(const NodeField& shares, double more);

/// Returns the nodes that terms of the sheet's own energy reach, and those beside which there is stress: a curvature
/// that ends where a stress does not loads it by the deflection itself, not by its second differences (a gutter that is
/// held at one end was felt four times too stiff).
[[nodiscard]] Which withDeflection(const PlateGrid& grid, const Which& sheet, const Which& stressed);

/// Takes those of a field's nodes away that its sides hold.
void takeOffHeld(Which& which, const Plate& plate);

/// Returns the node that a footprint presses on most, or kNone.
[[nodiscard]] int mostPressed(const Footprint& footprint);

/// Returns those of some nodes that hang together with one that is pressed.
[[nodiscard]] Which hangingTogether(const PlateGrid& grid, const Which& among, std::span<const Footprint> footprints);

/// Fills a field beyond the nodes that are known: a few rings as it goes on there, and the rest by their means.
void goOn(NodeField& field, const PlateGrid& grid, Which known);

} // namespace palp
