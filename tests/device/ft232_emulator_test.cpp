// Tests of the emulated Falcon as its driver sees it, and of the chip's timing.
#include "device/falcon/ft232_emulator.h"

#include <array>
#include <cmath>
#include <numbers>
#include <optional>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "device/haptic_device.h"
#include "engine/core/contract.h"

namespace palp {
namespace {

constexpr double kPacketTime = 16 * 10 / 1.5e6; // [s] 107 us: 16 bytes of 10 bits at 1.5 Mbaud

Ft232EmulatorSettings running()
{
    Ft232EmulatorSettings settings;
    settings.falcon.running = settings.falcon.homed = true;
    return settings;
}

void setRun(FalconLink& link, std::uint16_t latency, std::uint16_t event = 0)
{
    link.control(FtdiRequest::divisor, std::uint16_t(FalconDivisor::run));
    link.control(FtdiRequest::latencyTimer, latency);
    link.control(FtdiRequest::eventCharacter, event);
}

std::vector<std::uint8_t> hear(FalconLink& link, double timeout)
{
    std::vector<std::uint8_t>     heard;
    std::array<std::uint8_t, 512> bytes;
    for (const double until = link.now() + timeout; link.now() < until;) {
        const std::size_t count = link.read(bytes, until - link.now());
        heard.insert(heard.end(), bytes.begin(), bytes.begin() + std::ptrdiff_t(count));
    }
    return heard;
}

std::optional<FalconReply> ask(FalconLink& link, const FalconCommand& command, double timeout = 5e-3)
{
    link.write(encode(command));
    FalconParser                  parser;
    std::array<std::uint8_t, 512> bytes;
    for (const double until = link.now() + timeout; link.now() < until;) {
        parser.feed(std::span(bytes).first(link.read(bytes, until - link.now())));
        if (const auto reply = parser.next()) return reply;
    }
    return {};
}

TEST(Ft232Emulator, AnswersOnePacketWithOneAndTellsWhereTheGripIs)
{
    Ft232Emulator link(running(), [](const glm::dvec3&, double) { return glm::dvec3(0.02, 0, -0.015); });
    setRun(link, 1);
    link.falcon().press(4);

    const auto reply = ask(link, {});

    ASSERT_TRUE(reply);
    EXPECT_EQ(reply->encoders, (std::array<std::int16_t, 3>{-351, -856, -210})) << "(20, 0, 110) mm: -351.36, -856.23, "
                                                                                   "-209.63 by the closure equations";
    EXPECT_TRUE(reply->homed());
    EXPECT_EQ(reply->grip, 4);
    EXPECT_TRUE(hear(link, 0.05).empty()) << "one for one";
}

TEST(Ft232Emulator, IsSilentAtEveryOtherDivisor)
{
    for (std::uint16_t divisor : {std::uint16_t(0x4138), std::uint16_t(0x0015), std::uint16_t(0x0003)}) {
        Ft232Emulator link(running());
        setRun(link, 1);
        link.control(FtdiRequest::divisor, divisor);
        EXPECT_FALSE(ask(link, {}, 0.2)) << "divisor " << divisor;
        EXPECT_EQ(link.falcon().packets(), 0u);

        setRun(link, 1);
        link.write(encode(FalconCommand{}));
        link.control(FtdiRequest::divisor, divisor); // before the answer comes
        EXPECT_TRUE(hear(link, 0.1).empty()) << "divisor " << divisor;
        EXPECT_EQ(link.falcon().packets(), 1u);
    }
}

TEST(Ft232Emulator, TheTimerOrTheEventCharacterSendsAnAnswerOn)
{
    // After a wait the timer's phase is anywhere; what counts is the second answer, asked for as the first arrives.
    const auto roundTrip = [](std::uint16_t latency, std::uint16_t event) {
        Ft232Emulator link(running());
        setRun(link, latency, event);
        EXPECT_TRUE(ask(link, {}, 0.1));
        const double before = link.now();
        EXPECT_TRUE(ask(link, {}, 0.1));
        return link.now() - before;
    };
    const Ft232EmulatorSettings settings;
    const double                least = 2 * settings.transferTime + 2 * kPacketTime + settings.falcon.answerTime;

    EXPECT_NEAR(roundTrip(16, 0), 16e-3, 1e-9) << "from timer to timer, exact but for rounding";
    EXPECT_NEAR(roundTrip(1, 0), 1e-3, 1e-9) << "the same";
    EXPECT_NEAR(roundTrip(16, 0x100 | '>'), least, 1e-9) << "only the wires and the transfers";
}

TEST(Ft232Emulator, PacketsHoldSixtyTwoBytes)
{
    Ft232Emulator link(running());
    setRun(link, 255);
    for (int n = 0; n < 5; ++n) link.write(encode(FalconCommand{}));
    std::array<std::uint8_t, 512> bytes;

    EXPECT_EQ(link.read(bytes, 0.1), 62u) << "80 bytes have come, and the timer has not run out";
    EXPECT_LT(link.now(), 5e-3);
    EXPECT_EQ(link.read(bytes, 0.1), 0u);
    EXPECT_EQ(link.read(bytes, 0.3), 18u);
}

TEST(Ft232Emulator, TheMotorsLetGoWhenNoPacketComes)
{
    Ft232Emulator link(running());
    setRun(link, 1);
    ASSERT_TRUE(ask(link, {.motors = {100, -200, 4095}}));
    const double asked = link.now();
    EXPECT_EQ(link.falcon().motors(), (std::array<std::int16_t, 3>{100, -200, 4095}));

    link.waitUntil(0.5);

    EXPECT_EQ(link.falcon().motors(), (std::array<std::int16_t, 3>{}));
    EXPECT_NEAR(link.falcon().lastTorque(), asked + 20e-3, 1.5e-3) << "counted from the packet, a round trip earlier";
}

TEST(Ft232Emulator, TheForceOnTheHandIsThatOfTheTorques)
{
    glm::dvec3    felt{};
    Ft232Emulator link(running(), [&](const glm::dvec3& force, double dt) {
        if (dt > 0) felt = force;
        return glm::dvec3(0.02, 0, -0.015);
    });
    setRun(link, 1);

    // Torques of (1, 2, -3) N at (20, 0, 110) mm by the closure equations; counts are -4200 of them.
    ASSERT_TRUE(ask(link, {.motors = {650, 520, -345}}));
    link.waitUntil(link.now() + 1e-3);

    EXPECT_NEAR(glm::length(felt - glm::dvec3(1, 2, -3)), 0, 0.01) << "half a count of torque is 1.2e-4 N m, on 25 mm";
}

TEST(Ft232Emulator, NeedsAPulseTheGreetingAndTheRightBaudToLoad)
{
    Ft232Emulator                     link;
    const std::array<std::uint8_t, 3> hello{0x0A, 0x43, 0x0D};
    const std::vector<std::uint8_t>   welcome{0x0A, 0x44, 0x2C, 0x0D};
    link.control(FtdiRequest::divisor, std::uint16_t(FalconDivisor::hello));
    link.write(hello);
    EXPECT_TRUE(hear(link, 0.1).empty()) << "no pulse of DTR yet";

    link.control(FtdiRequest::modemLines, 0x0100);
    link.control(FtdiRequest::modemLines, 0x0101);
    link.write(hello);
    EXPECT_EQ(hear(link, 0.1), welcome);
    link.control(FtdiRequest::modemLines, 0x0100);
    link.control(FtdiRequest::divisor, std::uint16_t(FalconDivisor::loader));
    link.write(std::array<std::uint8_t, 1>{0x41});
    EXPECT_EQ(hear(link, 0.1), std::vector<std::uint8_t>{0x41});

    std::vector<std::uint8_t> image(4095);
    for (std::size_t n = 0; n < image.size(); ++n) image[n] = std::uint8_t(n * 7);
    std::vector<std::uint8_t> echo;
    for (std::size_t at = 0; at < image.size(); at += 105) { // 39 pieces, each of which fits into the chip
        link.write(std::span(image).subspan(at, 105));
        const auto heard = hear(link, 0.05);
        echo.insert(echo.end(), heard.begin(), heard.end());
    }
    EXPECT_EQ(echo, image);
    setRun(link, 1);
    EXPECT_FALSE(ask(link, {}, 0.1)) << "4095 bytes are no firmware";
}

TEST(Ft232Emulator, AskedForAnswersBeforeTheUploadItIsDeafUntilOpenedAnew)
{
    for (const bool isOpenedAnew : {false, true}) {
        Ft232Emulator emulator;
        auto          link = emulator.connect();
        setRun(*link, 1);
        EXPECT_FALSE(ask(*link, {}, 0.1));
        if (isOpenedAnew) link = emulator.connect();
        link->control(FtdiRequest::divisor, std::uint16_t(FalconDivisor::hello));
        link->control(FtdiRequest::modemLines, 0x0100);
        link->control(FtdiRequest::modemLines, 0x0101);
        link->write(std::array<std::uint8_t, 3>{0x0A, 0x43, 0x0D});
        EXPECT_EQ(hear(*link, 0.1).size(), isOpenedAnew ? 4u : 0u);
    }
}

TEST(Ft232Emulator, ALineThatTakesNothingForATenthOfASecondIsLost)
{
    Ft232Emulator link(running());
    setRun(link, 1);
    link.cause({LinkTroubleKind::stall, link.now(), link.now() + 1});
    const std::array<std::uint8_t, 256> full{};
    link.write(full); // the chip's buffer

    EXPECT_THROW(link.write(full), LinkLost);
}

TEST(Ft232Emulator, HomesOutThenInAndOnlyWhenAskedTo)
{
    double                z = 0; // m
    Ft232EmulatorSettings settings;
    settings.falcon.running = true;
    Ft232Emulator link(settings, [&](const glm::dvec3&, double) { return glm::dvec3(0, 0, z); });
    setRun(link, 1);
    const auto at = [&](double place, bool homing) {
        z = place;
        link.waitUntil(link.now() + 1e-3);
        return ask(link, {.homing = homing}).value();
    };

    EXPECT_EQ(at(0, true).encoders, (std::array<std::int16_t, 3>{-900, 100, 312})) << "-200 and what they are wrong by";
    EXPECT_FALSE(at(-0.05, true).homed()) << "not out yet";
    EXPECT_FALSE(at(0.045, true).homed()) << "not in again yet";
    EXPECT_FALSE(at(-0.05, false).homed()) << "not asked to";
    EXPECT_TRUE(at(-0.05, true).homed());
    EXPECT_EQ(at(0, true).encoders, (std::array<std::int16_t, 3>{-200, -200, -200}));
}

TEST(Ft232Emulator, UnpluggedItIsLostUntilItIsOpenedAnew)
{
    Ft232Emulator emulator(running());
    auto          link = emulator.connect();
    emulator.cause({LinkTroubleKind::unplug, 0.1, 0.2});
    std::array<std::uint8_t, 64> bytes;

    EXPECT_NO_THROW(static_cast<void>(link->read(bytes, 0.05)));
    EXPECT_THROW(static_cast<void>(link->read(bytes, 0.1)), LinkLost);
    EXPECT_THROW(static_cast<void>(emulator.connect()), Error);
    emulator.waitUntil(0.3);
    EXPECT_THROW(link->write(bytes), LinkLost) << "the old one stays lost";
    link = emulator.connect();
    setRun(*link, 1);
    EXPECT_TRUE(ask(*link, {}));
}

TEST(Ft232Emulator, TheSameCallsGiveTheSameBytesAndTimes)
{
    const auto run = [] {
        Ft232Emulator link(running());
        setRun(link, 1);
        link.cause({LinkTroubleKind::garbage, 0.01, 0.02});
        std::vector<std::uint8_t> all;
        for (int n = 0; n < 50; ++n) {
            link.write(encode(FalconCommand{}));
            const auto heard = hear(link, 0.7e-3);
            all.insert(all.end(), heard.begin(), heard.end());
        }
        return std::pair{all, link.now()};
    };
    EXPECT_EQ(run(), run());
}

} // namespace
} // namespace palp
