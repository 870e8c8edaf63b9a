#include "engine/tools/render/vulkan_image.h"

#include <array>
#include <string>
#include <vector>

namespace palp {
namespace {

using compute::check;
using compute::typed;

VkImageAspectFlags aspectOf(VkFormat format)
{
    return format == VK_FORMAT_D32_SFLOAT ? VK_IMAGE_ASPECT_DEPTH_BIT : VK_IMAGE_ASPECT_COLOR_BIT;
}

VkImage newImage(const compute::VulkanContext& context, VkExtent2D size, VkFormat format, VkImageUsageFlags usage)
{
    auto info        = typed<VkImageCreateInfo>(VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO);
    info.imageType   = VK_IMAGE_TYPE_2D;
    info.format      = format;
    info.extent      = {size.width, size.height, 1};
    info.mipLevels   = 1;
    info.arrayLayers = 1;
    info.samples     = VK_SAMPLE_COUNT_1_BIT;
    info.usage       = usage;
    VkImage image    = VK_NULL_HANDLE;
    check(vkCreateImage(context.device, &info, nullptr, &image), "make an image");
    return image;
}

VkDeviceMemory memoryFor(const compute::VulkanContext& context, VkImage image, const char* name)
{
    VkMemoryRequirements needs;
    vkGetImageMemoryRequirements(context.device, image, &needs);
    const auto type = compute::memoryTypeFor(context.memory, needs.memoryTypeBits, compute::Intent::processor);
    if (!type) throw Error("the GPU " + context.description.name + " has no memory for the image '" + name + "'");
    auto allocation            = typed<VkMemoryAllocateInfo>(VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO);
    allocation.allocationSize  = needs.size;
    allocation.memoryTypeIndex = *type;
    VkDeviceMemory memory      = VK_NULL_HANDLE;
    check(vkAllocateMemory(context.device, &allocation, nullptr, &memory), "find memory for an image");
    return memory;
}

VkImageView viewOf(const compute::VulkanContext& context, VkImage image, VkFormat format)
{
    auto info             = typed<VkImageViewCreateInfo>(VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO);
    info.image            = image;
    info.viewType         = VK_IMAGE_VIEW_TYPE_2D;
    info.format           = format;
    info.subresourceRange = {aspectOf(format), 0, 1, 0, 1};
    VkImageView view      = VK_NULL_HANDLE;
    check(vkCreateImageView(context.device, &info, nullptr, &view), "make a view of an image");
    return view;
}

VkAttachmentDescription attachment(const PassImage& image, bool depth)
{
    VkAttachmentDescription description{};
    description.format  = image.format;
    description.samples = VK_SAMPLE_COUNT_1_BIT;
    description.loadOp  = VK_ATTACHMENT_LOAD_OP_CLEAR;
    description.storeOp =
        image.after == VK_IMAGE_LAYOUT_UNDEFINED ? VK_ATTACHMENT_STORE_OP_DONT_CARE : VK_ATTACHMENT_STORE_OP_STORE;
    description.stencilLoadOp  = VK_ATTACHMENT_LOAD_OP_DONT_CARE;
    description.stencilStoreOp = VK_ATTACHMENT_STORE_OP_DONT_CARE;
    const VkImageLayout during =
        depth ? VK_IMAGE_LAYOUT_DEPTH_STENCIL_ATTACHMENT_OPTIMAL : VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL;
    description.initialLayout = image.before;
    description.finalLayout   = image.after == VK_IMAGE_LAYOUT_UNDEFINED ? during : image.after;
    return description;
}

/// Before: earlier passes and copies have ended. After: what is drawn can be read, copied and drawn over.
std::array<VkSubpassDependency, 2> dependencies()
{
    constexpr VkPipelineStageFlags kDraws = VK_PIPELINE_STAGE_COLOR_ATTACHMENT_OUTPUT_BIT |
                                            VK_PIPELINE_STAGE_EARLY_FRAGMENT_TESTS_BIT |
                                            VK_PIPELINE_STAGE_LATE_FRAGMENT_TESTS_BIT;
    constexpr VkPipelineStageFlags kUses =
        kDraws | VK_PIPELINE_STAGE_FRAGMENT_SHADER_BIT | VK_PIPELINE_STAGE_TRANSFER_BIT;
    constexpr VkAccessFlags kWrites =
        VK_ACCESS_COLOR_ATTACHMENT_WRITE_BIT | VK_ACCESS_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT;
    constexpr VkAccessFlags kReads = VK_ACCESS_SHADER_READ_BIT | VK_ACCESS_TRANSFER_READ_BIT |
                                     VK_ACCESS_COLOR_ATTACHMENT_READ_BIT | VK_ACCESS_DEPTH_STENCIL_ATTACHMENT_READ_BIT;
    return {{{VK_SUBPASS_EXTERNAL, 0, kUses, kDraws | VK_PIPELINE_STAGE_FRAGMENT_SHADER_BIT, kWrites,
              kWrites | VK_ACCESS_SHADER_READ_BIT | VK_ACCESS_COLOR_ATTACHMENT_READ_BIT |
                  VK_ACCESS_DEPTH_STENCIL_ATTACHMENT_READ_BIT,
              0},
             {0, VK_SUBPASS_EXTERNAL, kDraws, kUses, kWrites, kWrites | kReads, 0}}};
}

} // namespace

VulkanImage makeImage(const compute::VulkanContext& context, const char* name, VkExtent2D size, VkFormat format,
                      VkImageUsageFlags usage)
{
    VulkanImage made;
    made.format         = format;
    const VkImage image = newImage(context, size, format, usage);
    made.image          = {context, image};
    context.setName(VK_OBJECT_TYPE_IMAGE, reinterpret_cast<std::uint64_t>(image), name);
    made.memory = {context, memoryFor(context, image, name)};
    check(vkBindImageMemory(context.device, image, made.memory.get(), 0), "bind memory to an image");
    made.view = {context, viewOf(context, image, format)};
    return made;
}

RenderPass makePass(const compute::VulkanContext& context, std::span<const PassImage> colours, PassImage depth)
{
    std::vector<VkAttachmentDescription> attachments;
    std::vector<VkAttachmentReference>   references;
    for (const PassImage& colour : colours) {
        references.push_back({std::uint32_t(attachments.size()), VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL});
        attachments.push_back(attachment(colour, false));
    }
    const VkAttachmentReference depthReference{std::uint32_t(attachments.size()),
                                               VK_IMAGE_LAYOUT_DEPTH_STENCIL_ATTACHMENT_OPTIMAL};
    const bool                  hasDepth = depth.format != VK_FORMAT_UNDEFINED;
    if (hasDepth) attachments.push_back(attachment(depth, true));

    VkSubpassDescription subpass{};
    subpass.pipelineBindPoint       = VK_PIPELINE_BIND_POINT_GRAPHICS;
    subpass.colorAttachmentCount    = std::uint32_t(references.size());
    subpass.pColorAttachments       = references.data();
    subpass.pDepthStencilAttachment = hasDepth ? &depthReference : nullptr;
    const auto between              = dependencies();
    auto       info                 = typed<VkRenderPassCreateInfo>(VK_STRUCTURE_TYPE_RENDER_PASS_CREATE_INFO);
    info.attachmentCount            = std::uint32_t(attachments.size());
    info.pAttachments               = attachments.data();
    info.subpassCount               = 1;
    info.pSubpasses                 = &subpass;
    info.dependencyCount            = std::uint32_t(between.size());
    info.pDependencies              = between.data();
    VkRenderPass pass               = VK_NULL_HANDLE;
    check(vkCreateRenderPass(context.device, &info, nullptr, &pass), "make a render pass");
    return {context, pass};
}

Framebuffer makeFramebuffer(const compute::VulkanContext& context, VkRenderPass pass, VkExtent2D size,
                            std::span<const VulkanImage* const> images)
{
    std::vector<VkImageView> views;
    for (const VulkanImage* image : images) views.push_back(image->view.get());
    auto info                 = typed<VkFramebufferCreateInfo>(VK_STRUCTURE_TYPE_FRAMEBUFFER_CREATE_INFO);
    info.renderPass           = pass;
    info.attachmentCount      = std::uint32_t(views.size());
    info.pAttachments         = views.data();
    info.width                = size.width;
    info.height               = size.height;
    info.layers               = 1;
    VkFramebuffer framebuffer = VK_NULL_HANDLE;
    check(vkCreateFramebuffer(context.device, &info, nullptr, &framebuffer), "make a framebuffer");
    return {context, framebuffer};
}

} // namespace palp
