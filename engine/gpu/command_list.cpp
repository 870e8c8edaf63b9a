#include "engine/gpu/command_list.h"

#include <algorithm>
#include <string>

#include "engine/gpu/vulkan_handles.h"

namespace palp::gpu {
namespace {

constexpr std::uint32_t kQueriesPerPool = 64;
constexpr std::uint32_t kSetsPerPool    = 64; // a cycle of multigrid records about a hundred dispatches
constexpr std::uint32_t kBuffersPerPool = 64 * 8;

Owned<VkDescriptorPool, vkDestroyDescriptorPool> makeDescriptorPool(const Context::Handles& gpu, std::uint32_t buffers)
{
    const VkDescriptorPoolSize size{VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, std::max(buffers, kBuffersPerPool)};
    auto                       info = typed<VkDescriptorPoolCreateInfo>(VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO);
    info.maxSets                    = kSetsPerPool;
    info.poolSizeCount              = 1;
    info.pPoolSizes                 = &size;
    VkDescriptorPool pool           = VK_NULL_HANDLE;
    check(vkCreateDescriptorPool(gpu.device, &info, nullptr, &pool), "make a descriptor pool");
    return {gpu, pool};
}

void barrier(VkCommandBuffer commands, VkPipelineStageFlags before, VkAccessFlags written, VkPipelineStageFlags after,
             VkAccessFlags seen)
{
    const VkMemoryBarrier all{VK_STRUCTURE_TYPE_MEMORY_BARRIER, nullptr, written, seen};
    vkCmdPipelineBarrier(commands, before, after, 0, 1, &all, 0, nullptr, 0, nullptr);
}

constexpr VkPipelineStageFlags kWork   = VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT | VK_PIPELINE_STAGE_TRANSFER_BIT;
constexpr VkAccessFlags        kWrites = VK_ACCESS_SHADER_WRITE_BIT | VK_ACCESS_TRANSFER_WRITE_BIT;

std::size_t bytesOf(const Binding& binding)
{
    return binding.bytes == Binding::kRest ? binding.buffer->bytes() - binding.offset : binding.bytes;
}

} // namespace

CommandList::Handles::Handles(Context::Handles& owner) : context(owner)
{
    auto poolInfo             = typed<VkCommandPoolCreateInfo>(VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO);
    poolInfo.queueFamilyIndex = context.family;
    VkCommandPool pool        = VK_NULL_HANDLE;
    check(vkCreateCommandPool(context.device, &poolInfo, nullptr, &pool), "make a command pool");
    commandPool             = {context, pool};
    auto info               = typed<VkCommandBufferAllocateInfo>(VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO);
    info.commandPool        = pool;
    info.level              = VK_COMMAND_BUFFER_LEVEL_PRIMARY;
    info.commandBufferCount = 1;
    check(vkAllocateCommandBuffers(context.device, &info, &commands), "make a command buffer");
    const auto begin = typed<VkCommandBufferBeginInfo>(VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO);
    check(vkBeginCommandBuffer(commands, &begin), "record a command list");
}

void CommandList::Handles::separate() const
{
    // Before the first command too: the writes of the run before are available by then, but not yet visible.
    barrier(commands, kWork, kWrites, kWork | VK_PIPELINE_STAGE_DRAW_INDIRECT_BIT,
            kWrites | VK_ACCESS_SHADER_READ_BIT | VK_ACCESS_TRANSFER_READ_BIT | VK_ACCESS_INDIRECT_COMMAND_READ_BIT);
}

void CommandList::Handles::finish()
{
    barrier(commands, kWork, kWrites, VK_PIPELINE_STAGE_HOST_BIT, VK_ACCESS_HOST_READ_BIT);
    check(vkEndCommandBuffer(commands), "record a command list");
    ended = true;
}

VkDescriptorSet CommandList::Handles::descriptorSet(const Kernel& kernel)
{
    const VkDescriptorSetLayout layout = kernel.handles().setLayout.get();
    for (bool fresh = descriptorPools.empty();; fresh = true) {
        if (fresh) descriptorPools.push_back(makeDescriptorPool(context, std::uint32_t(kernel.code().buffers)));
        auto info               = typed<VkDescriptorSetAllocateInfo>(VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO);
        info.descriptorPool     = descriptorPools.back().get();
        info.descriptorSetCount = 1;
        info.pSetLayouts        = &layout;
        VkDescriptorSet set     = VK_NULL_HANDLE;
        const VkResult  result  = vkAllocateDescriptorSets(context.device, &info, &set);
        if (result == VK_SUCCESS) return set;
        const bool full = result == VK_ERROR_OUT_OF_POOL_MEMORY || result == VK_ERROR_FRAGMENTED_POOL;
        if (fresh || !full) check(result, "make a descriptor set");
    }
}

void CommandList::Handles::bind(const Kernel& kernel, const Bindings& bindings, const Push& push)
{
    const KernelCode& code = kernel.code();
    const std::string who  = std::string("the kernel ") + code.name;
    PALP_EXPECT(!ended, "a command list cannot be recorded after end()");
    PALP_EXPECT(bindings.size() == std::size_t(code.buffers),
                who + " takes " + std::to_string(code.buffers) + " buffers, not " + std::to_string(bindings.size()));
    PALP_EXPECT(push.size() == std::size_t(code.pushBytes), who + " takes " + std::to_string(code.pushBytes) +
                                                                " bytes of push constants, not " +
                                                                std::to_string(push.size()));
    std::vector<VkDescriptorBufferInfo> ranges;
    for (const Binding& binding : bindings) {
        const std::size_t all = binding.buffer->bytes();
        PALP_EXPECT(binding.offset < all && bytesOf(binding) > 0 && bytesOf(binding) <= all - binding.offset,
                    who + " reaches beyond the buffer '" + binding.buffer->name() + "'");
        PALP_EXPECT(binding.offset % context.native.minStorageBufferOffsetAlignment == 0,
                    who + ": the offset " + std::to_string(binding.offset) + " into '" + binding.buffer->name() +
                        "' is no multiple of " + std::to_string(context.native.minStorageBufferOffsetAlignment));
        ranges.push_back({binding.buffer->handles().buffer.get(), binding.offset, bytesOf(binding)});
    }

    const VkPipelineLayout layout = kernel.handles().layout.get();
    if (!ranges.empty()) {
        auto write            = typed<VkWriteDescriptorSet>(VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET);
        write.dstSet          = descriptorSet(kernel);
        write.descriptorCount = std::uint32_t(ranges.size()); // runs on into the next bindings
        write.descriptorType  = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
        write.pBufferInfo     = ranges.data();
        vkUpdateDescriptorSets(context.device, 1, &write, 0, nullptr);
        vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_COMPUTE, layout, 0, 1, &write.dstSet, 0, nullptr);
    }
    vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_COMPUTE, kernel.handles().pipeline.get());
    if (!push.empty())
        vkCmdPushConstants(commands, layout, VK_SHADER_STAGE_COMPUTE_BIT, 0, std::uint32_t(push.size()), push.data());
    separate();
    ++dispatches;
}

