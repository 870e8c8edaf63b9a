#include "engine/plate/multigrid/plate_kernels.h"

#include <algorithm>
#include <array>
#include <cstdint>

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
#include "compute_shaders/shared/tile_layout.h"
#include "engine/compute/context.h"
#include "engine/core/contract.h"
#include "engine/plate/host/host_kernels.h"

namespace palp {
namespace {

/// Shapes of workgroups. A software device runs 8 invocations side by side, pays for each more and for idle ones in
/// small levels; hardware wants wide rows for its memory, and hides the waits of serial kernels behind more
/// invocations.
struct Shapes {
    compute::Workgroup tile;   ///< nodes of a grid
    compute::Workgroup line;   ///< nodes one after the other; 65535 of them hold 2049 x 2049 nodes
    compute::Workgroup alone;  ///< the one workgroup of a serial kernel; kMostHalfBand invocations find work
    compute::Workgroup reduce; ///< at most kMostInvocations of cg_scalars.comp
};
constexpr Shapes kSoftware{{8, 8, 1}, {128, 1, 1}, {8, 1, 1}, {64, 1, 1}};
constexpr Shapes kHardware{{32, 4, 1}, {128, 1, 1}, {64, 1, 1}, {256, 1, 1}};

template <class Push, std::size_t N>
compute::KernelCode code(const char* name, const std::uint32_t (&spirv)[N], int buffers,
                         compute::HostKernel host = nullptr)
{
    return {name, spirv, buffers, int(sizeof(Push)), host};
}

bool isHardware(const compute::Context& context)
{
    return context.device().kind != "software" && context.device().kind != compute::kHostProcessor;
}

/// Where an operator row by row costs the same for all nodes as for half of them, half sweeps are dear.
Smoothing smoothingBy(Smoother smoother, Schedule schedule, const compute::Context& context)
{
    if (smoother == Smoother::automatic) {
        const bool byRows = context.device().kind == compute::kHostProcessor && schedule != Schedule::fused;
        smoother          = byRows ? Smoother::chebyshev : Smoother::redBlack;
    }
    return smoother == Smoother::redBlack ? Smoothing{smoother, 1, 2, 6, 16} : Smoothing{smoother, 2, 2, 2, 16};
}

constexpr compute::Workgroup kRegionShape{256, 1, 1}; // of plate_region.glsl

/// Fused passes compute the rims of regions several times: worth it where waiting for a dispatch costs more.
bool isFused(const compute::Context& context, Schedule schedule, Smoother smoother)
{
    PALP_EXPECT(smoother == Smoother::redBlack || schedule != Schedule::fused, "fused passes smooth in red and black");
    if (schedule == Schedule::fused && context.device().kind == compute::kHostProcessor)
        throw Error("the host has no fused passes: they spare dispatches, of which it has none");
    const bool fits = context.limits().sharedMemory >= sizeof(float) * shared::kTailPool &&
                      context.limits().invocations >= kRegionShape.x;
    PALP_EXPECT(fits || schedule != Schedule::fused, "the device's workgroups are too small for fused passes");
    return schedule == Schedule::fused ||
           (schedule == Schedule::automatic && fits && isHardware(context) && smoother == Smoother::redBlack);
}

PlateKernels::All::Fused fusedKernels(compute::Context& context)
{
    using namespace shared;
    const compute::Workgroup tailShape{std::min(context.limits().invocations, 1024U), 1, 1};
    const auto               bySweeps = [&](const compute::KernelCode& what, compute::Workgroup shape) {
        const std::uint32_t one = 1, two = 2;
        return std::array{compute::Kernel(context, what, shape, {&one, 1}),
                          compute::Kernel(context, what, shape, {&two, 1})};
    };
    return {bySweeps(code<LevelPush>("plate_down", plate_down_spv, 5), kRegionShape),
            bySweeps(code<TransferPush>("plate_up", plate_up_spv, 8), kRegionShape),
            bySweeps(code<TailPush>("plate_tail", plate_tail_spv, 9), tailShape)};
}

} // namespace

PlateKernels::PlateKernels(compute::Context& context, Schedule schedule, Precision precision, Smoother smoother)
{
    using namespace shared;
    const Shapes&      shapes = isHardware(context) ? kHardware : kSoftware;
    const HostKernels& host   = *hostVariant().kernels;
    const bool         f64    = context.device().float64 && precision == Precision::best;
    const auto real = [&](compute::KernelCode f32Code, compute::KernelCode f64Code) { return f64 ? f64Code : f32Code; };
#define PALPATE_REAL(Push, name, function, buffers)                                                                    \
    real(code<Push>(#name "_f32", name##_f32_spv, buffers, host.function##_f32),                                       \
         code<Push>(#name "_f64", name##_f64_spv, buffers, host.function##_f64))
#define PALPATE_FLOAT(Push, name, function, buffers) code<Push>(#name, name##_spv, buffers, host.function)
    const compute::KernelCode lift32{"plate_lift_f32", plate_lift_f32_spv, 5, 0, host.lift_f32},
        lift64{"plate_lift_f64", plate_lift_f64_spv, 5, 0, host.lift_f64};
    constexpr compute::Workgroup jumpTile{kTile, kTile, 1};
    const auto                   kernel = [&](const compute::KernelCode& what, compute::Workgroup group) {
        return compute::Kernel(context, what, group);
    };
    all_.reset(new All{f64,
                       smoothingBy(smoother, schedule, context),
                       kernel(PALPATE_FLOAT(TransferPush, rigidity_coarsen, coarsen, 2), shapes.tile),
                       kernel(PALPATE_FLOAT(LevelPush, plate_divisor, divisor, 2), shapes.tile),
                       kernel(PALPATE_FLOAT(LevelPush, jump_mark, jumpMark, 2), shapes.tile),
                       kernel(PALPATE_FLOAT(LevelPush, jump_list, jumpList, 2), shapes.reduce),
                       kernel(PALPATE_REAL(LevelPush, coarse_assemble, assemble, 2), shapes.tile),
                       kernel(PALPATE_REAL(LevelPush, coarse_factor, factor, 3), shapes.alone),
                       kernel(PALPATE_FLOAT(RelaxPush, plate_relax_first, relaxFirst, 3), shapes.tile),
                       kernel(PALPATE_FLOAT(RelaxPush, plate_relax, relax, 6), shapes.tile),
                       kernel(PALPATE_FLOAT(SmoothPush, plate_smooth_first, smoothFirst, 4), shapes.tile),
                       kernel(PALPATE_FLOAT(SmoothPush, plate_smooth, smooth, 5), shapes.tile),
                       kernel(PALPATE_FLOAT(RelaxPush, plate_relax_tile, relaxTile, 6), jumpTile),
                       kernel(PALPATE_FLOAT(RelaxPush, plate_copy_tile, copyTile, 3), jumpTile),
                       kernel(PALPATE_FLOAT(LevelPush, plate_residual, residual, 4), shapes.tile),
                       kernel(PALPATE_FLOAT(TransferPush, plate_restrict, restrict, 4), shapes.tile),
                       kernel(PALPATE_FLOAT(TransferPush, plate_correct, correct, 5), shapes.tile),
                       kernel(PALPATE_REAL(LevelPush, coarse_solve, coarseSolve, 3), shapes.alone),
                       kernel(PALPATE_REAL(LevelPush, plate_start, start, 5), shapes.tile),
                       kernel(PALPATE_REAL(TransferPush, plate_interpolate, interpolate, 4), shapes.tile),
                       kernel(PALPATE_REAL(TransferPush, plate_interpolate_first, interpolateFirst, 4), shapes.tile),
                       kernel(PALPATE_REAL(VectorPush, cg_dots, dots, 5), shapes.line),
                       kernel(PALPATE_REAL(ScalarsPush, cg_beta, beta, 2), shapes.reduce),
                       kernel(PALPATE_REAL(VectorPush, cg_direction, direction, 3), shapes.line),
                       kernel(PALPATE_REAL(LevelPush, plate_apply, apply, 3), shapes.tile),
                       kernel(PALPATE_REAL(VectorPush, cg_step_dots, stepDots, 3), shapes.line),
                       kernel(PALPATE_REAL(ScalarsPush, cg_step, step, 3), shapes.reduce),
                       kernel(PALPATE_REAL(VectorPush, cg_update, update, 6), shapes.line),
                       kernel(PALPATE_REAL(VectorPush, plate_result, result, 3), shapes.line),
                       kernel({"rigidity_nearest", rigidity_nearest_spv, 5, 0, host.rigidityNearest}, shapes.tile),
                       kernel({"rigidity_log_mean", rigidity_log_mean_spv, 5, 0, host.rigidityLogMean}, shapes.tile),
                       kernel(real(lift32, lift64), shapes.line)});
#undef PALPATE_REAL
#undef PALPATE_FLOAT
    if (isFused(context, schedule, all_->smoothing.by)) all_->fused.emplace(fusedKernels(context));
}

PlateKernels::~PlateKernels()                                  = default;
PlateKernels::PlateKernels(PlateKernels&&) noexcept            = default;
PlateKernels& PlateKernels::operator=(PlateKernels&&) noexcept = default;

} // namespace palp
