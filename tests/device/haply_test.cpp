// The driver of Haply's devices against an emulated Inverse Service, in virtual time.
#include "device/haply/emulated_haply.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include <glm/geometric.hpp>

#include "device/haply/haply_record.h"
#include "engine/core/contract.h"
#include "tests/device/governed.h"

namespace palp {
namespace {

constexpr double kTick = 1e-3;      // [s]
constexpr double kZero = 30e-3;     // [s] by which a force has ended, whatever happens
constexpr double kStep = 0.5001e-4; // [N] of a decimal place in a message

struct Bench {
    EmulatedHaply               service;
    std::unique_ptr<LineDevice> device;
    HapticState                 state{};
    double                      now = 0; // [s]

    explicit Bench(const EmulatedHaplySettings& settings = {}, const HaplyLineSettings& line = {},
                   EmulatedHaply::Arm arm = {})
        : service(settings, std::move(arm)), device(makeHaply(service.opener(), line, {.pace = LinePace::caller}))
    {
    }
    void run(double seconds, const GovernedForce& force)
    {
        for (const double end = now + seconds - kTick / 2; now < end; now += kTick) {
            service.moveTo(now);
            state = device->exchange(force, now);
        }
    }
};

std::string refusal(const EmulatedHaplySettings& settings, const HaplyLineSettings& line = {})
{
    Bench bench(settings, line);
    try {
        bench.device->open();
    } catch (const Error& error) {
        return error.what();
    }
    return {};
}

TEST(HaplyMessages, AllCommandsToADeviceHaveOneLength)
{
    const std::size_t size = haplyCommand("049D", HaplyDialect::vector, {}).size();
    for (const double newtons : {0.0, -0.00001, 1.0, -5.0, 9.99999, -1e6})
        for (const HaplyDialect dialect : {HaplyDialect::vector, HaplyDialect::values})
            EXPECT_EQ(haplyCommand("049D", dialect, glm::dvec3(newtons)).size(), size) << newtons;
    EXPECT_NE(haplyCommand("049D", HaplyDialect::vector, glm::dvec3(1)).find("\"vector\""), std::string::npos);
    EXPECT_NE(haplyCommand("049D", HaplyDialect::values, glm::dvec3(1)).find("\"values\""), std::string::npos);
    EXPECT_EQ(haplyCommand("049D", HaplyDialect::values, glm::dvec3(1)).find("\"vector\""), std::string::npos)
        << "never both: the service adds them up";
}

/// A guardian takes the force out of the masked frame itself.
TEST(HaplyMessages, AFramesZeroIsTheSameFrameWithoutItsForce)
{
    const std::array<std::uint8_t, 4> mask{0x37, 0xFA, 0x21, 0x3D};
    const auto                        frameOf = [&](const std::string& text) {
        const std::string frame = webSocketFrame(WebSocketKind::text, text, mask);
        return std::vector<std::uint8_t>(frame.begin(), frame.end());
    };
    for (const std::string id : {"049D", "a-device-with-31-letters-in-all_"}) {
        auto frame = frameOf(haplyCommand(id, HaplyDialect::vector, glm::dvec3(-1.5, 0.0203, 9.9)));
        EXPECT_TRUE(kHaplyZero.pushes(frame));
        kHaplyZero.silence(frame);
        EXPECT_FALSE(kHaplyZero.pushes(frame));
        WebSocketReader reader(WebSocketSide::client);
        reader.feed(frame);
        const auto message = reader.next();
        ASSERT_TRUE(message) << "it is a whole frame";
        EXPECT_EQ(message->payload, haplyCommand(id, HaplyDialect::vector, glm::dvec3(0))) << "digits of the name stay";
        EXPECT_FALSE(kHaplyZero.pushes(frameOf(haplyCommand(id, HaplyDialect::vector, {}))));
        EXPECT_TRUE(kHaplyZero.pushes(frameOf(haplyCommand(id, HaplyDialect::values, glm::dvec3(0, 0, 1e-4)))));
    }
    std::vector<std::uint8_t> odd{0x81, 0xFF, 1, 2, 3};
    EXPECT_FALSE(kHaplyZero.pushes(odd));
    kHaplyZero.silence(odd); // must not read beyond it
}

TEST(HaplyMessages, TheWordBeforeAForceFollowsFromTheVersion)
{
    EXPECT_EQ(dialectOf("3.5.0"), HaplyDialect::vector);
    EXPECT_EQ(dialectOf("v3.10-rc1"), HaplyDialect::vector);
    EXPECT_EQ(dialectOf("4.0"), HaplyDialect::vector);
    EXPECT_EQ(dialectOf("3.4.9"), HaplyDialect::values);
    EXPECT_EQ(dialectOf("3"), std::nullopt);
    EXPECT_EQ(dialectOf("main-abc"), std::nullopt);
}

TEST(HaplyMessages, FramesOfReferenceAreTurnedAndNotMirrored)
{
    const glm::dvec3 x(1, 0, 0), y(0, 1, 0);
    EXPECT_EQ(fromHaply({0, 0, 1}), y) << "up there is z";
    EXPECT_EQ(fromHaply({0, -1, 0}), glm::dvec3(0, 0, 1)) << "towards the user there is -y";
    EXPECT_EQ(glm::cross(fromHaply(x), fromHaply(y)), fromHaply(glm::cross(x, y)));
    EXPECT_EQ(toHaply(fromHaply({1, 2, 3})), glm::dvec3(1, 2, 3));
}

TEST(HaplyMessages, DevicesComeInAListOnly)
{
    const std::string one = R"({"device_id": "04BA", "status": {}})";
    EXPECT_EQ(haplyDevices("{\"inverse3\": [" + one + "]}").size(), 1U);
    EXPECT_TRUE(haplyDevices("{\"inverse3\": {\"a\": " + one + "}}").empty());
    EXPECT_TRUE(haplyDevices("{\"inverse3\": null}").empty());
    EXPECT_TRUE(haplyDevices("{}").empty());
}

TEST(HaplyMessages, AGripThatSaysNothingHoldsNoButton)
{
    const std::string device = R"("inverse3":[{"device_id":"049D","state":{"cursor_position":{"x":0,"y":0,"z":0},
        "cursor_velocity":{"x":0,"y":0,"z":0}},"status":{"calibrated":true,"ready":true}}])";
    HaplyState        state;
    ASSERT_EQ(
        takeHaplyState("{" + device + R"(,"wireless_verse_grip":[{"state":{"buttons":{"a":true}}}]})", "049D", state),
        HaplyVerdict::good);
    EXPECT_EQ(state.buttons, 1U);
    EXPECT_FALSE(state.rendered) << "it did not say what it renders";
    for (const char* grips : {"", R"(,"wireless_verse_grip":[])", R"(,"wireless_verse_grip":[{"device_id":"1"}])"}) {
        state.buttons = 1;
        ASSERT_EQ(takeHaplyState("{" + device + grips + "}", "049D", state), HaplyVerdict::good);
        EXPECT_EQ(state.buttons, 0U) << "a grip that sleeps would hold the clutch for ever";
    }
}

