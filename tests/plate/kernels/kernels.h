#pragma once
#include "compute_shaders/cg_beta_f32.spv.h"
#include "compute_shaders/cg_beta_f64.spv.h"
#include "compute_shaders/cg_direction_f32.spv.h"
#include "compute_shaders/cg_direction_f64.spv.h"
#include "compute_shaders/cg_dots_f32.spv.h"
#include "compute_shaders/cg_dots_f64.spv.h"
#include "compute_shaders/cg_step_dots_f32.spv.h"
#include "compute_shaders/cg_step_dots_f64.spv.h"
#include "compute_shaders/cg_step_f32.spv.h"
#include "compute_shaders/cg_step_f64.spv.h"
#include "compute_shaders/cg_update_f32.spv.h"
#include "compute_shaders/cg_update_f64.spv.h"
#include "compute_shaders/coarse_assemble_f32.spv.h"
#include "compute_shaders/coarse_assemble_f64.spv.h"
#include "compute_shaders/coarse_factor_f32.spv.h"
#include "compute_shaders/coarse_factor_f64.spv.h"
#include "compute_shaders/coarse_solve_f32.spv.h"
#include "compute_shaders/coarse_solve_f64.spv.h"
#include "compute_shaders/jump_list.spv.h"
#include "compute_shaders/jump_mark.spv.h"
#include "compute_shaders/plate_apply_f32.spv.h"
#include "compute_shaders/plate_apply_f64.spv.h"
#include "compute_shaders/plate_copy_tile.spv.h"
#include "compute_shaders/plate_correct.spv.h"
#include "compute_shaders/plate_divisor.spv.h"
#include "compute_shaders/plate_down.spv.h"
#include "compute_shaders/plate_interpolate_f32.spv.h"
#include "compute_shaders/plate_interpolate_f64.spv.h"
#include "compute_shaders/plate_interpolate_first_f32.spv.h"
#include "compute_shaders/plate_interpolate_first_f64.spv.h"
#include "compute_shaders/plate_lift_f32.spv.h"
#include "compute_shaders/plate_lift_f64.spv.h"
#include "compute_shaders/plate_relax.spv.h"
#include "compute_shaders/plate_relax_first.spv.h"
#include "compute_shaders/plate_relax_tile.spv.h"
#include "compute_shaders/plate_residual.spv.h"
#include "compute_shaders/plate_restrict.spv.h"
#include "compute_shaders/plate_result_f32.spv.h"
#include "compute_shaders/plate_result_f64.spv.h"
#include "compute_shaders/plate_smooth.spv.h"
#include "compute_shaders/plate_smooth_first.spv.h"
#include "compute_shaders/plate_start_f32.spv.h"
#include "compute_shaders/plate_start_f64.spv.h"
#include "compute_shaders/plate_tail.spv.h"
#include "compute_shaders/plate_up.spv.h"
#include "compute_shaders/rigidity_coarsen.spv.h"
#include "compute_shaders/rigidity_log_mean.spv.h"
#include "compute_shaders/rigidity_nearest.spv.h"
#include "compute_shaders/shared/plate_push.h"
#include "compute_shaders/shared/tail_level.h"
#include "engine/compute/kernel.h"
#include "engine/plate/host/host_kernels.h"

