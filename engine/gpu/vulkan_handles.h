#pragma once
#include <memory>
#include <utility>
#include <vector>

#include <vulkan/vulkan.h>

#include "engine/gpu/command_list.h"
#include "engine/gpu/vulkan_instance.h"

// What the public classes of engine/gpu hold. Internal to the layer: no other header names a type of Vulkan, except
// vulkan_instance.h.

namespace palp::gpu {

/// \throws DeviceLost for a lost device or missing memory, Error for any other failure; `what` completes "cannot ..."
void check(VkResult result, const char* what);

struct Context::Handles {
    explicit Handles(const ContextSettings& settings);
    ~Handles();
    Handles(const Handles&)            = delete;
    Handles& operator=(const Handles&) = delete;

    /// Whether an abandoned submission still runs: then nothing may be destroyed, and leaking is better than crashing.
    [[nodiscard]] bool atWork() const { return abandoned && vkGetFenceStatus(device, fence) == VK_NOT_READY; }

    /// Shows up in messages of the validation layer and in captures. Does nothing without VK_EXT_debug_utils.
    void setName(VkObjectType type, std::uint64_t handle, const std::string& name) const;

    std::unique_ptr<Instance>        instance;
    DeviceDescription                description;
    Limits                           limits;
    bool                             software = false;
    bool                             bitExact = false;
    double                           patience = 0; ///< [s]
    VkPhysicalDevice                 physical = VK_NULL_HANDLE;
    VkPhysicalDeviceLimits           native{};
    VkPhysicalDeviceMemoryProperties memory{};
    std::uint32_t                    timestampBits = 0; ///< 0: the queue has no clock
    VkDevice                         device        = VK_NULL_HANDLE;
    std::uint32_t                    family        = 0;
    VkQueue                          queue         = VK_NULL_HANDLE;
    VkFence                          fence         = VK_NULL_HANDLE;
    std::uint32_t                    allocations   = 0;     ///< live ones, of native.maxMemoryAllocationCount
    std::size_t                      allocated     = 0;     ///< [byte] of the live ones
    bool                             abandoned     = false; ///< a submission outlasted the patience
    PFN_vkSetDebugUtilsObjectNameEXT setObjectName = nullptr;

private:
    void describe(const Candidate& candidate);
    void open();
};

/// A handle that is destroyed with its owner, unless the device hangs and is still using it.
template <class Handle, auto Destroy>
class Owned {
public:
    Owned() = default;
    Owned(const Context::Handles& context, Handle handle) : context_(&context), handle_(handle) {}
    ~Owned()
    {
        if (handle_ && !context_->atWork()) Destroy(context_->device, handle_, nullptr);
    }
    Owned(Owned&& other) noexcept : context_(other.context_), handle_(std::exchange(other.handle_, {})) {}
    Owned& operator=(Owned&& other) noexcept
    {
        std::swap(context_, other.context_);
        std::swap(handle_, other.handle_);
        return *this;
    }

    [[nodiscard]] Handle get() const noexcept { return handle_; }

private:
    const Context::Handles* context_ = nullptr;
    Handle                  handle_{};
};

struct Buffer::Handles {
    Handles(Context::Handles& context, std::string name, std::size_t bytes);
    ~Handles();
    Handles(const Handles&)            = delete;
    Handles& operator=(const Handles&) = delete;

    Context::Handles&                   context;
    std::string                         name;
    std::size_t                         bytes;
    Owned<VkDeviceMemory, vkFreeMemory> memory; // outlives the buffer that is bound to it
    Owned<VkBuffer, vkDestroyBuffer>    buffer;
    void*                               mapped   = nullptr;
    bool                                coherent = true;
};

struct Kernel::Handles {
    KernelCode                                                 code;
    Workgroup                                                  workgroup;
    Owned<VkDescriptorSetLayout, vkDestroyDescriptorSetLayout> setLayout;
    Owned<VkPipelineLayout, vkDestroyPipelineLayout>           layout;
    Owned<VkPipeline, vkDestroyPipeline>                       pipeline;
};

struct CommandList::Handles {
    explicit Handles(Context::Handles& context);

    /// The barrier that every command but the last is followed by: what was written is seen by what comes next.
    void separate() const;
    void finish();
    void bind(const Kernel& kernel, const Bindings& bindings, const Push& push);
    void timestamp();

    Context::Handles&                                             context;
    Owned<VkCommandPool, vkDestroyCommandPool>                    commandPool; // frees the command buffer with it
    VkCommandBuffer                                               commands = VK_NULL_HANDLE;
    std::vector<Owned<VkDescriptorPool, vkDestroyDescriptorPool>> descriptorPools;
    std::vector<Owned<VkQueryPool, vkDestroyQueryPool>>           queryPools;
    std::uint32_t                                                 timestamps = 0;
    int                                                           dispatches = 0;
    bool                                                          ended      = false;
    bool                                                          ran        = false;

private:
    VkDescriptorSet descriptorSet(const Kernel& kernel);
};

} // namespace palp::gpu
