// The whole of it in virtual time: scene, plate, proxy, governor, the Falcon's driver, its wire, its motors, the arm
// and the hand that holds it.
#include "engine/session/gripped_falcon.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <numbers>
#include <utility>

#include <glm/geometric.hpp>

#include "device/hid/hidapi_system.h"
#include "tests/session/sheet_session.h"
#include "tests/support/sanitized.h"
#include "tests/support/temporary_folder.h"

namespace palp {
namespace {

/// Up and down by 5 mm and to and fro by 15 mm, at incommensurate rates, most of the time in contact: what a hand does
/// in ten minutes.
HandPath exploring(double seconds)
{
    std::vector<HandPose> way;
    for (double t = 0; t <= seconds; t += 5e-3) {
        const double out = t < 2 ? 6e-3 : -2e-3 + 5e-3 * std::cos(2 * std::numbers::pi * 0.37 * (t - 2));
        way.push_back({t, {15e-3 * std::sin(1.1 * t), 9e-3 * std::sin(0.7 * t), out}});
    }
    return HandPath(std::move(way));
}

/// Down and to rest in contact.
HandPath resting()
{
    return HandPath({{0, {5e-3, 0, 6e-3}}, {1, {5e-3, 0, 6e-3}}, {1.2, {5e-3, 0, -2e-3}}, {20, {5e-3, 0, -2e-3}}});
}

struct Session {
    SheetSession  session;
    HandPath      path;
    GrippingHand  hand{path, {.stiffness = 2000, .damping = 5}, deviceFrame({0, 0, 6e-3}, {0, 0, 1})};
    GrippedFalcon falcon;

    Session(const char* stiffness, HandPath way, double rate,
            const Ft232EmulatorSettings& settings = GrippedFalcon::ready())
        : session(sheetScene(stiffness)), path(std::move(way)), falcon(hand, settings)
    {
        session.scene.deformationRate = rate;
        falcon.open();
    }

    SessionSummary run(double seconds, const OnTick& onTick)
    {
        Deformation deformation(session.object, session.scene);
        return runVirtual({session.scene, session.object, deformation.solver(), falcon, hand.frame}, seconds, onTick);
    }
};

/// What is stored of the emulated Falcon is used by `--hand falcon-emulator` as that of a real one would be, so that a
/// user can try a damaged file.
TEST(FalconSession, TheEmulatedFalconRunsAsItsCalibrationFoundIt)
{
    const TemporaryFolder folder;
    const char* const     config = std::getenv("XDG_CONFIG_HOME");
    const std::string     before = config ? config : "";
    ::setenv("XDG_CONFIG_HOME", folder.path().c_str(), 1);

    HidapiSystem       hid;
    const HandPath     path({{0, {0, 0, 6e-3}}, {1, {10e-3, 0, 6e-3}}});
    const GrippingHand hand{path, {.stiffness = 500, .damping = 20}, deviceFrame({0, 0, 6e-3}, {0, 0, 1})};
    const auto         opened = [&](const DeviceOptionValues& options) {
        auto device = kFalconEmulatorRecord.make({.hid = hid, .options = options, .hand = &hand});
        device->open();
        return device->info();
    };
    const double     truth   = -fallingArm().weight.y;
    HapticDeviceInfo without = opened({});
    EXPECT_EQ(without.serial, kEmulatedFalconSerial);
    EXPECT_EQ(-without.weight.y, truth);
    EXPECT_EQ(without.note, "") << "it needs no calibration";
    EXPECT_EQ(kFalconEmulatorRecord.calibration(), "");

    const auto file = writeFalconConstants(
        {.serial = kEmulatedFalconSerial, .countsPerTorque = 4321, .armMass = 0.2, .date = "2026-11-22"});
    HapticDeviceInfo with = opened({});
    EXPECT_NEAR(-with.weight.y, 0.2 * 9.81, 1e-12);
    EXPECT_TRUE(holds(with.note, {"as its calibration found it", file.string()})) << with.note;
    EXPECT_TRUE(holds(opened({{"--falcon-counts", "5000"}}).note, {"5000", "given by hand", "4321"}));
    EXPECT_TRUE(holds(opened({{"--falcon-cold", "true"}}).note, {"as its calibration found it"})) << "cold as well";
    EXPECT_TRUE(holds(kFalconEmulatorRecord.calibration(), {"4321 counts per N m", "200 g"}));

    static_cast<void>(folder.write("palpate/falcon-EMULATED.json", "{"));
    EXPECT_TRUE(holds(refusalOf([&] { static_cast<void>(opened({})); }), {"the Falcon's calibration is damaged"}));
    EXPECT_TRUE(holds(kFalconEmulatorRecord.calibration(), {"damaged"}));

    before.empty() ? ::unsetenv("XDG_CONFIG_HOME") : ::setenv("XDG_CONFIG_HOME", before.c_str(), 1);
}

/// Moved out and in the arm is homed; then the hand goes along its path, whatever time that took.
TEST(FalconSession, AHandHomesTheFalconAndThenFollowsItsPath)
{
    const HandPath     path({{0, {0, 0, 6e-3}}, {1, {10e-3, 0, 6e-3}}});
    const GrippingHand hand{path, {.stiffness = 500, .damping = 20}, deviceFrame({0, 0, 6e-3}, {0, 0, 1})};
    auto               settings = GrippedFalcon::ready();
    settings.falcon.homed       = false;
    GrippedFalcon falcon(hand, settings);
    EXPECT_TRUE(falcon.info().needsHoming);
    falcon.open();
    falcon.home();
    HapticState state;
    double      now = 0; // [s]
    const auto  run = [&](double until) {
        for (; now < until; now += 1.5e-3) state = falcon.exchange({}, now);
    };
    run(0.7);
    EXPECT_FALSE(state.homed) << "out is not enough";
    run(2);
    EXPECT_TRUE(state.homed);
    EXPECT_TRUE(falcon.isBeingHomed()) << "the hand is still on its way back";
    run(2.8);
    EXPECT_NEAR(state.position.z, 0, 1e-3) << "back in the middle";
    EXPECT_NEAR(state.position.x, 0, 1e-3) << "the path waits";
    run(4);
    EXPECT_FALSE(falcon.isBeingHomed());
    EXPECT_NEAR(state.position.x, 10e-3, 1e-3) << "the path begins by itself";

    now = 0; // the session's clock, which starts anew
    run(0.5);
    EXPECT_NEAR(state.position.x, 5e-3, 1e-3) << "half way; the arm trails behind the hand";
    EXPECT_NEAR(state.time, now, 4e-3);
}

struct Object {
    const char* stiffness;
    double      contrast; ///< between the most and the least compliance that the hand meets, at least and at most:
    double      most;     ///< [1]
};

class TenMinutes : public ::testing::TestWithParam<Object> {};

INSTANTIATE_TEST_SUITE_P(On, TenMinutes,
                         ::testing::Values(Object{R"({"law": "constant", "value": 3e6})", 1, 1 + 1e-6},
                                           Object{R"({"law": "gaussian", "from": 0.1e6, "to": 10e6,
                                                     "centre": [0, 0, 0], "sigma": 6e-3})",
                                                  2, 100}),
                         [](const auto& which) { return which.index == 0 ? "AStiffSheet" : "AWart"; });

