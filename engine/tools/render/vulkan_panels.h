#pragma once
#include <cstdint>
#include <vector>

#include "engine/compute/vulkan_handles.h"

// Internal to engine/tools/render; in builds with Dear ImGui.

namespace palp {

/// Draws the panels of the current ImGui context over a picture: the only file that knows ImGui's Vulkan back end.
/// \thread one
class VulkanPanels {
public:
    /// \param pass  that panels are drawn in
    VulkanPanels(compute::VulkanContext& context, VkRenderPass pass);
    ~VulkanPanels();
    VulkanPanels(const VulkanPanels&)            = delete;
    VulkanPanels& operator=(const VulkanPanels&) = delete;

    /// Records the result of ImGui::Render() into the pass that is being recorded. Once that has thrown, the object is
    /// of no more use.
    void               record(VkCommandBuffer commands);
    [[nodiscard]] bool isBroken() const noexcept { return isBroken_; } ///< it has thrown

    /// Returns the squares of shared::kTile of a picture that the result covers, as Overlay::tiles has them.
    [[nodiscard]] static std::vector<std::uint32_t> tiles();
    [[nodiscard]] static VkExtent2D                 size(); ///< of that picture [px]

    /// Returns whether the font's pictures have been made anew since an object of this class took them.
    [[nodiscard]] static bool fontHasChanged();

private:
    void start(VkRenderPass pass);
    void uploadFont();
    void stop();

    compute::VulkanContext&                                   context_;
    compute::Owned<VkDescriptorPool, vkDestroyDescriptorPool> sets_;
    bool                                                      isBroken_ = false;
};

} // namespace palp