TEST(HaplyPaths, HaveAnAddressOrANumberOrBoth)
{
    EXPECT_EQ(parseHaplyPath("[::1]:9000/049D").address(), "::1:9000");
    EXPECT_EQ(parseHaplyPath("[::1]/049D").host, "::1");

    EXPECT_EQ(parseHaplyPath("").address(), "127.0.0.1:10001");
    const HaplyPath elsewhere = parseHaplyPath("lab:9000");
    EXPECT_EQ(parseHaplyPath("", elsewhere).address(), "lab:9000");
    EXPECT_EQ(parseHaplyPath("049D", elsewhere).address(), "lab:9000");
    EXPECT_EQ(parseHaplyPath("here:1", elsewhere).address(), "here:1") << "what is said wins";
    EXPECT_EQ(parseHaplyPath("049D").id, "049D");
    EXPECT_EQ(parseHaplyPath("lab:9000").address(), "lab:9000");
    EXPECT_EQ(parseHaplyPath("lab:9000/049D").id, "049D");
    for (const char* text :
         {"lab:", "lab:0", "lab:70000", ":9", "lab:1x", "a b", "lab:1/a b", "049D\"}", "127.0.0.1", "[::1", "[::1]x"})
        EXPECT_THROW((void)parseHaplyPath(text), Error) << text;
}

