#pragma once
#include "engine/plate/shell.h"

namespace palp {

/// Returns the values at the nodes of a grid of twice the spacing; none of none.
[[nodiscard]] NodeField everySecondOf(const NodeField& fine, const PlateGrid& coarse);

/// Returns the shell on a grid of twice the spacing.
[[nodiscard]] Shell everySecondOf(const Shell& fine);

/// Blurs what a shell resists by as much as its map would be if it had been resampled on a grid of twice the spacing:
/// by the logarithms, with a Gaussian whose variance is what the wider kernel's exceeds the present one's by.
/// \param pointSpacing  of the points that its rigidity was resampled from [m]; 0 where those were means, which
///                      were smoothed as if they had been dense
void blurAsIfCoarser(Shell& shell, double pointSpacing);

} // namespace palp
