#include <array>
#include <string>
#include <vector>

#include "engine/compute/vulkan_handles.h"

namespace palp::compute {
namespace {

void refuseWhatDoesNotFit(const VulkanContext& gpu, const KernelCode& code, Workgroup workgroup)
{
    const VkPhysicalDeviceLimits& limits = gpu.native;
    const std::string             who    = std::string("the kernel ") + code.name + " ";
    const std::string             limit  = " than the GPU " + gpu.description.name + " allows (";
    const std::uint64_t           all    = std::uint64_t(workgroup.x) * workgroup.y * workgroup.z;
    if (workgroup.x > limits.maxComputeWorkGroupSize[0] || workgroup.y > limits.maxComputeWorkGroupSize[1] ||
        workgroup.z > limits.maxComputeWorkGroupSize[2] || all > gpu.limits.invocations)
        throw Error(who + "wants a workgroup of " + std::to_string(workgroup.x) + "x" + std::to_string(workgroup.y) +
                    "x" + std::to_string(workgroup.z) + ", more" + limit + std::to_string(gpu.limits.invocations) +
                    " in all)");
    if (std::uint32_t(code.buffers) > gpu.limits.buffers)
        throw Error(who + "wants " + std::to_string(code.buffers) + " buffers, more" + limit +
                    std::to_string(gpu.limits.buffers) + ")");
    if (std::uint32_t(code.pushBytes) > limits.maxPushConstantsSize)
        throw Error(who + "wants " + std::to_string(code.pushBytes) + " bytes of push constants, more" + limit +
                    std::to_string(limits.maxPushConstantsSize) + ")");
}

VkDescriptorSetLayout makeSetLayout(const VulkanContext& gpu, int buffers)
{
    std::vector<VkDescriptorSetLayoutBinding> bindings;
    for (int n = 0; n < buffers; ++n)
        bindings.push_back(
            {std::uint32_t(n), VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 1, VK_SHADER_STAGE_COMPUTE_BIT, nullptr});
    auto info         = typed<VkDescriptorSetLayoutCreateInfo>(VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO);
    info.bindingCount = std::uint32_t(bindings.size());
    info.pBindings    = bindings.data();
    VkDescriptorSetLayout layout = VK_NULL_HANDLE;
    check(vkCreateDescriptorSetLayout(gpu.device, &info, nullptr, &layout), "make a descriptor set layout");
    return layout;
}

VkPipelineLayout makeLayout(const VulkanContext& gpu, VkDescriptorSetLayout set, int pushBytes)
{
    const VkPushConstantRange range{VK_SHADER_STAGE_COMPUTE_BIT, 0, std::uint32_t(pushBytes)};
    auto                      info = typed<VkPipelineLayoutCreateInfo>(VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO);
    info.setLayoutCount            = 1;
    info.pSetLayouts               = &set;
    info.pushConstantRangeCount    = pushBytes ? 1 : 0;
    info.pPushConstantRanges       = &range;
    VkPipelineLayout layout        = VK_NULL_HANDLE;
    check(vkCreatePipelineLayout(gpu.device, &info, nullptr, &layout), "make a pipeline layout");
    return layout;
}

VkPipeline makePipeline(const VulkanContext& gpu, VkPipelineLayout layout, const KernelCode& code,
                        std::span<const std::uint32_t> constants)
{
    auto moduleInfo       = typed<VkShaderModuleCreateInfo>(VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO);
    moduleInfo.codeSize   = code.spirv.size_bytes();
    moduleInfo.pCode      = code.spirv.data();
    VkShaderModule module = VK_NULL_HANDLE;
    check(vkCreateShaderModule(gpu.device, &moduleInfo, nullptr, &module), "take a shader");
    const Owned<VkShaderModule, vkDestroyShaderModule> keeper(gpu, module); // the pipeline needs no module later

    std::vector<VkSpecializationMapEntry> entries;
    for (std::uint32_t n = 0; n < constants.size(); ++n) entries.push_back({n, n * 4, 4});
    const VkSpecializationInfo specialization{std::uint32_t(entries.size()), entries.data(), constants.size_bytes(),
                                              constants.data()};
    auto info                      = typed<VkComputePipelineCreateInfo>(VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO);
    info.stage.sType               = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO;
    info.stage.stage               = VK_SHADER_STAGE_COMPUTE_BIT;
    info.stage.module              = module;
    info.stage.pName               = "main";
    info.stage.pSpecializationInfo = &specialization;
    info.layout                    = layout;
    VkPipeline pipeline            = VK_NULL_HANDLE;
    check(vkCreateComputePipelines(gpu.device, VK_NULL_HANDLE, 1, &info, nullptr, &pipeline), "compile a kernel");
    return pipeline;
}

} // namespace

std::unique_ptr<Kernel::Handles> VulkanContext::makeKernel(const KernelCode& code, Workgroup workgroup,
                                                           std::span<const std::uint32_t> constants)
{
    refuseWhatDoesNotFit(*this, code, workgroup);
    std::vector<std::uint32_t> all{workgroup.x, workgroup.y, workgroup.z};
    all.insert(all.end(), constants.begin(), constants.end());
    auto made       = std::make_unique<VulkanKernel>(code, workgroup);
    made->setLayout = {*this, makeSetLayout(*this, code.buffers)};
    made->layout    = {*this, makeLayout(*this, made->setLayout.get(), code.pushBytes)};
    made->pipeline  = {*this, makePipeline(*this, made->layout.get(), code, all)};
    setName(VK_OBJECT_TYPE_PIPELINE, reinterpret_cast<std::uint64_t>(made->pipeline.get()), code.name);
    return made;
}

} // namespace palp::compute
