#pragma once
#include <cstddef>
#include <string>
#include <string_view>

namespace palp {

/// A moment that somebody marked while a session ran: a key, a word of another program.
struct Marker {
    double      time = 0; ///< [s] of the newest tick then
    std::string text;     ///< as markerText() makes it
};

/// Most bytes of a marker's text.
inline constexpr std::size_t kMostOfMarker = 256;

/// Makes any bytes into the text of a marker: one line of UTF-8 of at most kMostOfMarker bytes. Control characters
/// become blanks and are dropped at both ends, and each byte that is not UTF-8 becomes U+FFFD, so that the text is
/// harmless in a terminal and in JSON. What is empty then becomes "marker".
[[nodiscard]] std::string markerText(std::string_view bytes);

} // namespace palp
