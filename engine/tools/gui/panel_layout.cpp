#include "engine/tools/gui/panel_layout.h"

#include <algorithm>

#include "engine/tools/render/annotation.h"

namespace palp {

float columnWidth(float width, float scale)
{
    constexpr float kWidth = 300, kMostOfWidth = 0.6F; // at scale 1 [px]; share of a narrow window [1]
    return std::min(kWidth * scale, kMostOfWidth * width);
}

float statusHeight(float scale)
{
    return (kPanelFont + 2 * kStatusPad) * scale;
}

float footHeight(float width, float height, float scale)
{
    return 3 * float(annotationSize(int(width), int(height), scale)); // a line of the key and its margins
}

PictureArea freeArea(const ViewState& state, const glm::ivec2& size, double scale)
{
    const glm::dvec2 all(size);
    if (!hasColumn(state)) return {{0, 0}, all};
    const double left = columnWidth(float(size.x), float(scale)), top = statusHeight(float(scale));
    const double foot = state.texts ? footHeight(float(size.x), float(size.y), float(scale)) : 0;
    // A window lower than its own lines has no room left; half of it serves as well as any other answer.
    return {{left, top}, {all.x - left, std::max(0.5 * all.y, all.y - top - foot)}};
}

glm::dvec2 centreOf(const PictureArea& area, const glm::ivec2& size)
{
    const glm::dvec2 off = area.corner + 0.5 * area.size - 0.5 * glm::dvec2(size); // [px], y down
    return glm::dvec2(off.x, -off.y) / (0.5 * size.y);
}

} // namespace palp
