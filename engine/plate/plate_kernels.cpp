#include "engine/plate/plate_kernels.h"

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
#include "compute_shaders/coarse_assemble.spv.h"
#include "compute_shaders/coarse_factor.spv.h"
#include "compute_shaders/coarse_solve.spv.h"
#include "compute_shaders/plate_apply_f32.spv.h"
#include "compute_shaders/plate_apply_f64.spv.h"
#include "compute_shaders/plate_correct.spv.h"
#include "compute_shaders/plate_divisor.spv.h"
#include "compute_shaders/plate_interpolate_f32.spv.h"
#include "compute_shaders/plate_interpolate_f64.spv.h"
#include "compute_shaders/plate_interpolate_first_f32.spv.h"
#include "compute_shaders/plate_interpolate_first_f64.spv.h"
#include "compute_shaders/plate_relax.spv.h"
#include "compute_shaders/plate_relax_first.spv.h"
#include "compute_shaders/plate_residual.spv.h"
#include "compute_shaders/plate_restrict.spv.h"
#include "compute_shaders/plate_result_f32.spv.h"
#include "compute_shaders/plate_result_f64.spv.h"
#include "compute_shaders/plate_start_f32.spv.h"
#include "compute_shaders/plate_start_f64.spv.h"
#include "compute_shaders/rigidity_coarsen.spv.h"
#include "compute_shaders/shared/plate_push.h"
#include "engine/gpu/context.h"

namespace palp {
namespace {

// Any multiple of 8 along x is within a few per cent of the best on every device that was tried; small levels waste less
// of a small group.
constexpr gpu::Workgroup kTile{16, 4, 1};   // nodes of a grid
constexpr gpu::Workgroup kLine{64, 1, 1};   // nodes one after the other
constexpr gpu::Workgroup kAlone{64, 1, 1};  // the one workgroup of a serial kernel; kMostHalfBand lanes are busy
constexpr gpu::Workgroup kReduce{128, 1, 1}; // at most kMostInvocations of cg_scalars.comp

template <class Push, std::size_t N>
gpu::KernelCode code(const char* name, const std::uint32_t (&spirv)[N], int buffers)
{
    return {name, spirv, buffers, int(sizeof(Push))};
}

} // namespace

PlateKernels::PlateKernels(gpu::Context& context)
{
    using namespace shared;
    const bool f64  = context.device().float64;
    const auto real = [&](gpu::KernelCode f32Code, gpu::KernelCode f64Code) { return f64 ? f64Code : f32Code; };
#define PALPATE_REAL(Push, name, buffers) real(code<Push>(#name "_f32", name##_f32_spv, buffers), code<Push>(#name "_f64", name##_f64_spv, buffers))
#define PALPATE_FLOAT(Push, name, buffers) code<Push>(#name, name##_spv, buffers)
    const auto kernel = [&](const gpu::KernelCode& what, gpu::Workgroup group) { return gpu::Kernel(context, what, group); };
    all_.reset(new All{
        f64,
        kernel(PALPATE_FLOAT(TransferPush, rigidity_coarsen, 2), kTile),
        kernel(PALPATE_FLOAT(LevelPush, plate_divisor, 2), kTile),
        kernel(PALPATE_FLOAT(LevelPush, coarse_assemble, 2), kTile),
        kernel(PALPATE_FLOAT(LevelPush, coarse_factor, 2), kAlone),
        kernel(PALPATE_FLOAT(RelaxPush, plate_relax_first, 3), kTile),
        kernel(PALPATE_FLOAT(RelaxPush, plate_relax, 6), kTile),
        kernel(PALPATE_FLOAT(LevelPush, plate_residual, 4), kTile),
        kernel(PALPATE_FLOAT(TransferPush, plate_restrict, 4), kTile),
        kernel(PALPATE_FLOAT(TransferPush, plate_correct, 5), kTile),
        kernel(PALPATE_FLOAT(LevelPush, coarse_solve, 3), kAlone),
        kernel(PALPATE_REAL(LevelPush, plate_start, 5), kTile),
        kernel(PALPATE_REAL(TransferPush, plate_interpolate, 4), kTile),
        kernel(PALPATE_REAL(TransferPush, plate_interpolate_first, 4), kTile),
        kernel(PALPATE_REAL(VectorPush, cg_dots, 5), kLine),
        kernel(PALPATE_REAL(ScalarsPush, cg_beta, 2), kReduce),
        kernel(PALPATE_REAL(VectorPush, cg_direction, 4), kLine),
        kernel(PALPATE_REAL(LevelPush, plate_apply, 3), kTile),
        kernel(PALPATE_REAL(VectorPush, cg_step_dots, 3), kLine),
        kernel(PALPATE_REAL(ScalarsPush, cg_step, 3), kReduce),
        kernel(PALPATE_REAL(VectorPush, cg_update, 6), kLine),
        kernel(PALPATE_REAL(VectorPush, plate_result, 3), kLine)});
#undef PALPATE_REAL
#undef PALPATE_FLOAT
}

PlateKernels::~PlateKernels()                                  = default;
PlateKernels::PlateKernels(PlateKernels&&) noexcept            = default;
PlateKernels& PlateKernels::operator=(PlateKernels&&) noexcept = default;

} // namespace palp