void CommandList::Handles::timestamp()
{
    if (!context.timestampBits) return;
    const std::uint32_t slot = timestamps % kQueriesPerPool;
    if (slot == 0) {
        auto info        = typed<VkQueryPoolCreateInfo>(VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO);
        info.queryType   = VK_QUERY_TYPE_TIMESTAMP;
        info.queryCount  = kQueriesPerPool;
        VkQueryPool pool = VK_NULL_HANDLE;
        check(vkCreateQueryPool(context.device, &info, nullptr, &pool), "make a clock");
        queryPools.emplace_back(context, pool);
        vkCmdResetQueryPool(commands, pool, 0, kQueriesPerPool);
    }
    vkCmdWriteTimestamp(commands, VK_PIPELINE_STAGE_BOTTOM_OF_PIPE_BIT, queryPools.back().get(), slot);
    ++timestamps;
}

CommandList::CommandList(Context& context) : handles_(std::make_unique<Handles>(context.handles())) {}
CommandList::~CommandList()                                 = default;
CommandList::CommandList(CommandList&&) noexcept            = default;
CommandList& CommandList::operator=(CommandList&&) noexcept = default;

void CommandList::dispatch(const Kernel& kernel, const Bindings& bindings, const Push& push, Groups groups)
{
    const auto& most = handles_->context.native.maxComputeWorkGroupCount;
    PALP_EXPECT(groups.x <= most[0] && groups.y <= most[1] && groups.z <= most[2],
                std::string("the kernel ") + kernel.code().name + " is dispatched in " + std::to_string(groups.x) +
                    "x" + std::to_string(groups.y) + "x" + std::to_string(groups.z) + " groups");
    handles_->bind(kernel, bindings, push);
    vkCmdDispatch(handles_->commands, groups.x, groups.y, groups.z);
}

