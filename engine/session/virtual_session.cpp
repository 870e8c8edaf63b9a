#include "engine/session/virtual_session.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <optional>

#include "engine/session/deformation.h"

namespace palp {
namespace {

using Clock = std::chrono::steady_clock;

constexpr double kTick = 1e-3; ///< [s]

double secondsSince(Clock::time_point start)
{
    return std::chrono::duration<double>(Clock::now() - start).count();
}

} // namespace

SessionSummary runVirtual(const Scene& scene, const PointCloud& cloud, const NeighbourIndex& index,
                          Deformation& deformation, const HandPath& hand, double seconds, const OnSample& onSample)
{
    Servo                    servo(cloud, index, scene);
    SessionSummary           summary;
    RecentMotion             hip;
    std::optional<PatchNews> inUse, underWay;

    const auto every = std::max<std::int64_t>(1, std::llround(1 / (scene.deformationRate * kTick))); // ticks a patch
    const auto ticks = std::llround(seconds / kTick);
    for (std::int64_t n = 0; n < ticks; ++n) {
        const double time = double(n) * kTick;
        if (n % every == 0) {
            if (underWay) inUse = underWay;
            underWay.reset();
            if (servo.touch().touching) {
                const auto began = Clock::now();
                underWay         = deformation.solve(servo.touch(), double(every) * kTick);
                summary.solve.add(secondsSince(began));
                ++(underWay ? summary.patches : summary.failedPatches);
            }
        }
        const auto       began = Clock::now();
        const glm::dvec3 place = hand.position(hand.begin() + time);
        hip.add(time, place);
        SessionSample sample = servo.tick(time, kTick, kTick, {place, hip.velocity()}, inUse ? &*inUse : nullptr);
        sample.tickTime      = secondsSince(began);
        summary.add(sample);
        if (onSample) onSample(sample);
    }
    summary.fault = servo.governor().fault();
    summary.why   = deformation.why();
    return summary;
}

} // namespace palp
