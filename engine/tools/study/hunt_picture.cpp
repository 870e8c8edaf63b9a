#include "engine/tools/study/hunt_picture.h"

#include <algorithm>
#include <cmath>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "engine/chart/chart.h"
#include "engine/core/quantity.h"
#include "engine/tools/plot/colour_map.h"
#include "engine/tools/plot/legend.h"
#include "engine/tools/plot/plot_frame.h"

namespace palp::study {
namespace {

const std::string kPoint = "#d9d9d9", kWay = "#4d4d4d"; ///< of the object and the path
constexpr double  kSymbol = 7;                          ///< radius of a declaration's mark [px]

std::string foundInk()
{
    return hexColour(kNamedColours[0]);
}
std::string missedInk()
{
    return hexColour(kNamedColours[1]);
}

/// The projection of a scene's places onto the page.
struct Page {
    Frame      frame;
    glm::dvec3 middle;
    PlotFrame  plot;

    [[nodiscard]] glm::dvec2 at(const glm::dvec3& p) const
    {
        return plot.pixel(glm::dot(p - middle, frame.east), glm::dot(p - middle, frame.north));
    }
    [[nodiscard]] double pixels(double metres) const { return plot.pixelX(metres) - plot.pixelX(0); }
};

Page pageOf(const PointCloud& cloud, const glm::dvec3& place, const glm::dvec3& outward, double ground)
{
    constexpr double kEdge = 560, kMargin = 1.06; // [px], and a factor by which no mark touches the border [1]
    const Frame      frame = Frame::about(glm::normalize(outward));
    double           reach = ground;
    if (reach <= 0)
        for (const glm::dvec3& p : cloud.positions())
            reach = std::max(
                {reach, std::abs(glm::dot(p - place, frame.east)), std::abs(glm::dot(p - place, frame.north))});
    const ValueRange shown = widened({-kMargin * reach, kMargin * reach}, Scale::linear);
    return {frame,
            place,
            {{kFrameLeft, 0},
             {kEdge, kEdge},
             Axis(shown, Scale::linear, "m", int(kEdge / 70)),
             Axis(shown, Scale::linear, "m", int(kEdge / 70))}};
}

/// Draws some of the object's points, which show its shape.
void drawObject(SvgDrawing& svg, const Page& page, const PointCloud& cloud)
{
    constexpr std::size_t kMost = 4000; // dots: enough for the shape, in a small file
    const std::size_t     step  = cloud.size() / kMost + 1;
    SvgPath               dots;
    for (std::size_t i = 0; i < cloud.size(); i += step) dots.dotAt(page.at(cloud.positions()[i]));
    svg.path(dots, "none", {kPoint, 2.5});
}

void drawWay(SvgDrawing& svg, const Page& page, const HuntScore& score)
{
    for (const auto& piece : score.path) {
        SvgPath way;
        for (const glm::dvec3& p : piece) way.lineTo(page.at(p));
        if (piece.size() > 1) svg.path(way, "none", {kWay, 1});
    }
}

Stroke outlineOf(bool found)
{
    return found ? Stroke{foundInk(), 3, ""} : Stroke{missedInk(), 3, "7 4"};
}

void drawNodules(SvgDrawing& svg, const Page& page, const HuntScore& score)
{
    for (std::size_t i = 0; i < score.nodules.size(); ++i) {
        const NoduleScore& n  = score.nodules[i];
        const glm::dvec2   at = page.at(n.nodule.centre);
        svg.circle(at, page.pixels(n.nodule.radius), "none", outlineOf(n.found));
        svg.text(at + glm::dvec2(0, -page.pixels(n.nodule.radius) - 7),
                 std::to_string(i + 1) + ": " + formatQuantity(n.nodule.modulus, "Pa") + ", edge " +
                     std::to_string(int(std::lround(100 * n.edge))) + " %",
                 {.anchor = Anchor::middle, .colour = n.found ? foundInk() : missedInk(), .bold = true, .halo = true});
    }
}

void drawDeclarations(SvgDrawing& svg, const Page& page, const HuntScore& score)
{
    for (const Declaration& d : score.declarations) {
        const bool found = d.nodule != Declaration::kNone;
        drawSymbol(svg, found ? Symbol::triangleUp : Symbol::cross, page.at(d.place), kSymbol,
                   found ? foundInk() : missedInk());
    }
}

std::vector<LegendEntry> legendOf(const HuntScore& score)
{
    const auto ring = [](bool found) {
        return [found](SvgDrawing& svg, glm::dvec2 at) { svg.circle(at, 8, "none", outlineOf(found)); };
    };
    const auto mark = [](Symbol symbol, const std::string& ink) {
        return [symbol, ink](SvgDrawing& svg, glm::dvec2 at) { drawSymbol(svg, symbol, at, kSymbol, ink); };
    };
    const auto count = [](std::size_t n) { return " (" + std::to_string(n) + ")"; };
    return {
        {"nodule found" + count(score.found), ring(true)},
        {"nodule missed" + count(score.nodules.size() - score.found), ring(false)},
        {"declared, a find", mark(Symbol::triangleUp, foundInk())},
        {"declared, nothing there" + count(score.falseAlarms), mark(Symbol::cross, missedInk())},
        {"way of the contact", [](SvgDrawing& svg, glm::dvec2 at) {
             svg.line(at - glm::dvec2(kLegendMarkWidth / 2, 0), at + glm::dvec2(kLegendMarkWidth / 2, 0), {kWay, 1});
         }}};
}

} // namespace

std::string huntSvg(const HuntScore& score, const PointCloud& cloud, const glm::dvec3& place, const glm::dvec3& outward,
                    double ground)
{
    Page       page = pageOf(cloud, place, outward, ground);
    SvgDrawing svg;
    const auto title = "Nodules found: " + std::to_string(score.found) + " of " + std::to_string(score.nodules.size());
    svg.text({kFrameLeft, 25}, title, {.size = 15, .bold = true});
    page.plot.corner.y = 36 + drawLegend(svg, legendOf(score), {kFrameLeft, 36}, page.plot.size.x) + 8;
    drawGridLines(svg, page.plot);
    svg.beginClip(page.plot.corner, page.plot.size);
    drawObject(svg, page, cloud);
    drawNodules(svg, page, score);
    drawWay(svg, page, score); // the path may follow an edge
    drawDeclarations(svg, page, score);
    svg.endClip();
    drawFrame(svg, page.plot, "east of the place", "north of the place");
    return svg.finish({kFrameLeft + page.plot.size.x + 24, page.plot.corner.y + page.plot.size.y + kFrameBelow}, title);
}

} // namespace palp::study
