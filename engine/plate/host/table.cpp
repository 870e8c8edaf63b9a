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
#include "compute_shaders/shared/plate_kernels.def"

extern const HostKernels kTable;

constexpr HostKernels kTable{
#define PALPATE_FLOATS(name, spirv, source, define, Push, buffers, shape) .name = &name,
#define PALPATE_REALS(name, spirv, source, define, Push, buffers, shape)                                               \
    .name##_f32 = &name##_f32, .name##_f64 = &name##_f64,
#define PALPATE_FUSED(name, spirv, source, define, Push, buffers, shape)
#include "compute_shaders/shared/plate_kernels.def"
};

} // namespace palp::PALPATE_ISA
