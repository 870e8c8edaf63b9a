#include "engine/session/marker.h"

#include "engine/core/shown_text.h"

namespace palp {
std::string markerText(std::string_view bytes)
{
    constexpr std::string_view kUnknown = "\xEF\xBF\xBD";
    std::string                text;
    while (!bytes.empty()) {
        const Utf8Character    next  = firstCharacter(bytes);
        const std::string_view piece = next.bytes == 0        ? kUnknown
                                       : isControl(next.code) ? std::string_view(" ")
                                                              : bytes.substr(0, next.bytes);
        if (text.size() + piece.size() > kMostOfMarker) break;
        if (!(text.empty() && piece == " ")) text += piece;
        bytes.remove_prefix(next.bytes == 0 ? 1 : next.bytes);
    }
    text.resize(text.find_last_not_of(' ') + 1);
    return text.empty() ? "marker" : text;
}

} // namespace palp
