#pragma once
#include "engine/compute/kernel.h"
#include "engine/plate/host/kernel_names.h"

#ifndef PALPATE_ISA
#error "set PALPATE_ISA, the namespace of an instruction set"
#endif

/// The plate's kernels for one instruction set; each is described by the shader of the same name in compute_shaders.
/// \thread any; each keeps what it needs per thread
namespace palp::PALPATE_ISA {

using compute::HostDispatch;

#define PALPATE_DECLARE(name) void name(const HostDispatch& d);
PALPATE_HOST_KERNELS(PALPATE_DECLARE)
#undef PALPATE_DECLARE

} // namespace palp::PALPATE_ISA
