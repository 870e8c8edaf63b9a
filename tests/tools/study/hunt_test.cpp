#include "engine/tools/study/hunt_scene.h"

#include <cmath>
#include <set>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "tests/support/temporary_folder.h"

namespace palp::study {
namespace {

/// With the keys of hunts, which the library does not know.
Scene parsed(const std::string& text)
{
    return parseScene(text, "a test", ".", {.toolKeys = &huntKeys()});
}

std::vector<Nodule> nodulesOf(const Scene& scene, const PointCloud& cloud)
{
    return hiddenIn(scene)->nodules(cloud, scene);
}

Scene sceneWith(const std::string& hunt, const std::string& more = "")
{
    return parsed(R"({"cloud": "sample:sheet", "points": 20000, "stiffness": {"law": "constant", "value": 3e5},
                      "footprint_radius": "3 mm", "hunt": )" +
                  hunt + more + "}");
}

const std::string kTwo = R"({"nodules": [{"at": [0.01, 0, 0], "radius": "6 mm", "modulus": "3 MPa"},
                                         {"at": "-10mm,0,0", "radius": 4e-3, "modulus": 6e5}]})";

TEST(Nodule, FadesFromThreeQuartersToFiveQuartersOfItsRadiusAndIsHalfAtIt)
{
    const Nodule nodule{{}, 4e-3, 3e6};

    EXPECT_EQ(nodule.share(0), 1);
    EXPECT_EQ(nodule.share(3e-3), 1);
    EXPECT_NEAR(nodule.share(4e-3), 0.5, 1e-15) << "rounding";
    EXPECT_EQ(nodule.share(5e-3), 0);
    EXPECT_GT(nodule.share(3.9e-3), nodule.share(4.1e-3));
}

TEST(Hunt, LiesOverTheCloudsOwnStiffnessInTheLogarithm)
{
    const Scene      scene  = sceneWith(kTwo);
    const PointCloud cloud  = loadCloud(scene).cloud;
    int              inside = 0, outside = 0;
    for (std::size_t i = 0; i < cloud.size(); ++i) {
        const double d = glm::distance(cloud.positions()[i], glm::dvec3(0.01, 0, 0));
        if (d < 4.5e-3) {
            EXPECT_DOUBLE_EQ(cloud.stiffness()[i], 3e6);
            ++inside;
        } else if (d > 7.5e-3 && glm::distance(cloud.positions()[i], glm::dvec3(-0.01, 0, 0)) > 5e-3) {
            EXPECT_EQ(cloud.stiffness()[i], 3e5);
            ++outside;
        } else if (std::abs(d - 6e-3) < 1e-4) { // half of the logarithm; steepest there by ln 10 / (1/2 r) * 3/2
            EXPECT_NEAR(std::log(cloud.stiffness()[i]), std::log(std::sqrt(3e5 * 3e6)), std::log(10) * 1e-4 / 2e-3);
        }
    }
    EXPECT_GT(inside, 20);
    EXPECT_GT(outside, 10000);
}

TEST(Hunt, ComesBackFromTheTextOfItsScene)
{
    const Scene scene = sceneWith(R"({"random": {"count": 3, "radius": ["3 mm", 5e-3], "modulus": [6e5, "3 MPa"]},
                                      "ground": "40 mm", "press_force": 0.3, "too_hard": "3 N"})",
                                  R"(, "hunt_seed": 9)");
    const Scene again = parsed(sceneJson(scene));

    EXPECT_EQ(sceneJson(again), sceneJson(scene));
    EXPECT_EQ(fingerprint(loadCloud(again).cloud), fingerprint(loadCloud(scene).cloud));
    EXPECT_EQ(hiddenIn(again)->hunt.tooHard, 3);
    EXPECT_EQ(hiddenIn(again)->hunt.mostRadius, 5e-3);
}

TEST(Hunt, IsNoKeyOfTheLibraryAndChangesTheCloudOnlyOfScenesThatHaveIt)
{
    const std::string text = R"({"cloud": "sample:sheet", "hunt": )" + kTwo + "}";
    EXPECT_NE(refusalOf([&] { static_cast<void>(parseScene(text, "a test", ".")); }).find("\"hunt\""),
              std::string::npos);
    const Scene with = sceneWith(kTwo), elsewhere = sceneWith(kTwo, R"(, "hunt_seed": 5)");
    const Scene without = parsed(R"({"cloud": "sample:sheet", "points": 20000,
        "stiffness": {"law": "constant", "value": 3e5}, "footprint_radius": "3 mm"})");
    EXPECT_EQ(hiddenIn(without), nullptr);
    EXPECT_EQ(fingerprint(loadBareCloud(with).cloud), fingerprint(loadCloud(without).cloud));
    EXPECT_FALSE(haveSameCloud(with, without));
    EXPECT_FALSE(haveSameCloud(with, elsewhere));
    EXPECT_TRUE(haveSameCloud(with, sceneWith(kTwo, R"(, "thickness": 0.002)")));
}

