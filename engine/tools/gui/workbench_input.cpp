#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

#include "engine/core/contract.h"
#include "engine/core/quantity.h"
#include "engine/tools/gui/panel_layout.h"
#include "engine/tools/gui/workbench.h"

// What keys and pointer do.

namespace palp {
namespace {

template <class Choice>
Choice next(Choice now, int count)
{
    return Choice((int(now) + 1) % count);
}

} // namespace

void Workbench::handle(const WindowInput& input)
{
    if (input.closing) closing_ = true; // the session ends in zero force first
    if (!input.keys.empty() || input.leftPressed) message_.clear();
    if (!input.panelsTakeKeys)
        for (const KeyPress& press : input.keys) handleKey(press);
    for (const auto& path : input.dropped) open(path);
    handlePointer(input);
    moveByCap();
}

void Workbench::handleKey(const KeyPress& press)
{
    if (press.control) {
        if (press.key == 'Z') undo();
        if (press.key == 'Y') redo();
        if (press.key == 'S') savePaint();
        return;
    }
    if (state_.blind && (press.key == 'V' || press.key == 'J' || press.key == 'B'))
        return say("not while something is hidden: it would show where");
    Overlays& shown = state_.look.overlays;
    switch (press.key) {
    case 'F':
        return frameAll();
    case 'R':
        resetCamera();
        return failed_ ? goOn() : void();
    case 'O':
        state_.camera = otherProjection(state_.camera);
        return;
    case '1':
        return lookAlong({0, -1, 0});
    case '3':
        return lookAlong({1, 0, 0});
    case '7':
        return lookAlong({0, 0, 1});
    case 'C':
        state_.look.map = next(state_.look.map, 3);
        return;
    case 'V':
        state_.look.paint = next(state_.look.paint, 3);
        return;
    case 'L':
        state_.look.ground = next(state_.look.ground, 2);
        return;
    case 'G':
        shown.ghost = !shown.ghost;
        return;
    case 'S':
        shown.sphere = !shown.sphere;
        return;
    case 'J':
        shown.projected = !shown.projected;
        return;
    case 'X':
        state_.look.exaggeration = state_.look.exaggeration >= 8 ? 1 : 2 * state_.look.exaggeration;
        return say("displacement \u00d7 " + std::to_string(int(state_.look.exaggeration)));
    case 'T':
        state_.texts = !state_.texts;
        return;
    case 'P':
        return screenshot(press.shift);
    case 'B':
        state_.tool = next(state_.tool, 2);
        if (state_.tool == Tool::paint) paintBefore_ = state_.look.paint;
        state_.look.paint = state_.tool == Tool::paint ? ViewPaint::stiffness : paintBefore_; // what is painted is seen
        return say(state_.tool == Tool::paint ? "brush: left button paints, [ and ] size, Ctrl+Z takes back"
                                              : "hold Space and move: touch");
    case 'M':
        return mark();
    case '[':
    case ']':
        state_.brush.radius *= press.key == '[' ? 0.8 : 1.25;
        return say("brush of " + formatQuantity(state_.brush.radius, "m"));
    case kTabKey:
        state_.panels = !state_.panels;
        return;
    case kF1Key:
        state_.keys = !state_.keys;
        return showKeys();
    case kF5Key:
        return toggleRecording();
    case kF6Key:
        return lastRecording_.empty() ? say("nothing has been recorded yet: F5 records") : open(lastRecording_);
    case kEscapeKey:
        return letGo();
    default:
        return;
    }
}

/// Lets go of the object, whatever the hand is; never quits.
void Workbench::letGo()
{
    state_.keys = false;
    letGo_      = true; // until Space is pressed anew
    if (pointer_) pointer_->release();
    if (!settings_.hand || failed_) return say("let go; close the window to quit");
    failed_ = true; // the session ends, and its last force is none
    restart();
    say("let go: no force; R takes the object again, closing the window quits");
}

/// The pointer's hand declares the place that it is on.
void Workbench::mark()
{
    if (!state_.blind) return say("M declares a hidden nodule; nothing is hidden in this scene");
    if (!pointer_ || settings_.hand || replay_) return say("the hand's own button declares");
    markedAt_ = Clock::now();
    pointer_->mark(true);
    say(pointer_->pressing() ? "declared: there is a nodule here" : "nothing is touched: hold Space over the place");
}

/// Without panels the keys are told in a line.
void Workbench::showKeys()
{
    if (state_.blind) return say(state_.keys ? "Space touch, wheel depth, M declare, F frame, R reset, F5 record" : "");
#ifndef PALPATE_PANELS
    say(state_.keys
            ? "Space touch, wheel depth, B brush, F frame, R reset, O orthographic, C V colours, L light, G S J "
              "overlays, P picture, F5 record"
            : "");
#endif
}

void Workbench::handlePointer(const WindowInput& input)
{
    touch(input);
    if (input.panelsTakePointer) {
        painting_ = false;
        return;
    }
    const bool paints = state_.tool == Tool::paint && !input.shift;
    paintWith(input);
    constexpr double kTurn = 0.006, kZoom = 0.88; // per pixel at scale 1 [rad], per notch [1]
    const double     half = 0.5 * std::max(1, input.size.y);
    if ((input.left && !input.shift && !paints) || (input.middle && paints))
        state_.camera = orbited(state_.camera, glm::dvec2(-input.moved.x, input.moved.y) * (kTurn / input.scale));
    else if (input.right || (input.left && input.shift) || input.middle)
        state_.camera = panned(state_.camera, {input.moved.x / half, -input.moved.y / half});
    if (input.wheel != 0 && !input.touch) state_.camera = dollied(state_.camera, std::pow(kZoom, input.wheel));
    if (input.doubleClick && !paints)
        if (const auto hit = hitAt(input)) state_.camera.target = hit->point;
}

std::optional<Hit> Workbench::hitAt(const WindowInput& input) const
{
    const double blur = std::max(0.5 * stage_->scene().patch.footprintRadius, 1e-9);
    return pick(rayThrough(state_.camera, input.pointer, input.size), stage_->painted().positions(),
                stage_->view().restNormals(), stage_->view().radii(), blur);
}

void Workbench::touch(const WindowInput& input)
{
    if (settings_.hand || replay_ || !pointer_) return;
    constexpr auto kHeld = std::chrono::milliseconds(60); // thrice what declares
    if (Clock::now() - markedAt_ > kHeld) pointer_->mark(false);
    if (!input.touch) letGo_ = false;
    if (!input.touch || input.panelsTakeKeys || letGo_) return pointer_->release();
    if (input.panelsTakePointer) return; // over a panel the hand stays where it is
    const double     thickness = stage_->scene().material.thickness;
    constexpr double kStep = 0.05, kMost = 3; // of the thickness: a notch, and how deep and high it goes [1]
    state_.pressDepth =
        std::clamp(state_.pressDepth - kStep * thickness * input.wheel, -kMost * thickness, kMost * thickness);
    if (input.wheel != 0) say("depth " + formatQuantity(state_.pressDepth, "m"));
    const auto hit = hitAt(input);
    if (!hit || pointer_->press(*hit, state_.pressDepth) || beginAt_) return;
    beginAt_ = *hit; // the object is in between: the hand begins anew, there
    if (recording_) {
        say("the recording has ended: the hand went round the object");
    }
    restart();
}

void Workbench::paintWith(const WindowInput& input)
{
    const bool paints = state_.tool == Tool::paint && input.left && !input.shift && doing_.empty();
    if (!paints) {
        if (painting_) stage_->paint([](StiffnessPainting& painting) { painting.endStroke(); });
        painting_ = false;
        return;
    }
    const auto hit = hitAt(input);
    if (!hit || (painting_ && input.moved == glm::dvec2(0))) return;
    std::vector<glm::dvec3> path{hit->point};
    if (painting_) path.insert(path.begin(), lastDab_);
    stage_->paint([&](StiffnessPainting& painting) {
        if (!painting_) painting.beginStroke();
        for (const glm::dvec3& place : dabsAlong(path, state_.brush.radius, stage_->painted())) {
            const Brush brush{place, state_.brush.radius, state_.brush.strength};
            if (state_.brush.smooths)
                painting.smooth(brush);
            else
                painting.paint(brush, state_.brush.value);
        }
    });
    painting_   = true;
    paintSaved_ = false;
    lastDab_    = hit->point;
    if (recording_) {
        restart();
        say("the recording has ended: what it was of is being painted");
    }
}

void Workbench::undo()
{
    if (!doing_.empty()) return;
    paintSaved_ = false;
    stage_->paint([](StiffnessPainting& painting) { painting.undo(); });
    lastChange_ = Clock::now();
}

void Workbench::redo()
{
    if (!doing_.empty()) return;
    paintSaved_ = false;
    stage_->paint([](StiffnessPainting& painting) { painting.redo(); });
    lastChange_ = Clock::now();
}

/// The cap of a SpaceMouse: what is pushed and turned moves the object under the eye.
void Workbench::moveByCap()
{
    if (!settings_.camera) return;
    const double now = std::chrono::duration<double>(Clock::now() - started_).count();
    const double dt  = std::min(0.1, now - capTime_); // [s]
    capTime_         = now;
    settings_.camera->exchange({}, now);
    const SpaceMouseAxes axes = settings_.camera->axes();
    if (glm::length(axes.push) + glm::length(axes.turn) < 0.02) return;
    constexpr double kTurn = 1.5, kPan = 1, kZoom = 1; // at full deflection [rad/s], [half heights/s], [1/s]
    state_.camera = orbited(state_.camera, glm::dvec2(-axes.turn.y, axes.turn.x) * (kTurn * dt));
    state_.camera = panned(state_.camera, glm::dvec2(axes.push.x, axes.push.y) * (kPan * dt));
    state_.camera = dollied(state_.camera, std::exp(-axes.push.z * kZoom * dt));
    lastChange_   = Clock::now();
}

void Workbench::frameAll()
{
    const Bounds& bounds = stage_->painted().cloud().bounds();
    if (input_.size.y < 1) {
        toFrame_ = true;
        return;
    }
    const glm::dvec2 room = panels_ ? freeArea(state_, input_.size, input_.scale).size : glm::dvec2(input_.size);
    const double     side = std::min(room.x, room.y) / input_.size.y; // of the height of the picture [1]
    state_.camera         = framed(state_.camera, bounds.centre(), 0.5 * bounds.diagonal(), side);
}

void Workbench::resetCamera()
{
    const Frame      frame  = Frame::about(stage_->place().outward);
    const glm::dvec2 centre = state_.camera.centre;
    state_.camera           = Camera{};
    state_.camera.centre    = centre;
    state_.camera.up        = frame.normal;
    state_.camera.toEye     = glm::normalize(0.75 * frame.normal + 0.25 * frame.east - 0.6 * frame.north);
    state_.camera.target    = stage_->place().point;
    frameAll();
}

void Workbench::lookAlong(const glm::dvec3& axis)
{
    state_.camera.toEye = axis;
    state_.camera.up    = std::abs(axis.z) > 0.5 ? glm::dvec3(0, 1, 0) : glm::dvec3(0, 0, 1);
    frameAll();
}

void Workbench::open(const std::filesystem::path& path)
{
    toOpen_ = path.string();
    failed_ = false;
    restart();
}

} // namespace palp
