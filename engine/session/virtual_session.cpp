#include "engine/session/virtual_session.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <memory>
#include <utility>

#include "engine/core/latest_pair.h"
#include "engine/core/thread_time.h"
#include "engine/session/clutch.h"
#include "engine/session/force_state.h"

namespace palp {
namespace {

using Clock = std::chrono::steady_clock;

constexpr double kTick = 1e-3; ///< [s]
constexpr double kLead = 1.5;  ///< [1] periods: a table is in use from one period after its touch to two

double secondsSince(Clock::time_point start)
{
    return std::chrono::duration<double>(Clock::now() - start).count();
}

/// Gives the device zero force at last, on every way out.
class ZeroAtLast {
public:
    explicit ZeroAtLast(HapticDevice& device) : device_(device) {}
    ZeroAtLast(const ZeroAtLast&)            = delete;
    ZeroAtLast& operator=(const ZeroAtLast&) = delete;
    ~ZeroAtLast()
    {
        device_.light(std::uint8_t(DeviceLight::blue));
        device_.exchange(GovernedForce(), now);
    }

    double now = 0; ///< [s] of the servo's clock

private:
    HapticDevice& device_;
};

} // namespace

SessionSummary runVirtual(const SessionParts& parts, double seconds, const OnTick& onTick,
                          const std::atomic<bool>* stop)
{
    Servo          servo(parts.object, parts.scene, parts.frame.inScene(parts.device.info()), parts.first, parts.from);
    SessionSummary summary;
    std::shared_ptr<const PatchUpdate>             underWay;
    LatestPair<std::shared_ptr<const PatchUpdate>> updates; // one thread, but a table may be in use still
    ZeroAtLast                                     zero(parts.device);
    Clutch                                         clutch(parts.frame.clutch);

    const auto every = std::max<std::int64_t>(1, std::llround(1 / (parts.scene.deformationRate * kTick))); // ticks
    const auto ticks = std::llround(seconds / kTick);
    for (std::int64_t n = 0; n < ticks; ++n) {
        if (stop && *stop) break;
        const double time = double(n) * kTick;
        zero.now          = time + kTick;
        if (n % every == 0) {
            if (underWay) {
                updates.draft() = std::exchange(underWay, nullptr);
                updates.publish();
            }
            if (const Touch& touch = servo.touch(); touch.sequence > 0) {
                const auto        began  = Clock::now();
                DeformationAnswer answer = parts.solver(touch, kLead * double(every) * kTick);
                if (answer.update || touch.touching) {
                    summary.solve.add(secondsSince(began));
                    summary.addPatch(answer.update != nullptr, answer.why);
                }
                underWay = answer.update ? std::move(answer.update) : std::move(answer.ends);
            }
        }
        updates.take([&](const auto& update) { return update && &update->table == servo.tableInUse(); });
        const auto* const newest = updates.newest();
        const double      began  = threadSeconds();
        Hand              hand   = parts.frame.handOf(clutch.step(parts.device.read(time), false));
        hand.clutched            = clutch.isHeld();
        TickRecord record        = servo.tick({time, kTick}, hand, newest ? newest->get() : nullptr);
        parts.device.light(std::uint8_t(lightOf(forceState(record))));
        parts.device.render(parts.frame.toDevice(servo.governor().force()));
        record.tickTime = threadSeconds() - began;
        summary.add(record);
        if (onTick) onTick(record);
    }
    summary.fault = servo.governor().fault();
    if (summary.deviceFault != DeviceFault::none) summary.deviceWords = parts.device.faultWords();
    return summary;
}

} // namespace palp
