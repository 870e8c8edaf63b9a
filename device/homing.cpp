#include "device/homing.h"

#include <chrono>

#include "engine/core/contract.h"
#include "engine/core/real_time.h"

namespace palp {

bool waitForHoming(HapticDevice& device, const std::atomic<bool>& stop,
                   const std::function<void(const std::string&)>& tell,
                   const std::function<bool(const HapticState&)>& isDone)
{
    constexpr double kPatience = 1; // [s] for the first answers, and for a fault that may pass
    if (!device.info().needsHoming) return false;
    const auto start = std::chrono::steady_clock::now();
    Metronome  metronome{std::chrono::milliseconds(1)};
    bool       told = false;
    double     well = 0; // [s] when it was last without a fault
    device.home();
    for (;;) {
        const double      now   = std::chrono::duration<double>(metronome.wait() - start).count();
        const HapticState state = device.exchange(GovernedForce(), now);
        if (isDone ? isDone(state) : state.homed) break;
        if (stop) throw Error("homing was given up; no force flows before it");
        if (state.fault == DeviceFault::none) well = now;
        if (now > well + kPatience)
            throw Error(device.info().model + ": lost while it was to be homed (" + name(state.fault) +
                        "); palpate doctor may tell why");
        if (now > kPatience && !told) {
            const std::string& own = device.info().homing;
            tell("home the " + device.info().model + ": " +
                 (own.empty() ? "pull the grip all the way out, then push it all the way in; its red light goes out"
                              : own));
            told = true;
        }
    }
    return told;
}

} // namespace palp
