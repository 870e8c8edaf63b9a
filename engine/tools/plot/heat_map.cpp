#include "engine/tools/plot/heat_map.h"

#include <algorithm>
#include <cmath>

#include "engine/core/contract.h"
#include "engine/tools/plot/colour_bar.h"
#include "engine/tools/plot/legend.h"
#include "engine/tools/plot/plot_frame.h"

namespace palp {
namespace {

constexpr double kLongSide   = 440; // of the coloured area [px]
constexpr double kShortest   = 130; // height of the colour bar next to a flat area [px]
constexpr int    kRasterSide = 880; // of the embedded picture, twice the drawn size for sharp screens [px]

struct Extreme {
    int    i = 0, j = 0;
    double value = 0;
};

struct FieldFacts {
    std::size_t undrawable = 0;
    std::size_t total      = 0;
    Extreme     least, most; ///< of the drawable nodes, where there are any

    [[nodiscard]] bool any() const { return undrawable < total; }
    /// Returns whether the field is constant within the rounding of averages; then its extremes' places are arbitrary.
    [[nodiscard]] bool constant() const
    {
        constexpr double kRounding = 1e-6; // of the value [1]
        return any() && most.value - least.value <= kRounding * std::max(std::abs(most.value), std::abs(least.value));
    }
    [[nodiscard]] ValueRange range() const
    {
        return constant() ? ValueRange{most.value, most.value} : ValueRange{least.value, most.value};
    }
};

FieldFacts factsOf(const NodeField& field, Scale scale)
{
    FieldFacts facts;
    for (int i = 0; i < field.nodesX(); ++i)
        for (int j = 0; j < field.nodesZ(); ++j) {
            const double  value = field(i, j);
            const Extreme here  = {i, j, value};
            const bool    first = !facts.any();
            ++facts.total;
            if (!drawable(value, scale)) {
                ++facts.undrawable;
                continue;
            }
            if (first || value < facts.least.value) facts.least = here;
            if (first || value > facts.most.value) facts.most = here;
        }
    return facts;
}

Rgb8 hatch(int x, int y)
{
    constexpr int  kPeriod = 10, kLine = 2; // [px of the embedded picture]
    constexpr Rgb8 kHatchLine = {130, 130, 130};
    return (x + y) % kPeriod < kLine ? kHatchLine : kUndefinedColour;
}

Rgb8 colourOf(double value, const Axis& axis, int x, int y)
{
    return drawable(value, axis.scale()) ? colourAt(axis.position(value)) : hatch(x, y);
}

// Enlarged here rather than by the viewer: some viewers blur whatever the picture says, and colours are to be taken at
// interpolated values, not interpolated themselves.
Image cellsImage(const NodeField& field, const Axis& axis)
{
    const int perNode = std::max(1, kRasterSide / std::max(field.nodesX(), field.nodesZ()));
    Image     image(perNode * field.nodesX(), perNode * field.nodesZ());
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x)
            image.at(x, y) = colourOf(field(x / perNode, field.nodesZ() - 1 - y / perNode), axis, x, y);
    return image;
}

Image smoothImage(const NodeField& field, const Axis& axis)
{
    const int cellsX = field.nodesX() - 1, cellsZ = field.nodesZ() - 1;
    const int perCell = std::max(1, kRasterSide / std::max(cellsX, cellsZ));
    Image     image(perCell * cellsX, perCell * cellsZ);
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x) {
            const double u = (x + 0.5) / perCell, v = cellsZ - (y + 0.5) / perCell;
            const int    i = std::min(int(u), cellsX - 1), j = std::min(int(v), cellsZ - 1);
            const double s = u - i, t = v - j;
            const double value = (1 - s) * ((1 - t) * field(i, j) + t * field(i, j + 1)) +
                                 s * ((1 - t) * field(i + 1, j) + t * field(i + 1, j + 1));
            const double nearest = field(i + (s > 0.5), j + (t > 0.5));
            image.at(x, y)       = colourOf(
                      drawable(nearest, axis.scale()) && drawable(value, axis.scale()) ? value : nearest, axis, x, y);
        }
    return image;
}