/// A service that takes `vector` and one that takes `values`: the force that arrives is the governor's.
TEST(HaplyDevice, TheForceThatArrivesIsTheGovernors)
{
    for (const HaplyDialect dialect : {HaplyDialect::vector, HaplyDialect::values}) {
        Bench bench({.version = dialect == HaplyDialect::vector ? "3.5.0" : "3.4.2", .dialect = dialect});
        bench.device->open();
        const GovernedForce push = governed({1, -0.5, 0.25});
        bench.run(0.1, push);
        EXPECT_EQ(bench.state.fault, DeviceFault::none);
        EXPECT_LT(glm::length(bench.service.force() - push.newtons()), 3 * kStep) << name(dialect);
        EXPECT_EQ(bench.service.profile(), "org.palpate:session");
        bench.device->close();
        EXPECT_EQ(bench.service.force(), glm::dvec3(0));
    }
}

/// A version that misleads: the word is changed once, after a fault that the governor sees.
TEST(HaplyDevice, AForceThatIsIgnoredIsSaidInTheOtherWordOnce)
{
    Bench bench({.version = "3.5.0", .dialect = HaplyDialect::values});
    bench.device->open();
    const GovernedForce push = governed({1, 0, 0});
    bool                told = false;
    for (int n = 0; n < 400; ++n) {
        bench.run(kTick, push);
        told = told || bench.state.fault == DeviceFault::ownWatchdog;
    }
    EXPECT_TRUE(told) << "the governor engages anew";
    EXPECT_EQ(bench.state.fault, DeviceFault::none);
    EXPECT_NEAR(bench.service.force().x, 1, kStep);
}

TEST(HaplyDevice, AServiceThatTakesNoForcesIsAFaultInWords)
{
    Bench bench({.takesForce = false});
    bench.device->open();
    bench.run(1, governed({1, 0, 0}));
    EXPECT_EQ(bench.state.fault, DeviceFault::ownWatchdog);
    EXPECT_NE(std::string(bench.device->faultWords()).find("does not take forces"), std::string::npos);
}

TEST(HaplyDevice, AServiceThatDoesNotSayWhatItRendersKeepsItsWord)
{
    Bench bench({.echoes = false});
    bench.device->open();
    bench.run(2, governed({1, 0, 0}));
    EXPECT_EQ(bench.state.fault, DeviceFault::none);
    EXPECT_NEAR(bench.service.force().x, 1, kStep);
}

TEST(HaplyDevice, AFloodOfAnswersToNothingIsAFault)
{
    Bench bench;
    bench.device->open();
    bench.run(0.1, governed({1, 0, 0}));
    EXPECT_EQ(bench.state.fault, DeviceFault::none);
    for (int n = 0; n < 200; ++n) {
        for (int k = 0; k < 3; ++k) bench.service.repeat();
        bench.run(kTick, governed({1, 0, 0}));
    }
    EXPECT_EQ(bench.state.fault, DeviceFault::ownWatchdog) << "old places would pass for new ones";
    EXPECT_NE(std::string(bench.device->faultWords()).find("nobody asked"), std::string::npos);
}

TEST(HaplyDevice, AServiceThatStopsTakingForcesIsAFaultLaterToo)
{
    Bench bench;
    bench.device->open();
    bench.run(1, governed({1, 0, 0}));
    EXPECT_EQ(bench.state.fault, DeviceFault::none);
    bench.service.ignoreForces();
    bool told = false;
    for (int n = 0; n < 400; ++n) {
        bench.run(kTick, governed({1, 0, 0}));
        told = told || std::string(bench.device->faultWords()).find("no longer renders") != std::string::npos;
    }
    EXPECT_TRUE(told) << "another program may have taken it";
}

/// A force that is too small to judge by changes no word.
TEST(HaplyDevice, WithoutAForceNothingIsFoundOut)
{
    Bench bench({.takesForce = false});
    bench.device->open();
    bench.run(1, governed({0.03, 0, 0}));
    EXPECT_EQ(bench.state.fault, DeviceFault::none);
}

