#include "engine/session/real_session.h"

#include <atomic>
#include <chrono>
#include <exception>
#include <thread>

#include <glm/geometric.hpp>

#include "engine/core/latest.h"
#include "engine/session/deformation.h"
#include "engine/session/real_time.h"

namespace palp {
namespace {

using Clock   = std::chrono::steady_clock;
using Seconds = std::chrono::duration<double>;

/// What the threads share, and nothing else.
struct Shared {
    Latest<Touch>       touch;
    Latest<PatchNews>   news;
    Latest<SessionView> view;
    std::atomic<bool>   over = false;
};

/// The servo's thread. \return what the system refused
std::string serve(Servo& servo, const HandPath& hand, const RealSessionSettings& settings, Shared& shared,
                  SessionSummary& summary)
{
    constexpr double  kTick = 1e-3, kMean = 0.1; // [s] nominal period; over which the measured one is averaged
    const std::string refused = askForRealTime();
    RecentMotion      hip;
    Metronome         metronome(std::chrono::microseconds(1000));
    const auto        start  = metronome.wait();
    auto              last   = start;
    double            period = kTick;
    for (;;) {
        const auto   now  = metronome.wait();
        const double time = Seconds(now - start).count(), dt = Seconds(now - last).count();
        if (time >= settings.seconds) break;
        last = now;
        period += (dt - period) * std::min(1.0, dt / kMean);
        summary.period.add(dt);
        shared.news.take();
        const glm::dvec3 place = hand.position(hand.begin() + time);
        hip.add(time, place);
        SessionSample sample = servo.tick(time, dt, period, {place, hip.velocity()}, shared.news.held());
        shared.touch.draft() = servo.touch();
        shared.touch.publish();
        shared.view.draft() = {time, glm::length(sample.force), glm::length(sample.proxy - sample.hip)};
        shared.view.publish();
        sample.tickTime = Seconds(Clock::now() - now).count();
        summary.add(sample);
        if (settings.onSample) settings.onSample(sample);
    }
    return refused;
}

/// The deformation's thread: the newest touch, once a period.
void bend(Deformation& deformation, double period, Shared& shared, SessionSummary& summary)
{
    Metronome     metronome(std::chrono::duration_cast<std::chrono::nanoseconds>(Seconds(period)));
    std::uint64_t done = 0;
    while (!shared.over) {
        metronome.wait();
        shared.touch.take();
        const Touch* touch = shared.touch.held();
        if (!touch || !touch->touching || touch->sequence == done) continue;
        done             = touch->sequence;
        const auto began = Clock::now();
        const auto news  = deformation.solve(*touch, period);
        summary.solve.add(Seconds(Clock::now() - began).count());
        ++(news ? summary.patches : summary.failedPatches);
        if (!news) continue;
        shared.news.draft() = *news;
        shared.news.publish();
    }
}

} // namespace

SessionSummary runReal(const Scene& scene, const PointCloud& cloud, const NeighbourIndex& index,
                       Deformation& deformation, const HandPath& hand, const RealSessionSettings& settings,
                       std::string& warning)
{
    Servo              servo(cloud, index, scene);
    Shared             shared;
    SessionSummary     summary, slow; // each thread counts in its own
    std::exception_ptr failure;
    std::atomic<bool>  served = false;

    std::thread bending([&] {
        try {
            bend(deformation, 1 / scene.deformationRate, shared, slow);
        } catch (...) { // the touch goes on with the last patch
            failure = std::current_exception();
        }
    });
    std::thread serving([&] {
        warning = serve(servo, hand, settings, shared, summary);
        served  = true;
    });
    while (!served) {
        std::this_thread::sleep_for(std::chrono::milliseconds(100));
        if (settings.onView && shared.view.take()) settings.onView(*shared.view.held());
    }
    serving.join();
    shared.over = true;
    bending.join();
    if (failure) std::rethrow_exception(failure);

    summary.patches       = slow.patches;
    summary.failedPatches = slow.failedPatches;
    summary.solve         = slow.solve;
    summary.fault         = servo.governor().fault();
    summary.why           = deformation.why();
    return summary;
}

} // namespace palp
