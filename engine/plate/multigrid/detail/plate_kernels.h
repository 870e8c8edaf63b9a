#pragma once
#include <array>
#include <optional>

#include "compute_shaders/shared/coarse_band.h"
#include "engine/compute/kernel.h"
#include "engine/plate/multigrid/multigrid_plate_solver.h"

namespace palp {

/// The smoothing before and after each correction: sweeps in red and black, or steps of Chebyshev's iteration.
struct Smoothing {
    Smoother by;          ///< redBlack or chebyshev
    int      nested;      ///< on the coarser levels of the nested iteration
    int      finest;      ///< in the cycles of the finest level
    int      tiles;       ///< extra sweeps, in red and black, of the tiles where the rigidity jumps
    int      strongTiles; ///< the same where it varies by more than 3000
};

/// The kernels of compute_shaders/shared/plate_kernels.def by name, for one processor; those in two precisions compute
/// in doubles where the processor has them.
struct PlateKernels::All {
    /// The cycle in fewer and larger passes, of which [n] has n + 1 sweeps before and after the correction; conjugate
    /// gradients; and what is prepared for a rigidity.
    struct Fused {
#define PALPATE_FLOATS(name, spirv, source, define, Push, buffers, shape)
#define PALPATE_REALS(name, spirv, source, define, Push, buffers, shape)
#define PALPATE_FUSED(name, spirv, source, define, Push, buffers, shape) std::array<compute::Kernel, 2> name;
#define PALPATE_FUSED_SWEEPS_REALS(name, spirv, source, define, Push, buffers, shape)                                  \
    PALPATE_FUSED(name, spirv, source, define, Push, buffers, shape)
#define PALPATE_FUSED_FLOATS(name, spirv, source, define, Push, buffers, shape) compute::Kernel name;
#define PALPATE_FUSED_REALS(name, spirv, source, define, Push, buffers, shape) compute::Kernel name;
#include "compute_shaders/shared/plate_kernels.def"
    };

    /// The exact correction at the rims of inclusions, which only the host has; see rim.h.
    struct ExactRims {
        compute::HostKernel factor;
        compute::Kernel     first, last, start;
    };

    bool      doubles       = false; ///< in conjugate gradients
    bool      coarseDoubles = false; ///< on the coarsest level
    Smoothing smoothing;
    int       together = 1; ///< loads whose numbers lie side by side at every node of a field

    /// Cells along a side of the coarsest level. On a GPU the factor of 17 x 17 nodes takes longer than all else on a
    /// new map of 129 x 129, and half as many cells a side cost the cycle next to nothing. One core makes that factor
    /// in 0.02 ms, and the level between would cost each table more.
    int coarsestCells = shared::kMostCoarseCells;
#define PALPATE_FLOATS(name, spirv, source, define, Push, buffers, shape) compute::Kernel name;
#define PALPATE_REALS(name, spirv, source, define, Push, buffers, shape) compute::Kernel name;
#define PALPATE_FUSED(name, spirv, source, define, Push, buffers, shape)
#define PALPATE_FUSED_SWEEPS_REALS(name, spirv, source, define, Push, buffers, shape)
#define PALPATE_FUSED_FLOATS(name, spirv, source, define, Push, buffers, shape)
#define PALPATE_FUSED_REALS(name, spirv, source, define, Push, buffers, shape)
#include "compute_shaders/shared/plate_kernels.def"
    std::optional<ExactRims> rims{};  ///< if the smoother is Smoother::exactRims
    std::optional<Fused>     fused{}; ///< if the schedule is Schedule::fused

    [[nodiscard]] std::size_t realBytes() const noexcept
    {
        return doubles ? sizeof(double) : sizeof(float);
    }
    [[nodiscard]] std::size_t coarseBytes() const noexcept
    {
        return coarseDoubles ? sizeof(double) : sizeof(float);
    }
};

} // namespace palp