/// The plate's kernels by name; those of conjugate gradients as code<float>() or code<double>().
namespace palp::kernels {

inline const HostKernels& host()
{
    return *hostVariant().kernels;
}

template <class Constants, std::size_t N>
compute::KernelCode code(const char* name, const std::uint32_t (&spirv)[N], int buffers, compute::HostKernel host)
{
    return {name, spirv, buffers, int(sizeof(Constants)), host};
}

#define PALPATE_KERNEL(function, name, Constants, buffers)                                                             \
    inline compute::KernelCode function()                                                                              \
    {                                                                                                                  \
        return code<shared::Constants>(#name, name##_spv, buffers, host().function);                                   \
    }
/// One that the host does without.
#define PALPATE_GPU_KERNEL(function, name, Constants, buffers)                                                         \
    inline compute::KernelCode function()                                                                              \
    {                                                                                                                  \
        return code<shared::Constants>(#name, name##_spv, buffers, nullptr);                                           \
    }
#define PALPATE_REAL_KERNEL(function, name, Constants, buffers)                                                        \
    template <class Real>                                                                                              \
    compute::KernelCode function()                                                                                     \
    {                                                                                                                  \
        if constexpr (sizeof(Real) == sizeof(double))                                                                  \
            return code<shared::Constants>(#name "_f64", name##_f64_spv, buffers, host().function##_f64);              \
        else                                                                                                           \
            return code<shared::Constants>(#name "_f32", name##_f32_spv, buffers, host().function##_f32);              \
    }

PALPATE_KERNEL(coarsen, rigidity_coarsen, TransferPush, 2)
PALPATE_KERNEL(divisor, plate_divisor, LevelPush, 2)
PALPATE_KERNEL(relaxFirst, plate_relax_first, RelaxPush, 3)
PALPATE_KERNEL(relax, plate_relax, RelaxPush, 6)
PALPATE_KERNEL(smoothFirst, plate_smooth_first, SmoothPush, 4)
PALPATE_KERNEL(smooth, plate_smooth, SmoothPush, 5)
PALPATE_KERNEL(jumpMark, jump_mark, LevelPush, 2)
PALPATE_KERNEL(jumpList, jump_list, LevelPush, 2)
PALPATE_KERNEL(relaxTile, plate_relax_tile, RelaxPush, 6)
PALPATE_KERNEL(copyTile, plate_copy_tile, RelaxPush, 3)
PALPATE_KERNEL(residual, plate_residual, LevelPush, 4)
PALPATE_KERNEL(restrict, plate_restrict, TransferPush, 4)
PALPATE_KERNEL(correct, plate_correct, TransferPush, 5)
PALPATE_GPU_KERNEL(down, plate_down, LevelPush, 5)
PALPATE_GPU_KERNEL(up, plate_up, TransferPush, 8)
PALPATE_GPU_KERNEL(tail, plate_tail, TailPush, 9)

PALPATE_REAL_KERNEL(assemble, coarse_assemble, LevelPush, 2)
PALPATE_REAL_KERNEL(factor, coarse_factor, LevelPush, 3)
PALPATE_REAL_KERNEL(coarseSolve, coarse_solve, LevelPush, 3)
PALPATE_REAL_KERNEL(start, plate_start, LevelPush, 5)
PALPATE_REAL_KERNEL(apply, plate_apply, LevelPush, 3)
PALPATE_REAL_KERNEL(interpolate, plate_interpolate, TransferPush, 4)
PALPATE_REAL_KERNEL(interpolateFirst, plate_interpolate_first, TransferPush, 4)
PALPATE_REAL_KERNEL(result, plate_result, VectorPush, 3)
PALPATE_REAL_KERNEL(dots, cg_dots, VectorPush, 5)
PALPATE_REAL_KERNEL(stepDots, cg_step_dots, VectorPush, 3)
PALPATE_REAL_KERNEL(direction, cg_direction, VectorPush, 3)
PALPATE_REAL_KERNEL(update, cg_update, VectorPush, 6)
PALPATE_REAL_KERNEL(beta, cg_beta, ScalarsPush, 2)
PALPATE_REAL_KERNEL(step, cg_step, ScalarsPush, 3)

#undef PALPATE_KERNEL
#undef PALPATE_GPU_KERNEL
#undef PALPATE_REAL_KERNEL

// Without push constants.
inline compute::KernelCode rigidityNearest()
{
    return {"rigidity_nearest", rigidity_nearest_spv, 5, 0, host().rigidityNearest};
}
inline compute::KernelCode rigidityLogMean()
{
    return {"rigidity_log_mean", rigidity_log_mean_spv, 5, 0, host().rigidityLogMean};
}
template <class Real>
compute::KernelCode lift()
{
    if constexpr (sizeof(Real) == sizeof(double))
        return {"plate_lift_f64", plate_lift_f64_spv, 5, 0, host().lift_f64};
    else
        return {"plate_lift_f32", plate_lift_f32_spv, 5, 0, host().lift_f32};
}

} // namespace palp::kernels
