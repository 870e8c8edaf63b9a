#pragma once
#include <string_view>

#include "engine/compute/backend.h"

namespace palp::compute {

/// The context of this machine's processor: kernels are functions, and lists are walked on the thread that runs them.
class HostContext : public Context::Handles {
public:
    HostContext();

    std::unique_ptr<Buffer::Handles>      makeBuffer(std::string name, std::size_t bytes, Intent intent) override;
    std::unique_ptr<Kernel::Handles>      makeKernel(const KernelCode& code, Workgroup workgroup,
                                                     std::span<const std::uint32_t> constants) override;
    std::unique_ptr<CommandList::Handles> makeList() override;
    void                                  run(std::span<CommandList* const> lists) override;
};

} // namespace palp::compute
