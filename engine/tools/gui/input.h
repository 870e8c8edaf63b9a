#pragma once
#include <filesystem>
#include <string_view>
#include <vector>

#include <glm/vec2.hpp>

namespace palp {

/// The numbers of keys without a character; any other key's number is its capital letter, digit or sign.
enum SpecialKey : int {
    kTabKey = 256,
    kEscapeKey,
    kEnterKey,
    kBackspaceKey,
    kDeleteKey,
    kLeftKey,
    kRightKey,
    kHomeKey,
    kEndKey,
    kF1Key,
    kF5Key,
    kF6Key,
    kF7Key
};

/// Returns the number of a key with a character by what the user's layout has written on it: Ctrl+Z is where Z is.
/// Digits, and keys whose character is no letter or bracket, count by their place on a keyboard of the US.
/// \param place  the number that the key has on such a keyboard
/// \param name   what it writes without modifiers, UTF-8; empty: unknown
constexpr int keyNumber(int place, std::string_view name) noexcept
{
    if (name.size() != 1 || (place >= '0' && place <= '9')) return place;
    const char written = name.front();
    if (written >= 'a' && written <= 'z') return written - 'a' + 'A';
    const bool isSign    = (written > ' ' && written < 'A') || (written > 'Z' && written < 127);
    const bool wasLetter = place >= 'A' && place <= 'Z';
    return written == '[' || written == ']' || (isSign && wasLetter) ? written : place;
}

struct KeyPress {
    int  key     = 0; ///< 'F', '7', '[', or a SpecialKey
    bool control = false, shift = false;
    bool repeats = false; ///< the key is held, and the desktop repeats it
};

/// The events in a window since the last picture.
struct WindowInput {
    glm::ivec2 size{};    ///< of the picture [px]; 0: minimised
    double     scale = 1; ///< of a display with many pixels per inch [1]
    glm::dvec2 pointer{}; ///< from the upper left corner [px]
    glm::dvec2 moved{};   ///< movement of the pointer [px]
    double     wheel = 0; ///< notches, positive away from the user

    bool left = false, right = false, middle = false; ///< buttons that are down
    bool shift = false, touch = false;                ///< keys that are held: shift; space or H
    bool leftPressed = false, doubleClick = false;    ///< since the last picture

    std::vector<KeyPress>              keys;
    std::vector<char32_t>              typed;           ///< characters, for texts
    std::vector<std::filesystem::path> dropped;         ///< files and folders dropped on the window
    bool                               closing = false; ///< the window is asked to close

    bool panelsTakePointer = false, panelsTakeKeys = false; ///< the panels take this input, not the object

    /// Returns whether any input may change the picture.
    [[nodiscard]] bool any() const
    {
        return moved != glm::dvec2(0) || wheel != 0 || left || right || middle || touch || !keys.empty() ||
               !dropped.empty() || closing;
    }
};

} // namespace palp
