#pragma once
#include <filesystem>
#include <vector>

#include <glm/vec2.hpp>

namespace palp {

/// Keys that are no characters; all others are their capital letter, digit or sign.
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
    kF6Key
};

struct KeyPress {
    int  key     = 0; ///< 'F', '7', '[', or a SpecialKey
    bool control = false, shift = false;
};

/// What happened in a window since the last picture.
struct WindowInput {
    glm::ivec2 size{};    ///< of the picture [px]; 0: minimised
    double     scale = 1; ///< of a display with many pixels per inch [1]
    glm::dvec2 pointer{}; ///< from the upper left corner [px]
    glm::dvec2 moved{};   ///< by the pointer [px]
    double     wheel = 0; ///< notches, away from the user [1]

    bool left = false, right = false, middle = false; ///< buttons that are down
    bool shift = false, touch = false;                ///< keys that are held: shift; space or H
    bool leftPressed = false, doubleClick = false;    ///< just now

    std::vector<KeyPress>              keys;
    std::vector<char32_t>              typed;           ///< characters, for texts
    std::vector<std::filesystem::path> dropped;         ///< files and folders that were let fall here
    bool                               closing = false; ///< somebody asks the window to close

    bool panelsTakePointer = false, panelsTakeKeys = false; ///< what follows is not for the object

    /// Whether anything is there that may change the picture.
    [[nodiscard]] bool any() const
    {
        return moved != glm::dvec2(0) || wheel != 0 || left || right || middle || touch || !keys.empty() ||
               !dropped.empty() || closing;
    }
};

} // namespace palp
