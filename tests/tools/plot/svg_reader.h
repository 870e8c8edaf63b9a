#pragma once
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "engine/tools/plot/png.h"
#include "tests/support/png_reader.h"

namespace palp::test {

struct SvgElement {
    std::string                        name;
    std::map<std::string, std::string> attributes;
    std::string                        text; ///< directly inside, entities resolved
};

/// The elements of an SVG picture in order.
/// \throws std::runtime_error if the text is not well-formed XML (of the kind that the pictures use)
std::vector<SvgElement> readSvg(std::string_view svg);

/// Texts of the picture, in order.
std::vector<std::string> textsOf(std::string_view svg);
bool                     hasText(std::string_view svg, const std::string& text);

/// Elements of one name.
std::vector<SvgElement> elementsOf(std::string_view svg, const std::string& name);

/// The picture inside the `number`th <image>.
Image embeddedImage(std::string_view svg, std::size_t number = 0);

} // namespace palp::test