const std::string kTissue =
    R"(, "foundation": "3 MPa/m", "thickness": "2 mm", "below": {"depth": "15 mm", "modulus": "20 kPa"})";

TEST(Hunt, ANoduleBelowTheSheetChangesNoStiffnessThatIsSeenAndIsUnderTheFinger)
{
    const Scene scene =
        sceneWith(R"({"nodules": [{"at": [0.01, 0, 0], "depth": "8 mm", "radius": "5 mm", "modulus": "1 MPa"},
                                                  {"at": [-0.02, 0, 0], "radius": "4 mm", "modulus": "6 MPa"}]})",
                  kTissue);
    const SoftObject object = loadObject(scene).object;
    const auto       at     = [&](double x) { return object.index().nearest({x, 0, 0}, 1).front().point; };
    EXPECT_EQ(object.cloud().stiffness()[at(0.01)], 3e5);
    EXPECT_EQ(object.cloud().stiffness()[at(-0.02)], 6e6);
    EXPECT_GT(object.foundationShape()[at(0.01)], 2);
    EXPECT_EQ(object.foundationShape()[at(-0.02)], 1);
    EXPECT_EQ(hiddenIn(parsed(sceneJson(scene)))->hunt.nodules[0].depth, 8e-3);
    EXPECT_EQ(hiddenIn(parsed(sceneJson(scene)))->hunt.nodules[1].depth, 0);
}

TEST(Hunt, RandomNodulesLieAsDeepAsTheirRangeSays)
{
    const Scene scene = sceneWith(R"({"random": {"count": 3, "depth": ["8 mm", "9 mm"], "radius": ["4 mm", "5 mm"],
                                      "modulus": [1e6, 2e6]}, "ground": "50 mm"})",
                                  kTissue);
    const PointCloud cloud = loadCloud(scene).cloud;
    for (const Nodule& n : nodulesOf(scene, cloud)) {
        EXPECT_GE(n.depth, 8e-3);
        EXPECT_LE(n.depth, 9e-3);
    }
    for (const double E : cloud.stiffness()) ASSERT_EQ(E, 3e5);
    EXPECT_EQ(huntJson(hiddenIn(parsed(sceneJson(scene)))->hunt), huntJson(hiddenIn(scene)->hunt));
}

TEST(Hunt, ANoduleBelowTheSheetNeedsTissueThere)
{
    const Scene scene =
        sceneWith(R"({"nodules": [{"at": [0, 0, 0], "depth": "8 mm", "radius": "5 mm", "modulus": "1 MPa"}]})");
    EXPECT_TRUE(holds(refusalOf([&] { static_cast<void>(loadObject(scene)); }), {"hunt", "tissue", "\"below\""}));
}

TEST(Hunt, ASeedPlacesTheSameNodulesElsewhereAndTheSameAgain)
{
    std::set<double> places;
    for (const char* seed : {"1", "2", "3", "4"}) {
        const Scene      scene   = sceneWith(kTwo, R"(, "hunt_seed": )" + std::string(seed));
        const PointCloud cloud   = loadCloud(scene).cloud;
        const auto       nodules = nodulesOf(scene, cloud);
        ASSERT_EQ(nodules.size(), 2u);
        EXPECT_EQ(nodules[0].radius, 6e-3);
        EXPECT_EQ(nodules[1].modulus, 6e5);
        EXPECT_EQ(nodulesOf(scene, cloud)[0].centre, nodules[0].centre);
        places.insert(nodules[0].centre.x);
    }
    EXPECT_EQ(places.size(), 4u);
    EXPECT_EQ(hiddenIn(sceneWith(kTwo, R"(, "hunt_seed": 4294967295)"))->seed, 4294967295u);
    const std::string said = refusalOf([] { static_cast<void>(sceneWith(kTwo, R"(, "hunt_seed": 4294967296)")); });
    EXPECT_TRUE(holds(said, {"hunt_seed", "from 0 to 4294967295", "found \"4294967296\""})) << said;
}

