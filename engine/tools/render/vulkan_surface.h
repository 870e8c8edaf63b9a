#pragma once
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "engine/compute/buffer.h"
#include "engine/tools/render/surface_input.h"
#include "engine/tools/render/vulkan_image.h"
#include "engine/tools/render/vulkan_pipeline.h"
#include "engine/tools/render/vulkan_window.h"

// Internal to engine/tools/render.

namespace palp {

class VulkanPanels;

/// The passes of compute_shaders/shared/view_layout.h. Images are made anew when the size changes, buffers when they
/// are too small.
/// \thread one
class VulkanSurface {
public:
    /// \throws compute::ProcessorError if the processor lacks a format
    /// \param picture  format of the pictures, of eight bits a channel
    explicit VulkanSurface(compute::Context& context, VkFormat picture = VK_FORMAT_R8G8B8A8_UNORM);
    ~VulkanSurface();
    VulkanSurface(const VulkanSurface&)            = delete;
    VulkanSurface& operator=(const VulkanSurface&) = delete;

    /// Draws and waits.
    /// \return rows from the top, channels in the order of format(); valid until the next call
    [[nodiscard]] std::span<const std::uint8_t> draw(const SurfaceInput& input);

    [[nodiscard]] VkFormat format() const noexcept { return format_; }

    /// Begins to draw into a window that has a next picture; finish() ends it. In between the host may prepare the next
    /// one.
    /// \pre finished
    void start(const SurfaceInput& input, VulkanWindow& window);
    /// Ends what start() began.
    /// \return whether something had been started
    bool finish();

    /// Lays the result of ImGui::Render() over every picture from now on, until the next call or another size.
    /// \throws Error in a build without Dear ImGui
    void takePanels();

    /// Returns whether takePanels() may be called while a picture is being drawn.
    [[nodiscard]] bool hasPanels() const;

private:
    /// A pass and its framebuffer.
    struct Step {
        RenderPass  pass;
        Framebuffer framebuffer;
    };
    void makeLayouts();
    void makeSteps();
    void makePipelines();
    void fit(VkExtent2D size);
    void makeImages();
    void makeFramebuffers();
    void upload(const SurfaceInput& input);
    void describe();
    void beginList();
    void record(const SurfaceInput& input);
    template <class Finish>
    void complete(const SurfaceInput& input, Finish&& finish);
    void recordPanels();
    void bindAll();
    void recordSurface(const SurfaceInput& input);
    void copyToHost();
    void begin(VkRenderPass pass, const Step& step, const VkRect2D& where, std::span<const VkClearValue> clear);
    void begin(const Step& step, std::span<const VkClearValue> clear);
    void draw(const Pipeline& pipeline, std::size_t corners, std::size_t first = 0);

    compute::Context&       owner_;
    compute::VulkanContext& context_;
    bool                    started_ = false;
    bool                    fresh_   = true; ///< nothing has been drawn into picture_ yet
    VkFormat                format_;
    VkExtent2D              size_{};

    SetLayout                                                 setLayout_;
    PipelineLayout                                            layout_;
    compute::Owned<VkDescriptorPool, vkDestroyDescriptorPool> sets_;
    VkDescriptorSet                                           set_ = VK_NULL_HANDLE;
    compute::Owned<VkCommandPool, vkDestroyCommandPool>       pool_;
    VkCommandBuffer                                           commands_ = VK_NULL_HANDLE;
    std::optional<VulkanImage> depthTest_, nearest_, normals_, colours_, surface_, albedo_, panelImage_, picture_;
    Step                       nearestStep_, blendStep_, surfaceStep_, faceStep_, panelStep_, lightStep_;
    RenderPass                 lightAgain_; ///< as lightStep_'s, over a picture that stays where it does not draw
    Pipeline                   nearestDepths_, sums_, means_, faces_;                       ///< fine
    Pipeline light_, ground_, points_, litFaces_, hiddenShapes_, shapes_, overlay_, panel_; ///< of lightStep_
    std::optional<compute::Buffer> frameBuffer_, splatBuffer_, shapeBuffer_, faceBuffer_, overlayBuffer_, tileBuffer_,
        pixels_;
    std::unique_ptr<VulkanPanels> panels_; ///< may be null
    std::vector<std::uint32_t>    tiles_;  ///< of the overlay, then of the panels
    std::vector<std::uint32_t>    panelTiles_;
    VkExtent2D                    panelSize_{};         ///< of the picture that they are for [px]
    bool                          freshPanels_ = false; ///< the panels must be drawn
};

} // namespace palp
