#include "engine/tools/render/vulkan_pipeline.h"

#include <array>
#include <vector>

namespace palp {
namespace {

using compute::check;
using compute::typed;

compute::Owned<VkShaderModule, vkDestroyShaderModule> moduleOf(const compute::VulkanContext&  context,
                                                               std::span<const std::uint32_t> code)
{
    auto info             = typed<VkShaderModuleCreateInfo>(VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO);
    info.codeSize         = code.size_bytes();
    info.pCode            = code.data();
    VkShaderModule module = VK_NULL_HANDLE;
    check(vkCreateShaderModule(context.device, &info, nullptr, &module), "take a shader");
    return {context, module};
}

VkPipelineShaderStageCreateInfo stage(VkShaderStageFlagBits which, VkShaderModule module)
{
    auto info   = typed<VkPipelineShaderStageCreateInfo>(VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO);
    info.stage  = which;
    info.module = module;
    info.pName  = "main";
    return info;
}

VkPipelineColorBlendAttachmentState blendingOf(Blending blending)
{
    VkPipelineColorBlendAttachmentState state{};
    state.colorWriteMask =
        VK_COLOR_COMPONENT_R_BIT | VK_COLOR_COMPONENT_G_BIT | VK_COLOR_COMPONENT_B_BIT | VK_COLOR_COMPONENT_A_BIT;
    if (blending == Blending::replace) return state;
    const bool sums           = blending == Blending::add;
    state.blendEnable         = VK_TRUE;
    state.srcColorBlendFactor = blending == Blending::cover ? VK_BLEND_FACTOR_SRC_ALPHA : VK_BLEND_FACTOR_ONE;
    state.dstColorBlendFactor = sums ? VK_BLEND_FACTOR_ONE : VK_BLEND_FACTOR_ONE_MINUS_SRC_ALPHA;
    state.srcAlphaBlendFactor = VK_BLEND_FACTOR_ONE;
    state.dstAlphaBlendFactor = sums ? VK_BLEND_FACTOR_ONE : VK_BLEND_FACTOR_ONE_MINUS_SRC_ALPHA;
    return state;
}

} // namespace

Pipeline makePipeline(const compute::VulkanContext& context, VkRenderPass pass, VkPipelineLayout layout,
                      const DrawSettings& settings)
{
    const auto       vertex   = moduleOf(context, settings.vertexShader); // the pipeline keeps what it needs
    const auto       fragment = moduleOf(context, settings.fragmentShader);
    const std::array stages{stage(VK_SHADER_STAGE_VERTEX_BIT, vertex.get()),
                            stage(VK_SHADER_STAGE_FRAGMENT_BIT, fragment.get())};
    const auto       noVertices =
        typed<VkPipelineVertexInputStateCreateInfo>(VK_STRUCTURE_TYPE_PIPELINE_VERTEX_INPUT_STATE_CREATE_INFO);
    auto assembly =
        typed<VkPipelineInputAssemblyStateCreateInfo>(VK_STRUCTURE_TYPE_PIPELINE_INPUT_ASSEMBLY_STATE_CREATE_INFO);
    assembly.topology = settings.topology;
    auto viewport     = typed<VkPipelineViewportStateCreateInfo>(VK_STRUCTURE_TYPE_PIPELINE_VIEWPORT_STATE_CREATE_INFO);
    viewport.viewportCount = 1;
    viewport.scissorCount  = 1;
    auto raster =
        typed<VkPipelineRasterizationStateCreateInfo>(VK_STRUCTURE_TYPE_PIPELINE_RASTERIZATION_STATE_CREATE_INFO);
    raster.lineWidth = 1;
    auto samples =
        typed<VkPipelineMultisampleStateCreateInfo>(VK_STRUCTURE_TYPE_PIPELINE_MULTISAMPLE_STATE_CREATE_INFO);
    samples.rasterizationSamples = VK_SAMPLE_COUNT_1_BIT;
    auto depth =
        typed<VkPipelineDepthStencilStateCreateInfo>(VK_STRUCTURE_TYPE_PIPELINE_DEPTH_STENCIL_STATE_CREATE_INFO);
    depth.depthTestEnable  = settings.depthTest != VK_COMPARE_OP_ALWAYS || settings.writesDepth;
    depth.depthWriteEnable = settings.writesDepth;
    depth.depthCompareOp   = settings.depthTest;
    const std::vector<VkPipelineColorBlendAttachmentState> blending(settings.colourImages,
                                                                    blendingOf(settings.blending));
    auto blend = typed<VkPipelineColorBlendStateCreateInfo>(VK_STRUCTURE_TYPE_PIPELINE_COLOR_BLEND_STATE_CREATE_INFO);
    blend.attachmentCount = settings.colourImages;
    blend.pAttachments    = blending.data();
    constexpr std::array kLater{VK_DYNAMIC_STATE_VIEWPORT, VK_DYNAMIC_STATE_SCISSOR};
    auto later = typed<VkPipelineDynamicStateCreateInfo>(VK_STRUCTURE_TYPE_PIPELINE_DYNAMIC_STATE_CREATE_INFO);
    later.dynamicStateCount = std::uint32_t(kLater.size());
    later.pDynamicStates    = kLater.data();

    auto info                = typed<VkGraphicsPipelineCreateInfo>(VK_STRUCTURE_TYPE_GRAPHICS_PIPELINE_CREATE_INFO);
    info.stageCount          = std::uint32_t(stages.size());
    info.pStages             = stages.data();
    info.pVertexInputState   = &noVertices;
    info.pInputAssemblyState = &assembly;
    info.pViewportState      = &viewport;
    info.pRasterizationState = &raster;
    info.pMultisampleState   = &samples;
    info.pDepthStencilState  = &depth;
    info.pColorBlendState    = &blend;
    info.pDynamicState       = &later;
    info.layout              = layout;
    info.renderPass          = pass;
    VkPipeline pipeline      = VK_NULL_HANDLE;
    check(vkCreateGraphicsPipelines(context.device, VK_NULL_HANDLE, 1, &info, nullptr, &pipeline),
          "compile a pipeline");
    context.setName(VK_OBJECT_TYPE_PIPELINE, reinterpret_cast<std::uint64_t>(pipeline), settings.name);
    return {context, pipeline};
}

} // namespace palp
