#pragma once
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "engine/cloud/detail/numbers.h"

namespace palp {

/// An element of an XML file. Texts are parts of the file.
struct XmlElement {
    std::string_view                                      name;
    std::vector<std::pair<std::string_view, std::string>> attributes; ///< entities are replaced
    std::string_view                                      text;       ///< before the first child
    std::vector<XmlElement>                               children;

    /// Returns an attribute's value; nothing if it is absent.
    [[nodiscard]] std::optional<std::string_view> attribute(std::string_view key) const;

    /// Returns the first child of a name; null if there is none.
    [[nodiscard]] const XmlElement* child(std::string_view key) const;
};

/// Reads the elements of an XML file, strictly: every element ends, attributes stand in quotes, and after the root
/// comes nothing. What VTK does not write is refused: document types, CDATA, instructions within the root.
///
/// An element called `rawName` ends the reading: what follows may be bytes that are no XML.
/// \return  the root, and whatever follows the start of the element `rawName`, which is the last child of the root then
/// \throws Error naming the line
[[nodiscard]] std::pair<XmlElement, std::string_view> parseXml(const WholeFile& file, std::string_view rawName);

} // namespace palp
