// The whole of it in virtual time: scene, plate, proxy, governor, the Falcon's driver, its wire, its motors, the arm
// and the hand that holds it.
#include "engine/session/held_falcon.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>

#include <glm/geometric.hpp>

#include "tests/session/sheet_session.h"

namespace palp {
namespace {

/// Up and down by 5 mm and to and fro by 15 mm, at incommensurate rates: what a hand does in ten minutes.
HandPath exploring(double seconds)
{
    std::vector<HandSample> way;
    for (double t = 0; t <= seconds; t += 5e-3) {
        const double out = t < 2 ? 6e-3 : 2e-3 + 5e-3 * std::cos(2 * std::numbers::pi * 0.37 * (t - 2));
        way.push_back({t, {15e-3 * std::sin(1.1 * t), 9e-3 * std::sin(0.7 * t), out}});
    }
    return HandPath(std::move(way));
}

struct Session {
    SheetSession session;
    HandPath     path;
    HoldingHand  hand{path, {.stiffness = 300, .damping = 2}, deviceFrame({0, 0, 6e-3}, {0, 0, 1})};
    HeldFalcon   falcon{hand};

    Session(const char* stiffness, double seconds, double rate)
        : session(sheetScene(stiffness)), path(exploring(seconds))
    {
        session.scene.deformationRate = rate;
        falcon.open();
    }

