#include "engine/tools/render/vulkan_surface.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <utility>

#include "compute_shaders/view_blend_frag.spv.h"
#include "compute_shaders/view_disc_vert.spv.h"
#include "compute_shaders/view_face_frag.spv.h"
#include "compute_shaders/view_face_vert.spv.h"
#include "compute_shaders/view_ground_frag.spv.h"
#include "compute_shaders/view_hidden_frag.spv.h"
#include "compute_shaders/view_light_frag.spv.h"
#include "compute_shaders/view_litface_frag.spv.h"
#include "compute_shaders/view_litface_vert.spv.h"
#include "compute_shaders/view_nearest_frag.spv.h"
#include "compute_shaders/view_overlay_frag.spv.h"
#include "compute_shaders/view_overlay_vert.spv.h"
#include "compute_shaders/view_panel_frag.spv.h"
#include "compute_shaders/view_point_frag.spv.h"
#include "compute_shaders/view_point_vert.spv.h"
#include "compute_shaders/view_screen_vert.spv.h"
#include "compute_shaders/view_shape_frag.spv.h"
#include "compute_shaders/view_shape_vert.spv.h"
#include "compute_shaders/view_splat_vert.spv.h"
#include "compute_shaders/view_surface_frag.spv.h"
#include "engine/core/contract.h"
#ifdef PALPATE_PANELS
#include "engine/tools/render/vulkan_panels.h"
#endif

