#include "engine/plate/host/host_kernels.h"
#include "engine/plate/host/kernels.h"

namespace palp::PALPATE_ISA {

extern const HostKernels kTable;

#define PALPATE_ENTRY(name) &name,
constexpr HostKernels kTable{PALPATE_HOST_KERNELS(PALPATE_ENTRY)};
#undef PALPATE_ENTRY

} // namespace palp::PALPATE_ISA
