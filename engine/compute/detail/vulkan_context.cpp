#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <memory>
#include <mutex>
#include <thread>
#include <utility>
#include <vector>

#include "engine/compute/command_list.h"
#include "engine/compute/vulkan_handles.h"
#include "engine/core/contract.h"
#include "engine/core/quantity.h"

namespace palp::compute {
namespace {

// Hardware: the kernel drivers of AMD, Intel and NVIDIA reset a GPU that makes no progress for 2 to 10 s; waiting
// longer only hides that. Software has no such watchdog and is legitimately slow: a validated multigrid cycle on a
// large grid lasts tens of seconds.
constexpr double kPatienceHardware = 10;  // [s]
constexpr double kPatienceSoftware = 300; // [s]

/// A thread that sleeps until an interrupt is woken 50 to 150 us late, as long as some solves take: so it looks at the
/// fence itself at first.
constexpr auto kLooking = std::chrono::milliseconds(1);

std::atomic<bool> isDriverLeftAtWork{false};

/// Keeps what a driver still works with; never destroyed, and no leak, because it can be reached.
void keepForEver(std::unique_ptr<Instance> instance)
{
    static std::mutex     mutex;
    static auto&          kept = *new std::vector<std::unique_ptr<Instance>>;
    const std::lock_guard lock(mutex);
    kept.push_back(std::move(instance));
}

const char* nameOf(VkResult result)
{
    switch (result) {
    case VK_ERROR_OUT_OF_HOST_MEMORY:
        return "no host memory left";
    case VK_ERROR_OUT_OF_DEVICE_MEMORY:
        return "no memory of the processor left";
    case VK_ERROR_DEVICE_LOST:
        return "the processor is lost";
    case VK_ERROR_INITIALIZATION_FAILED:
        return "initialization failed";
    case VK_ERROR_MEMORY_MAP_FAILED:
        return "mapping failed";
    case VK_ERROR_FEATURE_NOT_PRESENT:
        return "a feature is not present";
    case VK_TIMEOUT:
        return "no end in sight";
    case VK_ERROR_TOO_MANY_OBJECTS:
        return "too many objects";
    default:
        return "unexpected result";
    }
}

} // namespace

bool driverLeftAtWork() noexcept
{
    return isDriverLeftAtWork;
}

void check(VkResult result, const char* what)
{
    if (result == VK_SUCCESS) return;
    const std::string sentence =
        std::string("the GPU cannot ") + what + ": " + nameOf(result) + " (" + std::to_string(result) + ")";
    switch (result) {
    case VK_ERROR_OUT_OF_HOST_MEMORY:
    case VK_ERROR_OUT_OF_DEVICE_MEMORY:
        throw ProcessorOutOfMemory(sentence + "; try fewer cells");
    default: // lost, or a result that this call should not have: who gave it is not asked again
        throw ProcessorLost(sentence);
    }
}

VulkanContext::VulkanContext(std::unique_ptr<Instance>& entrance, const Candidate& candidate, double wantedPatience,
                             Purpose purpose)
{
    describe(candidate, purpose);
    const double usual = description.kind == ProcessorKind::software ? kPatienceSoftware : kPatienceHardware;
    patience           = wantedPatience > 0 ? wantedPatience : usual;
    open(*entrance, purpose);
    instance = std::move(entrance);
}

VulkanContext::~VulkanContext()
{
    if (atWork()) {
        isDriverLeftAtWork = true;
        keepForEver(std::move(instance));
        return;
    }
    if (fence) vkDestroyFence(device, fence, nullptr);
    if (device) vkDestroyDevice(device, nullptr);
}

void VulkanContext::describe(const Candidate& candidate, Purpose purpose)
{
    description         = candidate.description;
    physical            = candidate.physical;
    native              = candidate.limits;
    family              = purpose != Purpose::compute ? candidate.drawFamily.value() : candidate.family;
    timestampBits       = candidate.timestampBits;
    looks               = purpose == Purpose::compute && description.kind != ProcessorKind::software;
    bitExact            = candidate.driver == VK_DRIVER_ID_MESA_LLVMPIPE;
    limits.buffer       = std::size_t(std::min<VkDeviceSize>(native.maxStorageBufferRange, candidate.maxBufferBytes));
    limits.invocations  = native.maxComputeWorkGroupInvocations;
    limits.buffers      = native.maxPerStageDescriptorStorageBuffers;
    limits.sharedMemory = native.maxComputeSharedMemorySize;
    vkGetPhysicalDeviceMemoryProperties(physical, &memory);
}

void VulkanContext::open(const Instance& entrance, Purpose purpose)
{
    const float priority       = 1;
    auto        queueInfo      = typed<VkDeviceQueueCreateInfo>(VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO);
    queueInfo.queueFamilyIndex = family;
    queueInfo.queueCount       = 1;
    queueInfo.pQueuePriorities = &priority;

    auto layout = typed<VkPhysicalDeviceScalarBlockLayoutFeatures>(
        VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SCALAR_BLOCK_LAYOUT_FEATURES);
    layout.scalarBlockLayout = VK_TRUE;
    auto features            = typed<VkPhysicalDeviceFeatures2>(VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2, &layout);
    features.features.shaderFloat64 = description.float64;
    features.features.largePoints   = purpose != Purpose::compute; // openToDraw() refuses what has none
    auto info                       = typed<VkDeviceCreateInfo>(VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO, &features);
    info.queueCreateInfoCount       = 1;
    info.pQueueCreateInfos          = &queueInfo;
    const char* const swapchain     = VK_KHR_SWAPCHAIN_EXTENSION_NAME;
    if (purpose == Purpose::show) {
        info.enabledExtensionCount   = 1;
        info.ppEnabledExtensionNames = &swapchain;
    }
    if (const VkResult result = vkCreateDevice(physical, &info, nullptr, &device); result != VK_SUCCESS) {
        device = VK_NULL_HANDLE;
        throw ProcessorError("the GPU " + description.name + " cannot be opened: " + nameOf(result) + " (" +
                             std::to_string(result) + ")");
    }
    vkGetDeviceQueue(device, family, 0, &queue);
    if (entrance.hasDebugUtils())
        setObjectName = reinterpret_cast<PFN_vkSetDebugUtilsObjectNameEXT>(
            vkGetInstanceProcAddr(entrance.get(), "vkSetDebugUtilsObjectNameEXT"));
    const auto fenceInfo = typed<VkFenceCreateInfo>(VK_STRUCTURE_TYPE_FENCE_CREATE_INFO);
    if (const VkResult result = vkCreateFence(device, &fenceInfo, nullptr, &fence); result != VK_SUCCESS) {
        vkDestroyDevice(device, nullptr); // no destructor runs for an object that was never built
        check(result, "make a fence");
    }
}

void VulkanContext::setName(VkObjectType type, std::uint64_t handle, const std::string& name) const
{
    if (!setObjectName) return;
    auto info         = typed<VkDebugUtilsObjectNameInfoEXT>(VK_STRUCTURE_TYPE_DEBUG_UTILS_OBJECT_NAME_INFO_EXT);
    info.objectType   = type;
    info.objectHandle = handle;
    info.pObjectName  = name.c_str();
    setObjectName(device, &info); // a lost name is harmless
}

void VulkanContext::run(std::span<CommandList* const> lists)
{
    std::vector<VkCommandBuffer> commands;
    for (const CommandList* list : lists) commands.push_back(static_cast<const VulkanList&>(list->handles()).commands);
    submit(commands);
}

void VulkanContext::submit(std::span<const VkCommandBuffer> commands)
{
    start(commands);
    finish();
}

void VulkanContext::start(std::span<const VkCommandBuffer> commands)
{
    if (abandoned) throw ProcessorLost("the GPU " + description.name + " hung before and is not used any more");

    check(vkResetFences(device, 1, &fence), "reset a fence");
    auto submit               = typed<VkSubmitInfo>(VK_STRUCTURE_TYPE_SUBMIT_INFO);
    submit.commandBufferCount = std::uint32_t(commands.size());
    submit.pCommandBuffers    = commands.data();
    check(vkQueueSubmit(queue, 1, &submit, fence), "take a command list");
}

std::uint64_t VulkanContext::patienceInNanoseconds() const
{
    return std::uint64_t(std::ceil(patience * 1e9));
}

void VulkanContext::finish()
{
    if (looks) lookAtFence();
    const VkResult result = vkWaitForFences(device, 1, &fence, VK_TRUE, patienceInNanoseconds());
    if (result == VK_TIMEOUT || result == VK_ERROR_OUT_OF_HOST_MEMORY || result == VK_ERROR_OUT_OF_DEVICE_MEMORY)
        abandoned = true;
    if (result == VK_TIMEOUT)
        throw ProcessorLost("the GPU " + description.name + " did not finish within " + formatNumber(patience) +
                            " s; try fewer cells");
    check(result, "finish a command list");
}

void VulkanContext::lookAtFence() const
{
    using Clock = std::chrono::steady_clock;
    const std::chrono::duration<double> longest =
        std::min<std::chrono::duration<double>>(kLooking, std::chrono::duration<double>(patience));
    const auto began = Clock::now();
    while (vkGetFenceStatus(device, fence) == VK_NOT_READY && Clock::now() - began < longest) std::this_thread::yield();
}

std::vector<std::string> VulkanContext::takeMessages()
{
    return instance->takeMessages();
}

} // namespace palp::compute
