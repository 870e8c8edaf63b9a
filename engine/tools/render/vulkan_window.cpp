#include "engine/tools/render/vulkan_window.h"

#include <algorithm>
#include <utility>

#include "engine/core/contract.h"

namespace palp {
namespace {

using compute::check;
using compute::typed;

/// Chooses a format that takes colours without conversion.
VkSurfaceFormatKHR formatOf(const compute::VulkanContext& context, VkSurfaceKHR surface)
{
    std::uint32_t count = 0;
    check(vkGetPhysicalDeviceSurfaceFormatsKHR(context.physical, surface, &count, nullptr), "list a window's formats");
    std::vector<VkSurfaceFormatKHR> formats(count);
    check(vkGetPhysicalDeviceSurfaceFormatsKHR(context.physical, surface, &count, formats.data()),
          "list a window's formats");
    for (const VkFormat wanted : {VK_FORMAT_R8G8B8A8_UNORM, VK_FORMAT_B8G8R8A8_UNORM})
        for (const VkSurfaceFormatKHR& format : formats)
            if (format.format == wanted) return format;
    throw Error("the GPU " + context.description.name +
                " shows windows in none of the 8 bit formats; try another processor with --draw-on");
}

} // namespace

VulkanWindow::VulkanWindow(VkSurfaceKHR surface, compute::VulkanContext& context) : context_(context), surface_(surface)
{
}

VulkanWindow::VulkanWindow(compute::VulkanContext& context, VkSurfaceKHR surface) : VulkanWindow(surface, context)
{
    VkBool32 shows = VK_FALSE;
    check(vkGetPhysicalDeviceSurfaceSupportKHR(context.physical, context.family, surface, &shows),
          "ask whether a processor shows a window");
    if (!shows)
        throw Error("the GPU " + context.description.name +
                    " draws and cannot show windows; try another processor with --draw-on");
    format_         = formatOf(context, surface);
    const auto info = typed<VkFenceCreateInfo>(VK_STRUCTURE_TYPE_FENCE_CREATE_INFO);
    VkFence    fence{};
    check(vkCreateFence(context.device, &info, nullptr, &fence), "make a fence");
    ready_ = {context, fence};
}

VulkanWindow::~VulkanWindow()
{
    if (context_.atWork()) return;
    dropChain();
    vkDestroySurfaceKHR(context_.instance->get(), surface_, nullptr);
}

void VulkanWindow::dropChain() noexcept
{
    if (!chain_) return;
    vkQueueWaitIdle(context_.queue); // what is being shown
    vkDestroySwapchainKHR(context_.device, std::exchange(chain_, VK_NULL_HANDLE), nullptr);
    images_.clear();
}

void VulkanWindow::makeChain(VkExtent2D size)
{
    dropChain();
    wanted_ = size;
    VkSurfaceCapabilitiesKHR can;
    const VkResult           asked = vkGetPhysicalDeviceSurfaceCapabilitiesKHR(context_.physical, surface_, &can);
    if (asked == VK_ERROR_SURFACE_LOST_KHR) return; // its display has gone: the window says so
    check(asked, "ask what a window can");
    constexpr std::uint32_t kOurs = 0xFFFFFFFF; // the program sets the size
    size_                         = can.currentExtent.width != kOurs ? can.currentExtent : size;
    size_                         = {std::clamp(size_.width, can.minImageExtent.width, can.maxImageExtent.width),
                                     std::clamp(size_.height, can.minImageExtent.height, can.maxImageExtent.height)};
    if (size_.width == 0 || size_.height == 0) return;
    const std::uint32_t most = can.maxImageCount > 0 ? can.maxImageCount : 8;

    auto info             = typed<VkSwapchainCreateInfoKHR>(VK_STRUCTURE_TYPE_SWAPCHAIN_CREATE_INFO_KHR);
    info.surface          = surface_;
    info.minImageCount    = std::min(most, can.minImageCount + 1);
    info.imageFormat      = format_.format;
    info.imageColorSpace  = format_.colorSpace;
    info.imageExtent      = size_;
    info.imageArrayLayers = 1;
    info.imageUsage       = VK_IMAGE_USAGE_TRANSFER_DST_BIT;
    info.preTransform     = can.currentTransform;
    info.compositeAlpha   = VK_COMPOSITE_ALPHA_OPAQUE_BIT_KHR;
    info.presentMode      = VK_PRESENT_MODE_FIFO_KHR; // the one that all have
    info.clipped          = VK_TRUE;
    check(vkCreateSwapchainKHR(context_.device, &info, nullptr, &chain_), "make pictures for a window");
    std::uint32_t count = 0;
    check(vkGetSwapchainImagesKHR(context_.device, chain_, &count, nullptr), "list a window's pictures");
    images_.resize(count);
    check(vkGetSwapchainImagesKHR(context_.device, chain_, &count, images_.data()), "list a window's pictures");
}

bool VulkanWindow::next(VkExtent2D size)
{
    if (size.width == 0 || size.height == 0) return false;
    for (int attempt = 0; attempt < 3; ++attempt) { // its size may change here while the user drags it
        if (!chain_ || size.width != wanted_.width || size.height != wanted_.height) makeChain(size);
        if (!chain_) return false;
        const VkFence fence = ready_.get();
        check(vkResetFences(context_.device, 1, &fence), "reset a fence");
        constexpr std::uint64_t kPatience = 200'000'000; // [ns] windows that are covered may never give one
        const VkResult          result =
            vkAcquireNextImageKHR(context_.device, chain_, kPatience, VK_NULL_HANDLE, fence, &current_);
        if (result == VK_SUCCESS || result == VK_SUBOPTIMAL_KHR) {
            check(vkWaitForFences(context_.device, 1, &fence, VK_TRUE, context_.patienceInNanoseconds()),
                  "wait for a window's picture");
            if (result == VK_SUBOPTIMAL_KHR) wanted_ = {}; // the one after is made anew
            return true;
        }
        if (result == VK_TIMEOUT || result == VK_NOT_READY) return false;
        if (result == VK_ERROR_SURFACE_LOST_KHR) return false; // as above
        if (result != VK_ERROR_OUT_OF_DATE_KHR) check(result, "get a window's next picture");
        wanted_ = {};
    }
    return false;
}

void VulkanWindow::copy(VkCommandBuffer commands, VkImage image, VkExtent2D size) const
{
    auto barrier                = typed<VkImageMemoryBarrier>(VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER);
    barrier.dstAccessMask       = VK_ACCESS_TRANSFER_WRITE_BIT;
    barrier.oldLayout           = VK_IMAGE_LAYOUT_UNDEFINED;
    barrier.newLayout           = VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL;
    barrier.srcQueueFamilyIndex = barrier.dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
    barrier.image                                             = images_[current_];
    barrier.subresourceRange                                  = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
    vkCmdPipelineBarrier(commands, VK_PIPELINE_STAGE_TRANSFER_BIT, VK_PIPELINE_STAGE_TRANSFER_BIT, 0, 0, nullptr, 0,
                         nullptr, 1, &barrier);
    if (size.width == size_.width && size.height == size_.height) {
        VkImageCopy whole{}; // four times as fast as a blit where drivers draw in software
        whole.srcSubresource = whole.dstSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
        whole.extent                                = {size.width, size.height, 1};
        vkCmdCopyImage(commands, image, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, images_[current_],
                       VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &whole);
    } else {
        VkImageBlit whole{};
        whole.srcSubresource = whole.dstSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
        whole.srcOffsets[1]                         = {int(size.width), int(size.height), 1};
        whole.dstOffsets[1]                         = {int(size_.width), int(size_.height), 1};
        vkCmdBlitImage(commands, image, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, images_[current_],
                       VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &whole, VK_FILTER_NEAREST);
    }
    barrier.srcAccessMask = VK_ACCESS_TRANSFER_WRITE_BIT;
    barrier.dstAccessMask = 0;
    barrier.oldLayout     = VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL;
    barrier.newLayout     = VK_IMAGE_LAYOUT_PRESENT_SRC_KHR;
    vkCmdPipelineBarrier(commands, VK_PIPELINE_STAGE_TRANSFER_BIT, VK_PIPELINE_STAGE_BOTTOM_OF_PIPE_BIT, 0, 0, nullptr,
                         0, nullptr, 1, &barrier);
}

void VulkanWindow::show()
{
    auto info            = typed<VkPresentInfoKHR>(VK_STRUCTURE_TYPE_PRESENT_INFO_KHR);
    info.swapchainCount  = 1;
    info.pSwapchains     = &chain_;
    info.pImageIndices   = &current_;
    const VkResult shown = vkQueuePresentKHR(context_.queue, &info);
    if (shown == VK_ERROR_OUT_OF_DATE_KHR || shown == VK_SUBOPTIMAL_KHR)
        wanted_ = {};                            // the next one is made anew
    else if (shown != VK_ERROR_SURFACE_LOST_KHR) // as above
        check(shown, "show a picture in a window");
}

} // namespace palp
