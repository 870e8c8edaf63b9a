// The messages of Haply's service alone: what is read from them, to the bounds of each number.
#include "device/haply/haply_message.h"

#include <gtest/gtest.h>

#include <array>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include <glm/geometric.hpp>

namespace palp {
namespace {

/// An answer with one device that is somewhere, and more.
std::string answer(const std::string& position, const std::string& more = "")
{
    return R"({"inverse3":[{"device_id":"049D","state":{"cursor_position":)" + position + "}}]" + more + "}";
}

std::string gripTurned(double w, double x)
{
    return answer(R"({"x":0,"y":0,"z":0})", R"(,"verse_grip":[{"state":{"orientation":{"w":)" + std::to_string(w) +
                                                R"(,"x":)" + std::to_string(x) + R"(,"y":0,"z":0}}}])");
}

TEST(HaplyMessages, ANumberOfAMillionIsNone)
{
    for (const char* axis : {"x", "y", "z"})
        for (const auto& [number, verdict] : {std::pair{"999999", HaplyVerdict::good},
                                              {"-999999", HaplyVerdict::good},
                                              {"1e6", HaplyVerdict::garbled},
                                              {"-1000000", HaplyVerdict::garbled},
                                              {"1e400", HaplyVerdict::garbled},
                                              {"\"1\"", HaplyVerdict::garbled},
                                              {"null", HaplyVerdict::garbled},
                                              {"true", HaplyVerdict::garbled}}) {
            std::string place = R"({"x":0,"y":0,"z":0})";
            place.replace(place.find(axis) + 3, 1, number);
            HaplyState state;
            EXPECT_EQ(takeHaplyState(answer(place), "049D", state), verdict) << place;
            if (verdict == HaplyVerdict::garbled) {
                EXPECT_EQ(state.position, glm::dvec3(0)) << place;
            }
        }
    HaplyState state;
    EXPECT_EQ(takeHaplyState(answer(R"({"x":0,"z":0})"), "049D", state), HaplyVerdict::garbled) << "no y";
    EXPECT_EQ(takeHaplyState("[]", "049D", state), HaplyVerdict::garbled);
    EXPECT_EQ(takeHaplyState(answer(R"({"x":0,"y":0,"z":0})"), "other", state), HaplyVerdict::noDevice);
    EXPECT_EQ(takeHaplyState(answer(R"({"x":0,"y":0,"z":0})"), "", state), HaplyVerdict::good) << "the first";
}

TEST(HaplyMessages, ATurnIsAUnitQuaternionToATenth)
{
    for (const auto& [w, x, isOne] : {std::tuple{1.0, 0.0, true},
                                      {0.91, 0.0, true},
                                      {1.09, 0.0, true},
                                      {0.89, 0.0, false},
                                      {1.11, 0.0, false},
                                      {0.6, 0.8, true},
                                      {0.0, 0.0, false}}) {
        HaplyState state;
        ASSERT_EQ(takeHaplyState(gripTurned(w, x), "049D", state), HaplyVerdict::good);
        EXPECT_EQ(state.hasGrip, isOne) << w << ", " << x;
        EXPECT_NEAR(glm::length(state.orientation), 1, 1e-12);
        if (isOne) {
            EXPECT_NEAR(state.orientation.x * w, state.orientation.w * x, 1e-12);
        }
    }
}

TEST(HaplyMessages, EachButtonHasItsBitUnderBothNames)
{
    const auto buttons = [](const std::string& said) {
        HaplyState state;
        EXPECT_EQ(takeHaplyState(answer(R"({"x":0,"y":0,"z":0})", R"(,"custom_verse_grip":[{"state":{)" + said + "}}]"),
                                 "049D", state),
                  HaplyVerdict::good);
        return state.buttons;
    };
    const char *const letters[] = {"a", "b", "c", "home"}, *const numbers[] = {"button_0", "button_1", "button_2",
                                                                               "button_3"};
    for (unsigned n = 0; n < 4; ++n)
        for (const std::string name : {letters[n], numbers[n]}) {
            EXPECT_EQ(buttons(R"("buttons":{")" + name + R"(":true})"), 1U << n) << name;
            EXPECT_EQ(buttons(R"("buttons":{")" + name + R"(":false})"), 0U) << name;
        }
    EXPECT_EQ(buttons(R"("buttons":{"a":true,"button_1":true,"home":true})"), 1U | 2U | 8U);
    EXPECT_EQ(buttons(R"("button":true)"), 1U);
    EXPECT_EQ(buttons(R"("button":true,"buttons":{"c":true})"), 1U | 4U);
}

TEST(HaplyMessages, VersionAndScaleAreFoundWhereEitherServiceHasThem)
{
    EXPECT_EQ(versionIn(R"({"data":{"git_tag":"3.5.1"}})"), "3.5.1");
    EXPECT_EQ(versionIn(R"({"git_tag":"v3.4"})"), "v3.4");
    EXPECT_EQ(versionIn(R"({"data":{"version":"3.1"}})"), "3.1");
    EXPECT_EQ(versionIn(R"({"version":"4","git_tag":"3.9"})"), "3.9") << "the tag is what was released";
    EXPECT_EQ(versionIn(R"({"version":4})"), "");
    EXPECT_EQ(versionIn("no JSON"), "");
    EXPECT_EQ(forceScaleIn(R"({"data":0.5})"), 0.5);
    EXPECT_EQ(forceScaleIn(R"({"data":{"force_scale":0.25}})"), 0.25);
    EXPECT_EQ(forceScaleIn(R"({"force_scale":2})"), 2.0);
    EXPECT_EQ(forceScaleIn(R"({"force_scale":"2"})"), std::nullopt);
    EXPECT_EQ(dialectOf("3.5"), HaplyDialect::vector);
    EXPECT_EQ(dialectOf("3."), std::nullopt);
    EXPECT_EQ(dialectOf("2.9"), HaplyDialect::values);
}

TEST(HaplyMessages, ANameThatCouldEndACommandIsNone)
{
    for (const char* good : {"049D", "a", "z-_9", "0123456789abcdef0123456789ABCDEF"}) EXPECT_TRUE(isHaplyId(good));
    for (const char* bad : {"", "0123456789abcdef0123456789ABCDEFx", "a b", "a\"", "a/", "\xC3\xA4"})
        EXPECT_FALSE(isHaplyId(bad)) << bad;
    bool hasGrips = true;
    EXPECT_TRUE(haplyDevices(R"({"inverse3":[{"device_id":"a b"},7,{}]})", &hasGrips).empty());
    EXPECT_FALSE(hasGrips);
    EXPECT_EQ(haplyDevices(R"({"inverse3":[7,{"device_id":"b"}],"verse_grip":[{}]})", &hasGrips).size(), 1U);
    EXPECT_TRUE(hasGrips);
}

TEST(HaplyMessages, WhatADeviceSaysOfItselfIsRead)
{
    const auto one =
        haplyDevices(R"({"inverse3":[{"device_id":"049D","config":{"type":"minverse","preset":{"preset":"led_front"},
        "device_info":{"uuid":"77"},"filters":{"force_gate":{"gain":0.3},"damping":{"scalar":0.1}}},
        "status":{"calibrated":true,"ready":false}}]})");
    ASSERT_EQ(one.size(), 1U);
    EXPECT_EQ(one[0].type, "minverse");
    EXPECT_EQ(one[0].preset, "led_front");
    EXPECT_EQ(one[0].serial, "77");
    EXPECT_EQ(one[0].forceGate, 0.3);
    EXPECT_EQ(one[0].damping, 0.1);
    EXPECT_TRUE(one[0].calibrated);
    EXPECT_FALSE(one[0].ready);
    const auto other =
        haplyDevices(R"({"inverse3":[{"device_id":"b","config":{"preset":"defaults"},"status":{"ready":true}}]})");
    ASSERT_EQ(other.size(), 1U);
    EXPECT_EQ(other[0].preset, "defaults");
    EXPECT_FALSE(other[0].calibrated);
    EXPECT_TRUE(other[0].ready);
    EXPECT_EQ(other[0].forceGate, std::nullopt);
}

