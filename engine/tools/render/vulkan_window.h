#pragma once
#include <vector>

#include "engine/compute/vulkan_handles.h"
#include "engine/tools/render/vulkan_image.h"

// Internal to engine/tools/render.

namespace palp {

/// The pictures that a window shows in turn.
/// \thread one
class VulkanWindow {
public:
    /// \param surface  of the window; is destroyed with this
    /// \throws Error if the processor cannot show pictures there
    VulkanWindow(compute::VulkanContext& context, VkSurfaceKHR surface);
    ~VulkanWindow();
    VulkanWindow(const VulkanWindow&)            = delete;
    VulkanWindow& operator=(const VulkanWindow&) = delete;

    /// Returns the format of the pictures: eight bits each of red, green, blue and alpha, in one order or the other.
    [[nodiscard]] VkFormat format() const noexcept { return format_.format; }

    /// Acquires the next picture that can be drawn over, made anew if the window's size has changed.
    /// \param size  of the window [px]
    /// \return false if there is none now, as with a minimised window
    [[nodiscard]] bool next(VkExtent2D size);

    /// Copies an image of that format, in the layout TRANSFER_SRC_OPTIMAL, onto that picture, scaled if it must be.
    void copy(VkCommandBuffer commands, VkImage image, VkExtent2D size) const;

    /// Shows the picture, once the recorded commands are done.
    void show();

private:
    /// Takes the surface, which the destructor gives back from here on, also where the public constructor throws.
    VulkanWindow(VkSurfaceKHR surface, compute::VulkanContext& context);

    void makeChain(VkExtent2D size);
    void dropChain() noexcept;

    compute::VulkanContext&                 context_;
    VkSurfaceKHR                            surface_ = VK_NULL_HANDLE;
    VkSurfaceFormatKHR                      format_{};
    VkSwapchainKHR                          chain_ = VK_NULL_HANDLE;
    VkExtent2D                              wanted_{}, size_{}; ///< what the window had, what the pictures have [px]
    std::vector<VkImage>                    images_;
    std::uint32_t                           current_ = 0;
    compute::Owned<VkFence, vkDestroyFence> ready_; ///< the next picture is free
};

} // namespace palp
