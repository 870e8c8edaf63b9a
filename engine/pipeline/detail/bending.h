#pragma once
#include "engine/core/grid.h"

namespace palp {

/// The second derivatives of a deflection at a node [1/m].
struct Bending {
    double xx = 0, zz = 0, xz = 0;

    /// \pre the node has eight neighbours
    [[nodiscard]] static Bending at(const PlateGrid& grid, const NodeField& w, int i, int j) noexcept
    {
        const double dx = grid.spacingX, dz = grid.spacingZ;
        return {(w(i + 1, j) - 2 * w(i, j) + w(i - 1, j)) / (dx * dx),
                (w(i, j + 1) - 2 * w(i, j) + w(i, j - 1)) / (dz * dz),
                (w(i + 1, j + 1) - w(i + 1, j - 1) - w(i - 1, j + 1) + w(i - 1, j - 1)) / (4 * dx * dz)};
    }

    /// Returns twice the bending energy of a plate there, over its rigidity [1/m^2].
    [[nodiscard]] double energy(double poissonRatio) const noexcept
    {
        return (xx + zz) * (xx + zz) - 2 * (1 - poissonRatio) * (xx * zz - xz * xz);
    }
};

} // namespace palp