/// Whatever else a frame is, it holds no force that a guardian would have to take out.
TEST(HaplyMessages, AFrameThatIsNotOneMaskedTextPushesNothing)
{
    const std::array<std::uint8_t, 4> mask{9, 8, 7, 6};
    const std::string                 text = haplyCommand("049D", HaplyDialect::vector, glm::dvec3(1, 2, 3));
    std::vector<std::uint8_t>         good;
    good = {0x81, std::uint8_t(0x80 | 126), std::uint8_t(text.size() >> 8U), std::uint8_t(text.size())};
    good.insert(good.end(), mask.begin(), mask.end());
    for (std::size_t n = 0; n < text.size(); ++n) good.push_back(std::uint8_t(std::uint8_t(text[n]) ^ mask[n % 4]));
    EXPECT_TRUE(kHaplyZero.pushes(good));
    for (const auto& [place, value] :
         {std::pair<std::size_t, int>{0, 0x82}, {1, 126}, {3, good[3] + 1}, {3, good[3] - 1}, {1, 0xFF}}) {
        std::vector<std::uint8_t> other = good;
        other[place]                    = std::uint8_t(value);
        EXPECT_FALSE(kHaplyZero.pushes(other)) << place << ": " << value;
        const auto before = other;
        kHaplyZero.silence(other);
        EXPECT_EQ(other, before) << place << ": " << value;
    }
    for (std::size_t size = 0; size < good.size(); ++size)
        EXPECT_FALSE(kHaplyZero.pushes(std::span(good).first(size))) << size;
}

} // namespace
} // namespace palp
