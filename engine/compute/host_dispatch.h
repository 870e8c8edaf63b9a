#pragma once
#include <cstdint>

namespace palp::compute {

/// Invocations per workgroup; a multiple of 8 along x serves every processor known.
struct Workgroup {
    std::uint32_t x = 64, y = 1, z = 1;
};

/// Workgroups per dispatch.
struct Groups {
    std::uint32_t x = 1, y = 1, z = 1;
};

/// One dispatch as a kernel on the host sees it.
struct HostDispatch {
    void* const*         buffers;   ///< what is bound, in order
    const void*          push;      ///< constants, as laid out in the shader
    const std::uint32_t* constants; ///< specialization constants 3, 4, ...
    Workgroup            workgroup;
    Groups               groups; ///< none is 0
};

/// A kernel for the host: it does what all invocations of the dispatch do.
using HostKernel = void (*)(const HostDispatch&);

} // namespace palp::compute
