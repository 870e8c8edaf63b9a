#pragma once
#include <algorithm>
#include <cstdio>
#include <memory>
#include <utility>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "device/hid/hidapi_system.h"
#include "engine/session/device_registry.h"
#include "tests/session/sheet_session.h"

// Sessions in virtual time on emulated devices that a scripted hand grips.

namespace palp {

inline constexpr const char* kStiff = R"({"law": "constant", "value": 30e6})"; ///< stiffer than a device renders

/// At the scale that the scene has.
struct GrippedSession {
    SheetSession                  session;
    HandPath                      path;
    GrippingHand                  hand;
    std::unique_ptr<HapticDevice> device;

    GrippedSession(const char* name, const Scene& scene, HandPath way, const SimulatedHand& grip,
                   std::uint32_t clutch = 0)
        : session(scene), path(std::move(way)), hand{path, grip, deviceFrame({0, 0, 6e-3}, {0, 0, 1})}
    {
        hand.frame.scale  = scene.workspaceScale;
        hand.frame.clutch = clutch;
        HidapiSystem hid;
        device = deviceNamed(name)->make({.hid = hid, .hand = &hand});
        device->open();
    }
    SessionSummary run(double seconds, const OnTick& onTick)
    {
        Deformation deformation(session.object, session.scene);
        return runVirtual({session.scene, session.object, deformation.solver(), *device, hand.frame}, seconds, onTick);
    }
};

/// Held above a sheet, then pressed below its surface by a depth [m].
inline HandPath pressing(double depth)
{
    return HandPath({{0, {5e-3, 0, 6e-3}}, {2.5, {5e-3, 0, 6e-3}}, {2.8, {5e-3, 0, -depth}}, {20, {5e-3, 0, -depth}}});
}

/// A relaxed hand without damping, and a firm one, lean on a wall that is stiffer than the device renders. Expects that
/// the cap binds and the arm comes to rest.
/// \return that cap [N/m]
inline double restAtTheCap(const char* name, double depth, double scale = 1)
{
    double cap           = 0;
    Scene  scene         = sheetScene(kStiff);
    scene.workspaceScale = scale;
    for (const double grip : {50.0, 150.0, 500.0}) {
        GrippedSession s(name, scene, pressing(depth), {.stiffness = grip, .damping = 0});
        cap            = std::min(scene.stiffnessCap, s.device->info().maximumStiffness);
        double     low = 1, high = -1, stiffest = 0, force = 0; // [m], [N/m], [N]
        const auto summary = s.run(6, [&](const TickRecord& record) {
            if (record.time < 5) return;
            low      = std::min(low, record.hip.z / scale);
            high     = std::max(high, record.hip.z / scale);
            stiffest = std::max(stiffest, record.stiffness * scale);
            force    = glm::length(record.force);
        });
        std::printf("  %s, grip %3.0f N/m: swing %.1f um, %.0f N/m at the device, %.2f N\n", name, grip,
                    (high - low) * 1e6, stiffest, force);
        EXPECT_EQ(summary.fault, GovernorFault::none);
        EXPECT_EQ(summary.deviceFault, DeviceFault::none);
        EXPECT_LE(high - low, 2 * 48e-6) << "of the device, as on the Falcon's arm: two of its encoder's steps";
        EXPECT_GT(force, 0.1);
        EXPECT_LE(stiffest, cap * (1 + 1e-9)) << "rounding";
        EXPECT_GT(stiffest, 0.5 * cap) << "the cap must be near, or this shows little";
    }
    return cap;
}

} // namespace palp