TEST(HaplyDevice, PositionSpeedTurnAndButtonsComeInOurFrame)
{
    glm::dvec3 place{};
    Bench      bench({}, {}, [&](const glm::dvec3&, double dt) { return place += glm::dvec3(0.02, 0.01, -0.03) * dt; });
    const double     half = std::sqrt(0.5);
    const glm::dquat turn(half, 0, half, 0); // a quarter about our y
    bench.service.turn(turn);
    bench.service.press(5);
    bench.device->open();
    bench.run(1, {});
    EXPECT_LT(glm::length(bench.state.position - place), 1e-12);
    EXPECT_LT(glm::length(bench.state.velocity - glm::dvec3(0.02, 0.01, -0.03)), 1e-9);
    EXPECT_GT(std::abs(glm::dot(bench.state.orientation, turn)), 1 - 1e-12);
    EXPECT_EQ(bench.state.buttons, 5U);
    EXPECT_TRUE(bench.state.homed && bench.state.inBox);
    EXPECT_TRUE(bench.device->info().rotates);
    EXPECT_FALSE(Bench({.hasGrip = false}).device->info().hasGripper);
}

TEST(HaplyDevice, OfSeveralTheNumberDecides)
{
    Bench bench({.ids = {"AAAA", "049D"}}, {.id = "049D"});
    bench.device->open();
    EXPECT_EQ(bench.device->info().path, "127.0.0.1:10001/049D");
    bench.run(0.1, governed({1, 0, 0}));
    EXPECT_EQ(bench.service.force(), glm::dvec3(0)) << "the first one is not ours";
    EXPECT_NE(refusal({.ids = {"AAAA", "BBBB"}}, {.id = "049D", .openWait = 0.1}).find("AAAA, BBBB"),
              std::string::npos);
}

TEST(HaplyDevice, ADeviceThatComesLateIsAwaitedAndAMissingOneIsSaid)
{
    EXPECT_NE(refusal({.ids = {}}, {.openWait = 0.3}).find("knows a grip alone"), std::string::npos);
    EXPECT_NE(refusal({.ids = {}, .hasGrip = false}, {.openWait = 0.3}).find("knows no device"), std::string::npos);

    EmulatedHaply late({.ids = {}});
    int           connections = 0;
    const auto    device      = makeHaply(
        [&](HaplyPort port) {
            if (++connections == 5) late.plug({"049D"});
            return late.connect(port);
        },
        {}, {.pace = LinePace::caller});
    device->open();
    EXPECT_EQ(device->info().path, "127.0.0.1:10001/049D");
}

TEST(HaplyDevice, WithoutAServiceItSaysWhatToTry)
{
    const auto device = makeHaply([](HaplyPort) -> std::unique_ptr<ByteLine> { throw LineEnded("Connection refused"); },
                                  {}, {.pace = LinePace::caller});
    try {
        device->open();
        FAIL() << "there is nothing to open";
    } catch (const Error& error) {
        EXPECT_NE(std::string(error.what()).find("is haply-inverse-service running?"), std::string::npos)
            << error.what();
    }
    EXPECT_EQ(device->read(0).fault, DeviceFault::closed);
}

TEST(HaplyDevice, WhatTheServiceDoesToAForceIsSaid)
{
    Bench bench({.forceGate = 0.3, .forceScale = 0.5});
    bench.device->open();
    const std::string note = bench.device->info().note;
    EXPECT_EQ(note.find("gate"), std::string::npos) << "which acts on a force that oscillates only: " << note;
    EXPECT_NE(note.find("a force scale of 0.5"), std::string::npos) << note;
    bench.device->close();
    Bench neutral;
    neutral.device->open();
    EXPECT_EQ(neutral.device->info().note, "");
    EXPECT_NE(describeFilters({}, {}).find("does not say"), std::string::npos) << "unknown is not neutral";
    EXPECT_EQ(describeFilters({}, 1), "");
    EXPECT_NE(describeGate({.forceGate = 0.3}).find("0.3: it lessens a force while"), std::string::npos);
    EXPECT_EQ(describeGate({.forceGate = 0}), "");
    EXPECT_EQ(describeGate({}), "");
}

TEST(HaplyDevice, NotCalibratedIsNotHomedAndHasNoForce)
{
    Bench bench;
    bench.device->open();
    bench.run(0.1, governed({1, 0, 0}));
    ASSERT_GT(bench.service.force().x, 0.9);
    bench.service.cause(HaplyTrouble::uncalibrated);
    bench.run(5e-3, governed({1, 0, 0}));
    EXPECT_FALSE(bench.state.homed);
    EXPECT_EQ(bench.service.force(), glm::dvec3(0));
}

