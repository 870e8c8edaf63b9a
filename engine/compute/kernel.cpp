#include "engine/compute/kernel.h"

#include <string>

#include "engine/compute/backend.h"

namespace palp::compute {
namespace {

std::uint32_t groupsAlong(std::uint32_t invocations, std::uint32_t size)
{
    return invocations / size + (invocations % size != 0);
}

} // namespace

Kernel::Kernel(Context& context, const KernelCode& code, Workgroup workgroup, std::span<const std::uint32_t> constants)
{
    const bool hasCode = context.processor().kind == ProcessorKind::host ? code.host != nullptr : !code.spirv.empty();
    PALP_EXPECT(hasCode, std::string("the kernel ") + code.name + " has no code");
    PALP_EXPECT(code.buffers >= 0 && code.pushBytes >= 0 && code.pushBytes % 4 == 0,
                std::string("the kernel ") + code.name + " has " + std::to_string(code.buffers) + " buffers and " +
                    std::to_string(code.pushBytes) + " bytes of push constants");
    PALP_EXPECT(workgroup.x && workgroup.y && workgroup.z, "no side of a workgroup is 0");
    handles_ = context.handles().makeKernel(code, workgroup, constants);
}

Kernel::~Kernel()                            = default;
Kernel::Kernel(Kernel&&) noexcept            = default;
Kernel& Kernel::operator=(Kernel&&) noexcept = default;

Groups Kernel::groupsOver(std::uint32_t nx, std::uint32_t ny, std::uint32_t nz) const noexcept
{
    const Workgroup w = handles_->workgroup;
    return {groupsAlong(nx, w.x), groupsAlong(ny, w.y), groupsAlong(nz, w.z)};
}

const KernelCode& Kernel::code() const noexcept
{
    return handles_->code;
}

Workgroup Kernel::workgroup() const noexcept
{
    return handles_->workgroup;
}

} // namespace palp::compute
