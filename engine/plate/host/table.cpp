#include "engine/plate/host/host_kernels.h"

#ifndef PALPATE_ISA
#error "set PALPATE_ISA, the namespace of an instruction set"
#endif

// The kernels for one instruction set. The shader of the same name in compute_shaders describes what each of them does.

namespace palp::PALPATE_ISA {

#define PALPATE_FLOATS(name, spirv, source, define, Push, buffers, shape) void name(const compute::HostDispatch& d);
#define PALPATE_REALS(name, spirv, source, define, Push, buffers, shape)                                               \
    void name##_f32(const compute::HostDispatch& d);                                                                   \
    void name##_f64(const compute::HostDispatch& d);
#define PALPATE_FUSED(name, spirv, source, define, Push, buffers, shape)
#define PALPATE_FUSED_SWEEPS_REALS(name, spirv, source, define, Push, buffers, shape)
#define PALPATE_FUSED_FLOATS(name, spirv, source, define, Push, buffers, shape)
#define PALPATE_FUSED_REALS(name, spirv, source, define, Push, buffers, shape)
#include "compute_shaders/shared/plate_kernels.def"
void rimFactor(const compute::HostDispatch& d);
void rimFirst(const compute::HostDispatch& d);
void rimLast(const compute::HostDispatch& d);
void rimSolve(const compute::HostDispatch& d);
void rimStart_f32(const compute::HostDispatch& d);
void rimStart_f64(const compute::HostDispatch& d);
#define PALPATE_SHELL(name) void name(const compute::HostDispatch& d);
#define PALPATE_SHELL_FIELDS(name) void name(const compute::HostDispatch& d);
#include "engine/plate/host/shell_kernels.def"

extern const HostKernels kTable, kTogether;

constexpr HostKernels kTable{
#define PALPATE_FLOATS(name, spirv, source, define, Push, buffers, shape) .name = &name,
#define PALPATE_REALS(name, spirv, source, define, Push, buffers, shape)                                               \
    .name##_f32 = &name##_f32, .name##_f64 = &name##_f64,
#define PALPATE_FUSED(name, spirv, source, define, Push, buffers, shape)
#define PALPATE_FUSED_SWEEPS_REALS(name, spirv, source, define, Push, buffers, shape)
#define PALPATE_FUSED_FLOATS(name, spirv, source, define, Push, buffers, shape)
#define PALPATE_FUSED_REALS(name, spirv, source, define, Push, buffers, shape)
#include "compute_shaders/shared/plate_kernels.def"
    .rimFactor    = &rimFactor,
    .rimFirst     = &rimFirst,
    .rimLast      = &rimLast,
    .rimSolve     = &rimSolve,
    .rimStart_f32 = &rimStart_f32,
    .rimStart_f64 = &rimStart_f64,
#define PALPATE_SHELL(name) .name = &name,
#define PALPATE_SHELL_FIELDS(name) .name = &name,
#include "engine/plate/host/shell_kernels.def"
};

// The same, with those on fields for several loads. What is prepared for a rigidity, and scalars, have no fields.
#define PALPATE_TOGETHER(name)                                                                                         \
    void name##_together(const compute::HostDispatch& d);                                                              \
    all.name = &name##_together;
#define PALPATE_REALS_TOGETHER(name)                                                                                   \
    PALPATE_TOGETHER(name##_f32)                                                                                       \
    PALPATE_TOGETHER(name##_f64)
constexpr HostKernels kTogether = [] {
    HostKernels all = kTable;
    PALPATE_TOGETHER(relaxFirst)
    PALPATE_TOGETHER(relax)
    PALPATE_TOGETHER(smoothFirst)
    PALPATE_TOGETHER(smooth)
    PALPATE_TOGETHER(relaxTile)
    PALPATE_TOGETHER(copyTile)
    PALPATE_TOGETHER(residual)
    PALPATE_TOGETHER(restrict)
    PALPATE_TOGETHER(correct)
    PALPATE_REALS_TOGETHER(coarseSolve)
    PALPATE_REALS_TOGETHER(start)
    PALPATE_REALS_TOGETHER(interpolate)
    PALPATE_REALS_TOGETHER(interpolateFirst)
    PALPATE_REALS_TOGETHER(apply)
    PALPATE_REALS_TOGETHER(dots)
    PALPATE_REALS_TOGETHER(stepDots)
    PALPATE_REALS_TOGETHER(direction)
    PALPATE_REALS_TOGETHER(update)
    PALPATE_REALS_TOGETHER(result)
    PALPATE_REALS_TOGETHER(footprints)
    PALPATE_TOGETHER(rimFirst)
    PALPATE_TOGETHER(rimLast)
    PALPATE_TOGETHER(rimSolve)
    PALPATE_REALS_TOGETHER(rimStart)
#define PALPATE_SHELL(name)
#define PALPATE_SHELL_FIELDS(name) PALPATE_TOGETHER(name)
#include "engine/plate/host/shell_kernels.def"
    return all;
}();

} // namespace palp::PALPATE_ISA
