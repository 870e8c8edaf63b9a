// A Vulkan driver that does not work, for tests of what "auto" does then. PALPATE_BROKEN says where it fails: "start",
// "list" or, as an integrated and a discrete GPU that have all that is needed until they are used, "open".
#include <cstdlib>
#include <cstring>
#include <limits>
#include <string_view>

#include <vulkan/vk_icd.h>
#include <vulkan/vulkan.h>

namespace {

VK_LOADER_DATA theInstance, theGpus[2]; // the loader writes its tables there

bool failsAt(std::string_view where)
{
    const char* wanted = std::getenv("PALPATE_BROKEN");
    return wanted && wanted == where;
}

VKAPI_ATTR VkResult VKAPI_CALL enumerateVersion(std::uint32_t* version)
{
    *version = VK_API_VERSION_1_2;
    return VK_SUCCESS;
}

VKAPI_ATTR VkResult VKAPI_CALL noExtensions(const char*, std::uint32_t* count, VkExtensionProperties*)
{
    *count = 0;
    return VK_SUCCESS;
}

VKAPI_ATTR VkResult VKAPI_CALL noDeviceExtensions(VkPhysicalDevice, const char*, std::uint32_t* count,
                                                  VkExtensionProperties*)
{
    *count = 0;
    return VK_SUCCESS;
}

VKAPI_ATTR VkResult VKAPI_CALL createInstance(const VkInstanceCreateInfo*, const VkAllocationCallbacks*,
                                              VkInstance* instance)
{
    if (failsAt("start")) return VK_ERROR_OUT_OF_HOST_MEMORY; // the one failure that the loader does not swallow
    set_loader_magic_value(&theInstance);
    *instance = reinterpret_cast<VkInstance>(&theInstance);
    return VK_SUCCESS;
}

VKAPI_ATTR void VKAPI_CALL destroyInstance(VkInstance, const VkAllocationCallbacks*) {}

VKAPI_ATTR VkResult VKAPI_CALL enumerateDevices(VkInstance, std::uint32_t* count, VkPhysicalDevice* devices)
{
    if (failsAt("list")) return VK_ERROR_OUT_OF_HOST_MEMORY;
    *count = 2;
    for (std::uint32_t n = 0; devices && n < *count; ++n) {
        set_loader_magic_value(&theGpus[n]);
        devices[n] = reinterpret_cast<VkPhysicalDevice>(&theGpus[n]);
    }
    return VK_SUCCESS;
}

VKAPI_ATTR void VKAPI_CALL properties(VkPhysicalDevice device, VkPhysicalDeviceProperties* all)
{
    constexpr std::uint32_t kPlenty    = 1 << 20;
    const bool              isDiscrete = reinterpret_cast<VK_LOADER_DATA*>(device) == &theGpus[1];
    *all                               = {};
    all->apiVersion                    = VK_API_VERSION_1_2;
    all->deviceType = isDiscrete ? VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU : VK_PHYSICAL_DEVICE_TYPE_INTEGRATED_GPU;
    std::strcpy(all->deviceName, isDiscrete ? "Broken Large" : "Broken Small");
    all->limits.maxPerStageDescriptorStorageBuffers = kPlenty;
    all->limits.maxComputeWorkGroupInvocations      = kPlenty;
    all->limits.maxPushConstantsSize                = kPlenty;
    all->limits.maxComputeSharedMemorySize          = kPlenty;
}

VKAPI_ATTR void VKAPI_CALL properties2(VkPhysicalDevice device, VkPhysicalDeviceProperties2* all)
{
    properties(device, &all->properties);
}

VKAPI_ATTR void VKAPI_CALL features(VkPhysicalDevice, VkPhysicalDeviceFeatures* all)
{
    *all = {};
}

VKAPI_ATTR void VKAPI_CALL features2(VkPhysicalDevice device, VkPhysicalDeviceFeatures2* all)
{
    features(device, &all->features);
    for (auto* next = static_cast<VkBaseOutStructure*>(all->pNext); next; next = next->pNext)
        if (next->sType == VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SCALAR_BLOCK_LAYOUT_FEATURES)
            reinterpret_cast<VkPhysicalDeviceScalarBlockLayoutFeatures*>(next)->scalarBlockLayout = VK_TRUE;
}

VKAPI_ATTR void VKAPI_CALL memoryProperties(VkPhysicalDevice, VkPhysicalDeviceMemoryProperties* all)
{
    *all = {};
}

VKAPI_ATTR void VKAPI_CALL queueFamilies(VkPhysicalDevice, std::uint32_t* count, VkQueueFamilyProperties* all)
{
    *count = 1;
    if (all) *all = {VK_QUEUE_COMPUTE_BIT, 1, 0, {1, 1, 1}};
}

VKAPI_ATTR VkResult VKAPI_CALL createDevice(VkPhysicalDevice, const VkDeviceCreateInfo*, const VkAllocationCallbacks*,
                                            VkDevice*)
{
    return VK_ERROR_INITIALIZATION_FAILED;
}

/// What the loader wants to be there and nobody calls.
VKAPI_ATTR void VKAPI_CALL neverCalled() {}

template <class Function>
PFN_vkVoidFunction pointer(Function* function)
{
    return reinterpret_cast<PFN_vkVoidFunction>(function);
}

} // namespace

extern "C" VKAPI_ATTR VkResult VKAPI_CALL vk_icdNegotiateLoaderICDInterfaceVersion(std::uint32_t* version)
{
    *version = 5;
    return VK_SUCCESS;
}

extern "C" VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL vk_icdGetInstanceProcAddr(VkInstance, const char* name)
{
    constexpr struct {
        std::string_view name;
        PFN_vkVoidFunction (*function)();
    } kFunctions[] = {
        {"vkEnumerateInstanceVersion", [] { return pointer(enumerateVersion); }},
        {"vkEnumerateInstanceExtensionProperties", [] { return pointer(noExtensions); }},
        {"vkCreateInstance", [] { return pointer(createInstance); }},
        {"vkDestroyInstance", [] { return pointer(destroyInstance); }},
        {"vkEnumeratePhysicalDevices", [] { return pointer(enumerateDevices); }},
        {"vkEnumerateDeviceExtensionProperties", [] { return pointer(noDeviceExtensions); }},
        {"vkGetPhysicalDeviceProperties", [] { return pointer(properties); }},
        {"vkGetPhysicalDeviceProperties2", [] { return pointer(properties2); }},
        {"vkGetPhysicalDeviceFeatures", [] { return pointer(features); }},
        {"vkGetPhysicalDeviceFeatures2", [] { return pointer(features2); }},
        {"vkGetPhysicalDeviceMemoryProperties", [] { return pointer(memoryProperties); }},
        {"vkGetPhysicalDeviceQueueFamilyProperties", [] { return pointer(queueFamilies); }},
        {"vkCreateDevice", [] { return pointer(createDevice); }},
        {"vkGetDeviceProcAddr", [] { return pointer(neverCalled); }},
        {"vkGetPhysicalDeviceFormatProperties", [] { return pointer(neverCalled); }},
        {"vkGetPhysicalDeviceImageFormatProperties", [] { return pointer(neverCalled); }},
        {"vkGetPhysicalDeviceSparseImageFormatProperties", [] { return pointer(neverCalled); }},
    };
    for (const auto& entry : kFunctions)
        if (entry.name == name) return entry.function();
    return nullptr;
}
