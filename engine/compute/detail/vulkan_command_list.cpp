#include <algorithm>
#include <string>

#include "engine/compute/vulkan_handles.h"

namespace palp::compute {
namespace {

constexpr std::uint32_t kQueriesPerPool = 64;
constexpr std::uint32_t kSetsPerPool    = 64; // a cycle of multigrid records about a hundred dispatches
constexpr std::uint32_t kBuffersPerPool = 64 * 8;

Owned<VkDescriptorPool, vkDestroyDescriptorPool> makeDescriptorPool(const VulkanContext& gpu, std::uint32_t buffers)
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

VkBuffer bufferOf(const Buffer& buffer)
{
    return static_cast<const VulkanBuffer&>(buffer.handles()).buffer.get();
}

} // namespace

VulkanList::VulkanList(VulkanContext& owner) : Handles(owner), gpu(owner)
{
    auto poolInfo             = typed<VkCommandPoolCreateInfo>(VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO);
    poolInfo.queueFamilyIndex = gpu.family;
    VkCommandPool pool        = VK_NULL_HANDLE;
    check(vkCreateCommandPool(gpu.device, &poolInfo, nullptr, &pool), "make a command pool");
    commandPool             = {gpu, pool};
    auto info               = typed<VkCommandBufferAllocateInfo>(VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO);
    info.commandPool        = pool;
    info.level              = VK_COMMAND_BUFFER_LEVEL_PRIMARY;
    info.commandBufferCount = 1;
    check(vkAllocateCommandBuffers(gpu.device, &info, &commands), "make a command buffer");
    const auto begin = typed<VkCommandBufferBeginInfo>(VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO);
    check(vkBeginCommandBuffer(commands, &begin), "record a command list");
}

void VulkanList::separate(Next next) const
{
    // Before the first command too: the writes of the run before are available by then, but not yet visible. Only the
    // command's own stages wait: that which reads sizes waits longest.
    constexpr VkPipelineStageFlags kComputes = VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT;
    constexpr VkAccessFlags        kUses     = VK_ACCESS_SHADER_READ_BIT | VK_ACCESS_SHADER_WRITE_BIT;
    switch (next) {
    case Next::copies:
        return barrier(commands, kWork, kWrites, VK_PIPELINE_STAGE_TRANSFER_BIT,
                       VK_ACCESS_TRANSFER_READ_BIT | VK_ACCESS_TRANSFER_WRITE_BIT);
    case Next::computes:
        return barrier(commands, kWork, kWrites, kComputes, kUses);
    case Next::readsItsSize:
        return barrier(commands, kWork, kWrites, kComputes | VK_PIPELINE_STAGE_DRAW_INDIRECT_BIT,
                       kUses | VK_ACCESS_INDIRECT_COMMAND_READ_BIT);
    }
}

// A kernel says how many buffers it has, not which of them it writes: any may be.
void VulkanList::meansToWrite(VkBuffer buffer)
{
    seenSizes.erase(buffer);
}

void VulkanList::end()
{
    barrier(commands, kWork, kWrites, VK_PIPELINE_STAGE_HOST_BIT, VK_ACCESS_HOST_READ_BIT);
    check(vkEndCommandBuffer(commands), "record a command list");
}

VkDescriptorSet VulkanList::descriptorSet(const Kernel& kernel)
{
    const VkDescriptorSetLayout layout = static_cast<const VulkanKernel&>(kernel.handles()).setLayout.get();
    for (bool fresh = descriptorPools.empty();; fresh = true) {
        if (fresh) descriptorPools.push_back(makeDescriptorPool(gpu, std::uint32_t(kernel.code().buffers)));
        auto info               = typed<VkDescriptorSetAllocateInfo>(VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO);
        info.descriptorPool     = descriptorPools.back().get();
        info.descriptorSetCount = 1;
        info.pSetLayouts        = &layout;
        VkDescriptorSet set     = VK_NULL_HANDLE;
        const VkResult  result  = vkAllocateDescriptorSets(gpu.device, &info, &set);
        if (result == VK_SUCCESS) return set;
        const bool full = result == VK_ERROR_OUT_OF_POOL_MEMORY || result == VK_ERROR_FRAGMENTED_POOL;
        if (fresh || !full) check(result, "make a descriptor set");
    }
}

void VulkanList::bind(const Kernel& kernel, const Bindings& bindings, const Push& push, Next next)
{
    const auto&                         compiled = static_cast<const VulkanKernel&>(kernel.handles());
    std::vector<VkDescriptorBufferInfo> ranges;
    for (const Binding& binding : bindings) {
        PALP_EXPECT(binding.offset % gpu.native.minStorageBufferOffsetAlignment == 0,
                    std::string("the kernel ") + kernel.code().name + ": the offset " + std::to_string(binding.offset) +
                        " into '" + binding.buffer->name() + "' is no multiple of " +
                        std::to_string(gpu.native.minStorageBufferOffsetAlignment));
        ranges.push_back({bufferOf(*binding.buffer), binding.offset, bytesOf(binding)});
    }

    const VkPipelineLayout layout = compiled.layout.get();
    if (!ranges.empty()) {
        auto write            = typed<VkWriteDescriptorSet>(VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET);
        write.dstSet          = descriptorSet(kernel);
        write.descriptorCount = std::uint32_t(ranges.size()); // runs on into the next bindings
        write.descriptorType  = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
        write.pBufferInfo     = ranges.data();
        vkUpdateDescriptorSets(gpu.device, 1, &write, 0, nullptr);
        vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_COMPUTE, layout, 0, 1, &write.dstSet, 0, nullptr);
    }
    vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_COMPUTE, compiled.pipeline.get());
    if (!push.empty())
        vkCmdPushConstants(commands, layout, VK_SHADER_STAGE_COMPUTE_BIT, 0, std::uint32_t(push.size()), push.data());
    separate(next);
    for (const Binding& binding : bindings) meansToWrite(bufferOf(*binding.buffer));
}

