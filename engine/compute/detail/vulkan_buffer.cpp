#include <optional>
#include <vector>

#include "engine/compute/vulkan_handles.h"

namespace palp::compute {
namespace {

/// Returns the properties that serve an intent, best first.
std::vector<VkMemoryPropertyFlags> wishes(Intent intent)
{
    constexpr VkMemoryPropertyFlags kVisible  = VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT;
    constexpr VkMemoryPropertyFlags kCoherent = VK_MEMORY_PROPERTY_HOST_COHERENT_BIT;
    constexpr VkMemoryPropertyFlags kCached   = VK_MEMORY_PROPERTY_HOST_CACHED_BIT;
    switch (intent) {
    case Intent::processor:
        return {VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT, 0};
    case Intent::upload:
        return {kVisible | kCoherent}; // every driver has it
    case Intent::readback:
        return {kVisible | kCached | kCoherent, kVisible | kCached, kVisible | kCoherent};
    }
    return {};
}

std::string mebibytes(std::size_t bytes)
{
    const std::size_t whole = bytes >> 20;
    return whole ? std::to_string(whole) + " MiB" : std::to_string(bytes) + " bytes";
}

} // namespace

std::optional<std::uint32_t> memoryTypeFor(const VkPhysicalDeviceMemoryProperties& memory, std::uint32_t allowed,
                                           Intent intent)
{
    // Memory for special purposes, which must not be taken by chance.
    constexpr VkMemoryPropertyFlags kSpecial =
        VK_MEMORY_PROPERTY_LAZILY_ALLOCATED_BIT | VK_MEMORY_PROPERTY_PROTECTED_BIT |
        VK_MEMORY_PROPERTY_DEVICE_COHERENT_BIT_AMD | VK_MEMORY_PROPERTY_DEVICE_UNCACHED_BIT_AMD;
    for (const VkMemoryPropertyFlags wish : wishes(intent))
        for (std::uint32_t n = 0; n < memory.memoryTypeCount; ++n) {
            const VkMemoryPropertyFlags flags = memory.memoryTypes[n].propertyFlags;
            if ((allowed >> n & 1u) && (flags & wish) == wish && !(flags & kSpecial)) return n;
        }
    return std::nullopt;
}

VulkanBuffer::VulkanBuffer(VulkanContext& owner, std::string called, std::size_t size)
    : Handles(owner, std::move(called), size), context(owner)
{
}

VulkanBuffer::~VulkanBuffer()
{
    if (memory.get()) --context.allocations;
}

std::unique_ptr<Buffer::Handles> VulkanContext::makeBuffer(std::string name, std::size_t bytes, Intent intent)
{
    if (bytes > limits.buffer)
        throw ProcessorOutOfMemory("the buffer '" + name + "' of " + mebibytes(bytes) + " is larger than the GPU " +
                                   description.name + " allows (" + mebibytes(limits.buffer) + "); try fewer cells");
    if (allocations >= native.maxMemoryAllocationCount)
        throw ProcessorOutOfMemory("the buffer '" + name + "' is one too many: the GPU " + description.name +
                                   " allows " + std::to_string(native.maxMemoryAllocationCount));
    auto          made = std::make_unique<VulkanBuffer>(*this, std::move(name), bytes);
    VulkanBuffer& h    = *made;

    auto info  = typed<VkBufferCreateInfo>(VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO);
    info.size  = bytes;
    info.usage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT |
                 VK_BUFFER_USAGE_TRANSFER_SRC_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT |
                 VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT;
    VkBuffer buffer = VK_NULL_HANDLE;
    check(vkCreateBuffer(device, &info, nullptr, &buffer), "make a buffer");
    h.buffer = {*this, buffer};
    setName(VK_OBJECT_TYPE_BUFFER, reinterpret_cast<std::uint64_t>(buffer), h.name);

    VkMemoryRequirements needs;
    vkGetBufferMemoryRequirements(device, buffer, &needs);
    const auto type = memoryTypeFor(memory, needs.memoryTypeBits, intent);
    if (!type) throw Error("the GPU " + description.name + " has no memory for the buffer '" + h.name + "'");
    auto allocation            = typed<VkMemoryAllocateInfo>(VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO);
    allocation.allocationSize  = needs.size;
    allocation.memoryTypeIndex = *type;
    VkDeviceMemory given       = VK_NULL_HANDLE;
    check(vkAllocateMemory(device, &allocation, nullptr, &given),
          ("find " + mebibytes(bytes) + " for the buffer '" + h.name + "'").c_str());
    h.memory = {*this, given};
    ++allocations;
    check(vkBindBufferMemory(device, buffer, given, 0), "bind memory to a buffer");

    h.coherent = memory.memoryTypes[*type].propertyFlags & VK_MEMORY_PROPERTY_HOST_COHERENT_BIT;
    if (intent != Intent::processor) check(vkMapMemory(device, given, 0, VK_WHOLE_SIZE, 0, &h.mapped), "map a buffer");
    return made;
}

void VulkanBuffer::makeVisibleToHost()
{
    if (!mapped || coherent) return;
    auto range   = typed<VkMappedMemoryRange>(VK_STRUCTURE_TYPE_MAPPED_MEMORY_RANGE);
    range.memory = memory.get();
    range.size   = VK_WHOLE_SIZE;
    check(vkInvalidateMappedMemoryRanges(context.device, 1, &range), "show a buffer to the host");
}

} // namespace palp::compute
