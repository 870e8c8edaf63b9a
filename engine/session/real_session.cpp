#include "engine/session/real_session.h"

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <thread>
#include <utility>
#include <vector>

#include "engine/core/latest.h"
#include "engine/core/real_time.h"
#include "engine/core/thread_time.h"
#include "engine/session/clutch.h"
#include "engine/session/detail/deformation_loop.h"
#include "engine/session/force_state.h"
#include "engine/session/interrupt.h"

namespace palp {
namespace {

using Clock   = std::chrono::steady_clock;
using Seconds = std::chrono::duration<double>;

constexpr double kTick = 1e-3; ///< nominal period of servo and proxy [s]

/// A hand and its time.
struct TimedHand {
    double     time = 0; ///< [s]
    Hand       hand;
    glm::dvec3 lean{}; ///< [m]
};

/// The servo's output for the caller.
struct Shown {
    TickRecord    record;
    double        loopPeriod = 0; ///< [s]
    std::uint32_t buttons    = 0;
    const char*   words      = ""; ///< of static storage
};

/// The data that the threads share, and nothing else.
struct Shared {
    Latest<TimedHand>    hand; ///< with threads of the paper only, as is the next
    Latest<ProxyContact> held;
    Latest<Shown>        shown;

    std::atomic<bool>       over = false; ///< everybody ends
    std::mutex              mutex;        ///< of the next two; the servo takes it after its last tick
    std::condition_variable ended;
    bool                    served = false;

    void serveNoMore()
    {
        const std::lock_guard lock(mutex);
        served = true;
        ended.notify_one();
    }
};

/// One session: its threads are these functions.
class RealSession {
public:
    RealSession(const SessionParts& parts, const RealSessionSettings& settings)
        : parts_(parts), settings_(settings), deformation_(parts.solver, parts.scene.deformationRate),
          contact_(parts.object, parts.scene, parts.from),
          force_(parts.scene, parts.frame.inScene(parts.device.info()), parts.first), clutch_(parts.frame.clutch)
    {
    }

    SessionSummary run(std::string& warning);

private:
    void                servoThread();
    TickRecord          tick(const ForceHalf::TickTime& now, const HapticState& state, bool letGo) noexcept;
    const ProxyContact& held(double time, const Hand& hand) noexcept;
    void                proxyThread();
    void                watch();
    void                publish(const ProxyContact& held) noexcept;

    const SessionParts&        parts_;
    const RealSessionSettings& settings_;
    Shared                     shared_;
    DeformationLoop            deformation_;
    ContactHalf                contact_;      ///< of the servo's thread, or of the proxy's
    ProxyContact               nothing_;      ///< of the servo's thread, before the proxy's first answer
    ForceHalf                  force_;        ///< of the servo's thread
    Clutch                     clutch_;       ///< of the servo's thread
    SessionSummary             summary_;      ///< of the servo's thread
    std::string                warning_;      ///< of the servo's
    std::exception_ptr         failure_;      ///< of the servo's
    double                     lastTick_ = 0; ///< [s] of the servo's
    std::atomic<Clock::rep>    stopped_  = 0; ///< time for which the servo had the program stopped
};

/// Ctrl-Z: the force goes to zero, the device hears it, and only then the program stops.
class Stopping {
public:
    [[nodiscard]] bool isAsked() const noexcept { return program_.isAsked(); }

