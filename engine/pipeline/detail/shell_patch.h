#pragma once
#include "engine/pipeline/detail/curvature_sites.h"
#include "engine/pipeline/patch.h"

namespace palp {

/// Returns why a patch bends flat though the settings ask for a shell, as far as the contact alone shows it; else
/// nothing.
/// \pre the patch has its chart
[[nodiscard]] std::string whyFlat(const Patch& patch, const SoftObject& object, const PatchSettings& settings);

/// Makes a shell of the patch's plate, if the settings ask for one: finds how the touched surface is curved, and what
/// its membrane resists. Where that cannot be, or `flatBecause` says so already, the patch stays a plate, and says why
/// there.
/// \param object  that the patch's points are of
/// \param points  of the touched surface, all that have a place in the chart
void curvePatch(Patch& patch, const SoftObject& object, const LaidPoints& points, const PatchSettings& settings);

/// Fills in the principal curvatures at the contact and the length over which a dent dies away there.
/// \param foundation  of the scene [Pa/m]
void fillCurvatureAtContact(Patch& patch, const Material& material, double foundation);

/// Returns the shell of a patch, a flat one of a patch that is not curved.
/// \pre its membrane's compliance is known: the settings ask for a shell or large deflections
[[nodiscard]] Shell shellOf(const Patch& patch);

/// Returns the edges of the membrane that go with a window's edges: a free one is a border of the object, where no
/// force crosses it; a supported one cuts the window from a larger body; a clamped one holds it in its plane as well,
/// as does a supported one among three clamped ones.
[[nodiscard]] PlateEdges stressEdgesFor(const PlateEdges& edges) noexcept;

} // namespace palp
