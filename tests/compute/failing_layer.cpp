// A layer of Vulkan between a program and any driver, in which the n-th call that may fail does fail. It says how a
// program behaves whose driver crashes, hangs or has no memory left, at each instant of its life.
//
//     VK_INSTANCE_LAYERS=VK_LAYER_PALPATE_failing VK_LAYER_PATH=FOLDER   loads it; FOLDER holds its manifest
//     FAILING_LAYER_AT=n           the call that fails, counted from 1; without it none does
//     FAILING_LAYER_ONLY=NAME     only calls of that name are counted and fail
//     FAILING_LAYER_AS=memory      that call has no memory, as far as it may say so; those after it have
//                     lost        the processor is lost from that call on
//                     hang        what is submitted from that call on is never finished
//                     crash       that call ends the program by abort()
//     FAILING_LAYER_COUNT=FILE     the number of calls goes there when a device or an instance is destroyed
#include <algorithm>
#include <array>
#include <atomic>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <map>
#include <mutex>
#include <string_view>
#include <tuple>

#include <unistd.h>
#include <vulkan/vk_layer.h>
#include <vulkan/vulkan.h>

namespace {

/// The calls that may fail, in any order. What a driver does without a result cannot fail.
#define PALPATE_CALLS(CALL)                                                                                            \
    CALL(vkAllocateMemory)                                                                                             \
    CALL(vkBindBufferMemory)                                                                                           \
    CALL(vkBindImageMemory)                                                                                            \
    CALL(vkMapMemory)                                                                                                  \
    CALL(vkFlushMappedMemoryRanges)                                                                                    \
    CALL(vkInvalidateMappedMemoryRanges)                                                                               \
    CALL(vkCreateBuffer)                                                                                               \
    CALL(vkCreateImage)                                                                                                \
    CALL(vkCreateImageView)                                                                                            \
    CALL(vkCreateSampler)                                                                                              \
    CALL(vkCreateShaderModule)                                                                                         \
    CALL(vkCreateComputePipelines)                                                                                     \
    CALL(vkCreateGraphicsPipelines)                                                                                    \
    CALL(vkCreatePipelineLayout)                                                                                       \
    CALL(vkCreateDescriptorSetLayout)                                                                                  \
    CALL(vkCreateDescriptorPool)                                                                                       \
    CALL(vkAllocateDescriptorSets)                                                                                     \
    CALL(vkCreateRenderPass)                                                                                           \
    CALL(vkCreateFramebuffer)                                                                                          \
    CALL(vkCreateQueryPool)                                                                                            \
    CALL(vkGetQueryPoolResults)                                                                                        \
    CALL(vkCreateCommandPool)                                                                                          \
    CALL(vkResetCommandPool)                                                                                           \
    CALL(vkAllocateCommandBuffers)                                                                                     \
    CALL(vkBeginCommandBuffer)                                                                                         \
    CALL(vkEndCommandBuffer)                                                                                           \
    CALL(vkCreateFence)                                                                                                \
    CALL(vkResetFences)                                                                                                \
    CALL(vkGetFenceStatus)                                                                                             \
    CALL(vkWaitForFences)                                                                                              \
    CALL(vkQueueSubmit)                                                                                                \
    CALL(vkQueueWaitIdle)                                                                                              \
    CALL(vkDeviceWaitIdle)                                                                                             \
    CALL(vkCreateSwapchainKHR)                                                                                         \
    CALL(vkGetSwapchainImagesKHR)                                                                                      \
    CALL(vkAcquireNextImageKHR)                                                                                        \
    CALL(vkQueuePresentKHR)

enum class Call {
#define PALPATE_NAME(name) name,
    PALPATE_CALLS(PALPATE_NAME)
#undef PALPATE_NAME
        kCount
};
constexpr std::size_t kCalls = std::size_t(Call::kCount);

constexpr std::array<std::string_view, kCalls> kNames{
#define PALPATE_WORD(name) #name,
    PALPATE_CALLS(PALPATE_WORD)
#undef PALPATE_WORD
};

struct Device {
    VkDevice                               handle  = VK_NULL_HANDLE;
    PFN_vkGetDeviceProcAddr                get     = nullptr;
    PFN_vkDestroyDevice                    destroy = nullptr;
    std::array<PFN_vkVoidFunction, kCalls> next{};
};

/// Functions of the next layer, taken while an instance is made: later a loader may return those of the first layer.
struct Instance {
    PFN_vkGetInstanceProcAddr get          = nullptr;
    PFN_vkDestroyInstance     destroy      = nullptr;
    PFN_vkCreateDevice        createDevice = nullptr;
};

std::mutex                guard; // of the next two
std::map<void*, Device>   devices;
std::map<void*, Instance> instances;
std::atomic<long>         counted{0};
std::atomic<bool>         isLost{false}, hangs{false};

std::string_view setting(const char* name)
{
    const char* const value = std::getenv(name);
    return value ? value : "";
}

/// Returns what the loader writes at the start of every object that is dispatched, the same for all of a device.
void* keyOf(const void* object)
{
    return *static_cast<void* const*>(object);
}

/// Counts a call.
/// \return whether it is the one that fails
bool isDue(std::string_view name)
{
    static const std::string_view only = setting("FAILING_LAYER_ONLY");
    if (!only.empty() && name != only) return false;
    static const long at  = std::atol(std::string(setting("FAILING_LAYER_AT")).c_str());
    const bool        due = ++counted == at;
    if (due && setting("FAILING_LAYER_AS") == "crash") std::abort();
    return due;
}

bool isWait(Call call)
{
    return call == Call::vkWaitForFences || call == Call::vkGetFenceStatus || call == Call::vkQueueWaitIdle ||
           call == Call::vkDeviceWaitIdle;
}

bool saysLost(Call call)
{
    return isWait(call) || call == Call::vkQueueSubmit || call == Call::vkGetQueryPoolResults ||
           call == Call::vkAcquireNextImageKHR || call == Call::vkQueuePresentKHR;
}

/// Returns what a call fails with; VK_SUCCESS: it goes on to the driver.
VkResult failureOf(Call call)
{
    const std::string_view as = setting("FAILING_LAYER_AS");
    if (isDue(kNames[std::size_t(call)])) {
        if (as == "hang") hangs = true;
        if (as == "lost") isLost = true;
        if (as == "memory") {
            if (call == Call::vkMapMemory) return VK_ERROR_MEMORY_MAP_FAILED;
            return call == Call::vkAllocateMemory ? VK_ERROR_OUT_OF_DEVICE_MEMORY : VK_ERROR_OUT_OF_HOST_MEMORY;
        }
        if (as == "lost") return saysLost(call) ? VK_ERROR_DEVICE_LOST : VK_ERROR_OUT_OF_HOST_MEMORY;
    }
    if (isLost && saysLost(call)) return VK_ERROR_DEVICE_LOST;
    if (!hangs) return VK_SUCCESS;
    if (call == Call::vkWaitForFences || call == Call::vkAcquireNextImageKHR) return VK_TIMEOUT; // see outwait()
    return call == Call::vkGetFenceStatus ? VK_NOT_READY : VK_SUCCESS;
}

/// Waits until a device has nothing more to do.
void finishAll(const void* object)
{
    Device of;
    {
        const std::lock_guard lock(guard);
        of = devices[keyOf(object)];
    }
    const auto idle = of.next[std::size_t(Call::vkDeviceWaitIdle)];
    static_cast<void>(reinterpret_cast<PFN_vkDeviceWaitIdle>(idle)(of.handle));
}

/// What is never finished is waited for as long as the caller would: for ever, or not at all, because no test has
/// patience.
void outwait(std::uint64_t nanoseconds)
{
    while (nanoseconds == UINT64_MAX) ::pause();
}
template <Call call, class... Rest>
void outwait(Rest... rest)
{
    if constexpr (call == Call::vkWaitForFences) outwait(std::get<3>(std::tuple(rest...)));
    if constexpr (call == Call::vkAcquireNextImageKHR) outwait(std::get<1>(std::tuple(rest...)));
}

template <Call call, class Function>
struct Hooked;
template <Call call, class Object, class... Rest>
struct Hooked<call, VkResult(VKAPI_PTR*)(Object, Rest...)> {
    static VKAPI_ATTR VkResult VKAPI_CALL run(Object object, Rest... rest)
    {
        const bool wasLost = isLost;
        if (const VkResult failure = failureOf(call); failure != VK_SUCCESS) {
            if (isLost && !wasLost) finishAll(object); // nothing works on after a loss
            if (failure == VK_TIMEOUT) outwait<call>(rest...);
            return failure;
        }
        if (hangs && (call == Call::vkQueueSubmit || call == Call::vkQueuePresentKHR || isWait(call)))
            return VK_SUCCESS; // a wait of a queue would not end
        PFN_vkVoidFunction next = nullptr;
        {
            const std::lock_guard lock(guard);
            next = devices[keyOf(object)].next[std::size_t(call)];
        }
        return reinterpret_cast<VkResult(VKAPI_PTR*)(Object, Rest...)>(next)(object, rest...);
    }
};

const std::array<PFN_vkVoidFunction, kCalls> kHooks{
#define PALPATE_HOOK(name) reinterpret_cast<PFN_vkVoidFunction>(Hooked<Call::name, PFN_##name>::run),
    PALPATE_CALLS(PALPATE_HOOK)
#undef PALPATE_HOOK
};

void tellCount()
{
    const std::string file(setting("FAILING_LAYER_COUNT"));
    if (file.empty()) return;
    if (std::FILE* const out = std::fopen(file.c_str(), "w")) {
        std::fprintf(out, "%ld\n", counted.load());
        std::fclose(out);
    }
}

/// Returns the link to the next layer, which is taken off the chain.
template <class Link>
Link* linkIn(const void* chain, VkStructureType type)
{
    for (auto* one = static_cast<const VkBaseInStructure*>(chain); one; one = one->pNext)
        if (one->sType == type) {
            auto* const link = const_cast<Link*>(reinterpret_cast<const Link*>(one));
            if (link->function == VK_LAYER_LINK_INFO) return link;
        }
    return nullptr;
}

PFN_vkVoidFunction ownFunction(std::string_view name);

VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL getDevice(VkDevice device, const char* name)
{
    if (const PFN_vkVoidFunction own = ownFunction(name)) return own;
    const std::lock_guard lock(guard);
    return devices[keyOf(device)].get(device, name);
}

VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL getInstance(VkInstance instance, const char* name)
{
    if (const PFN_vkVoidFunction own = ownFunction(name)) return own;
    if (!instance) return nullptr;
    const std::lock_guard lock(guard);
    return instances[keyOf(instance)].get(instance, name);
}

VKAPI_ATTR VkResult VKAPI_CALL createInstance(const VkInstanceCreateInfo* info, const VkAllocationCallbacks* memory,
                                              VkInstance* instance)
{
    auto* const link = linkIn<VkLayerInstanceCreateInfo>(info->pNext, VK_STRUCTURE_TYPE_LOADER_INSTANCE_CREATE_INFO);
    if (!link) return VK_ERROR_INITIALIZATION_FAILED;
    const PFN_vkGetInstanceProcAddr get = link->u.pLayerInfo->pfnNextGetInstanceProcAddr;
    link->u.pLayerInfo                  = link->u.pLayerInfo->pNext;
    if (isDue("vkCreateInstance")) return VK_ERROR_OUT_OF_HOST_MEMORY;
    const auto     next   = reinterpret_cast<PFN_vkCreateInstance>(get(nullptr, "vkCreateInstance"));
    const VkResult result = next(info, memory, instance);
    if (result != VK_SUCCESS) return result;
    const std::lock_guard lock(guard);
    instances[keyOf(*instance)] = {get, reinterpret_cast<PFN_vkDestroyInstance>(get(*instance, "vkDestroyInstance")),
                                   reinterpret_cast<PFN_vkCreateDevice>(get(*instance, "vkCreateDevice"))};
    return result;
}

VKAPI_ATTR void VKAPI_CALL destroyInstance(VkInstance instance, const VkAllocationCallbacks* memory)
{
    tellCount();
    if (!instance) return;
    Instance gone;
    {
        const std::lock_guard lock(guard);
        gone = instances.extract(keyOf(instance)).mapped();
    }
    gone.destroy(instance, memory);
}

VKAPI_ATTR VkResult VKAPI_CALL createDevice(VkPhysicalDevice physical, const VkDeviceCreateInfo* info,
                                            const VkAllocationCallbacks* memory, VkDevice* device)
{
    auto* const link = linkIn<VkLayerDeviceCreateInfo>(info->pNext, VK_STRUCTURE_TYPE_LOADER_DEVICE_CREATE_INFO);
    if (!link) return VK_ERROR_INITIALIZATION_FAILED;
    Device made{.get = link->u.pLayerInfo->pfnNextGetDeviceProcAddr};
    link->u.pLayerInfo = link->u.pLayerInfo->pNext;
    if (isDue("vkCreateDevice")) return VK_ERROR_INITIALIZATION_FAILED;
    PFN_vkCreateDevice next = nullptr;
    {
        const std::lock_guard lock(guard);
        next = instances[keyOf(physical)].createDevice; // an instance's devices have its key
    }
    const VkResult result = next(physical, info, memory, device);
    if (result != VK_SUCCESS) return result;
    made.handle  = *device;
    made.destroy = reinterpret_cast<PFN_vkDestroyDevice>(made.get(*device, "vkDestroyDevice"));
    for (std::size_t n = 0; n < kCalls; ++n) made.next[n] = made.get(*device, kNames[n].data());
    const std::lock_guard lock(guard);
    devices[keyOf(*device)] = made;
    return result;
}

VKAPI_ATTR void VKAPI_CALL destroyDevice(VkDevice device, const VkAllocationCallbacks* memory)
{
    tellCount();
    if (!device) return;
    Device gone;
    {
        const std::lock_guard lock(guard);
        gone = devices.extract(keyOf(device)).mapped();
    }
    gone.destroy(device, memory);
}

template <class Function>
PFN_vkVoidFunction pointer(Function* function)
{
    return reinterpret_cast<PFN_vkVoidFunction>(function);
}

PFN_vkVoidFunction ownFunction(std::string_view name)
{
    if (name == "vkGetInstanceProcAddr") return pointer(getInstance);
    if (name == "vkGetDeviceProcAddr") return pointer(getDevice);
    if (name == "vkCreateInstance") return pointer(createInstance);
    if (name == "vkDestroyInstance") return pointer(destroyInstance);
    if (name == "vkCreateDevice") return pointer(createDevice);
    if (name == "vkDestroyDevice") return pointer(destroyDevice);
    const auto found = std::ranges::find(kNames, name);
    return found != kNames.end() ? kHooks[std::size_t(found - kNames.begin())] : nullptr;
}

} // namespace

extern "C" VKAPI_ATTR VkResult VKAPI_CALL vkNegotiateLoaderLayerInterfaceVersion(VkNegotiateLayerInterface* with)
{
    with->loaderLayerInterfaceVersion  = 2;
    with->pfnGetInstanceProcAddr       = getInstance;
    with->pfnGetDeviceProcAddr         = getDevice;
    with->pfnGetPhysicalDeviceProcAddr = nullptr;
    return VK_SUCCESS;
}
