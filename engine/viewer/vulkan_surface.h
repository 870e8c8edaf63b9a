#pragma once
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "compute_shaders/shared/view_layout.h"
#include "engine/gpu/buffer.h"
#include "engine/viewer/annotation.h"
#include "engine/viewer/surface_renderer.h"
#include "engine/viewer/vulkan_image.h"
#include "engine/viewer/vulkan_pipeline.h"
#include "engine/viewer/vulkan_window.h"

// Internal to engine/viewer.

namespace palp {

class VulkanPanels;

/// What one picture is drawn from.
struct SurfaceInput {
    shared::ViewFrame                   frame{};
    std::span<const shared::ViewSplat>  splats;
    std::size_t                         dots = 0; ///< the last so many splats are dots, whatever the detail [1]
    std::span<const std::uint32_t>      faces;    ///< numbers of splats, three to a triangle; empty: splats are drawn
    std::span<const shared::ViewCorner> shapes;   ///< three to a triangle
    Detail                              detail  = Detail::fine;
    const Overlay*                      overlay = nullptr; ///< of the picture's size; may be null
};

/// The passes of compute_shaders/shared/view_layout.h. Images are made anew when the size changes, buffers when they
/// are too small. \thread one
class VulkanSurface {
public:
    /// \throws gpu::DeviceError if the device lacks a format
    /// \param picture  format of the pictures, of eight bits a channel
    explicit VulkanSurface(gpu::Context& context, VkFormat picture = VK_FORMAT_R8G8B8A8_UNORM);
    ~VulkanSurface();
    VulkanSurface(const VulkanSurface&)            = delete;
    VulkanSurface& operator=(const VulkanSurface&) = delete;

    /// Draws and waits. \return rows from the top, channels in the order of format(); until the next call
    [[nodiscard]] std::span<const std::uint8_t> draw(const SurfaceInput& input);

    [[nodiscard]] VkFormat format() const noexcept { return format_; }

    /// Begins to draw into a window that has a next picture; finish() ends it. In between the host may prepare the next
    /// one. \pre finished
    void start(const SurfaceInput& input, VulkanWindow& window);
    /// \return whether something had been started
    bool finish();

    /// What ImGui::Render() has left is laid over every picture from now on, until the next call or another size.
    /// \throws Error in a build without Dear ImGui
    void takePanels();

    /// Whether takePanels() may be called while a picture is being drawn.
    [[nodiscard]] bool hasPanels() const;

private:
    /// A pass and what it draws into.
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
    void recordPanels();
    void bindAll();
    void recordSurface(const SurfaceInput& input);
    void copyToHost();
    void begin(const Step& step, std::span<const VkClearValue> clear);
    void draw(const Pipeline& pipeline, std::size_t corners, std::size_t first = 0);

    gpu::Context&       owner_;
    gpu::VulkanContext& context_;
    bool                started_ = false;
    VkFormat            format_;
    VkExtent2D          size_{};

    SetLayout                                             setLayout_;
    PipelineLayout                                        layout_;
    gpu::Owned<VkDescriptorPool, vkDestroyDescriptorPool> sets_;
    VkDescriptorSet                                       set_ = VK_NULL_HANDLE;
    gpu::Owned<VkCommandPool, vkDestroyCommandPool>       pool_;
    VkCommandBuffer                                       commands_ = VK_NULL_HANDLE;
    std::optional<VulkanImage> depthTest_, nearest_, normals_, colours_, surface_, albedo_, panelImage_, picture_;
    Step                       nearestStep_, blendStep_, surfaceStep_, faceStep_, panelStep_, lightStep_;
    Pipeline                   nearestDepths_, sums_, means_, faces_;                       ///< fine
    Pipeline light_, ground_, points_, litFaces_, hiddenShapes_, shapes_, overlay_, panel_; ///< of lightStep_
    std::optional<gpu::Buffer> frameBuffer_, splatBuffer_, shapeBuffer_, faceBuffer_, overlayBuffer_, tileBuffer_,
        pixels_;
    std::unique_ptr<VulkanPanels> panels_; ///< may be null
    std::vector<std::uint32_t>    tiles_;  ///< of the overlay, then of the panels
    std::vector<std::uint32_t>    panelTiles_;
    VkExtent2D                    panelSize_{};         ///< of the picture that they are for [px]
    bool                          freshPanels_ = false; ///< are to be drawn
};

} // namespace palp