void VulkanList::timestamp()
{
    if (!gpu.timestampBits) return;
    const std::uint32_t slot = timestamps % kQueriesPerPool;
    if (slot == 0) {
        auto info        = typed<VkQueryPoolCreateInfo>(VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO);
        info.queryType   = VK_QUERY_TYPE_TIMESTAMP;
        info.queryCount  = kQueriesPerPool;
        VkQueryPool pool = VK_NULL_HANDLE;
        check(vkCreateQueryPool(gpu.device, &info, nullptr, &pool), "make a clock");
        queryPools.emplace_back(gpu, pool);
        vkCmdResetQueryPool(commands, pool, 0, kQueriesPerPool);
    }
    vkCmdWriteTimestamp(commands, VK_PIPELINE_STAGE_BOTTOM_OF_PIPE_BIT, queryPools.back().get(), slot);
    ++timestamps;
}

void VulkanList::dispatch(const Kernel& kernel, const Bindings& bindings, const Push& push, Groups groups)
{
    const auto& most = gpu.native.maxComputeWorkGroupCount;
    PALP_EXPECT(groups.x <= most[0] && groups.y <= most[1] && groups.z <= most[2],
                std::string("the kernel ") + kernel.code().name + " is dispatched in " + std::to_string(groups.x) +
                    "x" + std::to_string(groups.y) + "x" + std::to_string(groups.z) + " groups");
    bind(kernel, bindings, push, Next::computes);
    vkCmdDispatch(commands, groups.x, groups.y, groups.z);
}

void VulkanList::dispatchIndirect(const Kernel& kernel, const Bindings& bindings, const Push& push,
                                  const Buffer& groups, std::size_t offset)
{
    const bool known = !seenSizes.insert(bufferOf(groups)).second;
    bind(kernel, bindings, push, known ? Next::computes : Next::readsItsSize);
    vkCmdDispatchIndirect(commands, bufferOf(groups), offset);
}

void VulkanList::copy(const Buffer& from, std::size_t fromOffset, const Buffer& to, std::size_t toOffset,
                      std::size_t bytes)
{
    separate(Next::copies);
    meansToWrite(bufferOf(to));
    const VkBufferCopy region{fromOffset, toOffset, bytes};
    vkCmdCopyBuffer(commands, bufferOf(from), bufferOf(to), 1, &region);
}

void VulkanList::fill(const Buffer& buffer, std::uint32_t word)
{
    separate(Next::copies);
    meansToWrite(bufferOf(buffer));
    vkCmdFillBuffer(commands, bufferOf(buffer), 0, VK_WHOLE_SIZE, word);
}

std::vector<double> VulkanList::timestampsMilliseconds() const
{
    std::vector<std::uint64_t> ticks(timestamps);
    for (std::uint32_t first = 0; first < ticks.size(); first += kQueriesPerPool) {
        const auto count = std::min(kQueriesPerPool, std::uint32_t(ticks.size()) - first);
        check(vkGetQueryPoolResults(gpu.device, queryPools[first / kQueriesPerPool].get(), 0, count,
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

std::unique_ptr<CommandList::Handles> VulkanContext::makeList()
{
    return std::make_unique<VulkanList>(*this);
}

} // namespace palp::compute
