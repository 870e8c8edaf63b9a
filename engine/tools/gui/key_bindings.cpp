#include "engine/tools/gui/key_bindings.h"

#include <algorithm>

#include "engine/tools/gui/controls.h"

namespace palp {
namespace {

/// Steps to the next value of an enumeration of `count`.
template <class Choice>
void step(Choice& choice, int count)
{
    choice = Choice((int(choice) + 1) % count);
}

void flip(bool& choice)
{
    choice = !choice;
}

using enum KeyModifier;
using enum KeyScope;
using enum KeyGroup;

// clang-format off
constexpr KeyBinding kBindings[] = {
    {0, none, always, view, "left drag", "orbit", nullptr},
    {0, none, always, view, "right or shift drag", "pan", nullptr},
    {0, none, nothingHidden, view, "middle drag", "orbit while painting", nullptr},
    {0, none, always, view, "wheel", "zoom", nullptr},
    {0, none, always, view, "double click", "set the pivot", nullptr},
    {'F', none, always, view, "F", "frame the object", [](Controls& c) { c.frameObject(); }, "F frame"},
    {'R', none, always, view, "R", "reset, also a fault", [](Controls& c) { c.reset(); }, "R reset"},
    {'O', none, always, view, "O", "orthographic", [](Controls& c) { c.state().camera = otherProjection(c.state().camera); }, "O orthographic"},
    {'1', none, always, view, "1", "along the axes", [](Controls& c) { c.lookFrom({0, -1, 0}); }},
    {'3', none, always, view, "3", nullptr, [](Controls& c) { c.lookFrom({1, 0, 0}); }},
    {'7', none, always, view, "7", nullptr, [](Controls& c) { c.lookFrom({0, 0, 1}); }},

    {'V', none, nothingHidden, show, "V", "next quantity in colours", [](Controls& c) { step(c.state().look.paint, 3); }, "V quantity"},
    {'C', none, always, show, "C", "next colour map", [](Controls& c) { step(c.state().look.map, 3); }, "C colours"},
    {'L', none, always, show, "L", "light or dark", [](Controls& c) { step(c.state().look.ground, 2); }, "L light"},
    {'X', none, always, show, "X", "exaggeration", [](Controls& c) { c.exaggerateMore(); }},
    {'G', none, always, show, "G", "surface at rest", [](Controls& c) { flip(c.state().look.overlays.ghost); }},
    {'S', none, always, show, "S", "fitted sphere", [](Controls& c) { flip(c.state().look.overlays.sphere); }},
    {'J', none, nothingHidden, show, "J", "projected points", [](Controls& c) { flip(c.state().look.overlays.projected); }},
    {'U', none, always, show, "U", "curvature of a shell", [](Controls& c) { flip(c.state().look.overlays.curvature); }},

    {0, none, always, touch, "hold Space or H", "touch; wheel is depth", nullptr, "Space touch, wheel depth"},
    {kEscapeKey, none, always, touch, "Esc", "let go of the object", [](Controls& c) { c.letGo(); }},
    {'K', none, always, touch, "K", "clutch of a device", [](Controls& c) { c.toggleClutch(); }},
    {'M', none, somethingHidden, touch, "M", "declare a nodule here", [](Controls& c) { c.declare(); }, "M declare"},
    {'B', none, nothingHidden, touch, "B", "paint instead of touch", [](Controls& c) { c.switchTool(); }, "B brush"},
    {'[', none, nothingHidden, touch, "[", "size of the brush", [](Controls& c) { c.resizeBrush(0.8); }, nullptr, true},
    {']', none, nothingHidden, touch, "]", nullptr, [](Controls& c) { c.resizeBrush(1.25); }, nullptr, true},
    {'Z', control, nothingHidden, touch, "Ctrl+Z", "undo, redo", [](Controls& c) { c.undo(); }, nullptr, true},
    {'Y', control, nothingHidden, touch, "Ctrl+Y", nullptr, [](Controls& c) { c.redo(); }, nullptr, true},
    {'S', control, nothingHidden, touch, "Ctrl+S", "save what is painted", [](Controls& c) { c.savePaint(); }},
    {kF5Key, none, always, touch, "F5", "record, mark a moment", [](Controls& c) { c.toggleRecording(); }, "F5 record"},
    {kF7Key, none, always, touch, "F7", nullptr, [](Controls& c) { c.mark(); }},
    {kF6Key, none, nothingHidden, touch, "F6", "replay the last recording", [](Controls& c) { c.replayLast(); }},

    {kTabKey, none, nothingHidden, program, "Tab", "panels", [](Controls& c) { flip(c.state().panels); }},
    {'T', none, always, program, "T", "texts", [](Controls& c) { flip(c.state().texts); }},
    {'P', none, always, program, "P", "picture, with panels", [](Controls& c) { c.savePicture(Controls::Shot::still); }, "P picture"},
    {'P', shift, always, program, "Shift+P", nullptr, [](Controls& c) { c.savePicture(Controls::Shot::window); }},
    {kF1Key, none, always, program, "F1", "this sheet", [](Controls& c) { c.toggleKeySheet(); }},
    {0, none, always, program, "close the window", "quit", nullptr},
};
// clang-format on

bool applies(KeyScope scope, bool hidden)
{
    return scope == always || (scope == somethingHidden) == hidden;
}

const char* refusal(KeyScope scope)
{
    return scope == somethingHidden ? "M declares a hidden nodule; nothing is hidden in this scene"
                                    : "not while something is hidden: it would show where, or end the hunt";
}

const KeyBinding* bindingOf(int key, KeyModifier modifier)
{
    const auto* const found = std::ranges::find_if(
        kBindings, [&](const KeyBinding& b) { return b.act && b.key == key && b.modifier == modifier; });
    return found == std::end(kBindings) ? nullptr : found;
}

} // namespace

std::span<const KeyBinding> keyBindings()
{
    return kBindings;
}

void handleKey(const KeyPress& press, Controls& controls)
{
    const KeyBinding* bound = bindingOf(press.key, press.control ? control : press.shift ? shift : none);
    if (!bound && !press.control) bound = bindingOf(press.key, none); // Shift alone changes nothing else
    if (!bound || (press.repeats && !bound->repeats)) return;
    if (!applies(bound->scope, controls.state().blind)) return controls.say(refusal(bound->scope));
    bound->act(controls);
}

std::vector<KeyLine> keyLines(bool hidden)
{
    std::vector<KeyLine> lines;
    for (const KeyBinding& binding : kBindings) {
        if (!applies(binding.scope, hidden)) continue;
        if (binding.help)
            lines.push_back({binding.group, binding.label, binding.help});
        else
            lines.back().keys += std::string("  ") + binding.label;
    }
    return lines;
}

std::string keyLine(bool hidden)
{
    std::string line;
    for (const KeyBinding& binding : kBindings)
        if (binding.brief && applies(binding.scope, hidden))
            line += (line.empty() ? "" : ", ") + std::string(binding.brief);
    return line;
}

} // namespace palp
