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

/// The meaning of a text's or a mark's colour, beside its words.
enum class Tone {
    plain,
    faint,  ///< labels and hints
    accent, ///< chosen items and first curves
    second, ///< second curves
    good,
    warning,
    fault
};

/// Returns the colour of a tone on this ground, with enough contrast for texts.
[[nodiscard]] Rgb8 colourOf(Tone tone, bool dark);

/// Returns a colour in the format of ImGui's draw lists.
/// \param alpha  0 to 1 [1]
[[nodiscard]] std::uint32_t packed(Rgb8 colour, double alpha = 1);

/// Formats short texts as printf does: numbers with a fixed number of decimals keep their place.
[[gnu::format(printf, 1, 2)]] [[nodiscard]] std::string formatted(const char* format, ...);

/// Writes a line of text in a tone; the wrapped form continues on further lines.
void toned(const PanelDesk& desk, Tone tone, std::string_view text);
void tonedWrapped(const PanelDesk& desk, Tone tone, std::string_view text);

/// Writes a label on the left; the next item takes the rest of the line.
void labelled(const PanelDesk& desk, const char* label, const char* tip = nullptr);

/// Writes one of two values in a line: label on the left, number on the right of its half, so that digits do not move.
enum class Half { left, right };
void reading(const PanelDesk& desk, Half half, const char* label, std::string_view value, Tone tone = Tone::plain);
/// Writes a value over the whole line.
void reading(const PanelDesk& desk, const char* label, std::string_view value, Tone tone = Tone::plain);

/// Writes the age of the plate's answer in use: in colour, and in words once it is stale.
void readingOfAge(const PanelDesk& desk, Half half, const char* label);

/// Draws buttons side by side over the rest of the line, of which one is chosen.
/// \return the other button that was clicked
[[nodiscard]] std::optional<int> segments(const PanelDesk& desk, const char* id, int chosen,
                                          std::initializer_list<const char*> names);

/// Draws a word on a filled ground, in the current line of text.
void badge(const char* text, Rgb8 fill);

/// Shows a sentence while the pointer rests on the last item.
void tip(const char* text);

/// Draws a button, which is grey if it cannot be pressed.
/// \return whether it was pressed
[[nodiscard]] bool buttonIf(bool enabled, const char* label, const char* what);

} // namespace palp
