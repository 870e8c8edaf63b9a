#include "engine/tools/gui/workbench.h"

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <utility>

#include <glm/geometric.hpp>

#include "engine/core/contract.h"
#include "engine/core/quantity.h"
#include "engine/session/drawn_load.h"
#include "engine/tools/gui/background_work.h"
#include "engine/tools/gui/key_bindings.h"
#include "engine/tools/gui/panel_layout.h"
#include "engine/tools/gui/scene_controls.h"
#include "engine/tools/gui/touch_faults.h"

namespace palp {
namespace {

using Clock   = std::chrono::steady_clock;
using Seconds = std::chrono::duration<double>;

bool inContact(const SessionView* view)
{
    return view && glm::length(view->record.normal) > 0;
}

/// Returns "points 500, thickness 4 mm".
std::string inWords(const SceneValues& values)
{
    std::string words;
    for (const auto& [key, value] : values) words += (words.empty() ? "" : ", ") + key + " " + value;
    return words;
}

/// Returns " × 3" for a device whose millimetre is three of the scene; the pointer is in the scene.
std::string scaleOf(const Scene& scene, bool byPointer)
{
    return byPointer || scene.workspaceScale == 1 ? "" : " \u00d7 " + shortNumber(scene.workspaceScale);
}

} // namespace

Workbench::Workbench(WorkbenchSettings settings, Screen& screen)
    : settings_(std::move(settings)), screen_(screen), state_(settings_.state), notices_(settings_.complained),
      object_(settings_), session_(settings_, notices_), paint_(notices_), camera_(state_.camera, settings_.camera),
      pictures_(screen), controls_({state_, notices_, object_, session_, paint_, camera_, pictures_, texts_})
{
}

WorkbenchReport Workbench::run(const Poll& poll, PanelFrame* panels)
{
    poll_    = poll;
    panels_  = PanelLayer(panels);
    started_ = Clock::now();
    controls_.setPanels(panels_.exist());
    try {
        openFirst();
        while (!closing_) {
            session_.rearm();
            takeRequests();
            if (session_.halted())
                frame(nullptr);
            else
                touch();
        }
    } catch (...) { // the display or what draws on it has gone
        if (keepPaint() && settings_.complained) settings_.complained(notices_.message());
        throw;
    }
    session_.endRecording();
    WorkbenchReport& report = pictures_.report();
    const bool       kept   = keepPaint();
    if (kept) report.said = notices_.message();
    report.hasLost  = session_.recorder().hasLost() || (object_.hasStage() && paint_.unsaved(object_.stage()));
    report.realTime = session_.realTime();
    return std::move(report);
}

/// Saves what is painted and not saved: here, or where else there may be room for it.
/// \return whether a file was written, which notices_ names
bool Workbench::keepPaint()
{
    if (!object_.hasStage() || !paint_.unsaved(object_.stage())) return false;
    const char* const home = std::getenv("HOME");
    std::error_code   none;
    for (const auto& folder :
         {std::filesystem::path(), std::filesystem::path(home ? home : ""), std::filesystem::temp_directory_path(none)})
        if (paint_.save(object_.stage(), folder)) return true;
    return false;
}

/// Does the work on another thread; the window stays responsive, keeps its picture and names the activity.
/// \return what the work returns
/// \throws what the work throws
template <class Work>
auto Workbench::meanwhile(const std::string& activity, Work work)
{
    struct Activity { // ends whatever happens
        Notices& notices;
        ~Activity() { notices.setActivity(""); }
    } const ends{notices_};
    bool begun = false;
    return inBackground(std::move(work), [&] {
        if (!std::exchange(begun, true)) notices_.setActivity(activity);
        if (handAdvice_.take()) notices_.setActivity(*handAdvice_.held());
        frame(nullptr);
        return !closing_;
    });
}

/// Opens the first object, and shows only words meanwhile.
void Workbench::openFirst()
{
    OpenedObject opened = inBackground(object_.opener(settings_.what, settings_.values), [this] {
        drawWords();
        return !closing_;
    });
    if (closing_) return;
    adopt(std::move(opened));
    controls_.resetView();
    if (settings_.welcome.empty() || state_.blind) return; // it names what a hunt does not have
    const std::string& said = notices_.message();
    notices_.say(settings_.welcome + (said.empty() ? "" : ". " + said));
}

/// Shows the name of what is being opened.
void Workbench::drawWords()
{
    input_ = poll_(0);
    if (input_.closing || (settings_.stop && *settings_.stop)) closing_ = true;
    ViewScene scene;
    scene.ground = state_.look.ground;
    scene.title  = fileNameOf(settings_.what);
    scene.note   = "opening the object ...";
    pictures_.showWords(scene, state_.camera, input_.size, input_.scale);
}

/// Does what the user has asked for since the last session began.
void Workbench::takeRequests()
{
    const auto mayDiscard = [this](const std::string& request) { return paint_.mayDiscard(object_.stage(), request); };
    if (const std::string what = object_.takeRequestedObject(); !what.empty() && mayDiscard(what)) openOther(what);
    if (const SceneValues wanted = object_.takeRequestedValues(); !wanted.empty()) takeValues(wanted);
}

void Workbench::openOther(const std::string& what)
{
    try {
        OpenedObject opened = meanwhile("opening " + fileNameOf(what) + " ...", object_.opener(what, {}));
        notices_.clearFaults();
        adopt(std::move(opened));
        object_.setValues({}); // the values were for another object
        controls_.resetView();
    } catch (const Error& error) {
        notices_.complain(error.what());
    }
}

void Workbench::takeValues(const SceneValues& wanted)
{
    SceneValues values = object_.valuesWith(wanted);
    try {
        const Scene scene = object_.sceneWith(values);
        if (haveSameCloud(scene, object_.stage().scene())) {
            object_.stage().change(scene);
            fixScales();
            session_.forgetSolver();
            paint_.forgetWarning();
        } else if (paint_.mayDiscard(object_.stage(), inWords(wanted))) {
            object_.adopt(meanwhile("reading " + fileNameOf(scene.cloud) + " again ...",
                                    [scene] { return std::make_unique<Stage>(scene); }));
            useObject();
        } else {
            return;
        }
        if (session_.replaying()) notices_.say("the replay has ended, because the scene has changed");
        session_.stopReplay();
        object_.setValues(std::move(values));
        notices_.clearFaults();
    } catch (const Error& error) {
        notices_.complain(error.what());
    }
}

void Workbench::adopt(OpenedObject opened)
{
    session_.stopReplay();
    if (settings_.opened) settings_.opened(opened.what);
    if (settings_.offered) offered_ = settings_.offered();
    object_.adopt(std::move(opened));
    if (settings_.titled) settings_.titled(object_.fileName());
    useObject();
    if (!object_.recorded()) return tellAssumptions();
    const RecordedSession& recorded = *object_.recorded();
    session_.startReplay(recorded);
    if (!recorded.cloud.empty() && recorded.cloud != fingerprint(object_.stage().object().cloud()))
        notices_.complain("the cloud is not the recorded one: " + object_.stage().scene().cloud + " has changed");
    if (!recorded.whyIncomplete.empty())
        notices_.complain(recorded.folder.string() + " is not complete: " + recorded.whyIncomplete);
    for (const std::string& doubt : recorded.doubts) notices_.complain(doubt);
}

/// Shows what was assumed of the cloud, as a message and not as a fault.
void Workbench::tellAssumptions()
{
    if (!settings_.assumed) return;
    std::string all;
    for (const std::string& sentence : settings_.assumed(object_.stage().scene(), object_.stage().report())) {
        all += (all.empty() ? "" : "; ") + sentence;
        if (settings_.complained) settings_.complained(sentence);
    }
    if (!all.empty()) notices_.say(all);
}

/// Fixes the ends of the scales of colours and arrows, so that a deeper dent or stronger force always looks so.
void Workbench::fixScales()
{
    const Scene& scene    = object_.stage().scene();
    const double limit    = scene.patch.large == Large::on ? 2 : 0.5; // of the theory's trust, in thicknesses [1]
    state_.look.deepest   = limit * scene.material.thickness;
    state_.look.strongest = 0.5 * scene.maxForce;
}

/// Begins anew with the object on the stage: the hand over it, the brush, and what may be shown of it.
void Workbench::useObject()
{
    Stage&       stage = object_.stage();
    const Scene& scene = stage.scene();
    session_.setStage(stage);
    paint_.startAnew();
    state_.pressDepth   = 0.4 * scene.material.thickness;
    state_.brush.radius = std::clamp(scene.patch.footprintRadius, BrushChoice::kSmallest, BrushChoice::kLargest);
    state_.brush.value  = contrastIn(stage.painted().cloud());
    fixScales();
    state_.blind = scene.overlay != nullptr;
    if (!state_.blind) return;
    state_.look.paint              = ViewPaint::plain; // no colours show the hidden nodules
    state_.look.overlays.projected = false;
    state_.tool                    = Tool::touch;
}

/// Touches until something asks for another session.
void Workbench::touch()
{
    try {
        session_.run([this] { return readyHand(); }, [this](const SessionView& view) { frame(&view); });
    } catch (const Error& error) {
        if (session_.neverRan()) throw; // nothing has worked yet: the program ends with the error
        notices_.complain(error.what());
        session_.halt();
    }
}

/// Returns the hand that the program gives; nothing if the user lets go or closes the window meanwhile.
std::optional<WorkbenchHand> Workbench::readyHand()
{
    const HandWait wait{session_.givenUp(), [this](const std::string& advice) {
                            handAdvice_.draft() = advice;
                            handAdvice_.publish();
                        }};
    try {
        return meanwhile("getting the hand ready; Esc cancels", [&] { return settings_.hand(object_.stage(), wait); });
    } catch (const Error&) {
        if (session_.givenUp()) return std::nullopt;
        throw;
    }
}

/// Handles one picture: input, touch and drawing.
void Workbench::frame(const SessionView* view)
{
    input_ = poll_(pictures_.patience(input_.size));
    input_ = panels_.begin(std::move(input_), state_.look.ground == Ground::dark, pictures_.resized(input_.size));
    handle();
    settleCamera();
    session_.collect(object_.isFirst() ? settings_.onTick : OnTick{});
    if (view) session_.noteRealTime(view->warning);
    if (settings_.seconds > 0 && Seconds(Clock::now() - started_).count() > settings_.seconds) closing_ = true;
    if (settings_.stop && *settings_.stop) closing_ = true;
    if (closing_) session_.end();
    const bool active = input_.any() || input_.panelsTakePointer || inContact(view) || session_.replaying() ||
                        session_.recorder().recording() || pictures_.resized(input_.size);
    if (active || std::exchange(noticesDrawn_, notices_.changes()) != notices_.changes()) pictures_.changed();
    if (!closing_ && pictures_.due(input_.size)) return draw(view);
    panels_.skip();
    pictures_.rest();
}

/// Does what the user asks for. A session that must end for it first ends in zero force.
void Workbench::handle()
{
    if (input_.closing) closing_ = true;
    if (input_.leftPressed || !std::ranges::all_of(input_.keys, &KeyPress::repeats)) notices_.clearMessage();
    if (!input_.panelsTakeKeys)
        for (const KeyPress& press : input_.keys) handleKey(press, controls_);
    for (const auto& path : input_.dropped) controls_.open(path);
    controls_.followPointer(input_);
    if (camera_.followSpaceMouse()) pictures_.changed();
}

/// Puts the object into the area that the panels leave free, and moves it smoothly when they appear or disappear.
void Workbench::settleCamera()
{
    const PictureArea area =
        panels_.exist() ? freeArea(state_, input_.size, input_.scale) : PictureArea{{0, 0}, glm::dvec2(input_.size)};
    if (camera_.settle(object_.stage().painted().cloud().bounds(), area, input_.size, pictures_.sinceBegin(),
                       pictures_.resized(input_.size)))
        pictures_.changed();
}

void Workbench::draw(const SessionView* view)
{
    pictures_.begin(input_.size);
    showTouch(view);
    const PanelWishes wishes =
        panels_.due() ? panels_.draw(state_, content(view), input_.scale, screen_) : PanelWishes{};
    if (state_.texts) writeTexts(view);
    pictures_.show(object_.stage().view().scene(), state_.camera, state_.texts ? texts_.of(input_.size) : nullptr,
                   inContact(view));
    controls_.perform(wishes);
}

/// Makes the scene to draw from the object as the session has it now.
void Workbench::showTouch(const SessionView* view)
{
    Stage& stage = object_.stage();
    if (view) {
        const double force = glm::length(view->record.force);
        stage.view().show(inContact(view) || force > 0 ? view->patch : nullptr, force, state_.look,
                          TouchHand{view->record.hip, view->record.force, view->record.proxy,
                                    session_.handTurns() ? std::optional(view->record.orientation) : std::nullopt},
                          drawnLoad(view->record, view->patch, stage.scene().material));
    } else {
        stage.view().show(nullptr, 0, state_.look);
    }
    if (state_.tool != Tool::paint || input_.panelsTakePointer) return;
    if (const auto hit = stage.hitAt(state_.camera, input_.pointer, input_.size))
        stage.view().scene().brush = brushOutline(*hit, state_.brush.radius);
}

/// Writes the texts over the picture. With panels, they show what title and note would.
void Workbench::writeTexts(const SessionView* view)
{
    ViewScene& scene = object_.stage().view().scene();
    if (!panels_.exist() || !hasColumn(state_)) {
        scene.title = object_.stem();
        scene.note  = note(view);
    }
    texts_.update(scene, state_.look.overlays, state_.camera, input_.size, input_.scale);
}

std::string Workbench::note(const SessionView* view) const
{
    if (const GovernorFault fault = view ? governorFault(view->record) : GovernorFault::none;
        fault != GovernorFault::none) {
        const FaultAdvice advice = adviceOn(fault);
        return std::string("no force: ") + advice.reason + " " + advice.remedy + " R starts anew.";
    }
    if (!notices_.current().empty()) return notices_.current();
    if (!notices_.faults().empty()) return notices_.faults().back();
    if (const std::string why = session_.unsolved(); inContact(view) && !why.empty())
        return "the plate cannot be solved here: " + why;
    if (const double force = view ? glm::length(view->record.force) : 0; force > 0) return formatQuantity(force, "N");
    return state_.blind ? "hold Space and move: touch.  M: declare a nodule here"
                        : "hold Space and move: touch.  F1: keys";
}

PanelContent Workbench::content(const SessionView* view) const
{
    const Stage& stage = object_.stage();
    PanelContent now{stage.scene(), stage.painted().cloud(), session_.history()};
    now.faults = notices_.faults();
    if (view) {
        now.patch       = view->patch;
        now.force       = drawnLoad(view->record, view->patch, stage.scene().material);
        now.loopPeriod  = view->loopPeriod;
        now.solveTime   = view->solveTime;
        now.touching    = inContact(view);
        now.hand        = session_.handModel() + scaleOf(stage.scene(), session_.byPointer());
        now.deviceWords = view->words;
        if (const std::string why = session_.unsolved(); !why.empty())
            now.faults.push_back("the plate cannot be solved here: " + why);
    }
    now.frameTime       = pictures_.frameTime();
    now.solvedOn        = stage.solvedOn();
    now.takeover        = session_.takeover();
    now.drawnOn         = screen_.processor().name;
    now.drawnInSoftware = screen_.processor().kind == compute::ProcessorKind::software;
    now.replaying       = session_.replaying();
    now.recording       = session_.recorder().recording() ? session_.recorder().folder() : "";
    now.title           = object_.fileName();
    now.painted         = paint_.unsaved(stage);
    now.canUndo         = stage.painting().canUndo();
    now.canRedo         = stage.painting().canRedo();
    now.message         = notices_.current();
    now.realTime        = session_.realTime();
    now.offered         = offered_;
    return now;
}

} // namespace palp
