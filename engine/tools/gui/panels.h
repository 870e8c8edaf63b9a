#pragma once
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "engine/session/real_session.h"
#include "engine/tools/gui/touch_history.h"
#include "engine/tools/gui/view_state.h"

namespace palp {

/// What panels show of a session and its machine. Everything outlives the frame.
struct PanelContent {
    const Scene&             scene;
    const PointCloud&        cloud; ///< as it is painted now
    const TouchHistory&      history;
    const Patch*             patch      = nullptr;                         ///< that is drawn; may be null
    double                   force      = 0;                               ///< that bends it [N]
    double                   loopPeriod = 0, solveTime = 0, frameTime = 0; ///< [s]
    std::string              hand{};                                       ///< "mouse", "Novint Falcon"
    std::string              solvedOn{};                                   ///< device of the plate
    std::string              drawnOn{};                                    ///< of the pictures
    bool                     drawnInSoftware = false;
    bool                     touching        = false; ///< a session runs
    bool                     replaying       = false; ///< of a recording
    std::string              recording{};             ///< its folder; empty: none
    std::string              title{};                 ///< of what is touched
    bool                     painted = false, canUndo = false, canRedo = false;
    std::vector<std::string> faults{};   ///< what is wrong now, each a sentence with its remedy
    std::string              message{};  ///< of the last thing done: "saved ..."; may be empty
    std::string              realTime{}; ///< what the system refused of real-time rights; empty if nothing
};

/// What the user asked for in a panel, to be done by the window.
struct PanelWishes {
    std::map<std::string, std::string, std::less<>>
         values; ///< of scene keys, as flags take them: {"thickness", "4 mm"}
    bool frame = false, reset = false, screenshot = false, record = false, undo = false, redo = false, save = false;
    bool resetFault = false; ///< of the governor: starts the session anew
};

/// The panels over the view, with Dear ImGui: view, scene's values, touch, chart, timing, painting, keys.
/// Changes of the view happen in `state` at once, all else is a wish.
/// \pre between ImGui::NewFrame() and ImGui::Render()
/// \param scale  of a display with many pixels per inch [1]
[[nodiscard]] PanelWishes drawPanels(ViewState& state, const PanelContent& content, double scale);

} // namespace palp