TEST(Hunt, RandomNodulesKeepApartFromEachOtherFromBordersAndWithinTheGround)
{
    for (std::uint64_t seed = 0; seed < 40; ++seed) {
        const double      ground = seed % 2 ? 50e-3 : 0; // [m]; 0: all of the sheet
        const std::string within = ground > 0 ? R"(, "ground": "50 mm"})" : "}";
        const Scene       scene =
            sceneWith(R"({"random": {"count": 8, "radius": ["3 mm", "6 mm"], "modulus": [6e5, 3e6]})" + within,
                      R"(, "hunt_seed": )" + std::to_string(seed));
        const auto nodules = nodulesOf(scene, loadCloud(scene).cloud);
        ASSERT_EQ(nodules.size(), 8u);
        for (std::size_t i = 0; i < nodules.size(); ++i) {
            const Nodule& one = nodules[i];
            EXPECT_TRUE(one.radius >= 3e-3 && one.radius <= 6e-3 && one.modulus >= 6e5 && one.modulus <= 3e6);
            EXPECT_LE(glm::length(one.centre) + one.radius, ground > 0 ? ground + 1e-12 : 1);
            EXPECT_LE(std::max(std::abs(one.centre.x), std::abs(one.centre.y)), 75e-3 - one.radius) << "the border";
            for (std::size_t k = 0; k < i; ++k)
                EXPECT_GE(glm::distance(one.centre, nodules[k].centre), 1.25 * (one.radius + nodules[k].radius) + 3e-3);
        }
    }
}

TEST(Hunt, RefusesWhatIsWrongByNameInOneSentence)
{
    const auto refused = [](const std::string& hunt, const std::string& word, const std::string& more = "") {
        const std::string said = refusalOf([&] { static_cast<void>(loadCloud(sceneWith(hunt, more))); });
        EXPECT_NE(said.find(word), std::string::npos) << hunt << "\n  said: " << said << "\n  not: " << word;
        EXPECT_EQ(said.find('\n'), std::string::npos);
    };
    const auto one = [](const std::string& at, const std::string& radius, const std::string& modulus) {
        return R"({"nodules": [{"at": )" + at + R"(, "radius": )" + radius + R"(, "modulus": )" + modulus + "}]}";
    };
    refused("{}", "neither");
    refused(R"({"nodules": []})", "1 to 64 nodules");
    refused(R"({"nodules": 3})", "1 to 64 nodules");
    refused(R"({"nodules": [{"at": [0,0,0], "radius": 4e-3}]})", "\"modulus\"");
    refused(R"({"nodules": [{"at": [0,0,0], "radius": 4e-3, "modulus": 1e6, "contrst": 3}]})", "contrst");
    refused(one("[0,0]", "4e-3", "1e6"), "\"at\"");
    refused(one("[0,0,0]", "\"nan\"", "1e6"), "radius");
    refused(one("[0,0,0]", "0", "1e6"), "radius");
    refused(one("[0,0,0]", "-4e-3", "1e6"), "nodule 1");
    refused(one("[0,0,0]", "\"4 MPa\"", "1e6"), "radius");
    refused(one("[0,0,0]", "4e-3", "\"inf\""), "modulus");
    refused(one("[0,0,0]", "4e-3", "0"), "modulus");
    refused(one("[1e999,0,0]", "4e-3", "1e6"), "a test");
    refused(one("[0,0,0.02]", "4e-3", "1e6"), "on the object");
    refused(one("[0.2,0,0]", "4e-3", "1e6"), "on the object");
    refused(one("[0,0,0]", "1e-3", "1e6"), "two spacings");
    refused(
        R"({"nodules": [{"at": [0,0,0], "radius": 4e-3, "modulus": 1e6}, {"at": [0.009,0,0], "radius": 4e-3, "modulus": 1e6}]})",
        "nodules 1 and 2 overlap");
    refused(R"({"random": {"count": 0, "radius": [3e-3, 4e-3], "modulus": [1e6, 2e6]}})", "count");
    refused(R"({"random": {"count": 2, "radius": [4e-3, 3e-3], "modulus": [1e6, 2e6]}})", "the least first");
    refused(R"({"random": {"count": 40, "radius": [9e-3, 9e-3], "modulus": [1e6, 2e6]}})", "expected room");
    refused(R"({"random": {"count": 2, "radius": [3e-3], "modulus": [1e6, 2e6]}})", "radius");
    refused(R"({"nodules": [{"at": [0,0,0], "radius": 4e-3, "modulus": 1e6}], "too_hard": 0})", "too_hard");
    EXPECT_NE(refusalOf([] {
                  static_cast<void>(parsed(R"({"cloud": "sample:sheet", "hunt_seed": 3})"));
              }).find("nothing is hidden"),
              std::string::npos);
}

} // namespace
} // namespace palp::study