PlotFrame frameOf(const HeatMapSettings& s, double top)
{
    const PlateGrid& g = s.grid;
    const double     border =
        s.nodeStyle == NodeStyle::cells ? 0.5 : 0; // a cell reaches half a spacing beyond its node [1]
    const ValueRange x              = {s.corner.x - border * g.spacingX, s.corner.x + g.sizeX() + border * g.spacingX};
    const ValueRange z              = {s.corner.z - border * g.spacingZ, s.corner.z + g.sizeZ() + border * g.spacingZ};
    const double     pixelsPerMetre = kLongSide / std::max(x.high - x.low, z.high - z.low);
    const glm::dvec2 size           = pixelsPerMetre * glm::dvec2(x.high - x.low, z.high - z.low);
    const auto       mostTicks      = [](double length) { return std::clamp(int(length / 60), 2, 8); };
    return {{kFrameLeft, top},
            size,
            Axis(x, Scale::linear, "m", mostTicks(size.x)),
            Axis(z, Scale::linear, "m", mostTicks(size.y))};
}

std::string placeText(const PlotFrame& frame, ChartPoint p)
{
    return "east " + frame.x.text(p.x) + ", north " + frame.y.text(p.z);
}

void drawContactCross(SvgDrawing& svg, glm::dvec2 at)
{
    drawSymbol(svg, Symbol::plus, at, 6.5, "#000000");
}

void drawRing(SvgDrawing& svg, glm::dvec2 at, double radius)
{
    svg.circle(at, radius, "none", {"#ffffff", 3.5});
    svg.circle(at, radius, "none", {"#000000", 1.5, "5 3"});
}

void drawDots(SvgDrawing& svg, const SvgPath& dots)
{
    svg.path(dots, "none", {"#ffffff", 3});
    svg.path(dots, "none", {"#000000", 1.6});
}

bool shows(const PlotFrame& frame, ChartPoint p)
{
    const auto within = [](const Axis& axis, double v) { return v >= axis.range().low && v <= axis.range().high; };
    return within(frame.x, p.x) && within(frame.y, p.z); // false for NaN
}

void drawOverlays(SvgDrawing& svg, const PlotFrame& frame, const HeatMapSettings& s, std::vector<LegendEntry>& legend)
{
    if (!s.points.empty()) {
        SvgPath     dots;
        std::size_t shown = 0;
        for (ChartPoint p : s.points) {
            if (!shows(frame, p)) continue;
            dots.dotAt(frame.pixel(p.x, p.z));
            ++shown;
        }
        drawDots(svg, dots);
        legend.push_back({"points in the patch window: " + std::to_string(shown),
                          [](SvgDrawing& to, glm::dvec2 at) { drawDots(to, SvgPath().dotAt(at)); }});
    }
    if (!s.contact) return;
    if (!shows(frame, *s.contact)) {
        legend.push_back({"contact: outside", drawContactCross});
        return;
    }
    const glm::dvec2 at = frame.pixel(s.contact->x, s.contact->z);
    if (s.footprintRadius > 0) {
        drawRing(svg, at, s.footprintRadius * frame.size.x / (frame.x.range().high - frame.x.range().low));
        legend.push_back({"footprint, radius " + frame.x.text(s.footprintRadius),
                          [](SvgDrawing& to, glm::dvec2 p) { drawRing(to, p, 7); }});
    }
    drawContactCross(svg, at);
    legend.push_back({"contact", drawContactCross});
}

/// Hollow, and wide enough for the contact's cross: the greatest value is often there.
void drawHollowTriangle(SvgDrawing& svg, glm::dvec2 at, double radius)
{
    const glm::dvec2 left = at + radius * glm::dvec2(-1.05, -0.75), right = at + radius * glm::dvec2(1.05, -0.75);
    const SvgPath    outline = SvgPath({left, right, at + radius * glm::dvec2(0, 1.15)}).close();
    svg.path(outline, "none", {"#ffffff", 3.5});
    svg.path(outline, "none", {"#000000", 1.5});
}

