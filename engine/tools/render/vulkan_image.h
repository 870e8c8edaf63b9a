#pragma once
#include <span>

#include "engine/compute/vulkan_handles.h"

// Images and the passes that draw into them. Internal to engine/tools/render.

namespace palp {

/// A picture in the processor's own memory. Destroyed in the order from the last member to the first.
struct VulkanImage {
    compute::Owned<VkDeviceMemory, vkFreeMemory>    memory;
    compute::Owned<VkImage, vkDestroyImage>         image;
    compute::Owned<VkImageView, vkDestroyImageView> view;
    VkFormat                                        format = VK_FORMAT_UNDEFINED;
};

/// \param name   appears in messages of the validation layer
/// \throws Error if the processor cannot hold such an image, compute::ProcessorLost if memory runs out
[[nodiscard]] VulkanImage makeImage(const compute::VulkanContext& context, const char* name, VkExtent2D size,
                                    VkFormat format, VkImageUsageFlags usage);

/// A pass's use of one of its images.
struct PassImage {
    VkFormat      format = VK_FORMAT_UNDEFINED;
    VkImageLayout after  = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL; ///< UNDEFINED: not needed afterwards
    VkImageLayout before = VK_IMAGE_LAYOUT_UNDEFINED; ///< another layout keeps the image outside of the pass's area
};

using RenderPass  = compute::Owned<VkRenderPass, vkDestroyRenderPass>;
using Framebuffer = compute::Owned<VkFramebuffer, vkDestroyFramebuffer>;

/// Makes a pass that clears its images and draws into them. It sees what earlier passes and copies have written, and
/// later ones see what it writes.
/// \param depth  its image for depths; of format UNDEFINED: none
[[nodiscard]] RenderPass makePass(const compute::VulkanContext& context, std::span<const PassImage> colours,
                                  PassImage depth);

[[nodiscard]] Framebuffer makeFramebuffer(const compute::VulkanContext& context, VkRenderPass pass, VkExtent2D size,
                                          std::span<const VulkanImage* const> images);

} // namespace palp
