#pragma once
#include "engine/gpu/kernel.h"
#include "engine/plate/plate_solver_vulkan.h"

namespace palp {

/// One kernel per shader and variant; `real` ones compute in doubles where the device has them.
struct PlateKernels::All {
    bool        doubles = false;
    gpu::Kernel coarsen, divisor, jumpMark, jumpList, assemble, factor; // once per rigidity
    gpu::Kernel relaxFirst, relax, relaxTile, copyTile, residual, restrict, correct,
        coarseSolve; // the cycle, in floats
    gpu::Kernel start, interpolate, interpolateFirst, dots, beta, direction, apply, stepDots, step, update,
        result; // real

    // Between points and nodes; the lift is real.
    gpu::Kernel rigidityNearest, rigidityLogMean, lift;

    [[nodiscard]] std::size_t realBytes() const noexcept { return doubles ? sizeof(double) : sizeof(float); }
};

} // namespace palp