struct TroubleCase {
    const char*  name;
    HaplyTrouble trouble;
    DeviceFault  fault; // none: it is borne
};

class HaplyTroubles : public ::testing::TestWithParam<TroubleCase> {};

INSTANTIATE_TEST_SUITE_P(Of, HaplyTroubles,
                         ::testing::Values(TroubleCase{"Silence", HaplyTrouble::silence, DeviceFault::silent},
                                           TroubleCase{"Garbage", HaplyTrouble::garbage, DeviceFault::garbled},
                                           TroubleCase{"BrokenFrames", HaplyTrouble::brokenFrame,
                                                       DeviceFault::linkLost},
                                           TroubleCase{"NotANumber", HaplyTrouble::notANumber, DeviceFault::garbled},
                                           TroubleCase{"Huge", HaplyTrouble::huge, DeviceFault::garbled},
                                           TroubleCase{"Keyless", HaplyTrouble::keyless, DeviceFault::garbled},
                                           TroubleCase{"Unlisted", HaplyTrouble::unlisted, DeviceFault::unplugged},
                                           TroubleCase{"CutInAFrame", HaplyTrouble::cut, DeviceFault::linkLost},
                                           TroubleCase{"Split", HaplyTrouble::split, DeviceFault::none},
                                           TroubleCase{"Merged", HaplyTrouble::merged, DeviceFault::none},
                                           TroubleCase{"Fragments", HaplyTrouble::fragments, DeviceFault::none}),
                         [](const auto& which) { return which.param.name; });

/// Zero force within 30 ms and a reason, or no fault at all; after a fault that may pass the force comes back.
TEST_P(HaplyTroubles, EndAtZeroForceWithAReasonOrAreBorne)
{
    // While the connection lasts the driver ends the force, of a service that would hold it for ever; with the
    // connection the service does.
    Bench bench({.hold = isFinal(GetParam().fault) ? 5e-3 : 1e6});
    bench.device->open();
    const GovernedForce push = governed({1, 0, 0});
    bench.run(0.1, push);
    ASSERT_GT(bench.service.force().x, 0.9);
    const double since = bench.now;
    bench.service.cause(GetParam().trouble);
    bench.run(0.2, push);
    EXPECT_EQ(bench.state.fault, GetParam().fault) << name(bench.state.fault);
    const bool isBorne = GetParam().fault == DeviceFault::none;
    if (isBorne) {
        EXPECT_GT(bench.service.force().x, 0.9);
        EXPECT_EQ(bench.state.missed, 0);
    } else {
        EXPECT_EQ(bench.service.force(), glm::dvec3(0));
        const double soon = isFinal(GetParam().fault) ? kZero : 15e-3; // 10 ms old, an answer's time, two ticks
        EXPECT_LE(bench.service.lastForce() - since, soon);
    }
    bench.service.cause(HaplyTrouble::none);
    bench.run(0.2, push);
    EXPECT_EQ(bench.state.fault, isFinal(GetParam().fault) ? GetParam().fault : DeviceFault::none);
    EXPECT_EQ(bench.service.force().x > 0.9, !isFinal(GetParam().fault));
    if (isFinal(GetParam().fault)) {
        EXPECT_STRNE(bench.device->faultWords(), "");
    }
    EXPECT_LT(glm::length(bench.state.position), 1e-9) << "no place came from it";
}

TEST(HaplyEvents, AreFaultsInWords)
{
    struct Case {
        const char* event;
        DeviceFault fault;
        const char* words;
    };
    for (const Case& c :
         {Case{R"({"name":"device-disconnected","data":{"device_id":"049D"}})", DeviceFault::unplugged, "unplugged"},
          Case{R"({"name":"device-disconnected","data":{"device_id":"BBBB"}})", DeviceFault::none, ""},
          Case{R"({"name":"device-safety-triggered","data":{"safety_type":"stall_detected"}})",
               DeviceFault::ownWatchdog, "stalls"},
          Case{R"({"name":"device-safety-triggered","data":{"safety_type":"ebrake_triggered"}})",
               DeviceFault::ownWatchdog, "brake"},
          Case{R"({"name":"device-connected"})", DeviceFault::none, ""}, Case{"{", DeviceFault::none, ""},
          Case{R"({"name":7,"data":[]})", DeviceFault::none, ""}}) {
        Bench bench;
        bench.device->open();
        const GovernedForce push = governed({1, 0, 0});
        bench.run(0.1, push);
        const double since = bench.now;
        bench.service.raise(c.event);
        bench.run(0.1, push);
        EXPECT_EQ(bench.state.fault, c.fault) << c.event;
        EXPECT_NE(std::string(bench.device->faultWords()).find(c.words), std::string::npos)
            << bench.device->faultWords();
        if (c.fault != DeviceFault::none) {
            EXPECT_LE(bench.service.lastForce() - since, kZero) << c.event;
        }
    }
}

