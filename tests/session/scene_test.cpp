#include "engine/session/scene.h"

#include <cmath>
#include <cstdlib>
#include <map>
#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "engine/cloud/samples.h"
#include "tests/support/temporary_folder.h"

namespace palp {
namespace {

using Json = nlohmann::json;

SceneOverrides overrides(std::map<std::string, std::string, std::less<>> flags,
                         std::map<std::string, std::string>              variables = {})
{
    return {std::move(flags), [variables](const char* name) {
                const auto found = variables.find(name);
                return found == variables.end() ? nullptr : found->second.c_str();
            }};
}

Scene parsed(const std::string& text, const SceneOverrides& more = {})
{
    return parseScene(text, "s.json", ".", more);
}

/// The refusal of a scene of a sample with this much more in its object.
std::string refusal(const std::string& more, const SceneOverrides& others = {})
{
    std::string text = R"({"cloud": "sample:skin")";
    if (!more.empty()) text.append(", ").append(more);
    text += "}";
    return refusalOf([&] { static_cast<void>(parsed(text, others)); });
}

/// One sentence, without a line end, that holds the words.
testing::AssertionResult says(const std::string& sentence, const std::vector<std::string_view>& words)
{
    if (sentence.empty()) return testing::AssertionFailure() << "was not refused";
    if (sentence.find('\n') != std::string::npos) return testing::AssertionFailure() << "several lines: " << sentence;
    for (const std::string_view word : words)
        if (sentence.find(word) == std::string::npos)
            return testing::AssertionFailure() << "lacks " << word << ": " << sentence;
    return testing::AssertionSuccess();
}

TEST(Scene, ASampleBringsItsConstantsAndTheFileWinsOverThem)
{
    const Scene scene = parsed(R"({"cloud": "sample:skin", "thickness": "3 mm"})");

    EXPECT_EQ(scene.material.thickness, 3e-3);
    EXPECT_EQ(scene.patch.foundation, sampleNamed("skin").foundation);
    EXPECT_EQ(scene.place, sampleNamed("skin").place);
    EXPECT_EQ(scene.points, 40'000u);
    EXPECT_EQ(scene.origins.at("thickness").origin, Origin::scene);
    EXPECT_EQ(scene.origins.at("foundation").origin, Origin::sample);
    EXPECT_EQ(scene.origins.at("foundation").where, "sample:skin");
    EXPECT_EQ(scene.origins.at("cells").origin, Origin::standard);
}

TEST(Scene, AFlagWinsOverTheEnvironmentAndThatOverTheFile)
{
    const std::string file = R"({"cloud": "sample:skin", "max_force": 1, "cells": 32, "window": 0.06})";
    const Scene       scene =
        parsed(file, overrides({{"max_force", "3N"}}, {{"PALPATE_MAX_FORCE", "2"}, {"PALPATE_CELLS", "48"}}));

    EXPECT_EQ(scene.maxForce, 3);
    EXPECT_EQ(scene.patch.cells, 48);
    EXPECT_EQ(scene.patch.window, 0.06);
    EXPECT_EQ(scene.origins.at("max_force").where, "--max-force");
    EXPECT_EQ(scene.origins.at("cells").where, "PALPATE_CELLS");
    EXPECT_EQ(scene.origins.at("window").where, "s.json");
}

TEST(Scene, AnotherCloudFromAFlagBringsItsOwnConstants)
{
    const Scene scene = parsed(R"({"cloud": "sample:skin"})", overrides({{"cloud", "sample:ear-lobe"}}));

    EXPECT_EQ(scene.material.thickness, 3e-3);
    EXPECT_EQ(scene.origins.at("thickness").where, "sample:ear-lobe");
    EXPECT_FALSE(scene.from) << "closed";
}

TEST(Scene, TheEnvironmentOfTheProcessCountsOnlyWhereItIsAskedFor)
{
    ::setenv("PALPATE_START_HEIGHT", "7mm", 1);
    const std::string file = R"({"cloud": "sample:skin"})";

    EXPECT_EQ(parsed(file, {{}, processEnvironment()}).startHeight, 7e-3);
    EXPECT_EQ(parsed(file).startHeight, 10e-3);
    ::unsetenv("PALPATE_START_HEIGHT");
}

TEST(Scene, AnEmptyVariableSaysNothing)
{
    EXPECT_EQ(parsed(R"({"cloud": "sample:skin"})", overrides({}, {{"PALPATE_THICKNESS", ""}})).material.thickness,
              4e-3);
}

TEST(Scene, EveryKeyOfEverySpellingIsRead)
{
    const Scene scene = parsed(R"({
        "cloud": "sample:sheet", "points": 1000, "seed": 7, "stiffness": "linear:from=1e5,to=1e6,axis=y",
        "thickness": "0.5 cm", "poisson": -0.2, "foundation": "2 MPa/m", "window": 0.05, "cells": 32.0,
        "footprint_radius": "3mm", "map": "gall-peters", "sampling": "nearest", "edges": {"x0": "free"},
        "force_law": "paper", "tolerance": 1e-6, "hand_over": "blend", "table_size": 7, "deformation_rate": 30,
        "proxy": "sphere", "static_friction": 1, "dynamic_friction": 0, "max_force": "500 mN",
        "stiffness_cap": 800, "device": "host", "place": [1e-3, 0, 0], "from": [0, 0, 2], "start_height": "2 cm"})");

    EXPECT_EQ(scene.points, 1000u);
    EXPECT_EQ(scene.seed, 7u);
    EXPECT_EQ(scene.stiffness, "linear:from=1e5,to=1e6,axis=y");
    EXPECT_EQ(scene.material.thickness, 5e-3);
    EXPECT_EQ(scene.material.poissonRatio, -0.2);
    EXPECT_EQ(scene.patch.foundation, 2e6);
    EXPECT_EQ(scene.patch.cells, 32);
    EXPECT_EQ(scene.patch.map, Map::gallPeters);
    EXPECT_EQ(scene.patch.sampling, Resampling::nearest);
    EXPECT_EQ(scene.patch.edges, (PlateEdges{.x0 = Edge::free}));
    EXPECT_EQ(scene.patch.forceLaw, ForceLaw::paper);
    EXPECT_EQ(scene.patch.tolerance, 1e-6);
    EXPECT_EQ(scene.handOver, ComplianceLaw::blend);
    EXPECT_EQ(scene.tableSize, 7);
    EXPECT_EQ(scene.deformationRate, 30);
    EXPECT_EQ(scene.proxy, ProxyForm::sphere);
    EXPECT_EQ(scene.staticFriction, 1);
    EXPECT_EQ(scene.dynamicFriction, 0);
    EXPECT_EQ(scene.maxForce, 0.5);
    EXPECT_EQ(scene.stiffnessCap, 800);
    EXPECT_EQ(scene.device, "host");
    EXPECT_EQ(scene.place, glm::dvec3(1e-3, 0, 0));
    EXPECT_EQ(scene.from, glm::dvec3(0, 0, 2));
    EXPECT_EQ(scene.startHeight, 20e-3);
}

TEST(Scene, WhatIsPrintedReadsBackToTheSameValues)
{
    const Scene first = parsed(R"({"cloud": "sample:palm", "thickness": 0.1e-2, "edges": "x1=supported",
        "stiffness": {"law": "constant", "value": 0.1e6}, "place": [0.1, 1e-17, -3]})");
    const Scene again = parsed(sceneJson(first));

