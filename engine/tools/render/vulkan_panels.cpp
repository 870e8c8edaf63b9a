#include "engine/tools/render/vulkan_panels.h"

#include <algorithm>
#include <cmath>

#include <backends/imgui_impl_vulkan.h>
#include <imgui.h>

#include "compute_shaders/shared/view_layout.h"
#include "engine/core/contract.h"

namespace palp {
namespace {

using compute::check;
using compute::typed;

constexpr std::uint32_t kFrames = 2; // the least that the back end takes; ours is one at a time

/// Back ends that must not free what they have, kept so that they are not taken for lost.
std::vector<void*>& leftBehind()
{
    static auto& all = *new std::vector<void*>;
    return all;
}

} // namespace

VulkanPanels::VulkanPanels(compute::VulkanContext& context, VkRenderPass pass) : context_(context)
{
    constexpr std::uint32_t    kSets = 8; // the font's, and room
    const VkDescriptorPoolSize size{VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, kSets};
    auto poolInfo          = typed<VkDescriptorPoolCreateInfo>(VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO);
    poolInfo.flags         = VK_DESCRIPTOR_POOL_CREATE_FREE_DESCRIPTOR_SET_BIT;
    poolInfo.maxSets       = kSets;
    poolInfo.poolSizeCount = 1;
    poolInfo.pPoolSizes    = &size;
    VkDescriptorPool pool  = VK_NULL_HANDLE;
    check(vkCreateDescriptorPool(context.device, &poolInfo, nullptr, &pool), "make a descriptor pool");
    sets_ = {context, pool};
    leftBehind().reserve(leftBehind().size() + 1); // the destructor asks for no memory
    try {
        start(pass);
        uploadFont();
    } catch (...) {
        stop(); // ImGui takes no second back end beside one that has begun to start
        throw;
    }
}

void VulkanPanels::start(VkRenderPass pass)
{
    ImGui_ImplVulkan_InitInfo info{};
    info.Instance        = context_.instance->get();
    info.PhysicalDevice  = context_.physical;
    info.Device          = context_.device;
    info.QueueFamily     = context_.family;
    info.Queue           = context_.queue;
    info.DescriptorPool  = sets_.get();
    info.MinImageCount   = kFrames;
    info.ImageCount      = kFrames;
    info.MSAASamples     = VK_SAMPLE_COUNT_1_BIT;
    info.CheckVkResultFn = [](VkResult result) { check(result, "draw a panel"); };
#if IMGUI_VERSION_NUM >= 19000 // the pass moved into the structure
    info.RenderPass    = pass;
    const bool started = ImGui_ImplVulkan_Init(&info);
#else
    const bool started        = ImGui_ImplVulkan_Init(&info, pass);
#endif
    PALP_EXPECT(started, "ImGui's back end starts");
}

void VulkanPanels::uploadFont()
{
#if IMGUI_VERSION_NUM >= 19000 // it does that by itself
    ImGui_ImplVulkan_CreateFontsTexture();
#else
    auto       poolInfo       = typed<VkCommandPoolCreateInfo>(VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO);
    poolInfo.queueFamilyIndex = context_.family;
    VkCommandPool pool        = VK_NULL_HANDLE;
    check(vkCreateCommandPool(context_.device, &poolInfo, nullptr, &pool), "make a command pool");
    const compute::Owned<VkCommandPool, vkDestroyCommandPool> owner{context_, pool};

    auto list                = typed<VkCommandBufferAllocateInfo>(VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO);
    list.commandPool         = pool;
    list.level               = VK_COMMAND_BUFFER_LEVEL_PRIMARY;
    list.commandBufferCount  = 1;
    VkCommandBuffer commands = VK_NULL_HANDLE;
    check(vkAllocateCommandBuffers(context_.device, &list, &commands), "make a command buffer");
    auto begin  = typed<VkCommandBufferBeginInfo>(VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO);
    begin.flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT;
    check(vkBeginCommandBuffer(commands, &begin), "record commands");
    ImGui_ImplVulkan_CreateFontsTexture(commands);
    check(vkEndCommandBuffer(commands), "end a list of commands");
    context_.submit({&commands, 1});
    ImGui_ImplVulkan_DestroyFontUploadObjects();
#endif
}

void VulkanPanels::stop()
{
    ImGuiIO& io = ImGui::GetIO();
    if (!io.BackendRendererUserData) return;
    if (!context_.atWork() && !isBroken_) return ImGui_ImplVulkan_Shutdown();
    // A driver that never finished uses what would be freed, and a back end that failed may have freed it already: it
    // is left behind, and ImGui forgets it.
    leftBehind().push_back(io.BackendRendererUserData);
    io.BackendRendererUserData = nullptr;
    io.BackendRendererName     = nullptr;
}

VulkanPanels::~VulkanPanels()
{
    stop();
}

// The back end sets the number of the texture, and building a font takes it away. Later ones follow the font
// themselves.
bool VulkanPanels::fontHasChanged()
{
#if IMGUI_VERSION_NUM < 19200
    return !ImGui::GetIO().Fonts->TexID;
#else
    return false;
#endif
}

void VulkanPanels::record(VkCommandBuffer commands)
{
    ImDrawData* const data = ImGui::GetDrawData();
    if (!data) return;
    isBroken_ = true; // a buffer that cannot be made larger has been freed, and would be freed again
    ImGui_ImplVulkan_RenderDrawData(data, commands);
    isBroken_ = false;
}

VkExtent2D VulkanPanels::size()
{
    const ImVec2 size = ImGui::GetIO().DisplaySize;
    return {std::uint32_t(size.x), std::uint32_t(size.y)};
}

std::vector<std::uint32_t> VulkanPanels::tiles()
{
    std::vector<std::uint32_t> tiles;
    const ImDrawData* const    data = ImGui::GetDrawData();
    if (!data) return tiles;
    const float tile    = float(shared::kTile);
    const int   columns = int(std::ceil(data->DisplaySize.x / tile)), rows = int(std::ceil(data->DisplaySize.y / tile));
    std::vector<bool> used(std::size_t(columns) * std::size_t(rows));
    for (int n = 0; n < data->CmdListsCount; ++n)
        for (const ImDrawCmd& command : data->CmdLists[n]->CmdBuffer) {
            if (command.ElemCount == 0) continue;
            const ImVec4& clip = command.ClipRect; // left, top, right, bottom [px]
            const int     left = std::max(0, int(clip.x / tile)), top = std::max(0, int(clip.y / tile));
            const int     right = std::min(columns, int(std::ceil(clip.z / tile)));
            const int     foot  = std::min(rows, int(std::ceil(clip.w / tile)));
            for (int y = top; y < foot; ++y)
                for (int x = left; x < right; ++x) used[std::size_t(y * columns + x)] = true;
        }
    for (int y = 0; y < rows; ++y)
        for (int x = 0; x < columns; ++x)
            if (used[std::size_t(y * columns + x)]) tiles.push_back(std::uint32_t(x) | std::uint32_t(y) << 16);
    return tiles;
}

} // namespace palp