void drawExtremes(SvgDrawing& svg, const PlotFrame& frame, const HeatMapSettings& s, const FieldFacts& facts,
                  const Axis& values, std::vector<LegendEntry>& legend)
{
    const auto placeOf = [&](const Extreme& e) {
        return ChartPoint{s.corner.x + e.i * s.grid.spacingX, s.corner.z + e.j * s.grid.spacingZ};
    };
    const auto entry = [&](const char* name, const Extreme& e) {
        return std::string(name) + " " + values.text(e.value) + " at " + placeText(frame, placeOf(e));
    };
    const auto pixelOf = [&](const Extreme& e) { return frame.pixel(placeOf(e).x, placeOf(e).z); };

    drawHollowTriangle(svg, pixelOf(facts.most), 12);
    legend.push_back({entry("max", facts.most), [](SvgDrawing& to, glm::dvec2 at) { drawHollowTriangle(to, at, 6); }});
    drawSymbol(svg, Symbol::diamond, pixelOf(facts.least), 5.5, "#000000");
    legend.push_back({entry("min", facts.least),
                      [](SvgDrawing& to, glm::dvec2 at) { drawSymbol(to, Symbol::diamond, at, 5, "#000000"); }});
}

void addSwatch(std::vector<LegendEntry>& legend, const std::string& text, Rgb8 colour, bool hatched)
{
    legend.push_back({text, [=](SvgDrawing& svg, glm::dvec2 at) {
                          Image swatch(40, 26, colour);
                          for (int y = 0; hatched && y < swatch.height; ++y)
                              for (int x = 0; x < swatch.width; ++x) swatch.at(x, y) = hatch(x, y);
                          svg.image(at - glm::dvec2(10, 6.5), {20, 13}, swatch);
                      }});
}

} // namespace

std::string heatMapSvg(const NodeField& field, const HeatMapSettings& settings)
{
    const PlateGrid& grid = settings.grid;
    PALP_EXPECT(field.on(grid) && grid.cellsX >= 1 && grid.cellsZ >= 1 && grid.spacingX > 0 && grid.spacingZ > 0,
                "a field of " + std::to_string(field.nodesX()) + " x " + std::to_string(field.nodesZ()) +
                    " nodes on a grid of " + std::to_string(grid.nodesX()) + " x " + std::to_string(grid.nodesZ()));

    const FieldFacts                facts     = factsOf(field, settings.scale);
    const std::optional<ValueRange> found     = facts.any() ? std::optional(facts.range()) : std::nullopt;
    const double                    top       = settings.title.empty() ? 18 : 42;
    const PlotFrame                 frame     = frameOf(settings, top);
    const double                    barHeight = std::max(frame.size.y, kShortest);
    const Axis values(settings.range.value_or(found.value_or(ValueRange{1, 2})), settings.scale, settings.unit,
                      std::clamp(int(barHeight / 45), 2, 9));
    std::vector<LegendEntry> legend;
    SvgDrawing               svg;
    if (!settings.title.empty()) svg.text({kFrameLeft, 25}, settings.title, {.size = 15, .bold = true});

    svg.image(frame.corner, frame.size,
              settings.nodeStyle == NodeStyle::cells ? cellsImage(field, values) : smoothImage(field, values));
    svg.beginClip(frame.corner, frame.size);
    drawOverlays(svg, frame, settings, legend);
    svg.endClip();
    drawFrame(svg, frame, "east", "north");
    if (facts.constant())
        addSwatch(legend, "constant " + values.text(facts.most.value), colourAt(values.position(facts.most.value)),
                  false);
    else if (facts.any() && settings.markExtremes)
        drawExtremes(svg, frame, settings, facts, values, legend);
    if (facts.undrawable > 0)
        addSwatch(legend,
                  !settings.undrawn.empty()         ? settings.undrawn
                  : settings.scale == Scale::linear ? std::to_string(facts.undrawable) + " not finite"
                                                    : std::to_string(facts.undrawable) + " not finite or not positive",
                  {}, true);

    const double barLeft = frame.corner.x + frame.size.x + 24;
    drawColourBar(svg, {&values, [](double at_) { return colourAt(at_); }, settings.quantity, found}, {barLeft, top},
                  barHeight);
    const double width  = std::max(barLeft + kColourBarWidth, kFrameLeft + textWidth(settings.title, 16) + 10);
    double       bottom = top + std::max(frame.size.y + kFrameBelow, barHeight) + 6;
    bottom += drawLegend(svg, legend, {kFrameLeft - kLegendMarkWidth / 2, bottom}, width - kFrameLeft);
    return svg.finish({width, bottom + 10}, settings.title.empty() ? settings.quantity : settings.title);
}

} // namespace palp
