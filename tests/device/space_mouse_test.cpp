#include "device/hid/space_mouse.h"

#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <random>
#include <set>
#include <sstream>
#include <string>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "engine/core/contract.h"
#include "tests/device/fake_hid.h"
#include "tests/support/allocations.h"
#include "tests/support/locks.h"
#include "tests/support/temporary_folder.h"

namespace palp {
namespace {

using Report = FakeHidDevice::Report;

HidListing compact()
{
    return {.path = "/dev/hidraw3", .vendor = 0x256f, .product = 0xc635, .usagePage = 1, .usage = 8};
}

Report axesReport(std::uint8_t number, std::initializer_list<int> axes)
{
    Report report{number};
    for (int axis : axes) {
        report.push_back(std::uint8_t(axis));
        report.push_back(std::uint8_t(axis >> 8));
    }
    return report;
}

/// Returns what a rule of udev wants of an attribute; empty if it takes any value.
std::string wanted(const std::string& rule, const std::string& attribute)
{
    const std::string start = "ATTRS{" + attribute + "}==\"";
    const std::size_t at    = rule.find(start);
    if (at == std::string::npos) return "";
    const std::size_t from = at + start.size();
    return rule.substr(from, rule.find('"', from) - from);
}

TEST(SpaceMouse, TheUdevRulesOpenItsModelsAndNoOtherProductOfTheirMakers)
{
    std::istringstream rules(contentsOf(PALPATE_FALCON_RULES));
    int                opened = 0;
    for (std::string line; std::getline(rules, line);) {
        const std::string vendor = wanted(line, "idVendor"), products = wanted(line, "idProduct");
        if (vendor != "046d" && vendor != "256f") continue;
        ++opened;
        for (unsigned product = 0; product <= 0xFFFF; ++product) {
            std::array<char, 8> digits{};
            std::snprintf(digits.data(), digits.size(), "%04x", product);
            const bool isOpened = products.empty() || products.find(digits.data()) != std::string::npos;
            const bool isOurs   = spaceMouseModel({.vendor  = std::uint16_t(std::stoul(vendor, nullptr, 16)),
                                                   .product = std::uint16_t(product)}) != nullptr;
            ASSERT_EQ(isOpened, isOurs) << line << ", product " << digits.data();
        }
    }
    EXPECT_EQ(opened, 2);
}

TEST(SpaceMouse, TheUdevRulesOpenWhatIsThereByBluetooth)
{
    const std::string rules = contentsOf(PALPATE_FALCON_RULES);
    for (unsigned product = 0; product <= 0xFFFF; ++product) {
        const SpaceMouseModel* model = spaceMouseModel({.vendor = 0x256f, .product = std::uint16_t(product)});
        std::array<char, 32>   name{}; // as the kernel calls it
        std::snprintf(name.data(), name.size(), "0005:256F:%04X.*", product);
        const bool isByBluetooth = model && std::string_view(model->name).find("Bluetooth") != std::string_view::npos;
        EXPECT_EQ(rules.find(name.data()) != std::string::npos, isByBluetooth) << name.data();
    }
}

TEST(SpaceMouseReport, TheOlderFormsFillThreeAxesEach)
{
    SpaceMouseCounts counts;
    EXPECT_TRUE(takeSpaceMouseReport(axesReport(1, {1, -2, 350}), counts));
    EXPECT_TRUE(takeSpaceMouseReport(axesReport(2, {-350, 5, 6}), counts));
    EXPECT_EQ(counts.axes, (std::array<std::int16_t, 6>{1, -2, 350, -350, 5, 6}));
    EXPECT_TRUE(takeSpaceMouseReport(Report{2, 0, 0, 0xe2, 0xff, 0, 0}, counts)) << "as captured from a SpaceNavigator";
    EXPECT_EQ(counts.axes, (std::array<std::int16_t, 6>{1, -2, 350, 0, -30, 0}));
}

TEST(SpaceMouseReport, TheNewerFormFillsAllSix)
{
    SpaceMouseCounts counts;
    EXPECT_TRUE(takeSpaceMouseReport(axesReport(1, {1, -2, 3, -4, 5, -6}), counts));
    EXPECT_EQ(counts.axes, (std::array<std::int16_t, 6>{1, -2, 3, -4, 5, -6}));
}

TEST(SpaceMouseReport, ButtonsAreAMaskOfAnyLength)
{
    SpaceMouseCounts counts;
    EXPECT_TRUE(takeSpaceMouseReport(Report{3, 2}, counts));
    EXPECT_EQ(counts.buttons, 2U);
    EXPECT_TRUE(takeSpaceMouseReport(Report{3, 1, 0, 0, 0x80}, counts));
    EXPECT_EQ(counts.buttons, 0x80000001U);
    EXPECT_TRUE(takeSpaceMouseReport(Report{3, 1, 0, 0, 0, 9, 9, 9}, counts));
    EXPECT_EQ(counts.buttons, 1U);
}

TEST(SpaceMouseReport, WhatIsNoneOfTheseChangesNothing)
{
    SpaceMouseCounts counts;
    ASSERT_TRUE(takeSpaceMouseReport(axesReport(1, {1, 2, 3, 4, 5, 6}), counts));
    ASSERT_TRUE(takeSpaceMouseReport(Report{3, 1}, counts));
    for (const Report& none :
         {Report{}, Report{1}, Report{3}, axesReport(1, {7, 7}), axesReport(2, {7, 7}), axesReport(0, {7, 7, 7}),
          axesReport(23, {7, 7, 7}), axesReport(1, {7, 7, 30000}), axesReport(1, {7, 7, 7, 7, 7, -32768})})
        EXPECT_FALSE(takeSpaceMouseReport(none, counts)) << none.size() << " bytes";
    EXPECT_EQ(counts.axes, (std::array<std::int16_t, 6>{1, 2, 3, 4, 5, 6}));
    EXPECT_EQ(counts.buttons, 1U);
}

TEST(SpaceMouseReport, GarbageNeverLeavesTheLimits)
{
    std::mt19937                       random(7);
    std::uniform_int_distribution<int> byte(0, 255), number(0, 4), length(0, 20);
    SpaceMouseCounts                   counts;
    int                                taken = 0;
    for (int n = 0; n < 200000; ++n) {
        Report report(std::size_t(length(random)));
        for (std::uint8_t& b : report) b = std::uint8_t(byte(random));
        if (!report.empty()) report[0] = std::uint8_t(number(random));
        taken += takeSpaceMouseReport(report, counts);
        for (int axis : counts.axes) ASSERT_LE(std::abs(axis), kMostSpaceMouseCounts);
    }
    EXPECT_GT(taken, 1000) << "the garbage is good enough to be taken at times";
}

TEST(SpaceMouseReport, KnowsCapsAndNothingElseOfTheirMaker)
{
    const std::set<int> withTwoButtons = {0xc626, 0xc628, 0xc62e, 0xc62f, 0xc635, 0xc63a};
    const auto          buttonsOf      = [](std::uint16_t vendor, int product) {
        const SpaceMouseModel* const model = spaceMouseModel({.vendor = vendor, .product = std::uint16_t(product)});
        return model ? model->buttons : 0;
    };
    for (int product : {0xc603, 0xc605, 0xc606, 0xc621, 0xc623, 0xc625, 0xc626, 0xc627, 0xc628, 0xc629, 0xc62b})
        EXPECT_EQ(buttonsOf(0x046d, product), withTwoButtons.contains(product) ? 2U : 32U) << product;
    for (int product : {0xc62e, 0xc62f, 0xc631, 0xc632, 0xc633, 0xc635, 0xc636, 0xc638, 0xc63a, 0xc652})
        EXPECT_EQ(buttonsOf(0x256f, product), withTwoButtons.contains(product) ? 2U : 32U) << product;
    // CadMice and keyboards
    for (int product : {0xc650, 0xc651, 0xc654, 0xc655, 0xc656, 0xc657, 0xc658, 0xc664, 0xc665, 0xc668, 0xc62c, 0xc641})
        EXPECT_FALSE(spaceMouseModel({.vendor = 0x256f, .product = std::uint16_t(product)})) << product;
    HidListing keyboard = compact();
    EXPECT_TRUE(spaceMouseModel(keyboard));
    keyboard.usage = 6;
    EXPECT_FALSE(spaceMouseModel(keyboard)) << "a receiver's other collection";
    EXPECT_FALSE(spaceMouseModel({.vendor = 0x046d, .product = 0xc635})) << "another maker's number";
}

class SpaceMouseInVirtualTime : public testing::Test {
protected:
    static SpaceMouseSettings settings() { return {.deadZone = 0.1, .pace = HidPace::caller}; }