    SessionSummary run(double seconds, const OnSample& onSample)
    {
        Deformation deformation(session.cloud.cloud, session.index, session.scene);
        return runVirtual({session.scene, session.cloud.cloud, session.index, deformation.solver(), falcon, hand.frame},
                          seconds, onSample);
    }
};

/// Led out and in the arm is homed; then the hand goes along its path, whatever time that took.
TEST(FalconSession, ALedHandHomesTheFalconAndThenFollowsItsPath)
{
    const HandPath    path({{0, {0, 0, 6e-3}}, {1, {10e-3, 0, 6e-3}}});
    const HoldingHand hand{path, {.stiffness = 500, .damping = 20}, deviceFrame({0, 0, 6e-3}, {0, 0, 1})};
    auto              settings = HeldFalcon::ready();
    settings.falcon.homed      = false;
    HeldFalcon falcon(hand, settings);
    falcon.open();
    HapticState state;
    double      now  = 0; // [s]
    const auto  hold = [&](double z, double seconds) {
        falcon.lead({0, 0, z});
        for (const double until = now + seconds; now < until; now += 1.5e-3) state = falcon.exchange({}, now);
    };
    hold(0.048, 0.5);
    EXPECT_FALSE(state.homed) << "out is not enough";
    hold(-0.052, 0.5);
    EXPECT_TRUE(state.homed);
    hold(0, 0.5);
    EXPECT_NEAR(state.position.x, 0, 1e-3) << "the path waits";

    falcon.follow();
    for (now = 0; now < 0.5; now += 1.5e-3) state = falcon.exchange({}, now);
    EXPECT_NEAR(state.position.x, 5e-3, 1e-3) << "half way; the arm trails behind the hand";
    EXPECT_NEAR(state.time, now, 4e-3);
}

class TenMinutes : public ::testing::TestWithParam<const char*> {};

INSTANTIATE_TEST_SUITE_P(On, TenMinutes,
                         ::testing::Values(R"({"law": "constant", "value": 3e6})",
                                           R"({"law": "gaussian", "from": 0.1e6, "to": 10e6, "centre": [0, 0, 0],
                                               "sigma": 6e-3})"),
                         [](const auto& which) { return which.index == 0 ? "AStiffSheet" : "AWart"; });

/// Ten minutes of touch, five on either object: no fault, nothing that is not finite, no energy from nowhere.
TEST_P(TenMinutes, NothingEverGoesWrong)
{
    constexpr double kSeconds = 300;
    Session          s(GetParam(), kSeconds, 30); // 30 Hz: half of the solves, and the harder case
    bool             finite = true;
    std::uint32_t    faults = 0, device = 0;
    double           most = 0, step = 0; // [N]
    glm::dvec3       last{};
    const auto       summary = s.run(kSeconds, [&](const SessionSample& sample) {
        const double force = glm::length(sample.force);
        finite = finite && std::isfinite(force + glm::length(sample.hip) + glm::length(sample.hipVelocity));
        faults |= sample.faults & 0xFFU;
        device |= sample.device & 0xFFU;
        most = std::max(most, force);
        step = std::max(step, glm::length(sample.force - last));
        last = sample.force;
    });
    std::printf("  %.0f s: in contact %.0f %%, force up to %.2f N, largest step %.3f N, a tick %.0f us\n", kSeconds,
                100.0 * double(summary.contactTicks) / double(summary.ticks), most, step,
                summary.tick.quantile(0.5) * 1e6);
    EXPECT_TRUE(finite);
    EXPECT_EQ(faults, 0U);
    EXPECT_EQ(device, 0U);
    EXPECT_GT(summary.contactTicks, summary.ticks / 5);
    EXPECT_GT(most, 0.5);
    EXPECT_LE(step, 1 + 1e-9) << "the governor's slew [N]; the proxy's friction lets go in steps";
    EXPECT_EQ(summary.failedPatches, 0U) << summary.why;
}

struct Trouble {
    const char*     name;
    LinkTroubleKind kind;
    double          lasts;   ///< [s]
    bool            isFault; ///< and not merely borne
};

/// Whatever happens on the wire: zero force at the motors within 20 ms of what the driver can know, and a reason.
TEST(FalconSession, EveryTroubleOfTheWireEndsAtZeroForceWithAReason)
{
    for (const Trouble& trouble :
         {Trouble{"silence", LinkTroubleKind::silence, 1, true}, Trouble{"unplugged", LinkTroubleKind::unplug, 1, true},
          Trouble{"runts", LinkTroubleKind::runt, 1, true},
          Trouble{"stall of 100 ms", LinkTroubleKind::stall, 0.1, true},
          Trouble{"stall of 20 ms", LinkTroubleKind::stall, 0.02, false},
          Trouble{"stall of 5 ms", LinkTroubleKind::stall, 0.005, false},
          Trouble{"split", LinkTroubleKind::split, 1, false}, Trouble{"garbage", LinkTroubleKind::garbage, 1, false}}) {
        Session    s(kWart, 10, 60);
        const auto begin = s.falcon.emulator().now();
        // Deepest at 3.35 s: pushed back by then.
        const double from = begin + 3.3;
        s.falcon.emulator().cause({trouble.kind, from, from + trouble.lasts});
        double        pushed = 0, before = 0, last = from; // [s] that the motors pushed in the trouble; [N]; [s]
        std::uint32_t reason = 0;
        (void)s.run(3.3 + trouble.lasts, [&](const SessionSample& sample) {
            const double now = s.falcon.emulator().now();
            if (now < from) {
                before = glm::length(sample.force);
                return;
            }
            if (s.falcon.emulator().falcon().motors() != std::array<std::int16_t, 3>{}) pushed += now - last;
            last = now;
            reason |= sample.device & 0xFFU;
        });
        EXPECT_GT(before, 0.3) << trouble.name << ": there must be a force to lose [N]";
        if (!trouble.isFault) continue;
        EXPECT_NE(reason, 0U) << trouble.name;
        // A stall keeps back what was sent before it too: one packet more, until the next says zero.
        EXPECT_LE(pushed, trouble.kind == LinkTroubleKind::stall ? 24e-3 : 20e-3) << trouble.name;
    }
}

/// What the hand feels is what was asked for: through the driver, the wire, the motors and back by the kinematics.
TEST(FalconSession, TheForceAtTheGripIsTheGovernors)
{
    Session    s(kWart, 6, 60);
    double     worst = 0; // [rad]
    glm::dvec3 sent{};    // [N] of the tick before
    (void)s.run(6, [&](const SessionSample& sample) {
        const auto&            motors = s.falcon.emulator().falcon().motors();
        const int              most   = std::max({std::abs(motors[0]), std::abs(motors[1]), std::abs(motors[2])});
        const FalconKinematics kinematics;
        // [counts] Rounding is sqrt(3)/2 of a count at most, and the torques' condition below 1.5: half a degree at
        // 150.
        if (most > 150) {
            const glm::dvec3 grip = s.falcon.emulator().falcon().position() + glm::dvec3(0, 0, 0.125);
            glm::dvec3       felt{}; // F = K^T tau, by the torques of three unit forces
            glm::dmat3       torques;
            for (int axis = 0; axis < 3; ++axis) {
                glm::dvec3 unit{};
                unit[axis]   = 1;
                const auto t = kinematics.torques(grip, unit);
                ASSERT_TRUE(t.has_value());
                torques[axis] = {(*t)[0], (*t)[1], (*t)[2]};
            }
            felt                    = glm::inverse(torques) * -glm::dvec3(motors[0], motors[1], motors[2]);
            const glm::dvec3 wanted = glm::conjugate(s.hand.frame.sceneFromDevice) * sent;
            const double     cosine = glm::dot(felt, wanted) / (glm::length(felt) * glm::length(wanted));
            worst                   = std::max(worst, std::acos(std::min(1.0, cosine)));
        }
        sent = sample.force;
    });
    std::printf("  largest angle %.3f degrees\n", worst * 180 / std::numbers::pi);
    EXPECT_GT(worst, 0) << "something was compared";
    EXPECT_LT(worst, 0.5 * std::numbers::pi / 180);
}

} // namespace
} // namespace palp
