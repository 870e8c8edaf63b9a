#include "tests/tools/plot/svg_reader.h"

#include <algorithm>
#include <cstring>
#include <stdexcept>

namespace palp::test {
namespace {

[[noreturn]] void fail(const std::string& what)
{
    throw std::runtime_error("not well-formed: " + what);
}

std::string resolved(std::string_view text)
{
    std::string plain;
    for (std::size_t n = 0; n < text.size(); ++n) {
        if (text[n] == '<' || text[n] == '>') fail("bare angle bracket");
        if (text[n] != '&') {
            plain += text[n];
            continue;
        }
        const std::size_t end  = text.find(';', n);
        const std::string name = end == std::string_view::npos ? "" : std::string(text.substr(n + 1, end - n - 1));
        if (name == "amp")
            plain += '&';
        else if (name == "lt")
            plain += '<';
        else if (name == "gt")
            plain += '>';
        else if (name == "quot")
            plain += '"';
        else
            fail("entity " + name);
        n = end;
    }
    return plain;
}

SvgElement elementOf(std::string_view tag)
{
    SvgElement  element;
    std::size_t n = std::min(tag.find(' '), tag.size());
    element.name  = std::string(tag.substr(0, n));
    while (n < tag.size()) {
        if (tag[n] != ' ') fail("no space before an attribute of " + element.name);
        const std::size_t equals = tag.find("=\"", n), end = tag.find('"', equals + 2);
        if (equals == std::string_view::npos || end == std::string_view::npos) fail("attribute of " + element.name);
        const std::string name(tag.substr(n + 1, equals - n - 1));
        if (name.empty() || name.find(' ') != std::string::npos) fail("attribute name \"" + name + "\"");
        if (!element.attributes.emplace(name, resolved(tag.substr(equals + 2, end - equals - 2))).second)
            fail("attribute " + name + " twice");
        n = end + 1;
    }
    return element;
}

std::string fromBase64(std::string_view text)
{
    constexpr std::string_view kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string                bytes;
    unsigned                   bits = 0, count = 0;
    for (char c : text) {
        if (c == '=') break;
        bits = bits << 6 | unsigned(kDigits.find(c));
        count += 6;
        if (count >= 8) bytes += char(bits >> (count -= 8) & 255);
    }
    return bytes;
}

} // namespace

std::vector<SvgElement> readSvg(std::string_view svg)
{
    std::vector<SvgElement>  elements;
    std::vector<std::size_t> open;
    for (std::size_t n = 0; n < svg.size();) {
        if (svg[n] != '<') {
            const std::size_t end  = std::min(svg.find('<', n), svg.size());
            const std::string text = resolved(svg.substr(n, end - n));
            if (!open.empty())
                elements[open.back()].text += text;
            else if (text.find_first_not_of(" \n") != std::string::npos)
                fail("text outside");
            n = end;
            continue;
        }
        const std::size_t end = svg.find('>', n);
        if (end == std::string_view::npos) fail("tag without end");
        std::string_view tag = svg.substr(n + 1, end - n - 1);
        n                    = end + 1;
        if (tag.starts_with('/')) {
            if (open.empty() || elements[open.back()].name != tag.substr(1)) fail("end of " + std::string(tag));
            open.pop_back();
            continue;
        }
        if (open.empty() && !elements.empty()) fail("second root");
        const bool empty = tag.ends_with('/');
        if (empty) tag.remove_suffix(1);
        elements.push_back(elementOf(tag));
        if (!empty) open.push_back(elements.size() - 1);
    }
    if (!open.empty()) fail("no end of " + elements[open.back()].name);
    return elements;
}

std::vector<SvgElement> elementsOf(std::string_view svg, const std::string& name)
{
    std::vector<SvgElement> elements = readSvg(svg);
    std::erase_if(elements, [&](const SvgElement& e) { return e.name != name; });
    return elements;
}

std::vector<std::string> textsOf(std::string_view svg)
{
    std::vector<std::string> texts;
    for (const SvgElement& e : elementsOf(svg, "text")) texts.push_back(e.text);
    return texts;
}

bool hasText(std::string_view svg, const std::string& text)
{
    const auto texts = textsOf(svg);
    return std::find(texts.begin(), texts.end(), text) != texts.end();
}

Image embeddedImage(std::string_view svg, std::size_t number)
{
    constexpr std::string_view kStart = "data:image/png;base64,";
    const std::string          href   = elementsOf(svg, "image").at(number).attributes.at("href");
    if (!href.starts_with(kStart)) throw std::runtime_error("no embedded PNG");
    return decodePng(fromBase64(std::string_view(href).substr(kStart.size())));
}

} // namespace palp::test
