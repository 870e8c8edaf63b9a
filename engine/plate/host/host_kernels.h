#pragma once
#include <string_view>
#include <vector>

#include "engine/compute/host_dispatch.h"

namespace palp {

/// The kernels of compute_shaders/shared/plate_kernels.def as functions for the processor of this machine.
struct HostKernels {
#define PALPATE_FLOATS(name, spirv, source, define, Push, buffers, shape) compute::HostKernel name;
#define PALPATE_REALS(name, spirv, source, define, Push, buffers, shape) compute::HostKernel name##_f32, name##_f64;
#define PALPATE_FUSED(name, spirv, source, define, Push, buffers, shape)
#define PALPATE_FUSED_SWEEPS_REALS(name, spirv, source, define, Push, buffers, shape)
#define PALPATE_FUSED_FLOATS(name, spirv, source, define, Push, buffers, shape)
#define PALPATE_FUSED_REALS(name, spirv, source, define, Push, buffers, shape)
#include "compute_shaders/shared/plate_kernels.def"
    /// What only the host has: the exact correction at rims, see rim_kernels.cpp.
    compute::HostKernel rimFactor, rimFirst, rimLast, rimSolve, rimStart_f32, rimStart_f64;
    /// And shells: see shell_kernels.cpp and shell_entry_kernels.cpp.
#define PALPATE_SHELL(name) compute::HostKernel name;
#define PALPATE_SHELL_FIELDS(name) compute::HostKernel name;
#include "engine/plate/host/shell_kernels.def"
};

/// Loads that the kernels take side by side in HostVariant::together.
inline constexpr int kLoadsTogether = 8;

/// The same kernels compiled for instruction sets; all give the same bits.
struct HostVariant {
    std::string_view   isa; ///< "portable", "avx2", "avx512"
    const HostKernels* kernels;
    /// For fields of kLoadsTogether loads each, whose numbers lie side by side at every node: the bits of each load are
    /// those of `kernels`.
    const HostKernels* together;
};

/// Lists the variants that this processor can run, best last.
/// \thread any
[[nodiscard]] const std::vector<HostVariant>& hostVariants();

/// Returns the best of them, but none better than the one that the environment variable PALPATE_HOST_ISA names.
/// \throws Error if there is no instruction set of that name
[[nodiscard]] const HostVariant& hostVariant();

} // namespace palp
