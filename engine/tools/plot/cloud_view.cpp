#include "engine/tools/plot/cloud_view.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <glm/geometric.hpp>

#include "engine/core/contract.h"
#include "engine/tools/plot/cloud_shading.h"
#include "engine/tools/plot/cloud_surface.h"
#include "engine/tools/plot/colour_bar.h"

namespace palp {
namespace {

constexpr double kSide                     = 18;   // left of the picture [px]
constexpr double kDegenerateWidth          = 1e-3; // half the width shown around points that all coincide [m]
constexpr std::array<const char*, 3> kInks = {"#c23b00", "#0059a0", "#7a2f66"}; // of markers, dark enough for text

bool finitePoint(const glm::dvec3& p)
{
    return drawable(p.x, Scale::linear) && drawable(p.y, Scale::linear) && drawable(p.z, Scale::linear);
}

void checkSettings(std::span<const glm::dvec3> positions, std::span<const double> values, const CloudViewSettings& s)
{
    PALP_EXPECT(values.empty() || values.size() == positions.size(), "found " + std::to_string(values.size()) +
                                                                         " values for " +
                                                                         std::to_string(positions.size()) + " points");
    PALP_EXPECT(s.width >= 64 && s.height >= 64 && s.width <= 8192 && s.height <= 8192,
                "found a picture of " + std::to_string(s.width) + " x " + std::to_string(s.height) + " px");
    PALP_EXPECT(finitePoint(s.direction) && finitePoint(s.up) &&
                    glm::length(glm::cross(s.direction, s.up)) > 1e-6 * glm::length(s.direction) * glm::length(s.up),
                "direction and up are finite, not zero and not parallel");
    PALP_EXPECT(!s.window || (finitePoint(s.window->centre) && s.window->halfWidth > 0 &&
                              drawable(s.window->halfWidth, Scale::linear)),
                "a window has a finite centre and a positive, finite half width");
}

CloudCamera cameraOf(std::span<const glm::dvec3> positions, const CloudViewSettings& s)
{
    constexpr double kFilled = 0.92; // share of the picture that the cloud takes [1]
    CloudCamera      camera;
    camera.width = s.width, camera.height = s.height;
    camera.toEye     = -glm::normalize(s.direction);
    camera.right     = glm::normalize(glm::cross(s.up, camera.toEye));
    camera.up        = glm::cross(camera.toEye, camera.right);
    double halfWidth = kDegenerateWidth; // [m]
    if (s.window) {
        camera.centre = s.window->centre;
        halfWidth     = s.window->halfWidth;
    } else {
        const auto inAxes = [&](const glm::dvec3& p) {
            return glm::dvec3(glm::dot(p, camera.right), glm::dot(p, camera.up), glm::dot(p, camera.toEye));
        };
        glm::dvec3 low(INFINITY), high(-INFINITY);
        for (const glm::dvec3& p : positions)
            if (finitePoint(p)) low = glm::min(low, inAxes(p)), high = glm::max(high, inAxes(p));
        const glm::dvec3 middle = 0.5 * (low + high);
        camera.centre           = middle.x * camera.right + middle.y * camera.up + middle.z * camera.toEye;
        const glm::dvec3 half   = 0.5 * (high - low);
        const double     needed = std::max(half.x, half.y * s.width / s.height) / kFilled;
        // The extents of coinciding points are rounding errors of their coordinates.
        if (needed > 1e-12 * glm::length(middle)) halfWidth = needed;
    }
    camera.pixelsPerMetre = 0.5 * s.width / halfWidth;
    return camera;
}

struct Box {
    glm::dvec2         low, high; // [px]
    [[nodiscard]] bool overlaps(const Box& b) const
    {
        return low.x < b.high.x && b.low.x < high.x && low.y < b.high.y && b.low.y < high.y;
    }
    [[nodiscard]] bool within(const Box& b) const
    {
        return low.x >= b.low.x && low.y >= b.low.y && high.x <= b.high.x && high.y <= b.high.y;
    }
};

// Places for labels that hide neither each other nor a marker.
class LabelPlacer {
public:
    explicit LabelPlacer(Box picture) : picture_(picture) {}

    void keepFree(glm::dvec2 at, double radius) { taken_.push_back({at - radius, at + radius}); }

