#pragma once
#include <cstdint>
#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>

#include "engine/tools/gui/panel_desk.h"
#include "engine/tools/plot/colour_map.h"

// Internal to the panels of engine/tools/gui, in builds with Dear ImGui.

namespace palp {

/// What a text or a mark tells by its colour, beside its words.
enum class Tone {
    plain,
    faint,  ///< of labels and hints
    accent, ///< of what is chosen, and of first curves
    second, ///< of second curves
    good,
    warning,
    fault
};

/// The colour of a tone on this ground, with enough contrast for texts.
[[nodiscard]] Rgb8 colourOf(Tone tone, bool dark);

/// A colour as ImGui's draw lists take it. \param alpha  0 to 1 [1]
[[nodiscard]] std::uint32_t packed(Rgb8 colour, double alpha = 1);

/// printf for short texts: numbers of a fixed number of decimals keep their place.
[[gnu::format(printf, 1, 2)]] [[nodiscard]] std::string formatted(const char* format, ...);

/// A line of text in a tone. With `wrapped` it goes on in further lines.
void toned(const PanelDesk& desk, Tone tone, std::string_view text);
void tonedWrapped(const PanelDesk& desk, Tone tone, std::string_view text);

/// A label on the left; what comes next takes the rest of the line.
void labelled(const PanelDesk& desk, const char* label, const char* tip = nullptr);

/// A value of two that share a line: label on the left, number on the right of its half, so that digits do not move.
enum class Half { left, right };
void reading(const PanelDesk& desk, Half half, const char* label, std::string_view value, Tone tone = Tone::plain);
/// The same over the whole line.
void reading(const PanelDesk& desk, const char* label, std::string_view value, Tone tone = Tone::plain);

/// How old the plate's answer in use is: in colour, and in words once it is stale.
void readingOfAge(const PanelDesk& desk, Half half, const char* label);

/// Buttons side by side over the rest of the line, of which one is chosen. \return a click on another one
[[nodiscard]] std::optional<int> segments(const PanelDesk& desk, const char* id, int chosen,
                                          std::initializer_list<const char*> names);

/// A word on a filled ground, in the line of text that is being written.
void badge(const char* text, Rgb8 fill);

/// A sentence that shows while the pointer rests on the last item.
void tip(const char* text);

/// A button that is grey if it cannot be pressed. \return pressed
[[nodiscard]] bool buttonIf(bool enabled, const char* label, const char* what);

} // namespace palp