    /// Counts a tick with this force; stops the program if that is asked for and zero was sent often enough.
    /// \return for how long it was stopped, which is no time of the session
    Clock::duration stopAtZero(const GovernedForce& force) noexcept
    {
        constexpr int kZeros = 10; // ticks: three exchanges of a slow line
        zeros_               = isAsked() && force.newtons() == glm::dvec3(0) ? zeros_ + 1 : 0;
        if (zeros_ < kZeros) return {};
        const auto since = Clock::now();
        program_.stop();
        zeros_ = 0;
        return Clock::now() - since;
    }

private:
    ZeroBeforeStop program_;
    int            zeros_ = 0;
};

/// Runs the servo.
void RealSession::servoThread()
{
    constexpr double kShare = 0.01; // of the newest tick in the mean that is shown [1]
    warning_                = askForRealTime();
    Metronome  metronome{std::chrono::microseconds(1000)};
    auto       start = metronome.wait(); // asking may take a quarter of a second
    double     last = 0, period = kTick;
    SleepWatch sleep;
    Stopping   stopping;
    if (settings_.onStart) settings_.onStart(start);
    for (;;) {
        const auto   now  = metronome.wait();
        const double time = Seconds(now - start).count(), dt = time - last;
        const double pause = sleep.slept();
        if (time >= settings_.seconds || shared_.over || (settings_.stop && *settings_.stop)) break;
        last = lastTick_ = time;
        period += (dt - period) * kShare;
        summary_.period.add(dt);
        const double      began  = threadSeconds();
        const HapticState state  = parts_.device.read(time);
        TickRecord        record = tick({time, dt + pause}, state, stopping.isAsked());
        parts_.device.light(std::uint8_t(lightOf(forceState(record))));
        parts_.device.render(parts_.frame.toDevice(force_.governor().force())); // leaves in this tick
        record.tickTime       = threadSeconds() - began;
        shared_.shown.draft() = {record, period, state.buttons, parts_.device.faultWords()};
        shared_.shown.publish();
        summary_.add(record);
        if (settings_.onTick) settings_.onTick(record);
        const Clock::duration stopped = stopping.stopAtZero(force_.governor().force());
        start += stopped;
        stopped_ += stopped.count();
        if (stopped.count() > 0) {
            sleep.restart(); // part of the stop, after which the hand engages anew
            if (settings_.onStart) settings_.onStart(start);
        }
        if (isFinal(state.fault)) break; // it does not come back without close() and open()
    }
}

TickRecord RealSession::tick(const ForceHalf::TickTime& now, const HapticState& state, bool letGo) noexcept
{
    const bool isAsked          = settings_.clutch && settings_.clutch->load(std::memory_order_relaxed);
    Hand       hand             = parts_.frame.handOf(clutch_.step(state, isAsked));
    hand.clutched               = clutch_.isHeld();
    hand.letGo                  = letGo;
    const ProxyContact& contact = held(now.time, hand);
    return force_.tick(now, hand, contact, deformation_.newest(force_.tableInUse()));
}

/// Returns the contact of the hand: computed here, or the latest of the proxy's thread.
const ProxyContact& RealSession::held(double time, const Hand& hand) noexcept
{
    if (settings_.threads == SessionThreads::paper) {
        shared_.hand.draft() = {time, hand, force_.lean()};
        shared_.hand.publish();
        shared_.held.take();
        if (const ProxyContact* const newest = shared_.held.held()) return *newest;
        nothing_.behind      = parts_.from.has_value();
        nothing_.touch.time  = time;
        nothing_.touch.point = hand.position;
        return nothing_;
    }
    const ProxyContact& contact = contact_.tick(time, hand, force_.lean());
    publish(contact);
    return contact;
}

/// Runs the proxy, with threads of the paper.
void RealSession::proxyThread()
{
    static_cast<void>(askForRealTime()); // the servo's warning covers this thread too
    Metronome metronome{std::chrono::microseconds(1000)};
    while (!shared_.over) {
        metronome.wait();
        if (!shared_.hand.take()) continue;
        const TimedHand&    newest = *shared_.hand.held();
        const ProxyContact& held   = contact_.tick(newest.time, newest.hand, newest.lean);
        publish(held);
        shared_.held.draft() = held;
        shared_.held.publish();
    }
}

void RealSession::publish(const ProxyContact& held) noexcept
{
    deformation_.touch.draft() = held.touch;
    deformation_.touch.publish();
}

/// Shows the session to the caller, on its thread, until the servo ends.
void RealSession::watch()
{
    const auto       period = std::chrono::duration_cast<Clock::duration>(Seconds(settings_.viewPeriod));
    std::unique_lock lock(shared_.mutex);
    while (!shared_.ended.wait_for(lock, period, [this] { return shared_.served; })) {
        if (!settings_.onView) continue;
        lock.unlock();
        deformation_.patch.take();
        const ShownPatch* const patch = deformation_.patch.held();
        if (shared_.shown.take()) {
            const Shown& shown = *shared_.shown.held();
            settings_.onView({shown.record, shown.loopPeriod, patch ? patch->solveTime : 0, shown.buttons, shown.words,
                              patch && patch->patch ? &*patch->patch : nullptr,
                              warning_}); // written before the first `shown`
        }
        lock.lock();
    }
}

/// Threads that are told to end, and waited for, on every way out.
class ThreadGroup {
public:
    explicit ThreadGroup(std::atomic<bool>& over) : over_(over) {}
    ThreadGroup(const ThreadGroup&)            = delete;
    ThreadGroup& operator=(const ThreadGroup&) = delete;
    ~ThreadGroup()
    {
        over_ = true;
        for (std::thread& thread : threads_) thread.join();
    }

    template <class Work>
    void add(Work work)
    {
        threads_.emplace_back(std::move(work));
    }

private:
    std::atomic<bool>&       over_;
    std::vector<std::thread> threads_;
};

SessionSummary RealSession::run(std::string& warning)
{
    {
        ThreadGroup threads(shared_.over);
        threads.add([this] { deformation_.run(shared_.over, &stopped_); });
        if (settings_.threads == SessionThreads::paper) threads.add([this] { proxyThread(); });
        threads.add([this] {
            try {
                servoThread();
            } catch (...) { // onTick's, against its promise
                failure_ = std::current_exception();
            }
            parts_.device.light(std::uint8_t(DeviceLight::blue));
            parts_.device.exchange(GovernedForce(), lastTick_);
            shared_.serveNoMore();
        });
        watch();
    }
    warning = warning_;
    if (failure_) std::rethrow_exception(failure_);
    const SessionSummary& slow = deformation_.slow;
    summary_.patches           = slow.patches;
    summary_.failedPatches     = slow.failedPatches;
    summary_.solve             = slow.solve;
    summary_.fault             = force_.governor().fault();
    summary_.why               = slow.why;
    if (summary_.deviceFault != DeviceFault::none) summary_.deviceWords = parts_.device.faultWords();
    summary_.whyPatchless = slow.whyPatchless;
    return summary_;
}

} // namespace

SessionSummary runReal(const SessionParts& parts, const RealSessionSettings& settings, std::string& warning)
{
    return RealSession(parts, settings).run(warning);
}

} // namespace palp
