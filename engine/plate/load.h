#pragma once
#include "engine/core/grid.h"

namespace palp {

/// Loads as forces at the nodes [N], the energy's own gradient, so that they need no further weights.
/// Positions are measured from the corner node (0, 0) of the grid.

/// Whether (x, z) [m] lies on the plate, edges included. Cells times spacing may round below the size that was asked
/// for, so a place may lie a little outside: the functions below take it for the edge.
[[nodiscard]] bool isOnPlate(const PlateGrid& grid, double x, double z) noexcept;

/// The area that a node stands for: a cell's inside, half on an edge, a quarter in a corner [m^2].
[[nodiscard]] double nodeArea(const PlateGrid& grid, int i, int j) noexcept;

/// Makes the load of a uniform pressure [Pa].
[[nodiscard]] NodeField uniformLoad(const PlateGrid& grid, double pressure);

/// Makes the load of a pressure given at the nodes [Pa].
[[nodiscard]] NodeField gridLoad(const PlateGrid& grid, const NodeField& pressure);

/// Makes the load of a point force [N] at (x, z) [m], shared bilinearly by the four nodes around it: force and moments are kept.
[[nodiscard]] NodeField pointLoad(const PlateGrid& grid, double force, double x, double z);

/// Makes the load of a Gaussian pressure of total force [N] on the infinite plane: force exp(-r^2/(2 sigma^2)) / (2 pi sigma^2). A node
/// gets its integral against the bilinear hat of that node, so that a sigma below the spacing fades into pointLoad
/// with force and moments kept; what lies beyond the edges is lost.
[[nodiscard]] NodeField gaussianLoad(const PlateGrid& grid, double force, double x, double z, double sigma);

/// Makes the load of a fingertip: a pressure proportional to (1 - (r/radius)^2)^2 within `radius` [m] of (x, z), integrated on
/// sub-cells, shared bilinearly and divided by its own sum, so that the total is exactly `force` [N].
/// \throws Error if the footprint does not lie wholly on the plate or is smaller than one spacing
/// \differs the paper puts the device's force, |F|, where its equation has a pressure, and does not say on what area;
///          here the area is a constant of the scene, so that the answer depends neither on the grid nor on the points
[[nodiscard]] NodeField footprintLoad(const PlateGrid& grid, double force, double x, double z, double radius);

/// Sum of the products at the nodes. Of a load on a deflection it is the work; of a load of 1 N on its own response,
/// the compliance that the load feels [m/N].
[[nodiscard]] double dot(const NodeField& a, const NodeField& b);

/// Interpolates a node field bilinearly at (x, z) [m], which must lie on the plate.
[[nodiscard]] double interpolate(const PlateGrid& grid, const NodeField& field, double x, double z);

} // namespace palp