/// Ten minutes of touch, five on either object: no fault, nothing that is not finite, no energy from nowhere.
TEST_P(TenMinutes, NothingEverGoesWrong)
{
    constexpr double kSeconds = kSanitized ? 30 : 300;                 // [s] the same code again
    Session          s(GetParam().stiffness, exploring(kSeconds), 30); // 30 Hz: half of the solves, and the harder case
    bool             finite = true;
    std::uint32_t    faults = 0, device = 0;
    double           most = 0, step = 0; // [N]
    glm::dvec3       last{};
    const auto       summary = s.run(kSeconds, [&](const TickRecord& record) {
        const double force = glm::length(record.force);
        finite = finite && std::isfinite(force + glm::length(record.hip) + glm::length(record.hipVelocity));
        faults |= record.faults & 0xFFU;
        device |= record.device & 0xFFU;
        most = std::max(most, force);
        step = std::max(step, glm::length(record.force - last));
        last = record.force;
    });
    std::printf("  %.0f s: in contact %.0f %%, force up to %.2f N, largest step %.3f N, a tick %.0f us\n", kSeconds,
                100.0 * double(summary.contactTicks) / double(summary.ticks), most, step,
                summary.tick.quantile(0.5) * 1e6);
    EXPECT_TRUE(finite);
    EXPECT_EQ(faults, 0U);
    EXPECT_EQ(device, 0U);
    EXPECT_GT(2 * summary.contactTicks, summary.ticks);
    EXPECT_GT(most, 2.0) << "N";
    EXPECT_GE(summary.mostCompliance / summary.leastCompliance, GetParam().contrast) << "the hand goes over it";
    EXPECT_LE(summary.mostCompliance / summary.leastCompliance, GetParam().most);
    EXPECT_LE(step, 1 + 1e-9) << "the governor's slew [N]; the proxy's friction lets go in steps";
    EXPECT_EQ(summary.failedPatches, 0U) << summary.why;
}

