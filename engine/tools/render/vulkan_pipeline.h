#pragma once
#include <cstdint>
#include <span>

#include "engine/compute/vulkan_handles.h"

// Internal to engine/tools/render.

namespace palp {

using Pipeline       = compute::Owned<VkPipeline, vkDestroyPipeline>;
using PipelineLayout = compute::Owned<VkPipelineLayout, vkDestroyPipelineLayout>;
using SetLayout      = compute::Owned<VkDescriptorSetLayout, vkDestroyDescriptorSetLayout>;

/// The combination of drawn colours with those already in the image.
enum class Blending {
    replace,
    add,   ///< sums
    cover, ///< by the share in alpha
    lay    ///< the same, with colours that are multiplied by it
};

/// Triangles or points without vertex buffers: shaders fetch what they draw by its number.
struct DrawSettings {
    const char*                    name = "";
    std::span<const std::uint32_t> vertexShader;
    std::span<const std::uint32_t> fragmentShader;
    std::uint32_t                  colourImages = 1;
    Blending                       blending     = Blending::replace;
    VkCompareOp                    depthTest    = VK_COMPARE_OP_ALWAYS;
    VkBool32                       writesDepth  = VK_FALSE;
    VkPrimitiveTopology            topology     = VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST;
};

/// Makes a pipeline, whose width and height are set when it is used.
[[nodiscard]] Pipeline makePipeline(const compute::VulkanContext& context, VkRenderPass pass, VkPipelineLayout layout,
                                    const DrawSettings& settings);

} // namespace palp
