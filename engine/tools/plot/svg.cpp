#include "engine/tools/plot/svg.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

#include "engine/core/contract.h"
#include "engine/core/shown_text.h"

namespace palp {
namespace {

std::string escaped(std::string_view text)
{
    std::string safe;
    while (!text.empty()) {
        const std::size_t length = firstCharacter(text).bytes; // a file name need not be UTF-8, XML must
        const char        c      = text.front();
        if (length == 0)
            safe += '?';
        else if (c == '&')
            safe += "&amp;";
        else if (c == '<')
            safe += "&lt;";
        else if (c == '>')
            safe += "&gt;";
        else if (c == '"')
            safe += "&quot;";
        else if (static_cast<unsigned char>(c) < ' ')
            safe += ' '; // XML 1.0 has no control characters
        else
            safe += text.substr(0, length);
        text.remove_prefix(std::max<std::size_t>(1, length));
    }
    return safe;
}

std::string attribute(std::string_view name, std::string_view value)
{
    return std::string(" ").append(name).append("=\"").append(escaped(value)).append("\"");
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

std::string pairOf(glm::dvec2 numbers)
{
    return svgNumber(numbers.x).append(" ").append(svgNumber(numbers.y));
}

} // namespace

std::string svgNumber(double value)
{
    PALP_EXPECT(std::abs(value) < 1e7, "a coordinate lies near the picture; found " + std::to_string(value));
    const double         rounded = std::round(100 * value) / 100;
    std::array<char, 32> text{};
    return {text.data(),
            std::to_chars(text.data(), text.data() + text.size(), rounded == 0 ? 0 : rounded, std::chars_format::fixed)
                .ptr};
}

double textWidth(std::string_view text, double size)
{
    constexpr double kWidthPerSize = 0.6; // of the wider common sans-serif fonts [1]
    const auto       letters       = std::count_if(text.begin(), text.end(), [](char c) { return (c & 0xC0) != 0x80; });
    return kWidthPerSize * size * double(letters);
}

SvgPath::SvgPath(std::initializer_list<glm::dvec2> corners)
{
    for (glm::dvec2 corner : corners) lineTo(corner);
}

SvgPath& SvgPath::moveTo(glm::dvec2 point)
{
    commands_.append("M").append(pairOf(point));
    return *this;
}

SvgPath& SvgPath::lineTo(glm::dvec2 point)
{
    commands_.append(commands_.empty() ? "M" : "L").append(pairOf(point));
    return *this;
}

SvgPath& SvgPath::dotAt(glm::dvec2 point)
{
    moveTo(point);
    commands_.append("h0");
    return *this;
}

SvgPath& SvgPath::close()
{
    commands_.append("Z");
    return *this;
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

void SvgDrawing::path(const SvgPath& path, std::string_view fill, const Stroke& stroke)
{
    body_ += "<path" + attribute("d", path.commands()) + attribute("fill", fill) + attributes(stroke) +
             " stroke-linejoin=\"round\" stroke-linecap=\"round\"/>\n";
}

void SvgDrawing::text(glm::dvec2 at, std::string_view content, const TextStyle& style)
{
    constexpr std::array<std::string_view, 3> kAnchors = {"start", "middle", "end"};
    body_ += "<text" + attribute("x", at.x) + attribute("y", at.y) + attribute("font-size", style.size) +
             attribute("text-anchor", kAnchors[std::size_t(style.anchor)]) + attribute("fill", style.colour);
    if (style.bold) body_ += attribute("font-weight", "bold");
    if (!style.upright) body_ += attribute("transform", std::string("rotate(-90 ").append(pairOf(at)).append(")"));
    if (style.halo) body_ += " stroke=\"#ffffff\" stroke-width=\"3\" stroke-linejoin=\"round\" paint-order=\"stroke\"";
    body_.append(">").append(escaped(content)).append("</text>\n");
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
             attribute("height", size.y) + attribute("viewBox", pairOf(corner) + " " + pairOf(size)) +
             " overflow=\"hidden\">\n";
}

void SvgDrawing::endClip()
{
    body_ += "</svg>\n";
}

std::string SvgDrawing::finish(glm::dvec2 size, std::string_view title) const
{
    return "<svg xmlns=\"http://www.w3.org/2000/svg\"" + attribute("width", size.x) + attribute("height", size.y) +
           attribute("viewBox", std::string("0 0 ").append(pairOf(size))) + " role=\"img\"" +
           attribute("aria-label", title) + " font-family=\"sans-serif\">\n<rect" + attribute("width", size.x) +
           attribute("height", size.y) + " fill=\"#ffffff\"/>\n" + body_ + "</svg>\n";
}

} // namespace palp