    HapticState after(double seconds, SpaceMouse& mouse)
    {
        HapticState state;
        for (const double until = now + seconds - 1e-9; now < until;) state = mouse.exchange({}, now += 1e-3);
        return state;
    }

    FakeHidSystem  system;
    FakeHidDevice& device = system.plug(compact());
    double         now    = 5; // [s] clocks do not start at 0
};

TEST_F(SpaceMouseInVirtualTime, DeflectionIsSpeed)
{
    SpaceMouse mouse(system, compact(), settings());
    mouse.open();
    mouse.exchange({}, now);
    device.send(axesReport(1, {350, 0, 0}));
    const HapticState full = after(0.2, mouse);
    EXPECT_NEAR(full.position.x, 0.1 * 0.2, 1e-12) << "0.1 m/s, rounding";
    EXPECT_NEAR(full.velocity.x, 0.1, 1e-9) << "a difference over 1 ms of clock rounded at 5 s: 1e-15/1e-3";
    EXPECT_TRUE(full.homed && full.inBox);
    EXPECT_EQ(full.sequence, 201U);
    EXPECT_EQ(full.missed, 0);

    device.send(axesReport(1, {-192, 0, 0})); // -0.54857: beyond a dead zone of 0.1 that is 0.49841 of the rest
    const HapticState back = after(0.1, mouse);
    EXPECT_NEAR(back.velocity.x, -0.1 * (192.0 / 350 - 0.1) / 0.9, 1e-9) << "rounding as above";

    device.send(axesReport(1, {34, -34, 34})); // inside the dead zone
    EXPECT_EQ(after(0.1, mouse).velocity, glm::dvec3(0));
}

TEST_F(SpaceMouseInVirtualTime, ItsAxesAreUpright)
{
    SpaceMouse mouse(system, compact(), settings());
    mouse.open();
    device.send(axesReport(1, {35, 70, 105, 140, 175, 700})); // right, towards the user, down
    after(0.01, mouse);
    const SpaceMouseAxes axes     = mouse.axes();
    const double         rounding = 1e-15;
    EXPECT_NEAR(glm::distance(axes.push, {0.1, -0.3, 0.2}), 0, rounding);
    EXPECT_NEAR(glm::distance(axes.turn, {0.4, -1.0, 0.5}), 0, rounding) << "and cut at full deflection";
}

TEST_F(SpaceMouseInVirtualTime, ThePointStaysWithinItsReach)
{
    SpaceMouse mouse(system, compact(), settings());
    mouse.open();
    mouse.exchange({}, now);
    for (int n = 0; n < 20; ++n) { // held: it goes on reporting
        device.send(axesReport(1, {350, 350, 350}));
        const HapticState state = after(0.1, mouse);
        EXPECT_LE(glm::length(state.position), 0.05 * (1 + 1e-12)) << "rounding";
    }
    EXPECT_NEAR(glm::length(after(0.001, mouse).position), 0.05, 1e-12) << "it got there; rounding";
}

TEST_F(SpaceMouseInVirtualTime, ADeflectionThatNobodyConfirmsEnds)
{
    SpaceMouse mouse(system, compact(), settings());
    mouse.open();
    mouse.exchange({}, now);
    device.send(axesReport(1, {0, 0, -35 - 63})); // 0.2 beyond the dead zone: 0.02 m/s
    const double reached = after(2, mouse).position.y;
    EXPECT_NEAR(reached, 0.02 * 0.5, 0.02 * 2e-3) << "for 0.5 s, give or take two ticks";
    EXPECT_EQ(mouse.axes().push, glm::dvec3(0));
}

TEST_F(SpaceMouseInVirtualTime, WhenTheServosClockStartsAnewADeflectionStillEnds)
{
    SpaceMouse mouse(system, compact(), settings());
    mouse.open();
    mouse.exchange({}, now);
    device.send(axesReport(1, {0, 0, -35 - 63})); // 0.02 m/s
    after(0.1, mouse);
    now                  = 0; // a session that starts after homing
    const double reached = after(2, mouse).position.y;
    EXPECT_NEAR(reached, 0.02 * 0.5, 0.02 * 3e-3) << "for 0.5 s in all, give or take three ticks";
    EXPECT_EQ(mouse.axes().push, glm::dvec3(0));
}

TEST_F(SpaceMouseInVirtualTime, APauseDoesNotMakeItJump)
{
    SpaceMouse mouse(system, compact(), settings());
    mouse.open();
    mouse.exchange({}, now);
    device.send(axesReport(1, {350, 0, 0}));
    now += 3600;
    EXPECT_LE(mouse.exchange({}, now).position.x, 0.1 * 0.1 * (1 + 1e-12)) << "at most 0.1 s of it; rounding";
    const HapticState before = mouse.exchange({}, now + 1);
    for (double odd : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(), now - 100})
        EXPECT_EQ(mouse.exchange({}, odd).position, before.position) << odd;
}

TEST_F(SpaceMouseInVirtualTime, ItsLightSaysWhetherItIsOpen)
{
    SpaceMouse mouse(system, compact(), settings());
    mouse.open();
    mouse.exchange({}, now);
    EXPECT_EQ(device.written(), (std::vector<Report>{{4, 1}}));
    mouse.light(0);
    mouse.exchange({}, now);
    mouse.light(1);
    mouse.exchange({}, now);
    mouse.exchange({}, now);
    EXPECT_EQ(device.written(), (std::vector<Report>{{4, 1}, {4, 0}, {4, 1}})) << "only changes are sent";
    mouse.close();
    EXPECT_EQ(device.written().back(), (Report{4, 0}));
    EXPECT_EQ(device.openPorts(), 0);
    EXPECT_EQ(mouse.exchange({}, now).fault, DeviceFault::closed);
}

TEST_F(SpaceMouseInVirtualTime, OneWithoutALightWorksAllTheSame)
{
    SpaceMouse mouse(system, compact(), settings());
    device.refuseWrites();
    mouse.open();
    device.send(Report{3, 2});
    const HapticState state = after(0.01, mouse);
    EXPECT_EQ(state.fault, DeviceFault::none);
    EXPECT_EQ(state.buttons, 2U);
}

TEST_F(SpaceMouseInVirtualTime, UnpluggedIsAFaultUntilItIsOpenedAnew)
{
    SpaceMouse mouse(system, compact(), settings());
    mouse.open();
    mouse.exchange({}, now);
    device.send(axesReport(1, {350, 0, 0}));
    device.send(Report{3, 1});
    const glm::dvec3 place = after(0.1, mouse).position;
    device.unplug();
    const HapticState lost = after(0.1, mouse);
    EXPECT_EQ(lost.fault, DeviceFault::unplugged);
    EXPECT_EQ(lost.position, place);
    EXPECT_EQ(lost.velocity, glm::dvec3(0));
    EXPECT_EQ(lost.buttons, 0U) << "nobody holds it down any more";
    mouse.close();
}

TEST_F(SpaceMouseInVirtualTime, RefusesWhatItIsNot)
{
    HidListing other = compact();
    other.product    = 0xc650;
    EXPECT_THROW(SpaceMouse(system, other), Error);
    EXPECT_THROW(SpaceMouse(system, compact(), {.deadZone = 1}), Error);
    EXPECT_THROW(SpaceMouse(system, compact(), {.speed = std::numeric_limits<double>::quiet_NaN()}), Error);
    device.refusal = "no permission";
    SpaceMouse mouse(system, compact(), settings());
    EXPECT_THROW(mouse.open(), HidRefused);
    EXPECT_EQ(mouse.exchange({}, now).fault, DeviceFault::closed);
}

TEST(SpaceMouseInRealTime, AnExchangeNeitherLocksNorAllocates)
{
    FakeHidSystem  system;
    FakeHidDevice& device = system.plug(compact());
    SpaceMouse     mouse(system, compact());
    mouse.open();
    device.send(axesReport(1, {350, 0, 0}));

    const std::size_t locks = locksOfThisThread(), allocations = allocationsOfThisThread();
    for (int n = 0; n < 100000; ++n) {
        mouse.exchange({}, n * 1e-3);
        static_cast<void>(mouse.axes());
    }
    EXPECT_EQ(locksOfThisThread(), locks) << "the fake's mutex would show, so no port was touched";
    EXPECT_EQ(allocationsOfThisThread(), allocations);
}

TEST(SpaceMouseInRealTime, AThreadReadsWhileTheServoOnlyTakes)
{
    FakeHidSystem  system;
    FakeHidDevice& device = system.plug(compact());
    SpaceMouse     mouse(system, compact());
    mouse.open();
    const auto start   = std::chrono::steady_clock::now();
    const auto seconds = [&] {
        return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    };
    HapticState state;
    while (seconds() < 10 && glm::length(state.position) < 0.01) { // 0.1 s at full speed; 10 s for a busy machine
        device.send(axesReport(1, {350, 0, 0}));
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
        state = mouse.exchange({}, seconds());
    }
    EXPECT_GE(state.position.x, 0.01);

    device.unplug();
    while (seconds() < 20 && state.fault == DeviceFault::none) state = mouse.exchange({}, seconds());
    EXPECT_EQ(state.fault, DeviceFault::unplugged);
}

} // namespace
} // namespace palp
