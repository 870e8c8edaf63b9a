#include "engine/core/nearest_name.h"

#include <array>
#include <string>

#include <gtest/gtest.h>

#include "engine/core/json_object.h"
#include "tests/support/temporary_folder.h"

namespace palp {
namespace {

constexpr std::array<std::string_view, 5> kKnown = {"thickness", "poisson", "map", "max_force", "cells"};

TEST(NearestName, FindsWhatOneSlipMade)
{
    for (const char* slip : {"thicknes", "thicknesss", "thickmess", "htickness", "Thickness", "THICKNESS"})
        EXPECT_EQ(nearestName(slip, kKnown), "thickness") << slip;
    EXPECT_EQ(nearestName("max-force", kKnown), "max_force");
    EXPECT_EQ(nearestName("poison", kKnown), "poisson");
}

TEST(NearestName, DoesNotGuessAtOtherWords)
{
    for (const char* word : {"", "x", "stiffness_of_the_wart", "mop up", "foundation"})
        EXPECT_EQ(nearestName(word, kKnown), std::nullopt) << word;
    EXPECT_EQ(nearestName(std::string(100'000, 'm'), kKnown), std::nullopt) << "and does not take a minute for it";
    EXPECT_EQ(nearestName("map", {}), std::nullopt);
}

TEST(NearestName, AShortNameMayHaveOneSlipAndTheNearestWins)
{
    EXPECT_EQ(nearestName("mup", kKnown), "map");
    EXPECT_EQ(nearestName("mu", kKnown), std::nullopt);
    constexpr std::array<std::string_view, 2> two = {"circle", "circles"};
    EXPECT_EQ(nearestName("circles", two), "circles");
}

TEST(NearestName, UnknownKeysAreAnsweredWithIt)
{
    const JsonObject object   = JsonObject::parse(R"({"cels": 4})", "a.json");
    const auto       sentence = refusalOf([&] { object.allowOnly({"cells", "size"}); });

    EXPECT_TRUE(holds(sentence, {"a.json", "\"cels\"", "did you mean \"cells\"?", "known keys: cells, size"}))
        << sentence;
}

} // namespace
} // namespace palp
