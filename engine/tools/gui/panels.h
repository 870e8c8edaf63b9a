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

/// The content of the panels: a session and its machine. Everything outlives the frame.
struct PanelContent {
    const Scene&             scene;
    const PointCloud&        cloud; ///< with its present paint
    const TouchHistory&      history;
    const Patch*             patch      = nullptr;                         ///< the drawn one; may be null
    double                   force      = 0;                               ///< bends the patch [N]
    double                   loopPeriod = 0, solveTime = 0, frameTime = 0; ///< [s]
    std::string              hand{};                                       ///< "mouse", "Novint Falcon"
    std::string              deviceWords{};                                ///< about its present fault; may be empty
    std::string              solvedOn{};                                   ///< solver of the plate
    std::string              takeover{}; ///< who took over from it, and why; may be empty
    std::string              drawnOn{};  ///< processor of the pictures
    bool                     drawnInSoftware = false;
    bool                     touching        = false; ///< a session runs
    bool                     replaying       = false; ///< of a recording
    std::string              recording{};             ///< its folder; empty: none
    std::string              title{};                 ///< of what is touched
    bool                     painted = false, canUndo = false, canRedo = false;
    std::vector<std::string> faults{};   ///< present faults, each a sentence with its remedy
    std::string              message{};  ///< on the last action: "saved ..."; may be empty
    std::string              realTime{}; ///< real-time rights that the system refused; empty if none
    std::vector<std::string> offered{};  ///< objects that can be opened: samples, and files opened last; may be empty
};

/// The user's requests in the panels, to be met by the window.
struct PanelWishes {
    std::map<std::string, std::string, std::less<>>
         values; ///< of scene keys, as flags take them: {"thickness", "4 mm"}
    bool frame = false, reset = false, screenshot = false, record = false, undo = false, redo = false, save = false;
    bool tool       = false; ///< changes between touch and paint
    bool resetFault = false; ///< of the governor: starts the session anew
    std::string open{};      ///< an object of those offered; empty: none
};

/// Draws the panels over the view, with Dear ImGui: view, scene's values, touch, chart, timing, painting, keys.
/// Changes of the view are made in `state` at once; all others are returned as wishes.
/// \pre between ImGui::NewFrame() and ImGui::Render()
/// \param scale  of a display with many pixels per inch [1]
[[nodiscard]] PanelWishes drawPanels(ViewState& state, const PanelContent& content, double scale);

} // namespace palp
