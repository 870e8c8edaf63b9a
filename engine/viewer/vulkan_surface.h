#pragma once
#include <optional>
#include <span>
#include <vector>

#include "compute_shaders/shared/view_layout.h"
#include "engine/gpu/buffer.h"
#include "engine/viewer/surface_renderer.h"
#include "engine/viewer/vulkan_image.h"
#include "engine/viewer/vulkan_pipeline.h"

// Internal to engine/viewer.

namespace palp {

/// What one picture is drawn from.
struct SurfaceInput {
    shared::ViewFrame                   frame{};
    std::span<const shared::ViewSplat>  splats;
    std::span<const shared::ViewCorner> shapes; ///< three to a triangle
    Detail                              detail = Detail::fine;
};

/// The four passes of compute_shaders/shared/view_layout.h. Images are made anew when the size changes, buffers when
/// they are too small. \thread one
class VulkanSurface {
public:
    /// \throws gpu::DeviceError if the device lacks a format
    explicit VulkanSurface(gpu::Context& context);

    /// Draws and waits. \return rows from the top, red, green, blue, alpha; until the next call
    [[nodiscard]] std::span<const std::uint8_t> draw(const SurfaceInput& input);

private:
    /// A pass, what it draws into, and with what.
    struct Step {
        RenderPass            pass;
        Framebuffer           framebuffer;
        std::vector<Pipeline> pipelines;
    };
    void makeLayouts();
    void makeSteps();
    void fit(VkExtent2D size);
    void makeImages();
    void makeFramebuffers();
    void upload(const SurfaceInput& input);
    void describe();
    void record(const SurfaceInput& input);
    void begin(const Step& step, std::span<const VkClearValue> clear);

    gpu::Context&       owner_;
    gpu::VulkanContext& context_;
    VkExtent2D          size_{};

    SetLayout                                             setLayout_;
    PipelineLayout                                        layout_;
    gpu::Owned<VkDescriptorPool, vkDestroyDescriptorPool> sets_;
    VkDescriptorSet                                       set_ = VK_NULL_HANDLE;
    gpu::Owned<VkCommandPool, vkDestroyCommandPool>       pool_;
    VkCommandBuffer                                       commands_ = VK_NULL_HANDLE;
    std::optional<VulkanImage> depthTest_, nearest_, normals_, colours_, surface_, albedo_, picture_;
    Step                       nearestStep_, blendStep_, surfaceStep_, lightStep_;
    std::optional<gpu::Buffer> frame_, splats_, shapes_, pixels_;
};

} // namespace palp
