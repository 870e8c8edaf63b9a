#include "engine/tools/gui/workbench.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>

#include <glm/geometric.hpp>

#include "engine/core/contract.h"
#include "engine/core/quantity.h"
#include "engine/tools/gui/panel_frame.h"
#include "engine/tools/gui/panel_layout.h"

namespace palp {
namespace {

using Seconds = std::chrono::duration<double>;

constexpr double kFramePeriod = 1.0 / 60; ///< no display shows more [s]
constexpr double kLong        = 1e9;      ///< of a session that ends when somebody says so [s]

bool inContact(const SessionView* view)
{
    return view && glm::length(view->sample.normal) > 0;
}

} // namespace

Workbench::Workbench(WorkbenchSettings settings, Screen& screen)
    : settings_(std::move(settings)), screen_(screen), state_(settings_.state), values_(settings_.values)
{
}

Workbench::~Workbench() = default;

WorkbenchReport Workbench::run(const Poll& poll, PanelFrame* panels)
{
    poll_    = poll;
    panels_  = panels;
    started_ = lastFrame_ = lastChange_ = Clock::now();
    openFirst();
    while (!closing_) {
        stop_ = false;
        takeChanges();
        if (failed_)
            frame(nullptr);
        else
            session();
    }
    endRecording();
    if (stage_ && stage_->painting().changed() && !paintSaved_) { // nothing is lost
        savePaint();
        report_.said = message_;
    }
    return std::move(report_);
}

/// Touches until something asks for another session.
void Workbench::session()
{
    try {
        history_.clear();
        // A session begins outside of the object: which side a hand is on is known from where it comes.
        pointer_->begin(std::exchange(beginAt_, std::nullopt).value_or(pointer_->at()));
        WorkbenchHand hand{&pointer_->device(), pointer_->frame(), kLong};
        if (replay_)
            hand = {replay_.get(), {}, double(replayed_->samples.size()) * 1e-3};
        else if (settings_.hand) {
            const auto ready = readyHand();
            if (!ready) return;
            hand = *ready;
        }
        hand_  = hand;
        begun_ = true;
        startRecording();
        const SessionParts  parts{stage_->scene(), stage_->object(), solver(), *hand.device, hand.frame};
        RealSessionSettings real;
        real.seconds    = hand.seconds;
        real.viewPeriod = 1e-4; // as soon as a picture is done the next begins
        real.stop       = &stop_;
        real.onView     = [this](const SessionView& view) { frame(&view); };
        real.onTick     = [this, recording = recording_.get()](const TickRecord& sample) {
            static_cast<void>(ring_.push(sample)); // curves may have gaps
            if (recording) recording->push(sample);
        };
        const SessionSummary summary = runReal(parts, real, report_.realTime);
        ended(summary);
    } catch (const Error& error) {
        if (!begun_) throw; // nothing works yet: that is for whoever started the program
        endRecording();
        complain(error.what());
        failed_ = true;
    }
}

/// A session has come to its end.
void Workbench::ended(const SessionSummary& summary)
{
    endRecording(); // one session, one recording
    if (stop_ || closing_) return;
    if (replay_) {
        replay_.reset();
        say("the replay is over");
    } else if (summary.deviceFault != DeviceFault::none) {
        complain(std::string("the device is ") + name(summary.deviceFault) + ": plug it in again and press R to go on");
        failed_ = true;
    } else if (settings_.hand) {
        failed_ = true;
        say("the hand has come to its end: R starts it again");
    }
}

/// One picture: what happened, what is felt, what is seen.
void Workbench::frame(const SessionView* view)
{
    input_ = poll_(patience());
    aim();
    beginPanels();
    handle(input_);
    unsolved_.take();
    const auto now = Clock::now();
    if (settings_.seconds > 0 && Seconds(now - started_).count() > settings_.seconds) closing_ = true;
    if (settings_.stop && *settings_.stop) closing_ = true;
    if (closing_) restart();
    for (auto samples = ring_.front(); !samples.empty(); samples = ring_.front()) {
        for (const TickRecord& sample : samples) {
            history_.add(sample);
            if (settings_.onTick && what_ == settings_.what) settings_.onTick(sample);
        }
        ring_.pop(samples.size());
    }
    const bool active = input_.any() || input_.panelsTakePointer || inContact(view) || replay_ || recording_;
    if (view && report_.realTime.empty()) report_.realTime = view->warning;
    if (active || input_.size != drawnSize_) lastChange_ = now;
    const bool changed = lastChange_ > lastBegin_;
    if (closing_ || input_.size.x < 1 || input_.size.y < 1 || (stillFine_ && !changed)) return rest();
    drawFrame(view);
}

/// Puts the object into what the panels leave free, and brings it there gently when they come and go.
void Workbench::aim()
{
    constexpr double kGlide = 0.08, kLongest = 0.05; // [s] in which a third of the way is left; of a step
    constexpr double kThere = 1e-3;                  // of half the height: no step is seen [1]
    if (input_.size.x < 1 || input_.size.y < 1) return;
    const PictureArea area =
        panels_ ? freeArea(state_, input_.size, input_.scale) : PictureArea{{0, 0}, glm::dvec2(input_.size)};
    const glm::dvec2 wanted = centreOf(area, input_.size), left = wanted - state_.camera.centre;
    if (left != glm::dvec2(0)) lastChange_ = Clock::now();
    const double since   = std::min(kLongest, Seconds(Clock::now() - lastBegin_).count()); // [s]
    const bool   jumps   = input_.size != drawnSize_ || glm::length(left) < kThere;
    state_.camera.centre = jumps ? wanted : state_.camera.centre + (1 - std::exp(-since / kGlide)) * left;
    if (std::exchange(toFrame_, false)) frameAll();
}

/// A frame of ImGui, if one is due: at once where the user is at the panels, and a few times a second else, because
/// drawing them takes as long as drawing the object.
void Workbench::beginPanels()
{
#ifdef PALPATE_PANELS
    constexpr double kSeldom = 0.2; // [s]
    const auto       now     = Clock::now();
    const bool       glides  = input_.moved != glm::dvec2(0) && !input_.touch;
    const bool       presses = input_.left || input_.leftPressed || leftBefore_ || !input_.keys.empty();
    const bool       orbits  = presses && !panelsTakePointer_ && input_.left;
    const bool       resized = input_.size != drawnSize_;
    panelsDue_  = panels_ && ((glides && !orbits) || (presses && !orbits) || !input_.typed.empty() || resized ||
                             Seconds(now - panelsAt_).count() > kSeldom);
    leftBefore_ = input_.left;
    if (!panelsDue_) {
        input_.panelsTakePointer = panelsTakePointer_;
        input_.panelsTakeKeys    = panelsTakeKeys_;
        return;
    }
    panelsAt_ = now;
    panels_->setDark(state_.look.ground == Ground::dark);
    input_             = panels_->begin(std::move(input_));
    panelsTakePointer_ = input_.panelsTakePointer;
    panelsTakeKeys_    = input_.panelsTakeKeys;
#endif
}

/// No new picture: the last one stays.
void Workbench::rest()
{
#ifdef PALPATE_PANELS
    if (panelsDue_) panels_->end();
#endif
    screen_.present();
}

double Workbench::patience() const
{
    constexpr double kIdle = 0.1; // between looks at a window in which nothing happens [s]
    if (stillFine_ || input_.size.x < 1 || input_.size.y < 1) return kIdle;
    return std::max(0.0, kFramePeriod - Seconds(Clock::now() - lastBegin_).count());
}

void Workbench::drawFrame(const SessionView* view)
{
    constexpr double kQuick = 12e-3,
                     kRest  = 0.8; // [s] of a fine picture that is as good as a fast one; until one is due
    const auto begin        = Clock::now();
    lastBegin_              = begin;
    const bool        rests = Seconds(begin - lastChange_).count() > kRest;
    const bool        fine  = rests || (fineTime_ > 0 && fineTime_ < kQuick);
    const PictureSize size{input_.size.x, input_.size.y, 1, fine ? Detail::fine : Detail::fast};
    showTouch(view);
    PanelWishes wishes;
#ifdef PALPATE_PANELS
    if (panelsDue_) {
        wishes = drawPanels(state_, content(view), input_.scale);
        panels_->end();
        screen_.takePanels();
    }
#endif
    writeTexts(view);
    const bool shown = screen_.show(stage_->view().scene(), state_.camera, size, textsFor(size));
    const auto end   = Clock::now();
    drawnSize_       = input_.size;
    drawTime_        = Seconds(end - begin).count();
    if (fine) fineTime_ = drawTime_;
    stillFine_ = shown && rests && fineTime_ >= kQuick;
    frameTime_ += 0.1 * (Seconds(end - lastFrame_).count() - frameTime_);
    if (shown) count(inContact(view), Seconds(end - lastFrame_).count());
    lastFrame_ = end;
    perform(wishes);
}

void Workbench::count(bool touching, double period)
{
    constexpr std::size_t kMost = 1'000'000; // five hours [1]
    ++report_.frames;
    if (!touching || report_.frameTimes.size() >= kMost) return;
    report_.frameTimes.push_back(period);
    report_.drawTimes.push_back(drawTime_);
}

/// The scene as the session has it now.
void Workbench::showTouch(const SessionView* view)
{
    TouchLook look  = state_.look;
    double    force = 0;
    if (view) {
        force = glm::length(view->sample.force);
    }
    look.deepest   = deepest_;
    look.strongest = strongest_;
    if (view)
        stage_->view().show(inContact(view) || force > 0 ? view->patch : nullptr, force, look,
                            TouchHand{view->sample.hip, view->sample.force, view->sample.proxy});
    else
        stage_->view().show(nullptr, 0, look);
    if (state_.tool == Tool::paint) addBrush();
}

/// The brush as a ring on the surface.
void Workbench::addBrush()
{
    constexpr int kSides = 48;
    const auto    hit    = hitAt(input_);
    if (!hit || input_.panelsTakePointer) return;
    const Frame frame = Frame::about(hit->outward);
    const auto  at    = [&](int n) {
        const double angle = 2 * 3.14159265358979 * n / kSides;
        return hit->point + state_.brush.radius * (std::cos(angle) * frame.east + std::sin(angle) * frame.north);
    };
    for (int n = 0; n < kSides; ++n) stage_->view().scene().outline.push_back({at(n), at(n + 1)});
}

/// The texts over the picture, written anew when they change, but not with every frame.
void Workbench::writeTexts(const SessionView* view)
{
    constexpr double kSeldom = 0.25; // [s]
    if (!state_.texts) return;
    ViewScene& scene = stage_->view().scene();
    if (!panelsShown()) { // which say all this themselves
        const double force = view ? glm::length(view->sample.force) : 0;
        scene.title        = std::filesystem::path(what_).stem().string();
        scene.note         = !saying().empty()  ? saying()
                             : !faults_.empty() ? faults_.back()
                             : force > 0        ? formatQuantity(force, "N")
                             : state_.blind     ? "hold Space and move: touch.  M: there is a nodule here"
                                                : "hold Space and move: touch.  F1: keys";
    }
    std::string says = scene.title + "|" + scene.note + "|" + scene.colours.quantity + "|" + name(state_.look.map) +
                       "|" + std::to_string(scene.colours.range.low) + "|" +
                       std::to_string(scene.colours.range.high * 1e6) + "|" +
                       std::to_string(state_.camera.halfHeight()) + "|" + std::to_string(input_.size.x) + "x" +
                       std::to_string(input_.size.y) + (state_.look.ground == Ground::dark ? "d" : "l") +
                       std::to_string(input_.scale) + (scene.proxy ? "p" : "") + (scene.force ? "f" : "") +
                       (scene.outline.empty() ? "" : "o") + (scene.sphere.empty() ? "" : "s") +
                       std::to_string(int(state_.look.overlays.ghost) + 2 * int(state_.look.overlays.projected));
    const auto now  = Clock::now();
    const bool fits = texts_.width == input_.size.x && texts_.height == input_.size.y;
    if (fits && (says == textsOf_ || Seconds(now - textsAt_).count() < kSeldom)) return;
    texts_   = annotations(scene, state_.camera, input_.size.x, input_.size.y, input_.scale);
    textsOf_ = std::move(says);
    textsAt_ = now;
}

PanelContent Workbench::content(const SessionView* view) const
{
    PanelContent now{stage_->scene(), stage_->painted().cloud(), history_};
    if (view) {
        now.patch      = view->patch;
        now.force      = glm::length(view->sample.force);
        now.loopPeriod = view->loopPeriod;
        now.solveTime  = view->solveTime;
        now.touching   = inContact(view);
        now.hand       = hand_.device->info().model;
    }
    now.frameTime       = frameTime_;
    now.solvedOn        = stage_->solvedOn();
    now.drawnOn         = screen_.device().name;
    now.drawnInSoftware = screen_.device().kind == "software";
    now.replaying       = replay_ != nullptr;
    now.recording       = recording_ ? recordFolder_ : "";
    now.title           = std::filesystem::path(what_).filename().string();
    now.painted         = stage_->painting().changed() && !paintSaved_;
    now.canUndo         = stage_->painting().canUndo();
    now.canRedo         = stage_->painting().canRedo();
    now.faults          = faults_;
    if (const std::string* const why = unsolved_.held(); view && why && !why->empty())
        now.faults.push_back("the plate cannot be solved here: " + *why);
    now.message  = saying();
    now.realTime = report_.realTime;
    return now;
}

void Workbench::perform(const PanelWishes& wishes)
{
    if (wishes.frame) frameAll();
    if (wishes.reset) resetCamera();
    if (wishes.screenshot) screenshot(false);
    if (wishes.record) toggleRecording();
    if (wishes.undo) undo();
    if (wishes.redo) redo();
    if (wishes.save) savePaint();
    if (wishes.resetFault) goOn();
    if (!wishes.values.empty()) change(wishes.values);
}

void Workbench::goOn()
{
    faults_.clear();
    failed_ = false;
    restart();
}

/// The stage's, with an ear for what it cannot solve.
PatchSolver Workbench::solver()
{
    return [this, solve = stage_->solver()](const Touch& touch, double period) {
        const auto note = [this](const std::string& why) {
            unsolved_.draft() = why;
            unsolved_.publish();
        };
        try {
            DeformationAnswer answer = solve(touch, period);
            note(answer.update ? "" : answer.why);
            return answer;
        } catch (const std::exception& error) {
            note(error.what());
            throw;
        }
    };
}

const Overlay* Workbench::textsFor(const PictureSize& size) const
{
    return state_.texts && texts_.width == size.width && texts_.height == size.height ? &texts_ : nullptr;
}

void Workbench::complain(const std::string& sentence)
{
    constexpr std::size_t kMost = 5;
    if (!faults_.empty() && faults_.back() == sentence) return;
    if (settings_.complained) settings_.complained(sentence);
    faults_.push_back(sentence);
    if (faults_.size() > kMost) faults_.erase(faults_.begin());
    lastChange_ = Clock::now();
}

} // namespace palp