namespace palp {
namespace {

using compute::check;
using compute::typed;

// Vulkan promises all of these as images to draw into; of the second one, that colours can be added up.
constexpr VkFormat kDepthTest = VK_FORMAT_D32_SFLOAT, kSums = VK_FORMAT_R16G16B16A16_SFLOAT;
constexpr VkFormat kDepth = VK_FORMAT_R32_SFLOAT, kSurface = VK_FORMAT_R32G32B32A32_SFLOAT;
constexpr VkFormat kColour = VK_FORMAT_R8G8B8A8_UNORM;

constexpr VkImageUsageFlags kDrawn = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_SAMPLED_BIT;

constexpr std::uint32_t kBuffers[] = {shared::kBindFrame,   shared::kBindSplats, shared::kBindShapes,
                                      shared::kBindOverlay, shared::kBindTiles,  shared::kBindFaces};
constexpr std::uint32_t kImages[]  = {shared::kBindDepth,   shared::kBindNormals, shared::kBindColours,
                                      shared::kBindSurface, shared::kBindAlbedo,  shared::kBindPanels};

constexpr std::uint32_t kCornersOfSplat = 6;

/// The frame is uniform: drivers in software then load its numbers once, not once per pixel.
constexpr VkDescriptorType typeOf(std::uint32_t binding)
{
    return binding == shared::kBindFrame ? VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER : VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
}

/// Anything beyond every depth [m].
constexpr float kNowhere = 1e30F;

} // namespace

VulkanSurface::VulkanSurface(compute::Context& context, VkFormat picture)
    : owner_(context), context_(static_cast<compute::VulkanContext&>(context.handles())), format_(picture)
{
    makeLayouts();
    makeSteps();
    makePipelines();
}

VulkanSurface::~VulkanSurface()
{
    try {
        finish();
    } catch (const Error&) { // a processor that hangs leaks its objects
    }
}

void VulkanSurface::makeLayouts()
{
    std::vector<VkDescriptorSetLayoutBinding> bindings;
    const VkShaderStageFlags                  stages = VK_SHADER_STAGE_VERTEX_BIT | VK_SHADER_STAGE_FRAGMENT_BIT;
    for (const std::uint32_t n : kBuffers) bindings.push_back({n, typeOf(n), 1, stages, nullptr});
    for (const std::uint32_t n : kImages)
        bindings.push_back({n, VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE, 1, VK_SHADER_STAGE_FRAGMENT_BIT, nullptr});
    auto info         = typed<VkDescriptorSetLayoutCreateInfo>(VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO);
    info.bindingCount = std::uint32_t(bindings.size());
    info.pBindings    = bindings.data();
    VkDescriptorSetLayout setLayout = VK_NULL_HANDLE;
    check(vkCreateDescriptorSetLayout(context_.device, &info, nullptr, &setLayout), "make a descriptor set layout");
    setLayout_ = {context_, setLayout};

    auto layoutInfo           = typed<VkPipelineLayoutCreateInfo>(VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO);
    layoutInfo.setLayoutCount = 1;
    layoutInfo.pSetLayouts    = &setLayout;
    VkPipelineLayout layout   = VK_NULL_HANDLE;
    check(vkCreatePipelineLayout(context_.device, &layoutInfo, nullptr, &layout), "make a pipeline layout");
    layout_ = {context_, layout};

    const std::array<VkDescriptorPoolSize, 3> sizes{
        {{VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, 1},
         {VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, std::uint32_t(std::size(kBuffers)) - 1},
         {VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE, std::uint32_t(std::size(kImages))}}};
    auto poolInfo          = typed<VkDescriptorPoolCreateInfo>(VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO);
    poolInfo.maxSets       = 1;
    poolInfo.poolSizeCount = std::uint32_t(sizes.size());
    poolInfo.pPoolSizes    = sizes.data();
    VkDescriptorPool pool  = VK_NULL_HANDLE;
    check(vkCreateDescriptorPool(context_.device, &poolInfo, nullptr, &pool), "make a descriptor pool");
    sets_                     = {context_, pool};
    auto wanted               = typed<VkDescriptorSetAllocateInfo>(VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO);
    wanted.descriptorPool     = pool;
    wanted.descriptorSetCount = 1;
    wanted.pSetLayouts        = &setLayout;
    check(vkAllocateDescriptorSets(context_.device, &wanted, &set_), "make a descriptor set");

    auto commandInfo             = typed<VkCommandPoolCreateInfo>(VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO);
    commandInfo.queueFamilyIndex = context_.family;
    VkCommandPool commandPool    = VK_NULL_HANDLE;
    check(vkCreateCommandPool(context_.device, &commandInfo, nullptr, &commandPool), "make a command pool");
    pool_                   = {context_, commandPool};
    auto list               = typed<VkCommandBufferAllocateInfo>(VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO);
    list.commandPool        = commandPool;
    list.level              = VK_COMMAND_BUFFER_LEVEL_PRIMARY;
    list.commandBufferCount = 1;
    check(vkAllocateCommandBuffers(context_.device, &list, &commands_), "make a command buffer");
}

void VulkanSurface::makeSteps()
{
    const PassImage depth{kDepthTest, VK_IMAGE_LAYOUT_UNDEFINED}, none{};
    const PassImage nearest[] = {{kDepth}}, sums[] = {{kSums}, {kSums}}, surface[] = {{kSurface}, {kColour}};
    const PassImage picture[] = {{format_, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL}};
    const PassImage panels[]  = {{kColour}};
    nearestStep_.pass         = makePass(context_, nearest, depth);
    blendStep_.pass           = makePass(context_, sums, none);
    surfaceStep_.pass         = makePass(context_, surface, none);
    faceStep_.pass            = makePass(context_, surface, depth);
    panelStep_.pass           = makePass(context_, panels, none);
    lightStep_.pass           = makePass(context_, picture, depth);

    const PassImage again[] = {{format_, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL}};
    lightAgain_             = makePass(context_, again, depth);
}

void VulkanSurface::makePipelines()
{
    const auto made = [this](const Step& step, const DrawSettings& settings) {
        return makePipeline(context_, step.pass.get(), layout_.get(), settings);
    };
    constexpr VkCompareOp kAlways = VK_COMPARE_OP_ALWAYS, kLess = VK_COMPARE_OP_LESS, kGreater = VK_COMPARE_OP_GREATER;
    constexpr Blending    kReplace = Blending::replace;
    nearestDepths_ =
        made(nearestStep_, {"nearest depths", view_disc_vert_spv, view_nearest_frag_spv, 1, kReplace, kLess, VK_TRUE});
    sums_   = made(blendStep_, {"sums over splats", view_splat_vert_spv, view_blend_frag_spv, 2, Blending::add});
    means_  = made(surfaceStep_, {"surface", view_screen_vert_spv, view_surface_frag_spv, 2});
    faces_  = made(faceStep_, {"faces", view_face_vert_spv, view_face_frag_spv, 2, kReplace, kLess, VK_TRUE});
    light_  = made(lightStep_, {"light", view_screen_vert_spv, view_light_frag_spv, 1, kReplace, kAlways, VK_TRUE});
    ground_ = made(lightStep_, {"ground", view_screen_vert_spv, view_ground_frag_spv});
    points_ = made(lightStep_, {"points", view_point_vert_spv, view_point_frag_spv, 1, kReplace, kLess, VK_TRUE,
                                VK_PRIMITIVE_TOPOLOGY_POINT_LIST});
    litFaces_ =
        made(lightStep_, {"lit faces", view_litface_vert_spv, view_litface_frag_spv, 1, kReplace, kLess, VK_TRUE});
    hiddenShapes_ =
        made(lightStep_, {"hidden shapes", view_shape_vert_spv, view_hidden_frag_spv, 1, Blending::cover, kGreater});
    shapes_  = made(lightStep_, {"shapes", view_shape_vert_spv, view_shape_frag_spv, 1, kReplace, kLess, VK_TRUE});
    overlay_ = made(lightStep_, {"overlay", view_overlay_vert_spv, view_overlay_frag_spv, 1, Blending::lay});
    panel_   = made(lightStep_, {"panels", view_overlay_vert_spv, view_panel_frag_spv, 1, Blending::lay});
}

void VulkanSurface::makeImages()
{
    depthTest_.emplace(
        makeImage(context_, "depth test", size_, kDepthTest, VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT));
    nearest_.emplace(makeImage(context_, "nearest depths", size_, kDepth, kDrawn));
    normals_.emplace(makeImage(context_, "sums of normals", size_, kSums, kDrawn));
    colours_.emplace(makeImage(context_, "sums of colours", size_, kSums, kDrawn));
    surface_.emplace(makeImage(context_, "surface", size_, kSurface, kDrawn));
    albedo_.emplace(makeImage(context_, "albedo", size_, kColour, kDrawn));
    panelImage_.emplace(makeImage(context_, "panels", size_, kColour, kDrawn));
    picture_.emplace(makeImage(context_, "picture", size_, format_,
                               VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT));
}

void VulkanSurface::makeFramebuffers()
{
    const auto fill = [this](Step& step, std::initializer_list<const VulkanImage*> images) {
        step.framebuffer = makeFramebuffer(context_, step.pass.get(), size_, std::vector(images));
    };
    fill(nearestStep_, {&*nearest_, &*depthTest_});
    fill(blendStep_, {&*normals_, &*colours_});
    fill(surfaceStep_, {&*surface_, &*albedo_});
    fill(faceStep_, {&*surface_, &*albedo_, &*depthTest_});
    fill(panelStep_, {&*panelImage_});
    fill(lightStep_, {&*picture_, &*depthTest_});
}

void VulkanSurface::fit(VkExtent2D size)
{
    if (size.width == size_.width && size.height == size_.height) return;
    const std::uint32_t most = context_.native.maxImageDimension2D;
    if (size.width > most || size.height > most)
        throw Error("a picture of " + std::to_string(size.width) + " x " + std::to_string(size.height) +
                    " px is larger than the GPU " + context_.description.name + " can draw (" + std::to_string(most) +
                    " a side)");
    size_        = size;
    fresh_       = true;
    freshPanels_ = hasPanels(); // into the new image
    if (!freshPanels_) panelTiles_.clear();
    for (Step* step : {&nearestStep_, &blendStep_, &surfaceStep_, &faceStep_, &panelStep_, &lightStep_})
        step->framebuffer = {};
    makeImages();
    makeFramebuffers();
    pixels_.emplace(owner_, "pixels", std::size_t(4) * size.width * size.height, compute::Intent::readback);
}

namespace {

/// Makes a buffer hold the bytes; it grows by more than is needed, so that it seldom must grow.
void fillBuffer(compute::Context& context, std::optional<compute::Buffer>& buffer, const char* name,
                std::span<const std::byte> bytes)
{
    constexpr std::size_t kLeast = 4096; // [byte]
    if (!buffer || buffer->bytes() < bytes.size())
        buffer.emplace(context, name, std::max(kLeast, bytes.size() + bytes.size() / 4 / 4 * 4),
                       compute::Intent::upload);
    if (!bytes.empty()) std::memcpy(buffer->mapped(), bytes.data(), bytes.size());
}

} // namespace

void VulkanSurface::upload(const SurfaceInput& input)
{
    static const Overlay nothing{};
    const Overlay&       overlay = input.overlay ? *input.overlay : nothing;
    fillBuffer(owner_, frameBuffer_, "frame", std::as_bytes(std::span(&input.frame, 1)));
    fillBuffer(owner_, splatBuffer_, "splats", std::as_bytes(input.splats));
    fillBuffer(owner_, shapeBuffer_, "shapes", std::as_bytes(input.shapes));
    fillBuffer(owner_, faceBuffer_, "faces", std::as_bytes(input.faces));
    if (!input.sameOverlay || !overlayBuffer_)
        fillBuffer(owner_, overlayBuffer_, "overlay", std::as_bytes(std::span(overlay.pixels)));
    tiles_ = overlay.tiles;
    if (panelSize_.width != size_.width || panelSize_.height != size_.height) panelTiles_.clear();
    tiles_.insert(tiles_.end(), panelTiles_.begin(), panelTiles_.end());
    fillBuffer(owner_, tileBuffer_, "tiles", std::as_bytes(std::span(tiles_)));
}

void VulkanSurface::describe()
{
    const compute::Buffer* const buffers[] = {&*frameBuffer_,   &*splatBuffer_, &*shapeBuffer_,
                                              &*overlayBuffer_, &*tileBuffer_,  &*faceBuffer_};
    const VulkanImage* const     images[]  = {&*nearest_, &*normals_, &*colours_, &*surface_, &*albedo_, &*panelImage_};
    std::array<VkDescriptorBufferInfo, std::size(kBuffers)> bufferInfos{};
    std::array<VkDescriptorImageInfo, std::size(kImages)>   imageInfos{};
    std::vector<VkWriteDescriptorSet>                       writes;
    const auto                                              write = [&](std::uint32_t binding, VkDescriptorType type) {
        auto one = typed<VkWriteDescriptorSet>(VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET);
        one.dstSet          = set_;
        one.dstBinding      = binding;
        one.descriptorCount = 1;
        one.descriptorType  = type;
        return one;
    };
    for (std::size_t n = 0; n < bufferInfos.size(); ++n) {
        const auto& handles = static_cast<const compute::VulkanBuffer&>(buffers[n]->handles());
        bufferInfos[n]      = {handles.buffer.get(), 0, VK_WHOLE_SIZE};
        writes.push_back(write(kBuffers[n], typeOf(kBuffers[n])));
        writes.back().pBufferInfo = &bufferInfos[n];
    }
    for (std::size_t n = 0; n < imageInfos.size(); ++n) {
        imageInfos[n] = {VK_NULL_HANDLE, images[n]->view.get(), VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL};
        writes.push_back(write(kImages[n], VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE));
        writes.back().pImageInfo = &imageInfos[n];
    }
    vkUpdateDescriptorSets(context_.device, std::uint32_t(writes.size()), writes.data(), 0, nullptr);
}

void VulkanSurface::begin(VkRenderPass pass, const Step& step, const VkRect2D& where,
                          std::span<const VkClearValue> clear)
{
    auto info            = typed<VkRenderPassBeginInfo>(VK_STRUCTURE_TYPE_RENDER_PASS_BEGIN_INFO);
    info.renderPass      = pass;
    info.framebuffer     = step.framebuffer.get();
    info.renderArea      = where;
    info.clearValueCount = std::uint32_t(clear.size());
    info.pClearValues    = clear.data();
    vkCmdBeginRenderPass(commands_, &info, VK_SUBPASS_CONTENTS_INLINE);
    vkCmdSetScissor(commands_, 0, 1, &where);
}

void VulkanSurface::begin(const Step& step, std::span<const VkClearValue> clear)
{
    begin(step.pass.get(), step, {{0, 0}, size_}, clear);
}

void VulkanSurface::draw(const Pipeline& pipeline, std::size_t corners, std::size_t first)
{
    if (corners == 0) return;
    vkCmdBindPipeline(commands_, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline.get());
    vkCmdDraw(commands_, std::uint32_t(corners), 1, std::uint32_t(first), 0);
}

void VulkanSurface::beginList()
{
    check(vkResetCommandPool(context_.device, pool_.get(), 0), "reset a command pool");
    auto info  = typed<VkCommandBufferBeginInfo>(VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO);
    info.flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT;
    check(vkBeginCommandBuffer(commands_, &info), "record commands");
    bindAll();
}

void VulkanSurface::bindAll()
{
    const VkViewport viewport{0, 0, float(size_.width), float(size_.height), 0, 1};
    vkCmdSetViewport(commands_, 0, 1, &viewport);
    vkCmdBindDescriptorSets(commands_, VK_PIPELINE_BIND_POINT_GRAPHICS, layout_.get(), 0, 1, &set_, 0, nullptr);
}

/// Draws normals, depths and colours of the visible surface, for the light.
void VulkanSurface::recordSurface(const SurfaceInput& input)
{
    VkClearValue zero{}, nowhere{}, farthest{};
    nowhere.color.float32[0]    = kNowhere;
    farthest.depthStencil.depth = 1;
    const VkClearValue first[] = {nowhere, farthest}, two[] = {zero, zero}, three[] = {zero, zero, farthest};
    if (!input.faces.empty()) {
        begin(faceStep_, three);
        draw(faces_, input.faces.size());
        vkCmdEndRenderPass(commands_);
        return;
    }
    const std::size_t corners = kCornersOfSplat * (input.splats.size() - input.dots);
    begin(nearestStep_, first);
    draw(nearestDepths_, corners);
    vkCmdEndRenderPass(commands_);
    begin(blendStep_, two);
    draw(sums_, corners);
    vkCmdEndRenderPass(commands_);
    begin(surfaceStep_, two);
    draw(means_, 3);
    vkCmdEndRenderPass(commands_);
}

namespace {

VkRect2D areaOf(const PixelRect& part)
{
    return {{part.left, part.top}, {std::uint32_t(part.right - part.left), std::uint32_t(part.bottom - part.top)}};
}

} // namespace

void VulkanSurface::record(const SurfaceInput& input)
{
    const std::size_t points = input.splats.size() - input.dots;
    const bool        fine   = input.detail == Detail::fine;
    const bool        whole  = std::exchange(fresh_, false) || freshPanels_ || !input.changed;
    recordPanels();
    if (!whole && input.changed->empty()) return;
    if (fine) recordSurface(input);
    VkClearValue zero{}, farthest{};
    farthest.depthStencil.depth = 1;
    const VkClearValue last[]   = {zero, farthest};
    if (whole)
        begin(lightStep_, last);
    else
        begin(lightAgain_.get(), lightStep_, areaOf(*input.changed), last);
    draw(fine ? light_ : ground_, 3);
    if (!fine && input.faces.empty()) draw(points_, points);
    if (!fine) draw(litFaces_, input.faces.size());
    draw(points_, input.dots, points);
    draw(hiddenShapes_, input.shining);
    draw(shapes_, input.shapes.size());
    if (input.overlay) draw(overlay_, kCornersOfSplat * input.overlay->tiles.size());
    draw(panel_, kCornersOfSplat * panelTiles_.size(), kCornersOfSplat * (tiles_.size() - panelTiles_.size()));
    vkCmdEndRenderPass(commands_);
}

/// Panels are drawn when they have changed, because a driver in software takes as long for them as for the surface.
void VulkanSurface::recordPanels()
{
#ifdef PALPATE_PANELS
    if (!std::exchange(freshPanels_, false)) return;
    const VkClearValue nothing[] = {{}};
    begin(panelStep_, nothing);
    panels_->record(commands_);
    vkCmdEndRenderPass(commands_);
    // It has set its own viewport and bound its own descriptors.
    bindAll();
#endif
}

void VulkanSurface::copyToHost()
{
    VkBufferImageCopy whole{};
    whole.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
    whole.imageExtent      = {size_.width, size_.height, 1};
    const auto& pixels     = static_cast<const compute::VulkanBuffer&>(pixels_->handles());
    vkCmdCopyImageToBuffer(commands_, picture_->image.get(), VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, pixels.buffer.get(),
                           1, &whole);
    auto toHost          = typed<VkMemoryBarrier>(VK_STRUCTURE_TYPE_MEMORY_BARRIER);
    toHost.srcAccessMask = VK_ACCESS_TRANSFER_WRITE_BIT;
    toHost.dstAccessMask = VK_ACCESS_HOST_READ_BIT;
    vkCmdPipelineBarrier(commands_, VK_PIPELINE_STAGE_TRANSFER_BIT, VK_PIPELINE_STAGE_HOST_BIT, 0, 1, &toHost, 0,
                         nullptr, 0, nullptr);
}

/// Records a picture, and what follows it. Where that fails, the next picture makes and draws everything anew.
template <class Finish>
void VulkanSurface::complete(const SurfaceInput& input, Finish&& finish)
{
    try {
        fit({std::uint32_t(input.frame.width), std::uint32_t(input.frame.height)});
        upload(input);
        describe();
        beginList();
        record(input);
        finish();
    } catch (...) {
        size_ = {};
        throw;
    }
}

std::span<const std::uint8_t> VulkanSurface::draw(const SurfaceInput& input)
{
    complete(input, [this] {
        copyToHost();
        check(vkEndCommandBuffer(commands_), "end a list of commands");
        context_.submit({&commands_, 1});
        pixels_->makeVisibleToHost();
    });
    return pixels_->as<std::uint8_t>();
}

void VulkanSurface::start(const SurfaceInput& input, VulkanWindow& window)
{
    complete(input, [&] {
        window.copy(commands_, picture_->image.get(), size_);
        check(vkEndCommandBuffer(commands_), "end a list of commands");
        context_.start({&commands_, 1});
    });
    started_ = true;
}

bool VulkanSurface::finish()
{
    if (!started_) return false;
    started_ = false;
    context_.finish();
    return true;
}

bool VulkanSurface::hasPanels() const
{
#ifdef PALPATE_PANELS
    return panels_ && !panels_->isBroken() && !VulkanPanels::fontHasChanged();
#else
    return false;
#endif
}

void VulkanSurface::takePanels()
{
#ifdef PALPATE_PANELS
    PALP_EXPECT(hasPanels() || !started_, "the first panels, and those of another font, are made between two pictures");
    if (!hasPanels()) { // the back end can take a font once only
        panels_.reset();
        freshPanels_ = false;
    }
    if (!panels_) panels_ = std::make_unique<VulkanPanels>(context_, panelStep_.pass.get());
    panelTiles_  = VulkanPanels::tiles();
    panelSize_   = VulkanPanels::size();
    freshPanels_ = true;
#else
    throw Error("this build has no panels: it was made without Dear ImGui");
#endif
}

} // namespace palp
