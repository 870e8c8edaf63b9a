#include "engine/tools/gui/touch_session.h"

#include <utility>

#include "engine/core/contract.h"
#include "engine/session/servo.h"
#include "engine/tools/gui/touch_faults.h"

namespace palp {
namespace {

constexpr double kUntilEnded = 1e9; // [s]

} // namespace

TouchSession::TouchSession(const WorkbenchSettings& settings, Notices& notices)
    : settings_(settings), notices_(notices), recorder_(notices)
{
}

void TouchSession::setStage(Stage& stage)
{
    stage_ = &stage;
    pointer_.emplace(stage, notices_);
    heldAt_.reset();
    forgetSolver();
    resume();
}

void TouchSession::forgetSolver()
{
    for (Latest<std::string>* const said : {&unsolved_, &takeover_}) {
        said->draft().clear();
        said->publish();
    }
}

void TouchSession::run(const ReadyHand& readyHand, const OnView& onView)
{
    try {
        history_.clear();
        pointer_->begin();
        if (replay_)
            runWith({replay_.get(), {}, kUntilEnded, replayFrom_}, onView); // its last tick ends it, however late
        else if (!settings_.hand)
            runWith({&pointer_->hand().device(), pointer_->hand().frame(), kUntilEnded}, onView);
        else if (auto hand = readyHand()) {
            if (hand->from && heldAt_) hand->from = heldAt_; // a hand that presses goes on where it is
            runWith(*hand, onView);
        }
    } catch (const Error&) {
        closeTap();
        recorder_.end();
        throw;
    }
}

void TouchSession::runWith(const WorkbenchHand& hand, const OnView& onView)
{
    hand_     = hand;
    state_    = State::ready;
    clutched_ = false;
    recorder_.begin([this] {
        SessionInfo info = settings_.recorded(*stage_, *hand_.device);
        info.hand        = hand_.frame.inScene(info.hand);
        info.from        = hand_.from;
        return info;
    });
    const SessionParts  parts{stage_->scene(), stage_->object(),   solver(), *hand.device,
                             hand.frame,      stage_->firstLaw(), hand.from};
    RealSessionSettings real;
    real.seconds    = hand.seconds;
    real.viewPeriod = 1e-4; // the next picture begins as soon as one is done
    real.stop       = &ended_;
    real.clutch     = &clutched_;
    real.onView     = onView;
    {
        const std::lock_guard lock(tapMutex_);
        tap_.emplace(recorder_.recording(), settings_.streams);
    }
    real.onStart = [this](std::chrono::steady_clock::time_point start) { tap_->begin(start); };
    std::optional<glm::dvec3> tool; // [m] in the last tick in which the device knew its place
    bool                      clutched = false;
    real.onTick = [this, &tool, &clutched, clear = stage_->object().spacing()](const TickRecord& record) {
        Hand then;
        then.setBits(record.device);
        if (then.hasPlace()) tool = record.proxy + clear * record.normal; // off the surface, so that its side is known
        clutched = clutched || then.clutched;
        static_cast<void>(ring_.push(record)); // curves may have gaps
        tap_->push(record);
    };
    const SessionSummary summary = runReal(parts, real, realTime_);
    closeTap();
    const bool isReplay = replaying();
    conclude(summary);
    // A hand that was let go may be elsewhere by now; and what a clutch moved the tool by is forgotten.
    // One that ended before its first tick says nothing new.
    if (!isReplay && (tool || halted())) heldAt_ = halted() || clutched ? std::nullopt : tool;
}

void TouchSession::closeTap()
{
    const std::lock_guard lock(tapMutex_);
    tap_.reset();
}

/// Shows why a session has ended by itself.
void TouchSession::conclude(const SessionSummary& summary)
{
    recorder_.end();
    if (ended_) return;
    if (replay_) {
        replay_.reset();
        notices_.say("the replay is over");
    } else if (summary.deviceFault != DeviceFault::none) {
        notices_.complain(std::string("the device is ") + name(summary.deviceFault) +
                          (summary.deviceWords.empty() ? "" : " (" + summary.deviceWords + ")") +
                          ": plug it in again and press R to continue");
        state_ = State::halted;
    } else if (settings_.hand) {
        state_ = State::halted;
        notices_.say("the hand's motion has ended: R starts it again");
    }
}

void TouchSession::halt()
{
    state_ = State::halted;
    heldAt_.reset();
    end();
}

void TouchSession::resume()
{
    if (state_ == State::halted) state_ = State::ready;
}

bool TouchSession::forceIsStopped() const
{
    return halted() || governorFault(history_.newest()) != GovernorFault::none;
}

void TouchSession::startReplay(const RecordedSession& session)
{
    replay_     = std::make_unique<ReplayDevice>(session.records, session.hand);
    replayFrom_ = session.from;
}

void TouchSession::toggleRecording()
{
    if (recorder_.recording()) { // the recording ends with its session
        notices_.say("recorded " + recorder_.folder());
    } else if (stage_->painting().changed()) {
        return notices_.say("save the paint and open its file first: only objects from files can be recorded");
    } else if (!settings_.recorded || replay_ || halted()) {
        return notices_.say("nothing can be recorded now");
    } else {
        recorder_.request();
    }
    end();
}

void TouchSession::mark()
{
    if (!tap_ || (!recorder_.recording() && settings_.streams.empty()))
        return notices_.say("nothing is recorded now: F5 starts a recording");
    mark("F7");
    notices_.say("marker " + std::to_string(tap_->marked()) + " of this session");
}

void TouchSession::mark(std::string_view text)
{
    const std::lock_guard lock(tapMutex_);
    if (tap_) tap_->mark(text);
}

void TouchSession::loseMarkers(std::uint64_t markers)
{
    const std::lock_guard lock(tapMutex_);
    if (tap_) tap_->lose(markers);
}

void TouchSession::followPointer(const WindowInput& input, const std::optional<Hit>& hit, double& depth)
{
    if (!byPointer() || !pointer_) return;
    if (pointer_->follow(input, hit, depth) == PointerTouch::Outcome::touched) return;
    if (recorder_.recording()) notices_.say("the recording has ended, because the hand moved round the object");
    end();
}

void TouchSession::letGo()
{
    if (pointer_) pointer_->letGo();
    if (!settings_.hand || halted()) return notices_.say("let go; close the window to quit");
    halt(); // the session ends, with zero as its last force
    notices_.say("let go: the force is off; R touches again, closing the window quits");
}

void TouchSession::toggleClutch()
{
    if (!settings_.hand || replay_) return notices_.say("the pointer needs no clutch: hold Space and move");
    clutched_ = !clutched_;
    notices_.say(clutched_ ? "clutch held: no force, and the tool stays; K lets go of it" : "clutch released");
}

void TouchSession::declare()
{
    if (!byPointer() || !pointer_) return notices_.say("the hand's own button declares");
    if (forceIsStopped()) return notices_.say("nothing is declared, because the force is off: R goes on");
    pointer_->declare();
}

void TouchSession::collect(const OnTick& onTick)
{
    unsolved_.take();
    takeover_.take();
    recorder_.tell();
    for (auto records = ring_.front(); !records.empty(); records = ring_.front()) {
        for (const TickRecord& record : records) {
            history_.add(record);
            if (onTick) onTick(record);
        }
        ring_.pop(records.size());
    }
}

std::string TouchSession::unsolved() const
{
    const std::string* const why = unsolved_.held();
    return why ? *why : "";
}

std::string TouchSession::takeover() const
{
    const std::string* const who = takeover_.held();
    return who ? *who : "";
}

void TouchSession::noteRealTime(std::string_view warning)
{
    if (realTime_.empty()) realTime_ = warning;
}

/// Returns the stage's solver; a patch that it cannot solve is reported to the window's thread.
PatchSolver TouchSession::solver()
{
    return [this, solve = stage_->solver()](const Touch& touch, double lead) {
        const auto note = [this](const std::string& why) {
            unsolved_.draft() = why;
            unsolved_.publish();
        };
        try {
            DeformationAnswer answer = solve(touch, lead);
            note(answer.update ? "" : answer.why);
            if (!answer.takeover.empty()) {
                takeover_.draft() = answer.takeover;
                takeover_.publish();
            }
            return answer;
        } catch (const std::exception& error) {
            note(error.what());
            throw;
        }
    };
}

} // namespace palp
