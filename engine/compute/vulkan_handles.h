#pragma once
#include <memory>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include <vulkan/vulkan.h>

#include "engine/compute/backend.h"
#include "engine/compute/vulkan_instance.h"

// Vulkan's objects behind the classes of engine/compute, for code that uses Vulkan itself, such as the renderer. No
// other header of the library names a type of Vulkan, except vulkan_instance.h.

namespace palp::compute {

/// \throws ProcessorOutOfMemory for missing memory, ProcessorLost for any other failure; `what` completes "cannot ..."
void check(VkResult result, const char* what);

class VulkanContext : public Context::Handles {
public:
    /// \param entrance  taken over only if the processor opens
    /// \param patience  see ContextSettings [s]
    /// \throws ProcessorError if the processor does not open
    VulkanContext(std::unique_ptr<Instance>& entrance, const Candidate& candidate, double patience,
                  Purpose purpose = Purpose::compute);
    ~VulkanContext() override;

    std::unique_ptr<Buffer::Handles>      makeBuffer(std::string name, std::size_t bytes, Intent intent) override;
    std::unique_ptr<Kernel::Handles>      makeKernel(const KernelCode& code, Workgroup workgroup,
                                                     std::span<const std::uint32_t> constants) override;
    std::unique_ptr<CommandList::Handles> makeList() override;
    void                                  run(std::span<CommandList* const> lists) override;
    std::vector<std::string>              takeMessages() override;

    /// Submits what was recorded and waits, as Context::run() does.
    /// \throws ProcessorLost as Context::run()
    void submit(std::span<const VkCommandBuffer> commands);

    /// Do the two halves of submit(); the host is free in between.
    /// \pre an earlier submission has been finished
    void start(std::span<const VkCommandBuffer> commands);
    void finish();
    void lookAtFence() const; ///< waits for a short while without sleeping

    [[nodiscard]] std::uint64_t patienceInNanoseconds() const; ///< for waits

    /// Returns whether an abandoned submission still runs: then nothing may be destroyed, and leaks replace crashes.
    [[nodiscard]] bool atWork() const { return abandoned && vkGetFenceStatus(device, fence) == VK_NOT_READY; }

    /// Sets the name in messages of the validation layer and in captures. Does nothing without VK_EXT_debug_utils.
    void setName(VkObjectType type, std::uint64_t handle, const std::string& name) const;

    std::unique_ptr<Instance>        instance;
    double                           patience = 0;     ///< [s]
    bool                             looks    = false; ///< at the fence before it sleeps: of solves on hardware
    VkPhysicalDevice                 physical = VK_NULL_HANDLE;
    VkPhysicalDeviceLimits           native{};
    VkPhysicalDeviceMemoryProperties memory{};
    std::uint32_t                    timestampBits = 0; ///< 0: the queue has no clock
    VkDevice                         device        = VK_NULL_HANDLE;
    std::uint32_t                    family        = 0;
    VkQueue                          queue         = VK_NULL_HANDLE;
    VkFence                          fence         = VK_NULL_HANDLE;
    std::uint32_t                    allocations   = 0;     ///< live ones, of native.maxMemoryAllocationCount
    bool                             abandoned     = false; ///< a submission outlasted the patience
    PFN_vkSetDebugUtilsObjectNameEXT setObjectName = nullptr;

private:
    void describe(const Candidate& candidate, Purpose purpose);
    void open(const Instance& entrance, Purpose purpose);
};

/// Returns the first memory type that meets the best possible wish; drivers list types from fast to slow.
/// \param allowed  the types that the resource may have, a bit each
[[nodiscard]] std::optional<std::uint32_t> memoryTypeFor(const VkPhysicalDeviceMemoryProperties& memory,
                                                         std::uint32_t allowed, Intent intent);

/// A handle that is destroyed with its owner, unless the processor hangs and is still using it.
template <class Handle, auto Destroy>
class Owned {
public:
    Owned() = default;
    Owned(const VulkanContext& context, Handle handle) : context_(&context), handle_(handle) {}
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
    const VulkanContext* context_ = nullptr;
    Handle               handle_{};
};

struct VulkanBuffer : Buffer::Handles {
    VulkanBuffer(VulkanContext& context, std::string name, std::size_t bytes);
    ~VulkanBuffer() override;

    void makeVisibleToHost() override;

    VulkanContext&                      context;
    Owned<VkDeviceMemory, vkFreeMemory> memory; // outlives the buffer that is bound to it
    Owned<VkBuffer, vkDestroyBuffer>    buffer;
    bool                                coherent = true;
};

struct VulkanKernel : Kernel::Handles {
    using Handles::Handles;

    Owned<VkDescriptorSetLayout, vkDestroyDescriptorSetLayout> setLayout;
    Owned<VkPipelineLayout, vkDestroyPipelineLayout>           layout;
    Owned<VkPipeline, vkDestroyPipeline>                       pipeline;
};

class VulkanList : public CommandList::Handles {
public:
    explicit VulkanList(VulkanContext& context);

    void dispatch(const Kernel& kernel, const Bindings& bindings, const Push& push, Groups groups) override;
    void dispatchIndirect(const Kernel& kernel, const Bindings& bindings, const Push& push, const Buffer& groups,
                          std::size_t offset) override;
    void copy(const Buffer& from, std::size_t fromOffset, const Buffer& to, std::size_t toOffset,
              std::size_t bytes) override;
    void fill(const Buffer& buffer, std::uint32_t word) override;
    void timestamp() override;
    void end() override;

    [[nodiscard]] std::vector<double> timestampsMilliseconds() const override;

    VkCommandBuffer commands = VK_NULL_HANDLE;

private:
    enum class Next { copies, computes, readsItsSize };
    /// Records the barrier before a command, which then sees what earlier ones wrote.
    void            separate(Next next) const;
    void            bind(const Kernel& kernel, const Bindings& bindings, const Push& push, Next next);
    void            meansToWrite(VkBuffer buffer);
    VkDescriptorSet descriptorSet(const Kernel& kernel);

    VulkanContext&                                                gpu;
    Owned<VkCommandPool, vkDestroyCommandPool>                    commandPool; // frees the command buffer with it
    std::vector<Owned<VkDescriptorPool, vkDestroyDescriptorPool>> descriptorPools;
    std::vector<Owned<VkQueryPool, vkDestroyQueryPool>>           queryPools;
    std::uint32_t                                                 timestamps = 0;
    std::set<VkBuffer>                                            seenSizes; ///< of dispatches, as they are by now
};

} // namespace palp::compute
