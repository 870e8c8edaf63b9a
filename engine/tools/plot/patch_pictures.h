#pragma once
#include <span>
#include <string>

#include "engine/pipeline/patch.h"

namespace palp {

/// A patch under a force, with the words that name it in a legend.
struct PressedPatch {
    const Patch* patch = nullptr;
    double       force = 0; ///< [N]
    std::string  label;
};

/// Draws a chart of the rigidity at the nodes, logarithmic, with the points it came from, contact and footprint.
[[nodiscard]] std::string rigidityChartSvg(const Patch& patch, const PatchSettings& settings, const std::string& title);

/// Draws a chart of the deflection at the nodes under `force` [N].
/// \param deepest  end of the colours, so that pictures can be compared [m]; 0: this patch's own
[[nodiscard]] std::string deflectionChartSvg(const Patch& patch, const PatchSettings& settings, double force,
                                             const std::string& title, double deepest = 0);

/// Plots the deflection from west to east and from south to north through the contact.
[[nodiscard]] std::string profileSvg(const Patch& patch, double force, const std::string& title);

/// Plots the deflection from west to east through the contact, for several patches.
[[nodiscard]] std::string profilesSvg(std::span<const PressedPatch> patches, const std::string& title);

} // namespace palp
