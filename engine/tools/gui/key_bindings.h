#pragma once
#include <span>
#include <string>
#include <vector>

#include "engine/tools/gui/input.h"

namespace palp {

class Controls;

enum class KeyModifier { none, control, shift };

/// The parts of the sheet of keys.
enum class KeyGroup { view, show, touch, program };

/// When a binding applies. In a hunt something is hidden in the object, and no key may show where.
enum class KeyScope { always, nothingHidden, somethingHidden };

/// A key, or something done with the mouse, and what it does.
struct KeyBinding {
    int         key; ///< as KeyPress::key; 0: only explained here, and handled as pointer input
    KeyModifier modifier;
    KeyScope    scope;
    KeyGroup    group;
    const char* label; ///< "Ctrl+Z"
    const char* help;  ///< what it does; null: the binding before explains this one too
    void (*act)(Controls&);
    const char* brief   = nullptr; ///< in the line of keys of a window without panels; null: omitted there
    bool        repeats = false;   ///< acts again and again while the key is held
};

/// Returns all bindings. They handle keys, the sheet of keys (F1) shows them, and a test compares the README's table.
[[nodiscard]] std::span<const KeyBinding> keyBindings();

/// Performs the action of a key. A binding that does not apply now shows a message instead.
void handleKey(const KeyPress& press, Controls& controls);

/// A line of the sheet of keys.
struct KeyLine {
    KeyGroup    group;
    std::string keys; ///< "P  Shift+P"
    std::string help;
};
/// Returns the lines of the bindings that apply.
/// \param hidden  something is hidden in the object
[[nodiscard]] std::vector<KeyLine> keyLines(bool hidden);

/// Returns the keys that apply as one line of text, for windows without panels.
[[nodiscard]] std::string keyLine(bool hidden);

} // namespace palp