TEST(HaplyEvents, ABrakeHoldsUntilItIsReleased)
{
    Bench bench;
    bench.device->open();
    const GovernedForce push = governed({1, 0, 0});
    bench.run(0.1, push);
    bench.service.raise(R"({"name":"device-safety-triggered","data":{"safety_type":"ebrake_triggered"}})");
    const double since = bench.now;
    bench.run(0.1, push);
    for (const char* other : {"stall_detected", "fod_stage_changed"})
        bench.service.raise(R"({"name":"device-safety-triggered","data":{"safety_type":")" + std::string(other) +
                            "\"}}");
    bench.run(5, push);
    EXPECT_EQ(bench.state.fault, DeviceFault::ownWatchdog) << "whatever else the service tells meanwhile";
    EXPECT_NE(std::string(bench.device->faultWords()).find("brake"), std::string::npos) << bench.device->faultWords();
    EXPECT_LE(bench.service.lastForce() - since, kZero);
    bench.service.raise(R"({"name":"device-safety-triggered","data":{"safety_type":"ebrake_released"}})");
    bench.run(0.2, push);
    EXPECT_EQ(bench.state.fault, DeviceFault::none);
    EXPECT_GT(bench.service.force().x, 0.9);
}

TEST(HaplyEvents, ThatEndTakeTheForceForGood)
{
    Bench bench;
    bench.device->open();
    const GovernedForce push = governed({1, 0, 0});
    bench.run(0.1, push);
    bench.service.endEvents();
    const double since = bench.now;
    bench.run(3, push);
    EXPECT_EQ(bench.state.fault, DeviceFault::ownWatchdog) << "a brake would not be heard";
    EXPECT_NE(std::string(bench.device->faultWords()).find("no events any more"), std::string::npos);
    EXPECT_LE(bench.service.lastForce() - since, kZero);
}

TEST(HaplyDevice, AServiceThatTellsNoVelocityIsFollowedByItsPositions)
{
    double time = 0;
    Bench  bench({.hasSpeed = false}, {}, [&](const glm::dvec3&, double dt) {
        time += dt;
        return glm::dvec3(0.1 * time, 0, 0);
    });
    bench.device->open();
    bench.run(0.3, {});
    EXPECT_NEAR(bench.state.velocity.x, 0.1, 0.02) << "[m/s]";
}

TEST(HaplyDevice, AForceThatIsNotFiniteIsNone)
{
    Bench bench;
    bench.device->open();
    bench.run(0.1, governed({1, 0, 0}));
    bench.run(2e-3, notFinite());
    EXPECT_EQ(bench.state.fault, DeviceFault::badForce);
    EXPECT_EQ(bench.service.force(), glm::dvec3(0));
}

TEST(HaplyDevice, AClockThatStartsAgainIsFollowed)
{
    Bench bench;
    bench.device->open();
    bench.run(0.1, {});
    bench.state = bench.device->exchange({}, 0);
    EXPECT_EQ(bench.state.fault, DeviceFault::none);
    EXPECT_LE(bench.state.time, 0.0);
}

TEST(HaplyDevice, ItOpensAgainAfterTheServiceHasEnded)
{
    Bench bench;
    bench.device->open();
    bench.run(0.05, {});
    bench.service.cause(HaplyTrouble::cut);
    bench.run(0.05, {});
    EXPECT_EQ(bench.state.fault, DeviceFault::linkLost);
    bench.service.cause(HaplyTrouble::none);
    bench.device->close();
    bench.device->close();
    bench.device->open();
    bench.run(0.05, governed({1, 0, 0}));
    EXPECT_EQ(bench.state.fault, DeviceFault::none);
    EXPECT_GT(bench.service.force().x, 0.9);
}

} // namespace
} // namespace palp