    EXPECT_EQ(sceneJson(again), sceneJson(first));
    EXPECT_EQ(again.material.thickness, first.material.thickness);
    EXPECT_EQ(again.place, first.place);
    EXPECT_EQ(again.patch.edges, first.patch.edges);
}

TEST(Scene, TheConfigurationShowsEveryKeyWithValueUnitAndOrigin)
{
    const Scene scene = parsed(R"({"cloud": "sample:skin", "thickness": "3 mm"})", overrides({{"cells", "32"}}));

    const std::string text = printConfig(scene, ConfigFormat::text);
    const Json        json = Json::parse(printConfig(scene, ConfigFormat::json));

    for (const SceneKey& key : sceneKeys()) {
        EXPECT_TRUE(holds(text, {key.name})) << key.name;
        ASSERT_TRUE(json.contains(key.name)) << key.name;
        EXPECT_EQ(json[std::string(key.name)]["unit"], key.unit);
    }
    EXPECT_EQ(json["thickness"], Json({{"value", 0.003}, {"unit", "m"}, {"origin", "scene"}, {"where", "s.json"}}));
    EXPECT_EQ(json["cells"]["origin"], "flag");
    EXPECT_EQ(json["max_force"]["origin"], "default");
    EXPECT_TRUE(json["length_unit"]["value"].is_null());
    EXPECT_NE(text.find("scene s.json\n"), std::string::npos) << text;
    EXPECT_NE(text.find("flag --cells\n"), std::string::npos) << text;
}

TEST(Scene, UnknownKeysAreRefusedWithTheNearestKnownOne)
{
    EXPECT_TRUE(says(refusal(R"("thicknes": 1)"), {"s.json", "\"thicknes\"", "did you mean \"thickness\"?"}));
    EXPECT_TRUE(says(refusal(R"("frictoin_static": 1)"), {"known keys", "static_friction"}));
    EXPECT_TRUE(says(refusal(R"("Poisson": 0.4)"), {"did you mean \"poisson\"?"}));
}

TEST(Scene, EachBadValueIsRefusedWithKeyExpectationAndFinding)
{
    const std::pair<const char*, std::vector<std::string_view>> cases[] = {
        {R"("thickness": -0.004)", {"s.json: key \"thickness\": expected a thickness from 1e-6", "found \"-0.004\""}},
        {R"("thickness": 0)", {"key \"thickness\"", "found \"0\""}},
        {R"("thickness": "4 N")", {"key \"thickness\"", "unknown unit \"N\"", "mm"}},
        {R"("thickness": "4 furlong")", {"key \"thickness\"", "furlong", "known units"}},
        {R"("thickness": "nan mm")", {"key \"thickness\"", "finite"}},
        {R"("thickness": "inf")", {"key \"thickness\"", "finite"}},
        {R"("thickness": true)", {"key \"thickness\"", "expected a thickness", "found true"}},
        {R"("thickness": null)", {"key \"thickness\"", "found null"}},
        {R"("thickness": [0.004])", {"key \"thickness\"", "found [0.004]"}},
        {R"("poisson": 0.5)", {"key \"poisson\"", "below 0.5", "found \"0.5\"", "0.49"}},
        {R"("poisson": 45)", {"key \"poisson\"", "incompressible"}},
        {R"("poisson": -1)", {"key \"poisson\"", "above -1"}},
        {R"("poisson": "0.45 m")", {"key \"poisson\"", "unknown unit \"m\""}},
        {R"("foundation": -1)", {"key \"foundation\"", "from 0"}},
        {R"("foundation": "1 MPa")", {"key \"foundation\"", "unknown unit \"MPa\"", "MPa/m"}},
        {R"("cells": 63)", {"key \"cells\"", "even", "63"}},
        {R"("cells": 64.5)", {"key \"cells\"", "64.5"}},
        {R"("cells": 1e300)", {"key \"cells\"", "even"}},
        {R"("points": -5)", {"key \"points\"", "whole number", "-5"}},
        {R"("points": 99999999999999999999)", {"key \"points\"", "whole number"}},
        {R"("table_size": 4)", {"key \"table_size\"", "0, 1, 3, 5 or 7"}},
        {R"("table_size": 9)", {"key \"table_size\"", "0, 1, 3, 5 or 7"}},
        {R"("map": "mercator")", {"key \"map\"", "lambert-azimuthal", "mercator"}},
        {R"("force_law": "seires")", {"key \"force_law\"", "series or paper", "did you mean \"series\"?"}},
        {R"("hand_over": 1)", {"key \"hand_over\"", "table, hold or blend"}},
        {R"("proxy": "")", {"key \"proxy\"", "hybrid"}},
        {R"("edges": "glued")", {"key \"edges\"", "glued", "clamped"}},
        {R"("edges": {"x2": "free"})", {"edges", "x2", "x0"}},
        {R"("edges": {"x0": 1})", {"edges", "x0"}},
        {R"("stiffness": {"law": "cubic", "from": 1, "to": 2})", {"key \"stiffness\"", "cubic", "linear"}},
        {R"("stiffness": {"law": "linear", "from": -1, "to": 2})", {"key \"stiffness\"", "from", "-1"}},
        {R"("stiffness": 3e5)", {"key \"stiffness\"", "law"}},
        {R"("max_force": 9)", {"key \"max_force\"", "8 N"}},
        {R"("stiffness_cap": 5000)", {"key \"stiffness_cap\"", "2000"}},
        {R"("place": [0, 0])", {"key \"place\"", "3 numbers"}},
        {R"("place": [0, 0, "x"])", {"key \"place\""}},
        {R"("from": [0, 0, 0])", {"key \"from\"", "not zero"}},
        {R"("device": "")", {"key \"device\""}},
        {R"("length_unit": "mm")", {"key \"length_unit\"", "sample:skin"}},
        {R"("dynamic_friction": 0.9)", {"key \"dynamic_friction\"", "static_friction"}},
        {R"("footprint_radius": 0.1)", {"key \"footprint_radius\"", "window"}},
        {R"("cells": 32, "cells": 64)", {"\"cells\"", "twice"}},
    };
    for (const auto& [more, words] : cases) EXPECT_TRUE(says(refusal(more), words)) << more;
}

TEST(Scene, FlagsAndVariablesAreRefusedUnderTheirOwnNames)
{
    EXPECT_TRUE(says(refusal("", overrides({{"thickness", "-4mm"}})), {"--thickness: expected a thickness", "-4mm"}));
    EXPECT_TRUE(says(refusal("", overrides({{"static_friction", ""}})), {"--static-friction: expected a value"}));
    EXPECT_TRUE(says(refusal("", overrides({}, {{"PALPATE_MAX_FORCE", "lots"}})), {"PALPATE_MAX_FORCE", "lots"}));
    EXPECT_TRUE(
        says(refusal("", overrides({}, {{"PALPATE_CLOUD", "sample:skni"}})), {"PALPATE_CLOUD", "skni", "skin"}));
}

TEST(Scene, FilesThatAreNoScenesAreRefused)
{
    const auto text = [](const std::string& whole) { return refusalOf([&] { static_cast<void>(parsed(whole)); }); };

    EXPECT_TRUE(says(text(""), {"s.json", "not valid JSON"}));
    EXPECT_TRUE(says(text("[1]"), {"s.json", "object"}));
    EXPECT_TRUE(says(text("{}"), {"\"cloud\" is missing", "sample:skin"}));
    EXPECT_TRUE(says(text(R"({"cloud": "sample:skin", "thickness": NaN})"), {"s.json", "not valid JSON"}));
    EXPECT_TRUE(says(text(R"({"cloud": "sample:skin", "thickness": 1e999})"), {"s.json"}));
    EXPECT_TRUE(says(text(R"({"cloud": "sample:skin)"), {"s.json", "not valid JSON"}));
    EXPECT_TRUE(says(text(R"({"cloud": "sample:nose"})"), {"key \"cloud\"", "nose", "ear-lobe"}));
    EXPECT_TRUE(says(text(R"({"cloud": ""})"), {"key \"cloud\"", "path"}));
    EXPECT_TRUE(says(text(R"({"cloud": 5})"), {"key \"cloud\"", "5"}));
    EXPECT_FALSE(text("{\"a\":" + std::string(100'000, '[')).empty()) << "deep nesting does not overflow the stack";
}

TEST(Scene, AMissingCloudOrSceneIsNamed)
{
    const TemporaryFolder folder;
    const auto            read = [&](const std::string& text) {
        const auto file = folder.write("s.json", text);
        return refusalOf([&] { static_cast<void>(readScene(file)); });
    };

    EXPECT_TRUE(says(read(R"({"cloud": "palm.ply", "place": [0,0,0]})"),
                     {"key \"cloud\"", "palm.ply", "No such file", "scene's folder"}));
    EXPECT_TRUE(says(refusalOf([&] { static_cast<void>(readScene(folder / "none.json")); }), {"none.json", "No such"}));
    EXPECT_TRUE(says(refusalOf([&] { static_cast<void>(readScene(folder.path())); }), {"is a folder"}));
    EXPECT_TRUE(says(read(std::string(3 << 20, ' ')), {"s.json", "longer than 1048576 bytes"}));
}

TEST(Scene, ACloudFileLiesBesideItsSceneAndIsScaledByItsUnit)
{
    const TemporaryFolder folder;
    std::string           points;
    for (int i = 0; i < 100; ++i) points += std::to_string(i % 10) + " " + std::to_string(i / 10) + " 0 1e6\n";
    static_cast<void>(folder.write("plane.xyz", points));
    const auto file = folder.write(
        "s.json", R"({"cloud": "plane.xyz", "length_unit": "mm", "place": [5e-3, 5e-3, 0], "from": [0, 0, 1],
                      "stiffness": {"law": "linear", "from": 1e5, "to": 1e6}})");

    const Scene       scene  = readScene(file);
    const LoadedCloud loaded = loadCloud(scene);

    EXPECT_EQ(loaded.cloud.size(), 100u);
    EXPECT_NEAR(loaded.cloud.bounds().high.x, 9e-3, 1e-12);
    EXPECT_NEAR(loaded.cloud.stiffness()[0], 1e5, 1e-6);
    EXPECT_NEAR(loaded.cloud.stiffness()[9], 1e6, 1e-6);
    EXPECT_EQ(sceneJson(parseScene(sceneJson(scene), "again", "/elsewhere")), sceneJson(scene)) << "absolute path";
    EXPECT_TRUE(says(refusalOf([&] {
                         static_cast<void>(readScene(file, overrides({{"length_unit", "parsec"}})));
                     }),
                     {"--length-unit", "parsec"}));
    EXPECT_TRUE(says(refusalOf([&] {
                         static_cast<void>(readScene(file, overrides({{"points", "100"}})));
                     }),
                     {"--points", "sample"}));
    const auto placeless = folder.write("t.json", R"({"cloud": "plane.xyz"})");
    EXPECT_TRUE(says(refusalOf([&] { static_cast<void>(readScene(placeless)); }), {"\"place\""}));
}

TEST(Scene, NamesOfFlagsAndVariablesAreUnique)
{
    std::set<std::string> names;
    for (const SceneKey& key : sceneKeys()) {
        EXPECT_TRUE(names.insert(flagOf(key.name)).second);
        EXPECT_FALSE(key.means.empty() || key.expected.empty()) << key.name;
    }
    EXPECT_EQ(flagOf("max_force"), "--max-force");
    EXPECT_EQ(variableOf("max_force"), "PALPATE_MAX_FORCE");
}

} // namespace
} // namespace palp
