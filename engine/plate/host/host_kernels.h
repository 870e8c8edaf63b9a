#pragma once
#include <string_view>
#include <vector>

#include "engine/compute/kernel.h"
#include "engine/plate/host/kernel_names.h"

namespace palp {

/// The plate's kernels as functions for the processor of this machine.
struct HostKernels {
#define PALPATE_FIELD(name) compute::HostKernel name;
    PALPATE_HOST_KERNELS(PALPATE_FIELD)
#undef PALPATE_FIELD
};

/// The same kernels compiled for instruction sets; all give the same bits.
struct HostVariant {
    std::string_view   isa; ///< "portable", "avx2", "avx512"
    const HostKernels* kernels;
};

/// The variants that this processor can run, best last. \thread any
[[nodiscard]] const std::vector<HostVariant>& hostVariants();

/// The best of them, but none better than the one that the environment variable PALPATE_HOST_ISA names.
/// \throws Error if there is no instruction set of that name
[[nodiscard]] const HostVariant& hostVariant();

} // namespace palp
