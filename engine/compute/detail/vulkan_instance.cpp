#include "engine/compute/vulkan_instance.h"

#include <algorithm>
#include <cstring>
#include <utility>

#include "engine/compute/vulkan_handles.h"

namespace palp::compute {
namespace {

constexpr const char* kValidationLayer = "VK_LAYER_KHRONOS_validation";

bool hasLayer(const char* name)
{
    std::uint32_t count = 0;
    vkEnumerateInstanceLayerProperties(&count, nullptr);
    std::vector<VkLayerProperties> layers(count);
    vkEnumerateInstanceLayerProperties(&count, layers.data());
    return std::any_of(layers.begin(), layers.end(),
                       [name](const VkLayerProperties& layer) { return std::strcmp(layer.layerName, name) == 0; });
}

bool hasExtension(const char* layer, const char* name)
{
    std::uint32_t count = 0;
    if (vkEnumerateInstanceExtensionProperties(layer, &count, nullptr) != VK_SUCCESS) return false;
    std::vector<VkExtensionProperties> found(count);
    vkEnumerateInstanceExtensionProperties(layer, &count, found.data());
    return std::any_of(found.begin(), found.end(), [name](const VkExtensionProperties& extension) {
        return std::strcmp(extension.extensionName, name) == 0;
    });
}

std::vector<VkValidationFeatureEnableEXT> featuresOf(Validation validation)
{
    switch (validation) {
    case Validation::synchronization:
        return {VK_VALIDATION_FEATURE_ENABLE_SYNCHRONIZATION_VALIDATION_EXT};
    case Validation::gpuAssisted:
        return {VK_VALIDATION_FEATURE_ENABLE_GPU_ASSISTED_EXT,
                VK_VALIDATION_FEATURE_ENABLE_GPU_ASSISTED_RESERVE_BINDING_SLOT_EXT};
    default:
        return {};
    }
}

} // namespace

Instance::Instance(Validation validation, const std::vector<std::string>& more)
{
    auto application             = typed<VkApplicationInfo>(VK_STRUCTURE_TYPE_APPLICATION_INFO);
    application.pApplicationName = "palpate";
    application.apiVersion       = VK_API_VERSION_1_2;
    auto info                    = typed<VkInstanceCreateInfo>(VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO);
    info.pApplicationInfo        = &application;

    std::vector<const char*> layers, extensions;
    debugUtils_                             = hasExtension(nullptr, VK_EXT_DEBUG_UTILS_EXTENSION_NAME);
    VkDebugUtilsMessengerCreateInfoEXT toUs = messengerInfo();
    auto       features                     = typed<VkValidationFeaturesEXT>(VK_STRUCTURE_TYPE_VALIDATION_FEATURES_EXT);
    const auto enabled                      = featuresOf(validation);
    if (validation != Validation::off) {
        if (!hasLayer(kValidationLayer))
            throw ProcessorError(std::string("validation was asked for and the layer ") + kValidationLayer +
                                 " is not installed (package vulkan-validationlayers)");
        layers.push_back(kValidationLayer);
        extensions.push_back(VK_EXT_VALIDATION_FEATURES_EXTENSION_NAME);
        debugUtils_                            = true; // the layer brings it
        features.enabledValidationFeatureCount = std::uint32_t(enabled.size());
        features.pEnabledValidationFeatures    = enabled.data();
        features.pNext                         = &toUs; // receives messages about the instance itself
        info.pNext                             = &features;
    }
    if (debugUtils_) extensions.push_back(VK_EXT_DEBUG_UTILS_EXTENSION_NAME);
    for (const std::string& extension : more) extensions.push_back(extension.c_str());
    info.enabledLayerCount       = std::uint32_t(layers.size());
    info.ppEnabledLayerNames     = layers.data();
    info.enabledExtensionCount   = std::uint32_t(extensions.size());
    info.ppEnabledExtensionNames = extensions.data();

    const VkResult result = vkCreateInstance(&info, nullptr, &instance_);
    if (result == VK_ERROR_INCOMPATIBLE_DRIVER) return; // no driver, or only ones that the loader cannot use
    if (result != VK_SUCCESS)
        throw ProcessorError("Vulkan does not start (error " + std::to_string(result) + "); does vulkaninfo run?");
    if (validation == Validation::off) return;
    const auto create = reinterpret_cast<PFN_vkCreateDebugUtilsMessengerEXT>(
        vkGetInstanceProcAddr(instance_, "vkCreateDebugUtilsMessengerEXT"));
    if (!create || create(instance_, &toUs, nullptr, &messenger_) != VK_SUCCESS) {
        vkDestroyInstance(instance_, nullptr);
        throw ProcessorError("the validation layer cannot report: it offers no debug messenger");
    }
}

Instance::~Instance()
{
    if (!instance_) return;
    if (messenger_)
        reinterpret_cast<PFN_vkDestroyDebugUtilsMessengerEXT>(
            vkGetInstanceProcAddr(instance_, "vkDestroyDebugUtilsMessengerEXT"))(instance_, messenger_, nullptr);
    vkDestroyInstance(instance_, nullptr);
}

VkDebugUtilsMessengerCreateInfoEXT Instance::messengerInfo()
{
    auto info = typed<VkDebugUtilsMessengerCreateInfoEXT>(VK_STRUCTURE_TYPE_DEBUG_UTILS_MESSENGER_CREATE_INFO_EXT);
    info.messageSeverity =
        VK_DEBUG_UTILS_MESSAGE_SEVERITY_WARNING_BIT_EXT | VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT;
    // GENERAL is omitted: there the loader reports drivers that do not fit this machine.
    info.messageType = VK_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT | VK_DEBUG_UTILS_MESSAGE_TYPE_PERFORMANCE_BIT_EXT;
    info.pfnUserCallback = collect;
    info.pUserData       = this;
    return info;
}

VkBool32 Instance::collect(VkDebugUtilsMessageSeverityFlagBitsEXT, VkDebugUtilsMessageTypeFlagsEXT,
                           const VkDebugUtilsMessengerCallbackDataEXT* data, void* self)
{
    Instance&              instance = *static_cast<Instance*>(self);
    const std::scoped_lock lock(instance.mutex_);
    instance.messages_.emplace_back(data->pMessage ? data->pMessage : "a message without text");
    return VK_FALSE; // the call goes on
}

std::vector<std::string> Instance::takeMessages()
{
    const std::scoped_lock lock(mutex_);
    return std::exchange(messages_, {});
}

} // namespace palp::compute
