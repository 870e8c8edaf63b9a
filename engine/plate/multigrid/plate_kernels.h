#pragma once
#include <array>
#include <optional>

#include "engine/compute/kernel.h"
#include "engine/plate/multigrid/multigrid_plate_solver.h"

namespace palp {

/// How much is smoothed before and after each correction: sweeps in red and black, or steps of Chebyshev's iteration
/// [1].
struct Smoothing {
    Smoother by;          ///< not automatic
    int      nested;      ///< on the coarser levels of the nested iteration
    int      finest;      ///< in the cycles of the finest level
    int      tiles;       ///< extra sweeps, in red and black, of the tiles where the rigidity jumps
    int      strongTiles; ///< the same where it varies by more than 3000
};

/// One kernel per shader and variant; `real` ones compute in doubles where the device has them.
struct PlateKernels::All {
    /// The cycle in fewer and larger passes; [n] has n + 1 sweeps before and after the correction.
    struct Fused {
        std::array<compute::Kernel, 2> down, up, tail;
    };

    bool            doubles = false;
    Smoothing       smoothing;
    compute::Kernel coarsen, divisor, jumpMark, jumpList, assemble, factor; // once per rigidity
    compute::Kernel relaxFirst, relax, smoothFirst, smooth, relaxTile, copyTile, residual, restrict, correct,
        coarseSolve; // the cycle, in floats, pass by pass
    compute::Kernel start, interpolate, interpolateFirst, dots, beta, direction, apply, stepDots, step, update,
        result;                                                  // real
    compute::Kernel      rigidityNearest, rigidityLogMean, lift; // between points and nodes; the lift is real
    std::optional<Fused> fused{};                                ///< if the schedule is Schedule::fused

    [[nodiscard]] std::size_t realBytes() const noexcept { return doubles ? sizeof(double) : sizeof(float); }
};

} // namespace palp
