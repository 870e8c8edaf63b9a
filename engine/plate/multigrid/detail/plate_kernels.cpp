#include "engine/plate/multigrid/detail/plate_kernels.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>

#include "compute_shaders/shared/coarse_band.h"
#include "compute_shaders/shared/region_layout.h"
#include "compute_shaders/shared/tail_level.h"
#include "compute_shaders/shared/tile_layout.h"
#include "engine/compute/context.h"
#include "engine/core/contract.h"
#include "engine/plate/host/kernel_codes.h"

namespace palp {
namespace {

/// Shapes of workgroups, by their names in plate_kernels.def. Vulkan in software runs 8 invocations side by side, and
/// more of them, or idle ones in small levels, cost time. Hardware needs wide rows for its memory, and hides the waits
/// of serial kernels behind more invocations.
struct Shapes {
    compute::Workgroup tile;    ///< nodes of a grid
    compute::Workgroup line;    ///< nodes one after the other; 65535 of them hold 2049 x 2049 nodes
    compute::Workgroup alone;   ///< the one workgroup of a serial kernel: one or two invocations per number in reach
    compute::Workgroup reduce;  ///< at most kMostInvocations of cg_scalars.comp
    compute::Workgroup tail;    ///< the one workgroup of plate_tail.comp: a multiple of kTailSums
    compute::Workgroup entries; ///< of plate_divisor.comp: nodes of a row, each with its 9 entries
    compute::Workgroup factor;  ///< the one workgroup of prepare_end.comp that factors: a power of two
    compute::Workgroup region;  ///< of plate_region.glsl: a power of two
    compute::Workgroup jumpTile{shared::kTile, shared::kTile, 1};
};

constexpr std::uint32_t kFewestOfRegions = 256; ///< invocations; each keeps up to four nodes

bool isHardware(const compute::Context& context)
{
    return context.processor().kind != compute::ProcessorKind::software &&
           context.processor().kind != compute::ProcessorKind::host;
}

Shapes shapesFor(const compute::Context& context)
{
    const compute::Workgroup most{std::bit_floor(std::min(context.limits().invocations, 1024U)), 1, 1};
    const compute::Workgroup tail{std::min(most.x, 640U), 1, 1}; // a colour of its largest level has 561 places
    if (isHardware(context)) return {{32, 4, 1}, {128, 1, 1}, {64, 1, 1}, {256, 1, 1}, tail, {28, 1, 9}, most, most};
    return {{8, 8, 1}, {128, 1, 1}, {8, 1, 1}, {64, 1, 1}, tail, {8, 1, 9}, {64, 1, 1}, {kFewestOfRegions, 1, 1}};
}

/// Chooses the smoother. Where an operator row by row costs the same for all nodes as for half of them, half sweeps are
/// expensive.
Smoother chosen(Smoother smoother, Schedule schedule, const compute::Context& context)
{
    const bool isHost = context.processor().kind == compute::ProcessorKind::host;
    PALP_EXPECT(isHost || smoother != Smoother::exactRims, "only the host solves rims exactly");
    if (smoother != Smoother::automatic) return smoother;
    return isHost && schedule != Schedule::fused ? Smoother::exactRims : Smoother::redBlack;
}

Smoothing smoothingBy(Smoother smoother)
{
    if (smoother == Smoother::exactRims) smoother = Smoother::chebyshev;
    return smoother == Smoother::redBlack ? Smoothing{smoother, shared::kNestedSweeps, 2, 6, 16}
                                          : Smoothing{smoother, 2, 2, 2, 16};
}

/// Chooses the schedule. Fused passes compute the rims of regions several times, which pays where waiting for a
/// dispatch costs more.
bool isFused(const compute::Context& context, Schedule schedule, Smoother smoother)
{
    PALP_EXPECT(smoother == Smoother::redBlack || schedule != Schedule::fused, "fused passes smooth in red and black");
    if (schedule == Schedule::fused && context.processor().kind == compute::ProcessorKind::host)
        throw Error("the host has no fused passes: they spare dispatches, of which it has none");
    constexpr std::uint32_t kBuffers = 14; // of the kernel that takes most
    const compute::Limits   limits   = context.limits();
    // coarse_solve.comp, where it inverts, and plate_down.comp with one sweep have most shared memory, 23 and 21 kB.
    constexpr int         kLeftSide = shared::kRegion - 2 * shared::kRimPerSweep;
    constexpr std::size_t kInverts =
        sizeof(double) * ((shared::kColumnsTogether + shared::kMostHalfBand) * (shared::kMostHalfBand + 1) +
                          2 * shared::kMostCoarseNodes);
    constexpr std::size_t kGoesDown = sizeof(float) * (2 * shared::kRegion * shared::kRegion + kLeftSide * kLeftSide);
    const bool            fits = limits.sharedMemory >= std::max(kInverts, kGoesDown) && limits.buffers >= kBuffers &&
                      limits.invocations >= kFewestOfRegions;
    PALP_EXPECT(fits || schedule != Schedule::fused, "the processor's workgroups are too small for fused passes");
    return schedule == Schedule::fused ||
           (schedule == Schedule::automatic && fits && isHardware(context) && smoother == Smoother::redBlack);
}

PlateKernels::All::ExactRims rimKernels(compute::Context& context, const HostKernels& host, bool doubles)
{
    const auto kernel = [&](const char* name, int buffers, compute::HostKernel code) {
        return compute::Kernel(context, {name, {}, buffers, int(sizeof(shared::LevelPush)), code}, {});
    };
    return {host.rimFactor, kernel("rim_first", 3, host.rimFirst), kernel("rim_last", 5, host.rimLast),
            kernel("rim_start", 3, doubles ? host.rimStart_f64 : host.rimStart_f32)};
}

/// A kernel that has the number of sweeps as its constant, for one and for two of them.
std::array<compute::Kernel, 2> bySweeps(compute::Context& context, const compute::KernelCode& code,
                                        compute::Workgroup shape)
{
    const std::uint32_t one = 1, two = 2;
    return {compute::Kernel(context, code, shape, {&one, 1}), compute::Kernel(context, code, shape, {&two, 1})};
}

PlateKernels::All::Fused fusedKernels(compute::Context& context, const Shapes& shapes, bool doubles)
{
    return {
#define PALPATE_FLOATS(name, spirv, source, define, Push, buffers, shape)
#define PALPATE_REALS(name, spirv, source, define, Push, buffers, shape)
#define PALPATE_FUSED(name, spirv, source, define, Push, buffers, shape)                                               \
    .name = bySweeps(context, kernels::name(), shapes.shape),
#define PALPATE_FUSED_SWEEPS_REALS(name, spirv, source, define, Push, buffers, shape)                                  \
    .name = bySweeps(context, doubles ? kernels::name<double>() : kernels::name<float>(), shapes.shape),
#define PALPATE_FUSED_FLOATS(name, spirv, source, define, Push, buffers, shape)                                        \
    .name = compute::Kernel(context, kernels::name(), shapes.shape),
#define PALPATE_FUSED_REALS(name, spirv, source, define, Push, buffers, shape)                                         \
    .name = compute::Kernel(context, doubles ? kernels::name<double>() : kernels::name<float>(), shapes.shape),
#include "compute_shaders/shared/plate_kernels.def"
    };
}

} // namespace

PlateKernels::PlateKernels(compute::Context& context, Schedule schedule, Precision precision, Smoother smoother,
                           FieldLayout layout)
{
    PALP_EXPECT(layout == FieldLayout::apart || context.processor().kind == compute::ProcessorKind::host,
                "only the host has kernels for loads side by side");
    const bool         sideBySide = layout == FieldLayout::sideBySide;
    const HostKernels& host       = sideBySide ? *hostVariant().together : *hostVariant().kernels;
    const Shapes       shapes     = shapesFor(context);
    const bool         f64        = context.processor().float64 && precision == Precision::best;
    const bool         coarse     = context.processor().float64 && precision != Precision::floats;
    all_.reset(new All{
        .doubles       = f64,
        .coarseDoubles = coarse,
        .smoothing     = smoothingBy(chosen(smoother, schedule, context)),
        .together      = sideBySide ? kLoadsTogether : 1,
#define PALPATE_FLOATS(name, spirv, source, define, Push, buffers, shape)                                              \
    .name = compute::Kernel(context, kernels::name(host), shapes.shape),
#define PALPATE_REALS(name, spirv, source, define, Push, buffers, shape)                                               \
    .name = compute::Kernel(context, f64 ? kernels::name<double>(host) : kernels::name<float>(host), shapes.shape),
#define PALPATE_FUSED(name, spirv, source, define, Push, buffers, shape)
#define PALPATE_FUSED_SWEEPS_REALS(name, spirv, source, define, Push, buffers, shape)
#define PALPATE_FUSED_FLOATS(name, spirv, source, define, Push, buffers, shape)
#define PALPATE_FUSED_REALS(name, spirv, source, define, Push, buffers, shape)
#include "compute_shaders/shared/plate_kernels.def"
    });
    if (coarse && !f64) {
        all_->assemble    = compute::Kernel(context, kernels::assemble<double>(host), shapes.tile);
        all_->factor      = compute::Kernel(context, kernels::factor<double>(host), shapes.alone);
        all_->coarseSolve = compute::Kernel(context, kernels::coarseSolve<double>(host), shapes.alone);
    }
    if (chosen(smoother, schedule, context) == Smoother::exactRims) all_->rims.emplace(rimKernels(context, host, f64));
    if (!isFused(context, schedule, all_->smoothing.by)) return;
    static_assert(shared::kTailCoarseCells <= shared::kMostCoarseCells);
    all_->coarsestCells = shared::kTailCoarseCells;
    all_->fused.emplace(fusedKernels(context, shapes, f64));
    if (coarse && !f64) {
        all_->fused->prepareEnd   = compute::Kernel(context, kernels::prepareEnd<double>(), shapes.factor);
        all_->fused->coarseInvert = compute::Kernel(context, kernels::coarseInvert<double>(), shapes.alone);
        all_->fused->tail         = bySweeps(context, kernels::tail<double>(), shapes.tail);
        all_->fused->nested       = compute::Kernel(context, kernels::nested<double>(), shapes.tail);
    }
}

PlateKernels::~PlateKernels()                                  = default;
PlateKernels::PlateKernels(PlateKernels&&) noexcept            = default;
PlateKernels& PlateKernels::operator=(PlateKernels&&) noexcept = default;

} // namespace palp
