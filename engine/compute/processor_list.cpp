#include "engine/compute/processor_list.h"

#include <algorithm>
#include <optional>

#include "engine/compute/vulkan_instance.h"

namespace palp::compute {
namespace {

ProcessorKind kindOf(VkPhysicalDeviceType type)
{
    using enum ProcessorKind;
    switch (type) {
    case VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU:
        return discrete;
    case VK_PHYSICAL_DEVICE_TYPE_INTEGRATED_GPU:
        return integrated;
    case VK_PHYSICAL_DEVICE_TYPE_VIRTUAL_GPU:
        return virtualGpu;
    case VK_PHYSICAL_DEVICE_TYPE_CPU:
        return software;
    default:
        return other;
    }
}

std::string versionText(std::uint32_t version)
{
    return std::to_string(VK_API_VERSION_MAJOR(version)) + "." + std::to_string(VK_API_VERSION_MINOR(version)) + "." +
           std::to_string(VK_API_VERSION_PATCH(version));
}

/// Returns the size of the largest heap of the processor's own [byte].
std::uint64_t ownMemory(VkPhysicalDevice physical)
{
    VkPhysicalDeviceMemoryProperties memory;
    vkGetPhysicalDeviceMemoryProperties(physical, &memory);
    std::uint64_t largest = 0;
    for (std::uint32_t n = 0; n < memory.memoryHeapCount; ++n)
        if (memory.memoryHeaps[n].flags & VK_MEMORY_HEAP_DEVICE_LOCAL_BIT)
            largest = std::max<std::uint64_t>(largest, memory.memoryHeaps[n].size);
    return largest;
}

/// Finds a family that computes, preferably one that does not draw, so that a viewer does not delay it.
void findQueue(Candidate& candidate)
{
    std::uint32_t count = 0;
    vkGetPhysicalDeviceQueueFamilyProperties(candidate.physical, &count, nullptr);
    std::vector<VkQueueFamilyProperties> families(count);
    vkGetPhysicalDeviceQueueFamilyProperties(candidate.physical, &count, families.data());
    std::optional<std::uint32_t> best;
    for (std::uint32_t n = 0; n < count; ++n) {
        const VkQueueFlags flags = families[n].queueFlags;
        if ((flags & VK_QUEUE_GRAPHICS_BIT) && !candidate.drawFamily) candidate.drawFamily = n;
        if (!(flags & VK_QUEUE_COMPUTE_BIT)) continue;
        if (!best || (!(flags & VK_QUEUE_GRAPHICS_BIT) && (families[*best].queueFlags & VK_QUEUE_GRAPHICS_BIT)))
            best = n;
    }
    if (!best) {
        candidate.description.refusals.push_back("it has no queue that computes");
        return;
    }
    candidate.family        = *best;
    candidate.timestampBits = families[*best].timestampValidBits;
}

/// Queries properties that only processors from Vulkan 1.2 on have.
void describeModern(Candidate& candidate)
{
    auto driver = typed<VkPhysicalDeviceDriverProperties>(VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_DRIVER_PROPERTIES);
    auto sizes  = typed<VkPhysicalDeviceMaintenance3Properties>(
        VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_MAINTENANCE_3_PROPERTIES, &driver);
    auto properties = typed<VkPhysicalDeviceProperties2>(VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2, &sizes);
    vkGetPhysicalDeviceProperties2(candidate.physical, &properties);
    candidate.driver             = driver.driverID;
    candidate.maxBufferBytes     = sizes.maxMemoryAllocationSize; // each buffer has an allocation of its own
    candidate.description.driver = std::string(driver.driverName) + " " + driver.driverInfo;

    auto layout = typed<VkPhysicalDeviceScalarBlockLayoutFeatures>(
        VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SCALAR_BLOCK_LAYOUT_FEATURES);
    auto features = typed<VkPhysicalDeviceFeatures2>(VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2, &layout);
    vkGetPhysicalDeviceFeatures2(candidate.physical, &features);
    candidate.description.float64 = features.features.shaderFloat64;
    candidate.largePoints         = features.features.largePoints;
    if (!layout.scalarBlockLayout)
        candidate.description.refusals.push_back("it does not lay structs out as C++ does (scalarBlockLayout)");
}

/// Refuses processors that are too small for the kernels of this project, as the smallest that Vulkan allows are.
void refuseSmall(Candidate& candidate)
{
    constexpr std::uint32_t kBuffers = 9, kInvocations = 256, kPushBytes = 128, kSharedBytes = 16 << 10;
    const auto              refuse = [&](const char* what, std::uint32_t has, std::uint32_t needed) {
        if (has < needed)
            candidate.description.refusals.push_back("its limit of " + std::to_string(has) + " " + what +
                                                                  " is below the " + std::to_string(needed) + " needed");
    };
    const VkPhysicalDeviceLimits& limits = candidate.limits;
    refuse("buffers per kernel", limits.maxPerStageDescriptorStorageBuffers, kBuffers);
    refuse("invocations per workgroup", limits.maxComputeWorkGroupInvocations, kInvocations);
    refuse("bytes of push constants", limits.maxPushConstantsSize, kPushBytes);
    refuse("bytes of shared memory", limits.maxComputeSharedMemorySize, kSharedBytes);
}

Candidate describe(VkPhysicalDevice physical, int index)
{
    VkPhysicalDeviceProperties properties;
    vkGetPhysicalDeviceProperties(physical, &properties);
    Candidate candidate;
    candidate.physical           = physical;
    candidate.limits             = properties.limits;
    candidate.description.index  = index;
    candidate.description.name   = properties.deviceName;
    candidate.description.kind   = kindOf(properties.deviceType);
    candidate.description.api    = versionText(properties.apiVersion);
    candidate.description.driver = "version " + std::to_string(properties.driverVersion);
    candidate.description.memory = ownMemory(physical);
    if (properties.apiVersion >= VK_API_VERSION_1_2)
        describeModern(candidate);
    else
        candidate.description.refusals.push_back("it speaks Vulkan " + candidate.description.api +
                                                 ", and 1.2 is needed");
    refuseSmall(candidate);
    findQueue(candidate);
    return candidate;
}

} // namespace

std::vector<Candidate> candidates(const Instance& instance)
{
    std::vector<Candidate> found;
    if (!instance.get()) return found;
    std::uint32_t                 count  = 0;
    VkResult                      result = vkEnumeratePhysicalDevices(instance.get(), &count, nullptr);
    std::vector<VkPhysicalDevice> devices(count);
    if (result == VK_SUCCESS && count) result = vkEnumeratePhysicalDevices(instance.get(), &count, devices.data());
    if (result != VK_SUCCESS)
        throw ProcessorError("Vulkan cannot list its processors (error " + std::to_string(result) +
                             "); does vulkaninfo run?");
    for (std::uint32_t n = 0; n < count; ++n) found.push_back(describe(devices[n], int(n)));
    return found;
}

std::vector<Processor> listProcessors()
{
    const Instance         instance(Validation::off);
    std::vector<Processor> list;
    for (const Candidate& candidate : candidates(instance)) list.push_back(candidate.description);
    return list;
}

} // namespace palp::compute
