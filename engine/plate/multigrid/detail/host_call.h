#pragma once
#include <initializer_list>

#include "engine/compute/host_dispatch.h"

namespace palp {

/// Calls a kernel of the host on plain memory.
/// \param buffers  what the kernel asks for, in order; those that it only reads may be constant
template <class Push>
void callHost(compute::HostKernel kernel, const Push& push, std::initializer_list<const void*> buffers)
{
    kernel({.buffers   = const_cast<void* const*>(buffers.begin()), // kernels know what they write
            .push      = &push,
            .constants = nullptr,
            .workgroup = {},
            .groups    = {}});
}

} // namespace palp
