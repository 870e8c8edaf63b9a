#pragma once
#include "engine/chart/curvature_field.h"
#include "engine/core/grid.h"

namespace palp {

/// Replaces a curvature tensor by the nearest one that a surface can have: the second derivatives of one height.
///
/// Fits know nothing of each other, and what they find together is the curvature of no surface. Such a sheet is
/// stretched by moving as a whole: the shallow theory's strain is compatible up to the second derivatives of k w, of
/// which those of k must cancel (Codazzi). An object that its window spans moves far more than it bends, so that little
/// is enough: of a corrugated strip that is held at one end, whose fits are 1.4 % off such a surface, it made the tip
/// 2.5 times too stiff. A dent that dies away in its window does not feel it.
///
/// The height is made of cubic splines half a radius of the fits apart, and nearest over the sheet in the mean of the
/// tensors' squares.
/// \param covered  share of the sheet at the nodes [1], not empty
/// \source  Codazzi's equations in the metric of a plane, as for Marguerre's shell, whose curvature is that of a height
void makeCompatible(CurvatureField& field, const PlateGrid& grid, const NodeField& covered);

} // namespace palp
