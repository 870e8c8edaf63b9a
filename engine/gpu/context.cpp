#include "engine/gpu/context.h"

#include "engine/core/contract.h"
#include "engine/gpu/backend.h"
#include "engine/gpu/host_device.h"
#include "engine/gpu/vulkan_handles.h"

namespace palp::gpu {
namespace {

std::unique_ptr<Context::Handles> open(const ContextSettings& settings)
{
    if (settings.device == kHostDevice) return std::make_unique<HostContext>();
    return std::make_unique<VulkanContext>(settings);
}

} // namespace

Context::Context(const ContextSettings& settings) : handles_(open(settings)) {}
Context::~Context()                             = default;
Context::Context(Context&&) noexcept            = default;
Context& Context::operator=(Context&&) noexcept = default;

void Context::run(CommandList& list)
{
    CommandList* const only = &list;
    run({&only, 1});
}

void Context::run(std::span<CommandList* const> lists)
{
    for (const CommandList* list : lists) {
        PALP_EXPECT(list->ended(), "a command list runs after end()");
        PALP_EXPECT(&list->handles().context == handles_.get(), "a command list runs on the context it was made from");
    }
    handles_->run(lists);
    for (const CommandList* list : lists) list->handles().ran = true;
}

std::vector<std::string> Context::takeMessages()
{
    return handles_->takeMessages();
}

const DeviceDescription& Context::device() const noexcept
{
    return handles_->description;
}

std::size_t Context::allocatedBytes() const noexcept
{
    return handles_->allocated;
}

const Limits& Context::limits() const noexcept
{
    return handles_->limits;
}

bool Context::bitExact() const noexcept
{
    return handles_->bitExact;
}

} // namespace palp::gpu
