#include "engine/gpu/buffer.h"

#include <optional>
#include <vector>

#include "engine/gpu/vulkan_handles.h"

namespace palp::gpu {
namespace {

/// The properties that serve an intent, best first.
std::vector<VkMemoryPropertyFlags> wishes(Intent intent)
{
    constexpr VkMemoryPropertyFlags kVisible  = VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT;
    constexpr VkMemoryPropertyFlags kCoherent = VK_MEMORY_PROPERTY_HOST_COHERENT_BIT;
    constexpr VkMemoryPropertyFlags kCached   = VK_MEMORY_PROPERTY_HOST_CACHED_BIT;
    switch (intent) {
    case Intent::device:
        return {VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT, 0};
    case Intent::upload:
        return {kVisible | kCoherent}; // every device has it
    case Intent::readback:
        return {kVisible | kCached | kCoherent, kVisible | kCached, kVisible | kCoherent};
    }
    return {};
}

/// The first memory type that fits the best wish it can; drivers list types from fast to slow.
std::optional<std::uint32_t> typeFor(const VkPhysicalDeviceMemoryProperties& memory, std::uint32_t allowed,
                                     Intent intent)
{
    // Memory of special purpose, which must not be taken by chance.
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

std::string mebibytes(std::size_t bytes)
{
    const std::size_t whole = bytes >> 20;
    return whole ? std::to_string(whole) + " MiB" : std::to_string(bytes) + " bytes";
}

} // namespace

Buffer::Handles::Handles(Context::Handles& owner, std::string called, std::size_t size)
    : context(owner), name(std::move(called)), bytes(size)
{
}

Buffer::Handles::~Handles()
{
    if (!memory.get()) return;
    --context.allocations;
    context.allocated -= bytes;
}

Buffer::Buffer(Context& context, std::string name, std::size_t bytes, Intent intent)
{
    PALP_EXPECT(bytes > 0 && bytes % 4 == 0, "the buffer '" + name + "' has " + std::to_string(bytes) +
                                                 " bytes: a positive multiple of 4 it must be");
    Context::Handles& gpu = context.handles();
    if (bytes > gpu.limits.buffer)
        throw Error("the buffer '" + name + "' of " + mebibytes(bytes) + " is larger than the GPU " +
                    gpu.description.name + " allows (" + mebibytes(gpu.limits.buffer) + "); try fewer cells");
    if (gpu.allocations >= gpu.native.maxMemoryAllocationCount)
        throw Error("the buffer '" + name + "' is one too many: the GPU " + gpu.description.name + " allows " +
                    std::to_string(gpu.native.maxMemoryAllocationCount));
    handles_   = std::make_unique<Handles>(gpu, std::move(name), bytes);
    Handles& h = *handles_;

    auto info  = typed<VkBufferCreateInfo>(VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO);
    info.size  = bytes;
    info.usage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_SRC_BIT |
                 VK_BUFFER_USAGE_TRANSFER_DST_BIT | VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT;
    VkBuffer buffer = VK_NULL_HANDLE;
    check(vkCreateBuffer(gpu.device, &info, nullptr, &buffer), "make a buffer");
    h.buffer = {gpu, buffer};
    gpu.setName(VK_OBJECT_TYPE_BUFFER, reinterpret_cast<std::uint64_t>(buffer), h.name);

    VkMemoryRequirements needs;
    vkGetBufferMemoryRequirements(gpu.device, buffer, &needs);
    const auto type = typeFor(gpu.memory, needs.memoryTypeBits, intent);
    if (!type) throw Error("the GPU " + gpu.description.name + " has no memory for the buffer '" + h.name + "'");
    auto allocation            = typed<VkMemoryAllocateInfo>(VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO);
    allocation.allocationSize  = needs.size;
    allocation.memoryTypeIndex = *type;
    VkDeviceMemory memory      = VK_NULL_HANDLE;
    check(vkAllocateMemory(gpu.device, &allocation, nullptr, &memory),
          ("find " + mebibytes(bytes) + " for the buffer '" + h.name + "'").c_str());
    h.memory = {gpu, memory};
    ++gpu.allocations;
    gpu.allocated += bytes;
    check(vkBindBufferMemory(gpu.device, buffer, memory, 0), "bind memory to a buffer");

    h.coherent = gpu.memory.memoryTypes[*type].propertyFlags & VK_MEMORY_PROPERTY_HOST_COHERENT_BIT;
    if (intent != Intent::device)
        check(vkMapMemory(gpu.device, memory, 0, VK_WHOLE_SIZE, 0, &h.mapped), "map a buffer");
}

Buffer::~Buffer()                            = default;
Buffer::Buffer(Buffer&&) noexcept            = default;
Buffer& Buffer::operator=(Buffer&&) noexcept = default;

void* Buffer::mapped() const noexcept
{
    return handles_->mapped;
}

void Buffer::makeVisibleToHost() const
{
    if (!handles_->mapped || handles_->coherent) return;
    auto range   = typed<VkMappedMemoryRange>(VK_STRUCTURE_TYPE_MAPPED_MEMORY_RANGE);
    range.memory = handles_->memory.get();
    range.size   = VK_WHOLE_SIZE;
    check(vkInvalidateMappedMemoryRanges(handles_->context.device, 1, &range), "show a buffer to the host");
}

std::size_t Buffer::bytes() const noexcept
{
    return handles_->bytes;
}

const std::string& Buffer::name() const noexcept
{
    return handles_->name;
}

} // namespace palp::gpu
