#pragma once
#include <glm/vec2.hpp>

#include "engine/tools/gui/view_state.h"

namespace palp {

// The layout of panels in a window, known without drawing them, so that the object can be put beside them.

inline constexpr float kPanelFont = 15; ///< size of their font, at scale 1 [px]
inline constexpr float kStatusPad = 5;  ///< above and below the text of the status line, at scale 1 [px]

/// Returns the width of the column at the left [px].
/// \param width  of the picture [px]
/// \param scale  of the display [1]
[[nodiscard]] float columnWidth(float width, float scale);
/// Returns the height of the line at the top [px].
[[nodiscard]] float statusHeight(float scale);
/// Returns the height of the texts at the foot of the picture, see annotate() [px].
/// \param width, height  of the picture [px]
[[nodiscard]] float footHeight(float width, float height, float scale);

/// Returns whether the column and the status line are shown: nobody has hidden them, and no nodules are hidden.
[[nodiscard]] inline bool hasColumn(const ViewState& state)
{
    return state.panels && !state.blind;
}

/// A part of a picture.
struct PictureArea {
    glm::dvec2 corner{}; ///< the upper left one [px]
    glm::dvec2 size{};   ///< [px]
};

/// Returns the area of a picture that the panels leave free: all of it while they, or nodules, are hidden.
/// \param size  of the picture [px]
[[nodiscard]] PictureArea freeArea(const ViewState& state, const glm::ivec2& size, double scale);

/// Returns the middle of an area in a picture of that size, as Camera::centre has it [1].
[[nodiscard]] glm::dvec2 centreOf(const PictureArea& area, const glm::ivec2& size);

} // namespace palp
