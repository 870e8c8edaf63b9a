#include "engine/tools/plot/line_plot.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "engine/core/contract.h"
#include "engine/tools/plot/colour_map.h"
#include "engine/tools/plot/legend.h"
#include "engine/tools/plot/plot_frame.h"

namespace palp {
namespace {

constexpr double kMarkerRadius  = 4;  // [px]
constexpr double kMarkerSpacing = 70; // between the markers of a dense line [px]

struct Look {
    std::string colour;
    std::string dash; ///< as in Stroke
    Symbol      symbol = Symbol::circle;
    double      width  = 1.8; ///< [px]
};

Look lookOf(SeriesStyle style, std::size_t number)
{
    constexpr std::array<const char*, 5> kDashes  = {"", "7 3", "2 3", "9 3 2 3", "12 4"};
    constexpr std::array<Symbol, 7>      kSymbols = {Symbol::circle,  Symbol::square, Symbol::triangleUp,
                                                     Symbol::diamond, Symbol::cross,  Symbol::triangleDown,
                                                     Symbol::plus};
    if (style == SeriesStyle::reference) return {"#4d4d4d", number % 2 == 0 ? "5 4" : "1.5 3", Symbol::circle, 1.2};
    return {hexColour(kNamedColours[number % kNamedColours.size()]), kDashes[number % kDashes.size()],
            kSymbols[number % kSymbols.size()]};
}

ValueRange padded(ValueRange range, Scale scale)
{
    constexpr double kMargin = 0.04; // of the span, so that no marker touches the border [1]
    if (scale == Scale::logarithmic) {
        const double factor = std::pow(range.high / range.low, kMargin);
        return {range.low / factor, range.high * factor};
    }
    const double margin = kMargin * (range.high - range.low);
    return {range.low - margin, range.high + margin};
}

ValueRange rangeOfAll(std::span<const PlotSeries> series, const PlotAxis& axis, std::vector<double> PlotSeries::*values)
{
    if (axis.range) return *axis.range;
    std::optional<ValueRange> all;
    for (const PlotSeries& s : series)
        if (const auto range = rangeOf(s.*values, axis.scale))
            all = all ? ValueRange{std::min(all->low, range->low), std::max(all->high, range->high)} : *range;
    if (!all) return {0.1, 1}; // nothing to show: any axis is acceptable
    return padded(widened(*all, axis.scale), axis.scale);
}

// The pixels of a series in pieces, parted at points that cannot be drawn.
std::vector<std::vector<glm::dvec2>> piecesOf(const PlotSeries& s, const PlotFrame& frame)
{
    constexpr double                     kFar = 1e6; // far outside any picture, near enough to be a coordinate [px]
    std::vector<std::vector<glm::dvec2>> pieces(1);
    for (std::size_t n = 0; n < s.x.size(); ++n) {
        if (drawable(s.x[n], frame.x.scale()) && drawable(s.y[n], frame.y.scale()))
            pieces.back().push_back(glm::clamp(frame.pixel(s.x[n], s.y[n]), glm::dvec2(-kFar), glm::dvec2(kFar)));
        else if (!pieces.back().empty())
            pieces.emplace_back();
    }
    return pieces;
}

std::size_t undrawableIn(const PlotSeries& s, const PlotFrame& frame)
{
    std::size_t count = 0;
    for (std::size_t n = 0; n < s.x.size(); ++n)
        count += !drawable(s.x[n], frame.x.scale()) || !drawable(s.y[n], frame.y.scale());
    return count;
}

// Of consecutive points in one pixel column only the first, lowest, highest and last show.
std::vector<glm::dvec2> thinned(const std::vector<glm::dvec2>& points)
{
    std::vector<glm::dvec2> kept;
    for (std::size_t begin = 0, end = 0; begin < points.size(); begin = end) {
        const double column = std::floor(points[begin].x);
        while (end < points.size() && std::floor(points[end].x) == column) ++end;
        const auto from = points.begin() + std::ptrdiff_t(begin), to = points.begin() + std::ptrdiff_t(end);
        const auto [low, high] = std::minmax_element(from, to, [](glm::dvec2 a, glm::dvec2 b) { return a.y < b.y; });
        std::array<std::ptrdiff_t, 4> picks = {0, low - from, high - from, to - from - 1};
        std::sort(picks.begin(), picks.end());
        for (auto pick = picks.begin(), last = std::unique(picks.begin(), picks.end()); pick != last; ++pick)
            kept.push_back(from[*pick]);
    }
    return kept;
}

void drawLine(SvgDrawing& svg, const std::vector<glm::dvec2>& points, const Look& look)
{
    SvgPath path;
    for (glm::dvec2 p : thinned(points)) path.lineTo(p);
    if (points.size() == 1) path.dotAt(points.front()); // a lone point between gaps shows as a dot
    if (!points.empty()) svg.path(path, "none", {look.colour, look.width, look.dash});
}

void drawMarkers(SvgDrawing& svg, const std::vector<glm::dvec2>& points, const Look& look, double spacing,
                 double offset)
{
    double travelled = spacing - offset;
    for (std::size_t n = 0; n < points.size(); ++n) {
        if (n > 0) travelled += glm::distance(points[n - 1], points[n]);
        if (travelled < spacing) continue;
        travelled = 0;
        drawSymbol(svg, look.symbol, points[n], kMarkerRadius, look.colour);
    }
}

void drawSeries(SvgDrawing& svg, const PlotSeries& s, const Look& look, const PlotFrame& frame, std::size_t number)
{
    constexpr std::size_t kFew    = 40; // markers of one line that can still be distinguished
    const bool            dense   = s.style == SeriesStyle::lineAndMarkers && s.x.size() > kFew;
    const double          spacing = dense ? kMarkerSpacing : 0;
    const double offset = dense ? 17.0 * double(number % 4) : 0; // so that markers of near curves do not coincide [px]
    const auto   pieces = piecesOf(s, frame);
    for (const auto& piece : pieces)
        if (s.style != SeriesStyle::markers) drawLine(svg, piece, look);
    for (const auto& piece : pieces)
        if (s.style == SeriesStyle::markers || s.style == SeriesStyle::lineAndMarkers)
            drawMarkers(svg, piece, look, spacing, offset);
}

LegendEntry legendEntry(const PlotSeries& s, const Look& look, std::size_t undrawable)
{
    const SeriesStyle style = s.style;
    return {s.name + (undrawable > 0 ? " (" + std::to_string(undrawable) + " not drawn)" : ""),
            [look, style](SvgDrawing& svg, glm::dvec2 at) {
                const glm::dvec2 half = {kLegendMarkWidth / 2, 0};
                if (style != SeriesStyle::markers) svg.line(at - half, at + half, {look.colour, look.width, look.dash});
                if (style == SeriesStyle::markers || style == SeriesStyle::lineAndMarkers)
                    drawSymbol(svg, look.symbol, at, kMarkerRadius, look.colour);
            }};
}

} // namespace

std::string linePlotSvg(std::span<const PlotSeries> series, const LinePlotSettings& settings)
{
    for (const PlotSeries& s : series)
        PALP_EXPECT(s.x.size() == s.y.size(), "series " + s.name + " has " + std::to_string(s.x.size()) + " x and " +
                                                  std::to_string(s.y.size()) + " y");
    PALP_EXPECT(settings.width >= 100 && settings.height >= 100, "a plot needs 100 px for its labels");

    PlotFrame                frame{{kFrameLeft, 0},
                    {settings.width, settings.height},
                    Axis(rangeOfAll(series, settings.x, &PlotSeries::x), settings.x.scale, settings.x.unit,
                                        int(settings.width / 70)),
                    Axis(rangeOfAll(series, settings.y, &PlotSeries::y), settings.y.scale, settings.y.unit,
                                        int(settings.height / 45) + 1)};
    std::vector<Look>        looks;
    std::vector<LegendEntry> legend;
    std::size_t              references = 0, others = 0;
    for (const PlotSeries& s : series) {
        looks.push_back(lookOf(s.style, s.style == SeriesStyle::reference ? references++ : others++));
        if (!s.name.empty()) legend.push_back(legendEntry(s, looks.back(), undrawableIn(s, frame)));
    }

    SvgDrawing   svg;
    const double width = std::max(kFrameLeft + settings.width + 24, kFrameLeft + textWidth(settings.title, 16) + 10);
    double       top   = 14;
    if (!settings.title.empty()) {
        svg.text({kFrameLeft, 25}, settings.title, {.size = 15, .bold = true});
        top = 36;
    }
    top += drawLegend(svg, legend, {kFrameLeft, top}, settings.width) + (legend.empty() ? 4 : 8);
    frame.corner.y = top;
    drawGridLines(svg, frame);
    svg.beginClip(frame.corner, frame.size);
    for (bool referencesFirst : {true, false})
        for (std::size_t n = 0; n < series.size(); ++n)
            if ((series[n].style == SeriesStyle::reference) == referencesFirst)
                drawSeries(svg, series[n], looks[n], frame, n);
    svg.endClip();
    drawFrame(svg, frame, settings.x.quantity, settings.y.quantity);
    return svg.finish({width, top + settings.height + kFrameBelow},
                      settings.title.empty() ? settings.y.quantity : settings.title);
}

} // namespace palp
