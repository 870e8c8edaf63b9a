#include "engine/picture/svg.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

#include "engine/core/contract.h"

namespace palp {
namespace {

std::string escaped(std::string_view text)
{
    std::string safe;
    for (char c : text) {
        switch (c) {
        case '&':
            safe += "&amp;";
            break;
        case '<':
            safe += "&lt;";
            break;
        case '>':
            safe += "&gt;";
            break;
        case '"':
            safe += "&quot;";
            break;
        default:
            safe += static_cast<unsigned char>(c) < ' ' ? ' ' : c; // XML 1.0 has no control characters
        }
    }
    return safe;
}

std::string attribute(std::string_view name, std::string_view value)
{
    return " " + std::string(name) + "=\"" + escaped(value) + "\"";
}

std::string attribute(std::string_view name, double value)
{
    return attribute(name, svgNumber(value));
}

std::string attributes(const Stroke& stroke)
{
    if (stroke.colour == "none") return "";
    return attribute("stroke", stroke.colour) + attribute("stroke-width", stroke.width) +
           (stroke.dash.empty() ? "" : attribute("stroke-dasharray", stroke.dash));
}

} // namespace

std::string svgNumber(double value)
{
    PALP_EXPECT(std::abs(value) < 1e7, "a coordinate lies near the picture; found " + std::to_string(value));
    const double         rounded = std::round(100 * value) / 100;
    std::array<char, 32> text{};
    return {text.data(), std::to_chars(text.data(), text.data() + text.size(), rounded == 0 ? 0 : rounded).ptr};
}

std::string svgPoint(glm::dvec2 point)
{
    return svgNumber(point.x) + " " + svgNumber(point.y);
}

double textWidth(std::string_view text, double size)
{
    constexpr double kWidthPerSize = 0.6; // of the wider common sans-serif fonts [1]
    const auto       letters       = std::count_if(text.begin(), text.end(), [](char c) { return (c & 0xC0) != 0x80; });
    return kWidthPerSize * size * double(letters);
}

void SvgDrawing::line(glm::dvec2 from, glm::dvec2 to, const Stroke& stroke)
{
    body_ += "<line" + attribute("x1", from.x) + attribute("y1", from.y) + attribute("x2", to.x) +
             attribute("y2", to.y) + attributes(stroke) + "/>\n";
}

void SvgDrawing::rectangle(glm::dvec2 corner, glm::dvec2 size, std::string_view fill, const Stroke& stroke)
{
    body_ += "<rect" + attribute("x", corner.x) + attribute("y", corner.y) + attribute("width", size.x) +
             attribute("height", size.y) + attribute("fill", fill) + attributes(stroke) + "/>\n";
}

void SvgDrawing::circle(glm::dvec2 centre, double radius, std::string_view fill, const Stroke& stroke)
{
    body_ += "<circle" + attribute("cx", centre.x) + attribute("cy", centre.y) + attribute("r", radius) +
             attribute("fill", fill) + attributes(stroke) + "/>\n";
}

void SvgDrawing::path(std::string_view commands, std::string_view fill, const Stroke& stroke)
{
    body_ += "<path" + attribute("d", commands) + attribute("fill", fill) + attributes(stroke) +
             " stroke-linejoin=\"round\" stroke-linecap=\"round\"/>\n";
}

void SvgDrawing::text(glm::dvec2 at, std::string_view content, const TextStyle& style)
{
    constexpr std::array<std::string_view, 3> kAnchors = {"start", "middle", "end"};
    body_ += "<text" + attribute("x", at.x) + attribute("y", at.y) + attribute("font-size", style.size) +
             attribute("text-anchor", kAnchors[std::size_t(style.anchor)]) + attribute("fill", style.colour);
    if (style.bold) body_ += attribute("font-weight", "bold");
    if (!style.upright) body_ += attribute("transform", "rotate(-90 " + svgPoint(at) + ")");
    if (style.halo) body_ += " stroke=\"#ffffff\" stroke-width=\"3\" stroke-linejoin=\"round\" paint-order=\"stroke\"";
    body_ += ">" + escaped(content) + "</text>\n";
}

void SvgDrawing::image(glm::dvec2 corner, glm::dvec2 size, const Image& image)
{
    body_ += "<image" + attribute("x", corner.x) + attribute("y", corner.y) + attribute("width", size.x) +
             attribute("height", size.y) + " preserveAspectRatio=\"none\" style=\"image-rendering:pixelated\"" +
             " href=\"data:image/png;base64," + base64(encodePng(image)) + "\"/>\n";
}

void SvgDrawing::beginClip(glm::dvec2 corner, glm::dvec2 size)
{
    body_ += "<svg" + attribute("x", corner.x) + attribute("y", corner.y) + attribute("width", size.x) +
             attribute("height", size.y) + attribute("viewBox", svgPoint(corner) + " " + svgPoint(size)) +
             " overflow=\"hidden\">\n";
}

void SvgDrawing::endClip()
{
    body_ += "</svg>\n";
}

std::string SvgDrawing::finish(glm::dvec2 size, std::string_view title) const
{
    return "<svg xmlns=\"http://www.w3.org/2000/svg\"" + attribute("width", size.x) + attribute("height", size.y) +
           attribute("viewBox", "0 0 " + svgPoint(size)) + " role=\"img\"" + attribute("aria-label", title) +
           " font-family=\"sans-serif\">\n<rect" + attribute("width", size.x) + attribute("height", size.y) +
           " fill=\"#ffffff\"/>\n" + body_ + "</svg>\n";
}

} // namespace palp
