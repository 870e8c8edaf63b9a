#pragma once
#include <cstdint>
#include <functional>
#include <memory>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "device/falcon/falcon_device.h"
#include "device/falcon/ft232_emulator.h"
#include "engine/force/governor.h"

namespace palp {

/// A force as only the governor makes them: it wants `newtons` until that comes out.
inline GovernedForce governed(const glm::dvec3& newtons)
{
    ForceGovernor governor;
    GovernorInput in;
    in.homed = in.inBox = true;
    in.dt               = 1e-3;
    for (int n = 0; n < 2000; ++n) {
        in.force = n < 20 ? glm::dvec3(0) : newtons; // small at first, or it waits
        governor.step(in);
    }
    EXPECT_NEAR(glm::length(governor.force().newtons() - newtons), 0, 1e-12) << "at most 6 N";
    return governor.force();
}

inline Ft232EmulatorSettings runningFalcon()
{
    Ft232EmulatorSettings settings;
    settings.falcon.running = settings.falcon.homed = true;
    return settings;
}

/// An open FalconDevice on an emulated Falcon, both in virtual time; the servo ticks each millisecond, or as fast as
/// the exchanges go where they take longer.
struct FalconBench {
    Ft232Emulator                 emulator;
    std::unique_ptr<FalconDevice> device;
    HapticState                   state{};
    double                        now = 0; ///< [s] the servo's
    GovernedForce                 force{};

    explicit FalconBench(const Ft232EmulatorSettings& falcon = runningFalcon(), EmulatedFalcon::Arm arm = {},
                         FalconDeviceSettings settings = {})
        : emulator(falcon, std::move(arm))
    {
        settings.pace = FalconPace::stepped;
        device        = std::make_unique<FalconDevice>([this] { return emulator.connect(); }, settings);
        device->open();
        now = emulator.now();
    }

    void tick()
    {
        if (state.fault == DeviceFault::unplugged) emulator.waitUntil(now); // nobody else lets its time pass
        state = device->exchange(force, now);
        now   = std::max(now + 1e-3, emulator.now());
    }

    void run(double seconds, const std::function<void()>& check = {})
    {
        for (const double until = now + seconds; now < until;) {
            tick();
            if (check) check();
        }
    }

    [[nodiscard]] bool pushes() const { return emulator.falcon().motors() != std::array<std::int16_t, 3>{}; }
};

} // namespace palp
