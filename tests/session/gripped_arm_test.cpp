#include "engine/session/gripped_arm.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

#include "engine/core/contract.h"
#include "tests/session/sheet_session.h"

namespace palp {
namespace {

/// A wart a hundred times as stiff, which the cap of 1000 N/m binds on.
const char* const kHardWart = R"({"law": "gaussian", "from": 0.1e6, "to": 10e6, "centre": [0, 0, 0], "sigma": 6e-3})";

struct Felt {
    double        swing = 0, force = 0; ///< [m], [N] in the last half second
    std::uint32_t faults = 0;           ///< of the governor and the device, together
    bool          finite = true;
};

/// The hand goes down 5 mm from above, the arm in its grip, and stays.
Felt released(const SheetSession& session, double grip, double seconds)
{
    const HandPath     down({{0, {0, 0, 5e-3}}, {1.8, {0, 0, 5e-3}}, {1.85, {0, 0, -4e-3}}, {2, {0, 0, -4e-3}}});
    const GrippingHand hand{down, {.stiffness = grip, .damping = 2}, deviceFrame({0, 0, 5e-3}, {0, 0, 1})};
    GrippedArm         arm(hand);
    arm.open();
    Deformation deformation(session.object, session.scene);
    Felt        felt;
    double      low = 1, high = -1; // [m]
    runVirtual({session.scene, session.object, deformation.solver(), arm, hand.frame}, seconds,
               [&](const TickRecord& s) {
                   felt.finite = felt.finite && std::isfinite(glm::length(s.force) + glm::length(s.hip));
                   felt.faults |= (s.faults | s.device) & 0xFFU;
                   if (s.time < seconds - 0.5) return;
                   low        = std::min(low, s.hip.z);
                   high       = std::max(high, s.hip.z);
                   felt.force = std::max(felt.force, glm::length(s.force));
               });
    felt.swing = high - low;
    return felt;
}

TEST(GrippedArm, ReleasedIntoAHardWartThroughTheWholeEngineItSettles)
{
    const SheetSession session(sheetScene(kHardWart));
    for (const double grip : {150.0, 500.0}) {
        const Felt felt = released(session, grip, 4);
        EXPECT_TRUE(felt.finite);
        EXPECT_EQ(felt.faults, 0U);
        EXPECT_LE(felt.swing, 2 * 48e-6) << "two encoder steps; grip " << grip << " N/m";
        EXPECT_GT(felt.force, 0.3) << "it rests in contact";
    }
}

TEST(GrippedArm, ForcesMoveIt)
{
    const SheetSession session(sheetScene(kHardWart));
    EXPECT_LT(released(session, 150, 3).force, released(session, 500, 3).force) << "a firmer hand gets deeper";
}

TEST(GrippedArm, ThePathMustLieInTheWorkspace)
{
    const HandPath far({{0, {0, 0, 0}}, {1, {0.1, 0, 0}}});
    EXPECT_THROW(GrippedArm({far, {.stiffness = 150}}), Error);
}

TEST(DeviceFrames, ADeviceOnATableBeforeTheObject)
{
    for (const glm::dvec3 outward : {glm::dvec3(0, 0, 2), glm::dvec3(1, 0, 0), glm::dvec3(0.3, -0.5, 0.7)}) {
        const DeviceFrame frame = deviceFrame({1, 2, 3}, outward);
        HapticState       up;
        up.position = up.velocity = {0, 0.01, 0};
        const Hand hand           = frame.handOf(up);
        EXPECT_NEAR(glm::length(hand.position - glm::dvec3(1, 2, 3) - 0.01 * glm::normalize(outward)), 0, 1e-15);
        EXPECT_NEAR(glm::length(hand.velocity - 0.01 * glm::normalize(outward)), 0, 1e-15) << "rounding";
    }
}

} // namespace
} // namespace palp