enum class Ends {
    byTheDriver, ///< which says zero, or has the motors let go, in time
    byTheHold,   ///< nothing can reach the motors: the firmware's own watchdog is the last line
    notAtAll     ///< it is borne, and force flows again
};

struct Trouble {
    const char*     name;
    LinkTroubleKind kind;
    double          lasts; ///< [s]
    Ends            ends;
};

/// Whatever happens on the wire: zero force at the motors within 20 ms and a reason, or no fault at all. Where the
/// driver sees to it, with a firmware that would hold a torque for ever.
TEST(FalconSession, EveryTroubleOfTheWireEndsAtZeroForceWithAReasonOrIsBorne)
{
    for (const Trouble& trouble : {Trouble{"silence", LinkTroubleKind::silence, 1, Ends::byTheDriver},
                                   Trouble{"runts", LinkTroubleKind::runt, 1, Ends::byTheDriver},
                                   Trouble{"unplugged", LinkTroubleKind::unplug, 1, Ends::byTheHold},
                                   Trouble{"stall of 100 ms", LinkTroubleKind::stall, 0.1, Ends::byTheHold},
                                   Trouble{"stall of 20 ms", LinkTroubleKind::stall, 0.02, Ends::notAtAll},
                                   Trouble{"stall of 5 ms", LinkTroubleKind::stall, 0.005, Ends::notAtAll},
                                   Trouble{"split", LinkTroubleKind::split, 1, Ends::notAtAll},
                                   Trouble{"merged", LinkTroubleKind::merged, 1, Ends::notAtAll},
                                   Trouble{"repeated", LinkTroubleKind::repeat, 1, Ends::notAtAll},
                                   Trouble{"garbage", LinkTroubleKind::garbage, 1, Ends::notAtAll}}) {
        Ft232EmulatorSettings settings = GrippedFalcon::ready();
        if (trouble.ends == Ends::byTheDriver) settings.falcon.holdTime = 1e6;
        Session      s(kWart, resting(), 60, settings);
        const double from = s.falcon.emulator().now() + 3.3; // [s] at rest in contact
        s.falcon.emulator().cause({trouble.kind, from, from + trouble.lasts});
        double        pushed = 0, before = 0, last = from, after = 0; // [s] in the trouble; [N]; [s]; [N]
        std::uint32_t reason = 0;
        (void)s.run(3.3 + trouble.lasts + 0.5, [&](const TickRecord& record) {
            const double now = s.falcon.emulator().now();
            after            = glm::length(record.force);
            if (now < from) before = after;
            if (now < from || now > from + trouble.lasts) return;
            if (s.falcon.emulator().falcon().motors() != std::array<std::int16_t, 3>{}) pushed += now - last;
            last = now;
            reason |= record.device & 0xFFU;
        });
        EXPECT_GT(before, 0.3) << trouble.name << ": there must be a force to lose [N]";
        if (trouble.ends == Ends::notAtAll) {
            EXPECT_EQ(reason, 0U) << trouble.name;
            EXPECT_GT(after, 0.1) << trouble.name << ": it flows again [N]";
            continue;
        }
        EXPECT_NE(reason, 0U) << trouble.name;
        // What went out before a stall is still acted on, and then held: 20 ms of hold after the last packet.
        EXPECT_LE(pushed, trouble.ends == Ends::byTheHold ? 24e-3 : 20e-3) << trouble.name;
    }
}

/// What the motors give is what was asked for, and what carries the arm: through the driver, the wire, the motors and
/// back by the kinematics.
TEST(FalconSession, TheForceAtTheGripIsTheGovernors)
{
    Session    s(kWart, exploring(6), 60);
    double     worst = 0; // [rad]
    glm::dvec3 sent{};    // [N] of the tick before
    (void)s.run(6, [&](const TickRecord& record) {
        const auto&            motors = s.falcon.emulator().falcon().motors();
        const int              most   = std::max({std::abs(motors[0]), std::abs(motors[1]), std::abs(motors[2])});
        const FalconKinematics kinematics;
        // [counts] Rounding is sqrt(3)/2 of a count at most, and the torques' condition below 1.5: half a degree at
        // 150.
        if (most > 150 && sent != glm::dvec3(0)) {
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
        const bool isWhole = (record.actions & static_cast<std::uint32_t>(GovernorAction::lifting)) == 0;
        sent = isWhole ? record.force - kCarried * s.hand.frame.inScene(s.falcon.info()).weight : glm::dvec3(0);
    });
    std::printf("  largest angle %.3f degrees\n", worst * 180 / std::numbers::pi);
    EXPECT_GT(worst, 0) << "something was compared";
    EXPECT_LT(worst, 0.5 * std::numbers::pi / 180);
}

} // namespace
} // namespace palp
