#include "engine/core/spatial_law.h"

#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "engine/core/contract.h"
#include "tests/support/temporary_folder.h"

namespace palp {
namespace {

using Space = SpatialLaw::Space;

constexpr glm::dvec3 kLow{-1, 2, 0}, kHigh{3, 4, 10}; ///< [m] the region of the laws below

SpatialLaw volumeLaw(const std::string& text)
{
    return parseSpatialLaw(text, kLow, kHigh, Space::volume);
}
SpatialLaw planeLaw(const std::string& text)
{
    return parseSpatialLaw(text, {0, 0, 0}, {1, 0, 2}, Space::plane);
}

std::string refusal(const std::string& text)
{
    return refusalOf([&] { static_cast<void>(volumeLaw(text)); });
}

TEST(SpatialLaw, AConstantIsTheSameEverywhere)
{
    const SpatialLaw law = volumeLaw("constant:value=3.5");

    EXPECT_EQ(law({0, 0, 0}), 3.5);
    EXPECT_EQ(law({1e9, -1, 2}), 3.5);
}

TEST(SpatialLaw, GradedLawsRunAcrossTheRegionAndHoldBeyond)
{
    const SpatialLaw linear      = volumeLaw("linear:from=1,to=10,axis=z");
    const SpatialLaw hyperbolic  = volumeLaw("hyperbolic:from=10,to=1,axis=z");
    const SpatialLaw exponential = volumeLaw("exponential:from=1,to=100,axis=z");

    for (const SpatialLaw& law : {linear, hyperbolic, exponential}) {
        EXPECT_DOUBLE_EQ(law({9, 9, 0}), law.from);
        EXPECT_DOUBLE_EQ(law({9, 9, -5}), law.from);
        EXPECT_DOUBLE_EQ(law({-9, -9, 10}), law.to);
        EXPECT_DOUBLE_EQ(law({-9, -9, 11}), law.to);
    }
    EXPECT_DOUBLE_EQ(linear({0, 0, 2.5}), 3.25);
    EXPECT_DOUBLE_EQ(hyperbolic({0, 0, 2.5}), 10 / (1 + 9 * 0.25)) << "the compliance varies linearly";
    EXPECT_DOUBLE_EQ(exponential({0, 0, 5}), 10);
}

TEST(SpatialLaw, TheAxisIsXIfNeitherItNorALineIsGiven)
{
    EXPECT_DOUBLE_EQ(volumeLaw("linear:from=1,to=5")({1, 0, 0}), 3);
    const SpatialLaw slanted = volumeLaw("linear:from=1,to=3,start=0;0;0,end=2;2;0");
    EXPECT_DOUBLE_EQ(slanted({1, 1, 7}), 2);
    EXPECT_DOUBLE_EQ(slanted({2, 0, 7}), 2) << "only the place along the line matters";
}

TEST(SpatialLaw, AGaussianPeaksAtTheNearestOfItsCentres)
{
    const SpatialLaw law = volumeLaw("gaussian:from=1,to=101,centres=0;0;0/10;0;0,sigma=2");

    EXPECT_DOUBLE_EQ(law({10, 0, 0}), 101);
    EXPECT_DOUBLE_EQ(law({2, 0, 0}), 1 + 100 * std::exp(-0.5));
    EXPECT_DOUBLE_EQ(law({0, 0, 2}), law({0, 2, 0}));
}

TEST(SpatialLaw, ADiscHoldsItsRimUpToRounding)
{
    const SpatialLaw law = volumeLaw("disc:from=1,to=7,centre=0;0;0,radius=0.3");

    EXPECT_EQ(law({0.1 * 3, 0, 0}), 7) << "0.1 * 3 exceeds 0.3 by rounding";
    EXPECT_EQ(law({0.3001, 0, 0}), 1);
    EXPECT_EQ(law({0, 0.2, 0.2}), 7);
}

TEST(SpatialLaw, ABoxHoldsItsRimUpToRounding)
{
    const SpatialLaw law = planeLaw(R"({"law":"box","from":1,"to":10,"low":[0.1,0.5],"high":[0.3,0.75]})");

    EXPECT_EQ(law({0.1 * 3, 0, 0.75}), 10);
    EXPECT_EQ(law({0.31, 0, 0.6}), 1);
    EXPECT_EQ(law({0.2, 0, 0.4}), 1);
}

TEST(SpatialLaw, ACheckerAlternatesInAllThreeCoordinatesFromTheCornerOfTheRegion)
{
    const SpatialLaw law = volumeLaw("checker:from=1,to=2,edge=0.5");

    EXPECT_EQ(law(kLow + glm::dvec3(0.1)), 2);
    for (int k = 0; k < 3; ++k) {
        glm::dvec3 next(0.1);
        next[k] += 0.5;
        EXPECT_EQ(law(kLow + next), 1) << k;
        next[k] += 0.5;
        EXPECT_EQ(law(kLow + next), 2) << k;
        next[k] -= 1.5;
        EXPECT_EQ(law(kLow + next), 1) << k << ", below the corner";
    }
}

TEST(SpatialLaw, JsonAndShortFormSayTheSame)
{
    const SpatialLaw json  = volumeLaw(R"({"law":"gaussian","from":1,"to":2,"centre":[0.1,-2e-1,3],"sigma":0.5})");
    const SpatialLaw brief = volumeLaw("gaussian:from=1,to=2,centre=0.1;-2e-1;3,sigma=0.5");

    EXPECT_EQ(json.centres, brief.centres);
    EXPECT_EQ(json.width, brief.width);
    EXPECT_EQ(json.from, brief.from);
    EXPECT_EQ(json.kind, brief.kind);
}

TEST(SpatialLaw, APlanesPointsHaveTwoCoordinatesXAndZ)
{
    const SpatialLaw law = planeLaw("disc:from=1,to=7,centre=0.5;1.5,radius=0.1");

    EXPECT_EQ(law({0.5, 0, 1.5}), 7);
    EXPECT_EQ(law({1.5, 0, 0.5}), 1);
    EXPECT_DOUBLE_EQ(planeLaw("linear:from=1,to=3,axis=z")({0, 0, 1}), 2);
}

TEST(SpatialLaw, RefusalsNameWhatWasFoundAndWhatIsKnown)
{
    EXPECT_TRUE(holds(refusal("quadratic:from=1"), {"quadratic", "hyperbolic", "checker"}));
    EXPECT_TRUE(holds(refusal("linear:form=1,to=2"), {"form", "from, to, axis, start, end"}));
    EXPECT_TRUE(holds(refusal("linear:from=1"), {"to", "missing"}));
    EXPECT_TRUE(holds(refusal("linear:from=soft,to=2"), {"from", "number", "soft"}));
    EXPECT_TRUE(holds(refusal("linear:from=0,to=2"), {"from", "positive", "0"}));
    EXPECT_TRUE(holds(refusal("linear:from=1,to=-2"), {"to", "positive", "-2"}));
    EXPECT_TRUE(holds(refusal("linear:from=nan,to=2"), {"from", "number"}));
    EXPECT_TRUE(holds(refusal("linear:from=1,to=2,axis=w"), {"axis", "\"w\"", "\"y\""}));
    EXPECT_TRUE(holds(refusal("linear:from=1,to=2,start=0;0;0,end=0;0;0"), {"must differ"}));
    EXPECT_TRUE(holds(refusal("linear:from=1,to=2,axis=x,start=0;0;0,end=1;0;0"), {"axis", "start", "not both"}));
    for (const char* half : {"linear:from=1,to=2,start=0;0;0", "exponential:from=1,to=2,axis=x,end=1;0;0"})
        EXPECT_TRUE(holds(refusal(half), {"\"start\" and \"end\" or neither"})) << half;
    EXPECT_TRUE(holds(refusal("gaussian:from=1,to=2,centre=0;0,sigma=1"), {"centre", "3 numbers", "[0,0]"}));
    EXPECT_TRUE(holds(refusal("gaussian:from=1,to=2,centre=0;0;0,sigma=0"), {"sigma", "positive"}));
    EXPECT_TRUE(holds(refusal("gaussian:from=1,to=2,centre=0;0;0,radius=1"), {"radius", "sigma"}));
    EXPECT_TRUE(holds(refusal("disc:from=1,to=2,centre=0;0;0,centres=0;0;0,radius=1"), {"not both"}));
    EXPECT_TRUE(holds(refusal(R"({"law":"disc","from":1,"to":2,"centres":[],"radius":1})"), {"1 to 1000 points"}));
    std::string many = "disc:from=1,to=2,radius=1,centres=0;0;0";
    for (int n = 1; n <= 1000; ++n) many += "/0;0;0";
    EXPECT_TRUE(holds(refusal(many), {"1 to 1000 points"}));
    many.resize(many.rfind('/'));
    EXPECT_EQ(volumeLaw(many).centres.size(), 1000u);
    EXPECT_TRUE(holds(refusal("box:from=1,to=2,low=0;0;0,high=1;-1;1"), {"high", "low"}));
    EXPECT_TRUE(holds(refusal("constant:from=1"), {"from", "value"}));
    EXPECT_TRUE(holds(refusal("linear"), {"missing"}));
}

TEST(SpatialLaw, APlaneHasNoAxisYAndAFlatRegionNoLengthAcross)
{
    EXPECT_TRUE(holds(refusalOf([] { static_cast<void>(planeLaw("linear:from=1,to=2,axis=y")); }), {"\"y\"", "\"z\""}));
    const auto flat = [] {
        static_cast<void>(parseSpatialLaw("linear:from=1,to=2,axis=y", {0, 1, 0}, {1, 1, 1}, Space::volume));
    };
    EXPECT_TRUE(holds(refusalOf(flat), {"must differ"}));
}

TEST(SpatialLaw, AnyOtherTextIsRefusedAndNothingElseHappens)
{
    const std::vector<std::string> texts = {"",
                                            ":",
                                            "linear:",
                                            "linear:from",
                                            "linear:from=",
                                            "linear:=1",
                                            "linear:,",
                                            "{",
                                            "{}",
                                            "{\"law\":1}",
                                            "[1]",
                                            "linear:a\"b=1",
                                            "linear:from=1;;2,to=2",
                                            "linear:from=1,from=2,to=3",
                                            "linear:from=1e999,to=2",
                                            "{\"law\":\"linear\",\"from\":1e999,\"to\":2}",
                                            std::string("linear:from=1\0,to=2", 20),
                                            "\xff\xfe:x=1"};
    for (const std::string& text : texts) EXPECT_NE(refusal(text), "") << text;
}

TEST(SpatialLaw, AWordOfTheShortFormHasPlainCharactersOnly)
{
    for (const std::string word : {"", "fr om", "fr\"om", "fr\\om", "fr\x7fom", "fr\xc3\xb6m"}) {
        const std::string complaint =
            ": expected NAME:key=value,key=value such as linear:from=1,to=10,axis=x, found \"";
        for (const std::string& text : {"linear:" + word + "=1,to=2", word + ":from=1,to=2"})
            EXPECT_TRUE(holds(refusal(text), {complaint + word.substr(0, 2)})) << refusal(text);
    }
}

TEST(SpatialLaw, AKeyGivenTwiceIsRefused)
{
    EXPECT_TRUE(holds(refusal(R"({"law":"constant","value":1,"value":2})"), {"value", "twice"}));
}

TEST(SpatialLaw, BrokenJsonIsReportedWithItsLine)
{
    EXPECT_TRUE(holds(refusal("{\"law\": \"constant\",\n \"value\": }"), {"line 2", "JSON"}));
}

} // namespace
} // namespace palp