void CommandList::dispatchIndirect(const Kernel& kernel, const Bindings& bindings, const Push& push,
                                   const Buffer& groups, std::size_t offset)
{
    PALP_EXPECT(offset % 4 == 0 && groups.bytes() >= sizeof(Groups) && offset <= groups.bytes() - sizeof(Groups),
                "no three words at byte " + std::to_string(offset) + " of the buffer '" + groups.name() + "'");
    handles_->bind(kernel, bindings, push);
    vkCmdDispatchIndirect(handles_->commands, groups.handles().buffer.get(), offset);
}

void CommandList::copy(const Buffer& from, std::size_t fromOffset, const Buffer& to, std::size_t toOffset,
                       std::size_t bytes)
{
    PALP_EXPECT(!ended(), "a command list cannot be recorded after end()");
    PALP_EXPECT(bytes > 0 && bytes <= from.bytes() && fromOffset <= from.bytes() - bytes && bytes <= to.bytes() &&
                    toOffset <= to.bytes() - bytes,
                "copying " + std::to_string(bytes) + " bytes from '" + from.name() + "' at " +
                    std::to_string(fromOffset) + " to '" + to.name() + "' at " + std::to_string(toOffset));
    handles_->separate();
    const VkBufferCopy region{fromOffset, toOffset, bytes};
    vkCmdCopyBuffer(handles_->commands, from.handles().buffer.get(), to.handles().buffer.get(), 1, &region);
}

void CommandList::fill(const Buffer& buffer, std::uint32_t word)
{
    PALP_EXPECT(!ended(), "a command list cannot be recorded after end()");
    handles_->separate();
    vkCmdFillBuffer(handles_->commands, buffer.handles().buffer.get(), 0, VK_WHOLE_SIZE, word);
}

void CommandList::timestamp()
{
    PALP_EXPECT(!ended(), "a command list cannot be recorded after end()");
    handles_->timestamp();
}

void CommandList::end()
{
    PALP_EXPECT(!ended(), "a command list ends once");
    handles_->finish();
}

std::vector<double> CommandList::timestampsMilliseconds() const
{
    PALP_EXPECT(handles_->ran, "a command list has no times before it has run");
    const Context::Handles&    gpu = handles_->context;
    std::vector<std::uint64_t> ticks(handles_->timestamps);
    for (std::uint32_t first = 0; first < ticks.size(); first += kQueriesPerPool) {
        const auto count = std::min(kQueriesPerPool, std::uint32_t(ticks.size()) - first);
        check(vkGetQueryPoolResults(gpu.device, handles_->queryPools[first / kQueriesPerPool].get(), 0, count,
                                    count * sizeof(std::uint64_t), ticks.data() + first, sizeof(std::uint64_t),
                                    VK_QUERY_RESULT_64_BIT | VK_QUERY_RESULT_WAIT_BIT),
              "tell the time");
    }
    const std::uint64_t mask = gpu.timestampBits < 64 ? (std::uint64_t(1) << gpu.timestampBits) - 1 : ~std::uint64_t(0);
    std::vector<double> milliseconds;
    for (const std::uint64_t tick : ticks) // the counter may pass through 0
        milliseconds.push_back(double((tick - ticks.front()) & mask) * double(gpu.native.timestampPeriod) * 1e-6);
    return milliseconds;
}

int CommandList::dispatches() const noexcept
{
    return handles_->dispatches;
}

bool CommandList::ended() const noexcept
{
    return handles_->ended;
}

} // namespace palp::gpu
