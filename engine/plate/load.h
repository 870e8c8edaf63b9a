#pragma once
#include "engine/core/grid.h"

namespace palp {

// Loads are forces at the nodes [N], the energy's own gradient, so that they need no further weights. Positions are
// measured from the corner node (0, 0) of the grid.

/// Returns whether (x, z) [m] lies on the plate, edges included. Cells times spacing may round below the requested
/// size, so a place may lie slightly outside: the functions below take it for the edge.
[[nodiscard]] bool isOnPlate(const PlateGrid& grid, double x, double z) noexcept;

/// Returns the area of a node [m^2]: a cell's inside the plate, half on an edge, a quarter in a corner.
[[nodiscard]] double nodeArea(const PlateGrid& grid, int i, int j) noexcept;

/// Makes the load of a uniform pressure [Pa].
[[nodiscard]] NodeField uniformLoad(const PlateGrid& grid, double pressure);

/// Makes the load of a pressure given at the nodes [Pa].
[[nodiscard]] NodeField gridLoad(const PlateGrid& grid, const NodeField& pressure);

/// Makes the load of a point force [N] at (x, z) [m], shared bilinearly by the four nodes around it: force and moments
/// are kept.
[[nodiscard]] NodeField pointLoad(const PlateGrid& grid, double force, double x, double z);

/// Makes the load of a Gaussian pressure of total force [N] on the infinite plane: force exp(-r^2/(2 sigma^2)) / (2 pi
/// sigma^2). A node gets its integral against the bilinear hat of that node, so that a sigma below the spacing fades
/// into pointLoad with force and moments kept; the part beyond the edges is lost.
[[nodiscard]] NodeField gaussianLoad(const PlateGrid& grid, double force, double x, double z, double sigma);

/// Makes the load of a fingertip: a pressure proportional to (1 - (r/radius)^2)^2 within `radius` [m] of (x, z),
/// integrated on sub-cells, shared bilinearly and divided by its own sum, so that the total is exactly `force` [N].
/// \throws Error if the footprint does not lie wholly on the plate or is smaller than one spacing
/// \differs the paper uses the device's force, |F|, where its equation has a pressure, and does not name the area; here
///          the area is a constant of the scene, so that the answer depends neither on the grid nor on the points
[[nodiscard]] NodeField footprintLoad(const PlateGrid& grid, double force, double x, double z, double radius);

/// Returns the sum of the products at the nodes. For a load and a deflection it is the work; for a load of 1 N and its
/// own response, the compliance that the load feels [m/N].
[[nodiscard]] double dot(const NodeField& a, const NodeField& b);

/// Interpolates a node field bilinearly at (x, z) [m], which must lie on the plate.
[[nodiscard]] double interpolate(const PlateGrid& grid, const NodeField& field, double x, double z);

} // namespace palp
