#pragma once
#include "compute_shaders/plate_kernels.spv.h"
#include "compute_shaders/shared/plate_push.h"
#include "compute_shaders/shared/rigidity_level.h"
#include "compute_shaders/shared/tail_level.h"
#include "engine/compute/kernel.h"
#include "engine/plate/host/host_kernels.h"

/// The code of each kernel in compute_shaders/shared/plate_kernels.def, by its name; of those in two precisions as
/// name<float>() and name<double>(). The host's functions are those of hostVariant(). Internal to the plate.
namespace palp::kernels {

#define PALPATE_CODE(name, function, Push, buffers)                                                                    \
    compute::KernelCode                                                                                                \
    {                                                                                                                  \
#name, name##_spv, buffers, int(sizeof(shared::Push)), function                                                \
    }
#define PALPATE_FLOATS(name, spirv, source, define, Push, buffers, shape)                                              \
    inline compute::KernelCode name(const HostKernels& host = *hostVariant().kernels)                                  \
    {                                                                                                                  \
        return PALPATE_CODE(spirv, host.name, Push, buffers);                                                          \
    }
#define PALPATE_REALS(name, spirv, source, define, Push, buffers, shape)                                               \
    template <class Real>                                                                                              \
    compute::KernelCode name(const HostKernels& host = *hostVariant().kernels)                                         \
    {                                                                                                                  \
        if constexpr (sizeof(Real) == sizeof(double))                                                                  \
            return PALPATE_CODE(spirv##_f64, host.name##_f64, Push, buffers);                                          \
        else                                                                                                           \
            return PALPATE_CODE(spirv##_f32, host.name##_f32, Push, buffers);                                          \
    }
#define PALPATE_FUSED(name, spirv, source, define, Push, buffers, shape)                                               \
    inline compute::KernelCode name()                                                                                  \
    {                                                                                                                  \
        return PALPATE_CODE(spirv, nullptr, Push, buffers);                                                            \
    }
#define PALPATE_FUSED_FLOATS(name, spirv, source, define, Push, buffers, shape)                                        \
    PALPATE_FUSED(name, spirv, source, define, Push, buffers, shape)
#define PALPATE_FUSED_REALS(name, spirv, source, define, Push, buffers, shape)                                         \
    template <class Real>                                                                                              \
    compute::KernelCode name()                                                                                         \
    {                                                                                                                  \
        if constexpr (sizeof(Real) == sizeof(double))                                                                  \
            return PALPATE_CODE(spirv##_f64, nullptr, Push, buffers);                                                  \
        else                                                                                                           \
            return PALPATE_CODE(spirv##_f32, nullptr, Push, buffers);                                                  \
    }
#define PALPATE_FUSED_SWEEPS_REALS(name, spirv, source, define, Push, buffers, shape)                                  \
    PALPATE_FUSED_REALS(name, spirv, source, define, Push, buffers, shape)
#include "compute_shaders/shared/plate_kernels.def"
#undef PALPATE_CODE

} // namespace palp::kernels
