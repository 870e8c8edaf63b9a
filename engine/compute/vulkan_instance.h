#pragma once
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include <vulkan/vulkan.h>

#include "engine/compute/context.h"

// The entrance to Vulkan, for code that uses Vulkan itself.

namespace palp::compute {

/// Makes a structure of Vulkan that is zero but for its type and its chain.
template <class Structure>
[[nodiscard]] Structure typed(VkStructureType type, void* next = nullptr)
{
    Structure structure{};
    structure.sType = type;
    structure.pNext = next;
    return structure;
}

/// The entrance to the drivers, with the validation layer if requested.
class Instance {
public:
    /// \param more  extensions beside the engine's own
    /// \throws ProcessorError if validation is requested and not installed, or if a driver fails; not if there is none
    explicit Instance(Validation validation, const std::vector<std::string>& more = {});
    ~Instance();
    Instance(const Instance&)            = delete;
    Instance& operator=(const Instance&) = delete;

    [[nodiscard]] VkInstance get() const noexcept { return instance_; } ///< null: there is no driver
    [[nodiscard]] bool       hasDebugUtils() const noexcept { return debugUtils_; }

    /// Returns the messages since the last call.
    /// \thread any
    [[nodiscard]] std::vector<std::string> takeMessages();

private:
    static VKAPI_ATTR VkBool32 VKAPI_CALL            collect(VkDebugUtilsMessageSeverityFlagBitsEXT      severity,
                                                             VkDebugUtilsMessageTypeFlagsEXT             types,
                                                             const VkDebugUtilsMessengerCallbackDataEXT* data, void* self);
    [[nodiscard]] VkDebugUtilsMessengerCreateInfoEXT messengerInfo();

    VkInstance               instance_   = VK_NULL_HANDLE;
    VkDebugUtilsMessengerEXT messenger_  = VK_NULL_HANDLE;
    bool                     debugUtils_ = false;
    std::mutex               mutex_; // guards messages_: the layer may call from any thread
    std::vector<std::string> messages_;
};

/// A Vulkan processor and, if it cannot be used, why.
struct Candidate {
    Processor                    description;
    VkPhysicalDevice             physical      = VK_NULL_HANDLE;
    VkDriverId                   driver        = VkDriverId(0);
    std::uint32_t                family        = 0; ///< the queue family to compute with
    std::uint32_t                timestampBits = 0;
    std::optional<std::uint32_t> drawFamily;          ///< the queue family to draw with; empty: none draws
    bool                         largePoints = false; ///< it draws points larger than a pixel
    VkPhysicalDeviceLimits       limits{};
    VkDeviceSize                 maxBufferBytes = 0; ///< [byte]
};

/// Describes every Vulkan processor, in the order of the drivers.
/// \throws ProcessorError if they cannot be listed
[[nodiscard]] std::vector<Candidate> candidates(const Instance& instance);

} // namespace palp::compute