    // The box of a label for `at`, on the first free of some places around it; the last tried if none is free.
    Box place(glm::dvec2 at, glm::dvec2 size)
    {
        constexpr std::array<glm::dvec2, 8> kSides = {
            {{1, -1}, {1, 1}, {-1, -1}, {-1, 1}, {1, 0}, {-1, 0}, {0, -1}, {0, 1}}};
        Box box;
        for (double distance : {26.0, 48.0, 76.0, 110.0})
            for (glm::dvec2 side : kSides) {
                const glm::dvec2 middle = at + side * glm::dvec2(distance + size.x / 2, distance);
                box                     = {middle - size / 2.0, middle + size / 2.0};
                const bool free =
                    std::none_of(taken_.begin(), taken_.end(), [&](const Box& b) { return b.overlaps(box); });
                if (free && box.within(picture_)) {
                    taken_.push_back(box);
                    return box;
                }
            }
        box = {at, at + size};
        taken_.push_back(box);
        return box;
    }

private:
    Box              picture_;
    std::vector<Box> taken_;
};

void drawArrow(SvgDrawing& svg, glm::dvec2 from, glm::dvec2 to, const std::string& colour)
{
    constexpr double kHead = 9; // [px]
    if (glm::distance(from, to) < 1) return;
    const glm::dvec2 along = glm::normalize(to - from), across(-along.y, along.x);
    const glm::dvec2 neck  = to - kHead * along;
    svg.line(from, neck, {"#ffffff", 5});
    svg.line(from, neck, {colour, 2.5});
    svg.path(SvgPath({to, neck + 0.45 * kHead * across, neck - 0.45 * kHead * across}).close(), colour, {"#ffffff", 1});
}

void drawMarkers(SvgDrawing& svg, const CloudViewSettings& s, const CloudCamera& camera, const CloudSurface& surface,
                 glm::dvec2 corner)
{
    constexpr double kRadius = 6, kText = 13, kHiddenBehind = 2; // [px]
    const Box        picture = {corner, corner + glm::dvec2(s.width, s.height)};
    LabelPlacer      labels(picture);
    const auto       pixelOf = [&](const glm::dvec3& world) -> std::optional<glm::dvec2> {
        const auto p = camera.project(world);
        return p ? std::optional(corner + glm::dvec2(p->x, p->y)) : std::nullopt;
    };
    for (const CloudMarker& marker : s.markers) {
        if (const auto at = pixelOf(marker.position)) labels.keepFree(*at, kRadius + 3);
        if (const auto tip = pixelOf(marker.position + marker.arrow)) labels.keepFree(*tip, kRadius);
    }
    for (std::size_t n = 0; n < s.markers.size(); ++n) {
        const CloudMarker& marker = s.markers[n];
        const std::string  ink = marker.label.empty() ? kInks[0] : kInks[n % kInks.size()]; // a colour needs its name
        const auto         p   = camera.project(marker.position);
        if (!p || p->x < 0 || p->y < 0 || p->x >= s.width || p->y >= s.height) continue;
        const glm::dvec2 at = corner + glm::dvec2(p->x, p->y);
        if (const auto tip = pixelOf(marker.position + marker.arrow)) drawArrow(svg, at, *tip, ink);
        const CloudSurface::Sample& seen = surface.at(int(p->x), int(p->y));
        drawSymbol(svg, marker.symbol, at, kRadius, ink);
        if (seen.coverage > 0.5F && p->depth > double(seen.depth) + kHiddenBehind)
            drawSymbol(svg, marker.symbol, at, 0.5 * kRadius, "#ffffff");
        if (marker.label.empty()) continue;
        const Box        box  = labels.place(at, {textWidth(marker.label, kText), kText + 4});
        const glm::dvec2 near = glm::clamp(at, box.low, box.high);
        const glm::dvec2 out  = glm::normalize(near - at + glm::dvec2(1e-9, 0));
        svg.line(at + (kRadius + 2) * out, near, {"#ffffff", 3});
        svg.line(at + (kRadius + 2) * out, near, {ink, 1});
        const bool left = box.high.x <= at.x; // a label on the left ends at its line
        svg.text(
            {left ? box.high.x - 3 : box.low.x + 3, box.high.y - 5}, marker.label,
            {.size = kText, .anchor = left ? Anchor::end : Anchor::start, .colour = ink, .bold = true, .halo = true});
    }
}

void drawScaleBar(SvgDrawing& svg, const CloudCamera& camera, glm::dvec2 rightEnd)
{
    constexpr double kLongest = 160; // [px]
    const ValueRange range{0, kLongest / camera.pixelsPerMetre};
    Axis             axis(range, Scale::linear, "m", 2);
    if (axis.ticks().size() < 2) axis = Axis(range, Scale::linear, "m", 3); // 4 to 5: steps of 5 leave only zero
    const double     length  = axis.ticks().back().value;
    const glm::dvec2 leftEnd = rightEnd - glm::dvec2(length * camera.pixelsPerMetre, 0);
    svg.line(leftEnd, rightEnd, {"#1a1a1a", 2.5});
    for (glm::dvec2 end : {leftEnd, rightEnd})
        svg.line(end - glm::dvec2(0, 4), end + glm::dvec2(0, 4), {"#1a1a1a", 1.5});
    svg.text(0.5 * (leftEnd + rightEnd) - glm::dvec2(0, 8), axis.ticks().back().label + " " + axis.unit(),
             {.anchor = Anchor::middle, .halo = true});
}

void drawWorldAxes(SvgDrawing& svg, const CloudCamera& camera, glm::dvec2 origin)
{
    constexpr double kLength = 30; // [px]
    for (int k = 0; k < 3; ++k) {
        glm::dvec3 axis(0);
        axis[k]                = 1;
        const glm::dvec2 along = kLength * glm::dvec2(glm::dot(axis, camera.right), -glm::dot(axis, camera.up));
        drawArrow(svg, origin, origin + along, "#595959");
        const double length = std::max(glm::length(along), 1.0);
        svg.text(origin + along * (1 + 10 / length) + glm::dvec2(0, 4), std::string(1, "xyz"[k]),
                 {.anchor = Anchor::middle, .colour = "#595959", .halo = true});
    }
}

std::string notesOf(std::size_t leftOut, std::size_t withoutValue)
{
    std::string note;
    if (leftOut > 0) note = std::to_string(leftOut) + " points without a finite position are left out. ";
    if (withoutValue > 0) note += std::to_string(withoutValue) + " points without a value that can be drawn are grey.";
    return note;
}

} // namespace

std::string cloudViewSvg(std::span<const glm::dvec3> positions, std::span<const double> values,
                         const CloudViewSettings& settings)
{
    checkSettings(positions, values, settings);
    const std::size_t placed = std::size_t(std::count_if(positions.begin(), positions.end(), finitePoint));
    const std::size_t valued =
        std::size_t(std::count_if(values.begin(), values.end(), [&](double v) { return drawable(v, settings.scale); }));
    const glm::dvec2 corner(kSide, settings.title.empty() ? 14 : 42);
    const glm::dvec2 size(settings.width, settings.height);
    SvgDrawing       svg;
    if (!settings.title.empty()) svg.text({kSide, 25}, settings.title, {.size = 15, .bold = true});

    double width = kSide + size.x + kSide;
    if (placed == 0) {
        svg.rectangle(corner, size, "none", {"#bfbfbf", 1});
        svg.text(corner + 0.5 * size, "no points to draw", {.size = 14, .anchor = Anchor::middle, .colour = "#595959"});
    } else {
        const auto        found  = rangeOf(values, settings.scale);
        const bool        shown  = !values.empty();
        const double      height = std::min(0.7 * size.y, 420.0);
        const Axis        axis(settings.range.value_or(found.value_or(ValueRange{1, 2})), settings.scale, settings.unit,
                               std::clamp(int(height / 45), 2, 9));
        const CloudCamera camera = cameraOf(positions, settings);
        std::vector<double> drawn(values.begin(), values.end());
        for (double& v : drawn) v = drawable(v, settings.scale) ? std::clamp(axis.position(v), 0.0, 1.0) : NAN;
        const CloudSurface surface = cloudSurface(positions, drawn, camera);
        svg.image(corner, size, cloudImage(surface, shown ? Paint::values : Paint::clay));
        svg.beginClip(corner, size);
        drawMarkers(svg, settings, camera, surface, corner);
        drawScaleBar(svg, camera, corner + size - glm::dvec2(14, 14));
        drawWorldAxes(svg, camera, corner + glm::dvec2(48, size.y - 48));
        svg.endClip();
        if (shown) {
            drawColourBar(svg,
                          {&axis, [](double position) { return surfaceColour(position); }, settings.quantity, found},
                          corner + glm::dvec2(size.x + 10, 0.5 * (size.y - height)), height);
            width = kSide + size.x + 10 + kColourBarWidth;
        }
    }
    double            bottom = corner.y + size.y + 12;
    const std::string notes  = notesOf(positions.size() - placed, values.size() - valued);
    if (!notes.empty()) svg.text({kSide, bottom += 8}, notes, {.colour = "#595959"});
    return svg.finish({std::max(width, kSide + textWidth(settings.title, 16)), bottom + 8},
                      settings.title.empty() ? settings.quantity : settings.title);
}

} // namespace palp
