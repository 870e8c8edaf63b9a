#include "engine/session/scene_keys.h"

#include <cmath>
#include <cstdlib>
#include <map>
#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "engine/cloud/samples.h"
#include "engine/core/quantity.h"
#include "engine/session/hand_path.h"
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

TEST(Scene, AShellsWindowHasSupportedEdgesUnlessEdgesSaysOtherwise)
{
    const PlateEdges  supported{Edge::supported, Edge::supported, Edge::supported, Edge::supported};
    const std::string shell = R"({"cloud": "sample:skin", "theory": "shell")";
    const Scene       plain = parsed(shell + "}");
    EXPECT_EQ(plain.patch.edges, supported);
    EXPECT_EQ(plain.origins.at("edges").where, "s.json: theory shell");
    EXPECT_EQ(parsed(shell + R"(, "preset": "palpate"})").patch.edges, supported) << "presets have clamped ones";
    EXPECT_EQ(parsed(shell + R"(, "edges": "clamped"})").patch.edges, PlateEdges{});
    EXPECT_EQ(parsed(R"({"cloud": "sample:skin", "edges": "clamped"})", overrides({{"theory", "shell"}})).patch.edges,
              PlateEdges{})
        << "a flag's theory does not undo what the file says of the edges";
    EXPECT_EQ(parsed(shell + R"(, "edges": "z1=clamped"})").patch.edges,
              (PlateEdges{Edge::supported, Edge::supported, Edge::supported, Edge::clamped}))
        << "sides that are not named stay a shell's";
    EXPECT_EQ(parsed(R"({"cloud": "sample:skin", "edges": "z1=free"})").patch.edges,
              (PlateEdges{Edge::clamped, Edge::clamped, Edge::clamped, Edge::free}))
        << "or a plate's";

    const Scene flat = parsed(shell + "}", overrides({{"theory", "plate"}}));
    EXPECT_EQ(flat.patch.theory, Theory::plate);
    EXPECT_EQ(flat.patch.edges, PlateEdges{});
    EXPECT_EQ(parsed(shell + "}", overrides({{"preset", "paper"}})).patch.theory, Theory::plate);
    EXPECT_EQ(parsed(shell + "}", overrides({{"preset", "paper"}})).patch.edges, PlateEdges{});
}

TEST(Scene, AShellsWindowIsAsWideAsItsDentsAskForUnlessWindowSaysOtherwise)
{
    const std::string shell = R"({"cloud": "sample:ellipsoid", "theory": "shell")";
    const Scene       plain = parsed(shell + "}");
    EXPECT_EQ(plain.patch.windowOf, WindowOf::dent);
    EXPECT_EQ(plain.origins.at("window").where, "s.json: theory shell");
    EXPECT_EQ(parseScene(sceneJson(plain), "again", ".").patch.windowOf, WindowOf::dent);
    const Scene stated = parsed(shell + R"(, "window": "35 mm"})");
    EXPECT_EQ(stated.patch.windowOf, WindowOf::contact);
    EXPECT_EQ(stated.patch.window, 35e-3);
    EXPECT_EQ(parsed(shell + R"(, "window": "auto"})", overrides({{"window", "0.03"}})).patch.window, 30e-3);
    EXPECT_EQ(parsed(shell + "}", overrides({{"theory", "plate"}})).patch.windowOf, WindowOf::contact);
    EXPECT_EQ(parsed(R"({"cloud": "sample:ellipsoid", "window": "auto"})").patch.windowOf, WindowOf::dent)
        << "a foundation ends dents too";
}

TEST(Scene, EveryKeyOfEverySpellingIsRead)
{
    const Scene scene = parsed(R"({
        "cloud": "sample:sheet", "points": 1000, "seed": 7, "stiffness": "linear:from=1e5,to=1e6,axis=y",
        "thickness": "0.5 cm", "poisson": -0.2, "foundation": "2 MPa/m", "window": 0.05, "cells": 32.0,
        "stiffening": "0.81 1/mm", "relaxation": "0.26@0.41s,0.31@4.3", "material": "meat",
        "footprint_radius": "3mm", "map": "gall-peters", "resampling": "nearest", "edges": {"x0": "free"},
        "theory": "shell", "large": "on", "force_law": "paper", "tolerance": 1e-6, "compliance_law": "blend", "table_size": 7, "deformation_rate": 30,
        "proxy": "sphere", "static_friction": 1, "dynamic_friction": 0, "max_force": "500 mN",
        "stiffness_cap": 800, "solver": "host", "place": [1e-3, 0, 0], "from": [0, 0, 2], "start_height": "2 cm",
        "workspace_scale": 3, "clutch_button": 2})");

    EXPECT_EQ(scene.patch.theory, Theory::shell);
    EXPECT_EQ(scene.patch.large, Large::on);
    EXPECT_EQ(scene.workspaceScale, 3);
    EXPECT_EQ(scene.clutchButton, 2);
    EXPECT_EQ(scene.points, 1000u);
    EXPECT_EQ(scene.seed, 7u);
    EXPECT_EQ(scene.stiffness, "linear:from=1e5,to=1e6,axis=y");
    EXPECT_EQ(scene.material.thickness, 5e-3);
    EXPECT_EQ(scene.material.poissonRatio, -0.2);
    EXPECT_EQ(scene.patch.foundation, 2e6);
    EXPECT_EQ(scene.material.stiffening, 810);
    EXPECT_EQ(scene.material.relaxation, (Relaxation{{{{0.26, 0.41}, {0.31, 4.3}}}, 2}));
    EXPECT_EQ(scene.materialName, "meat");
    EXPECT_EQ(scene.patch.cells, 32);
    EXPECT_EQ(scene.patch.map, Map::gallPeters);
    EXPECT_EQ(scene.patch.resampling, Resampling::nearest);
    EXPECT_EQ(scene.patch.edges, (PlateEdges{Edge::free, Edge::supported, Edge::supported, Edge::supported}));
    EXPECT_EQ(scene.patch.forceLaw, ForceLaw::paper);
    EXPECT_EQ(scene.patch.tolerance, 1e-6);
    EXPECT_EQ(scene.complianceLaw, ComplianceLaw::blend);
    EXPECT_EQ(scene.tableSize, 7);
    EXPECT_EQ(scene.deformationRate, 30);
    EXPECT_EQ(scene.proxy, ProxyForm::sphere);
    EXPECT_EQ(scene.staticFriction, 1);
    EXPECT_EQ(scene.dynamicFriction, 0);
    EXPECT_EQ(scene.maxForce, 0.5);
    EXPECT_EQ(scene.stiffnessCap, 800);
    EXPECT_EQ(scene.solver, "host");
    EXPECT_EQ(scene.place, glm::dvec3(1e-3, 0, 0));
    EXPECT_EQ(scene.from, glm::dvec3(0, 0, 2));
    EXPECT_EQ(scene.startHeight, 20e-3);
}

TEST(Scene, AMaterialSetsWhatIsKnownOfItAndOtherKeysWin)
{
    const Scene silicone = parsed(R"({"cloud": "sample:sheet", "material": "ecoflex-0030"})");
    EXPECT_EQ(silicone.stiffness, "constant:value=97260");
    EXPECT_EQ(silicone.material.poissonRatio, 0.49);
    EXPECT_TRUE(silicone.material.isLinear());
    EXPECT_EQ(silicone.origins.at("poisson").where, "s.json: material ecoflex-0030");
    EXPECT_EQ(sceneJson(parsed(sceneJson(silicone))), sceneJson(silicone));

    const Scene meat = parsed(R"({"cloud": "sample:sheet", "material": "meat", "stiffening": 300})");
    EXPECT_TRUE(meat.stiffness.empty()) << "its modulus is not known";
    EXPECT_EQ(meat.material.stiffening, 300);
    EXPECT_EQ(meat.material.relaxation.count, 2u);
    EXPECT_EQ(sceneJson(parsed(sceneJson(meat))), sceneJson(meat));

    const Scene paper = parsed(R"({"cloud": "sample:sheet", "material": "meat"})", overrides({{"preset", "paper"}}));
    EXPECT_TRUE(paper.material.isLinear()) << "a flag's preset wins over the file's material";
}

/// A stated stiffening counts in place of the cloud's: what nobody stated may not be stated where it is written.
TEST(Scene, AStiffeningThatNobodyStatedIsNotWritten)
{
    const Scene spring = parsed(R"({"cloud": "sample:sheet"})"),
                zero   = parsed(R"({"cloud": "sample:sheet", "stiffening": 0})");
    EXPECT_FALSE(statesStiffening(parsed(sceneJson(spring))));
    EXPECT_TRUE(statesStiffening(parsed(sceneJson(zero))));
    EXPECT_EQ(sceneJson(parsed(sceneJson(spring))), sceneJson(spring));
}

TEST(Scene, AScenesCloudInAFolderIsRelativeToIt)
{
    const TemporaryFolder folder;
    (void)folder.write("cloud.csv", "x,y,z,stiffness\n0,0,0,1\n1,0,0,1\n");
    Scene scene = parseScene(R"({"cloud": "cloud.csv"})", "s.json", folder.path());
    EXPECT_NE(sceneJson(scene, folder.path()).find("\"cloud\": \"cloud.csv\""), std::string::npos);
    EXPECT_NE(sceneJson(scene, folder.path() / "below").find((folder.path() / "cloud.csv").string()),
              std::string::npos);
    EXPECT_NE(sceneJson(scene).find((folder.path() / "cloud.csv").string()), std::string::npos);
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
        {R"("thickness": -0.004)",
         {"s.json: key \"thickness\": expected a length from 1e-6 to 1 m, such as 4 mm", "found \"-0.004\""}},
        {R"("thickness": 0)", {"key \"thickness\"", "found \"0\""}},
        {R"("thickness": "4 N")", {"key \"thickness\"", "unknown unit \"N\"", "mm"}},
        {R"("thickness": "4 furlong")", {"key \"thickness\"", "furlong", "known units"}},
        {R"("thickness": "nan mm")", {"key \"thickness\"", "finite"}},
        {R"("thickness": "inf")", {"key \"thickness\"", "finite"}},
        {R"("thickness": true)", {"key \"thickness\"", "expected a length", "found true"}},
        {R"("thickness": null)", {"key \"thickness\"", "found null"}},
        {R"("thickness": [0.004])", {"key \"thickness\"", "found [0.004]"}},
        {R"("poisson": 0.5)", {"key \"poisson\"", "below 0.5", "found \"0.5\"", "0.49"}},
        {R"("poisson": 45)", {"key \"poisson\"", "incompressible"}},
        {R"("poisson": -1)", {"key \"poisson\"", "above -1"}},
        {R"("poisson": "0.45 m")", {"key \"poisson\"", "unknown unit \"m\""}},
        {R"("stiffening": -1)", {"key \"stiffening\"", "from 0"}},
        {R"("stiffening": "1 mm")", {"key \"stiffening\"", "unknown unit \"mm\"", "1/mm"}},
        {R"("relaxation": "half")", {"key \"relaxation\"", "SHARE@TIME", "found \"half\""}},
        {R"("relaxation": "0.6@1s,0.4@2s")", {"key \"relaxation\"", "0.99"}},
        {R"("relaxation": "0.1@1,0.1@2,0.1@3,0.1@4")", {"key \"relaxation\"", "more terms"}},
        {R"("relaxation": "0@1s")", {"key \"relaxation\"", "not above 0"}},
        {R"("relaxation": "0.5@1us")", {"key \"relaxation\"", "unknown unit \"us\""}},
        {R"("relaxation": "0.5@0")", {"key \"relaxation\"", "1e-3"}},
        {R"("material": "ecoflex-0030-thiner-25")", {"key \"material\"", "did you mean \"ecoflex-0030-thinner-25\"?"}},
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
        {R"("compliance_law": 1)", {"key \"compliance_law\"", "table, hold or blend"}},
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
        {R"("solver": "")", {"key \"solver\""}},
        {R"("length_unit": "mm")", {"key \"length_unit\"", "sample:skin"}},
        {R"("dynamic_friction": 0.9)", {"key \"dynamic_friction\"", "static_friction"}},
        {R"("footprint_radius": 0.1)", {"key \"footprint_radius\"", "window"}},
        {R"("cells": 32, "cells": 64)", {"\"cells\"", "twice"}},
        {R"("edges": "x0=free,z1=clamped,x0=supported")",
         {"s.json: key \"edges\": expected each side once", "found \"x0=free\" and \"x0=supported\"", "omit one"}},
        {R"("edges": {"x0": "free", "x0": "supported"})", {"\"x0\"", "twice"}},
        {R"("edges": "clampd")",
         {"key \"edges\": expected clamped, supported, free or guided", "found \"clampd\"",
          "did you mean \"clamped\"?"}},
        {R"("held": "foo")", {"key \"held\": expected", "own", "found \"foo\""}},
    };
    for (const auto& [more, words] : cases) EXPECT_TRUE(says(refusal(more), words)) << more;
}

TEST(Scene, FlagsAndVariablesAreRefusedUnderTheirOwnNames)
{
    EXPECT_TRUE(says(refusal("", overrides({{"thickness", "-4mm"}})), {"--thickness: expected a length", "-4mm"}));
    EXPECT_TRUE(says(refusal("", overrides({{"static_friction", ""}})), {"--static-friction: expected a value"}));
    EXPECT_TRUE(says(refusal("", overrides({}, {{"PALPATE_MAX_FORCE", "lots"}})), {"PALPATE_MAX_FORCE", "lots"}));
    EXPECT_TRUE(says(refusal("", overrides({{"edges", "x0=free,x0=free"}})), {"--edges: expected each side once"}));
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
    EXPECT_TRUE(says(text(R"({"cloud": ""})"), {"key \"cloud\"", "path", "sample:NAME, found \"\""}));
    EXPECT_TRUE(says(text(R"({"cloud": 5})"), {"key \"cloud\"", "5"}));
    EXPECT_TRUE(says(text(R"({"cloud": "sample:skin", /* a comment */ "cells": 32, "cells": 64})"),
                     {"s.json", "the key \"cells\" is given twice in one object"}));
    EXPECT_TRUE(says(text(R"({"cloud": "sample:skin", "below": {"depth": "1 mm", "depth": "2 mm"}})"),
                     {"the key \"depth\" is given twice in one object"}));
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
    const std::string beside  = std::filesystem::relative(folder / "plane.xyz").string();
    const Scene       flagged = parsed("{}", overrides({{"cloud", beside}}));
    EXPECT_EQ(flagged.cloud, beside);
    EXPECT_EQ(loadCloud(parseScene(sceneJson(flagged), "again", "/elsewhere")).cloud.size(), 100u);
    EXPECT_TRUE(says(refusalOf([&] {
                         static_cast<void>(readScene(file, overrides({{"length_unit", "parsec"}})));
                     }),
                     {"--length-unit", "parsec"}));
    for (const char* micrometres : {"um", "\u00b5m", "\u03bcm"})
        EXPECT_EQ(readScene(file, overrides({{"length_unit", micrometres}})).reading.lengthUnit, "um");
    EXPECT_TRUE(says(refusalOf([&] {
                         SceneOverrides flags    = overrides({{"window", "1e-6"}, {"length_unit", "mm"}});
                         flags.flagsInLengthUnit = true;
                         static_cast<void>(readScene(file, flags));
                     }),
                     {"--window", "from 1e-6 to 100 m", "found \"1e-6\", which the length unit makes 1e-9 m"}));
    EXPECT_TRUE(says(refusalOf([&] {
                         static_cast<void>(readScene(file, overrides({{"points", "100"}})));
                     }),
                     {"--points", "sample"}));
    const auto placeless = folder.write("t.json", R"({"cloud": "plane.xyz"})");
    EXPECT_FALSE(readScene(placeless).place) << "it is touched where it comes nearest to the viewer";
}

/// A plane of points in millimetres whose property "quality" runs from 0 to 9.
std::filesystem::path paintedScan(const TemporaryFolder& folder, const std::string& comment = "")
{
    std::string text = "ply\nformat ascii 1.0\n" + comment +
                       "element vertex 100\nproperty float x\nproperty float y\nproperty float z\n"
                       "property float quality\nend_header\n";
    for (int i = 0; i < 100; ++i)
        text += std::to_string(i % 10) + " " + std::to_string(i / 10) + " 0 " + std::to_string(i % 10) + "\n";
    return folder.write("scan.ply", text);
}

TEST(Scene, EveryKeyForReadingAFileIsRead)
{
    const TemporaryFolder folder;
    static_cast<void>(paintedScan(folder));
    const auto file = folder.write("s.json", R"({"cloud": "scan.ply", "length_unit": "mm",
        "stiffness_property": "quality", "stiffness_unit": "N_m", "stiffness_range": [1e-3, 0.1], "log_range": true,
        "columns": "x,y,z", "drop_invalid": true, "scatter": 0.002, "place": ["1mm", 0, 0]})");
    EXPECT_TRUE(says(refusalOf([&] { static_cast<void>(readScene(file)); }), {"key \"place\""}));
    static_cast<void>(folder.write("t.json", R"({"cloud": "scan.ply", "length_unit": "mm",
        "stiffness_property": "quality", "stiffness_unit": "N_m", "stiffness_range": [1e-3, 0.1], "log_range": true,
        "columns": "x,y,z", "drop_invalid": true, "scatter": 0.002})"));
    const Scene scene = readScene(folder / "t.json");

    EXPECT_EQ(scene.reading.lengthUnit, "mm");
    EXPECT_EQ(scene.reading.stiffnessProperty, "quality");
    EXPECT_EQ(scene.reading.stiffnessKind, StiffnessKind::rigidity);
    EXPECT_EQ(scene.reading.range->from, 1e-3);
    EXPECT_EQ(scene.reading.range->to, 0.1);
    EXPECT_EQ(scene.reading.range->scale, RangeScale::logarithmic);
    EXPECT_EQ(scene.reading.columns, "x,y,z");
    EXPECT_EQ(scene.scatterDistance, 2e-3);
    EXPECT_TRUE(scene.reading.dropInvalid);
    EXPECT_FALSE(scene.place);
    EXPECT_EQ(sceneJson(parseScene(sceneJson(scene), "again", "/elsewhere")), sceneJson(scene));

    EXPECT_TRUE(holds(refusalOf([&] { static_cast<void>(loadCloud(scene)); }), {"columns are for text files"}));
    Scene binary = scene;
    binary.reading.columns.clear();
    binary.scatter         = Scatter::off; // the points have no faces
    const PointCloud cloud = loadCloud(binary).cloud;
    EXPECT_EQ(cloud.kind(), StiffnessKind::rigidity);
    EXPECT_NEAR(cloud.bounds().high.x, 9e-3, 1e-12);
    EXPECT_NEAR(cloud.stiffness()[0], 1e-3, 1e-15);
    EXPECT_NEAR(cloud.stiffness()[9], 0.1, 1e-13);
    EXPECT_NEAR(cloud.stiffness()[3], std::pow(10, -3 + 2 * 3.0 / 9), 1e-12) << "equal factors";
}

TEST(Scene, AStiffnessThatContradictsTheFileIsRefusedUnderItsOwnName)
{
    const TemporaryFolder folder;
    const auto            scan = paintedScan(folder, "comment length_unit mm\n");
    const auto            read = [&](std::map<std::string, std::string, std::less<>> flags) {
        flags["cloud"] = scan.string();
        return refusalOf([&] { static_cast<void>(loadCloud(parsed("{}", overrides(flags)))); });
    };
    EXPECT_EQ(read({{"uniform", "300kPa"}}), "") << "quality is no stiffness unless somebody names it";
    EXPECT_TRUE(says(read({{"uniform", "300kPa"}, {"stiffness_property", "quality"}, {"stiffness_range", "1kPa,2kPa"}}),
                     {"--uniform: expected a file without stiffness", "constant:value"}));
    EXPECT_TRUE(says(read({{"log_range", "true"}}), {"--log-range: expected --stiffness-range beside it"}));
    EXPECT_TRUE(says(read({{"log_range", "yes"}}), {"--log-range: expected true or false", "yes"}));
    EXPECT_TRUE(says(read({{"stiffness_range", "1kPa"}}), {"--stiffness-range: expected two stiffnesses", "1kPa"}));
    EXPECT_TRUE(
        says(read({{"stiffness_range", "0,1kPa"}}), {"--stiffness-range: expected two stiffnesses above zero"}));
    EXPECT_TRUE(says(read({{"stiffness_range", "1kPa,2mm"}}), {"--stiffness-range", "unknown unit \"mm\""}));
    EXPECT_TRUE(says(read({{"stiffness_unit", "kPa"}}), {"--stiffness-unit: expected Pa, N_m or N/m", "kPa"}));
    EXPECT_TRUE(says(read({{"stiffness_property", "qualty"}}), {"scan.ply", "qualty"}));
    EXPECT_TRUE(says(read({{"uniform", "nan"}}), {"--uniform", "finite"}));
    for (const char* key : {"stiffness_property", "stiffness_unit", "stiffness_range", "uniform", "columns",
                            "drop_invalid", "scatter", "length_unit"})
        EXPECT_TRUE(says(refusal("\"" + std::string(key) + "\": \"x\""),
                         {"key \"" + std::string(key) + "\": expected a file as the cloud, found sample:skin"}));
}

TEST(Scene, APresetStandsBelowTheKeysOfItsOwnSourceAndAboveWeakerSources)
{
    const std::string file = R"({"cloud": "sample:skin", "preset": "paper", "force_law": "series"})";
    const Scene       own  = parsed(file);
    EXPECT_EQ(own.preset, Preset::paper);
    EXPECT_EQ(own.patch.map, Map::gallPeters) << "over the default";
    EXPECT_EQ(own.patch.foundation, 0) << "over the sample";
    EXPECT_EQ(own.patch.forceLaw, ForceLaw::series) << "the file's own key wins";
    EXPECT_EQ(own.origins.at("map").where, "s.json: preset paper");
    EXPECT_EQ(own.origins.at("map").origin, Origin::scene);

    const Scene over = parsed(R"({"cloud": "sample:skin", "force_law": "series", "foundation": "1 MPa/m"})",
                              overrides({{"preset", "paper"}, {"map", "lambert-cylindrical"}}));
    EXPECT_EQ(over.patch.forceLaw, ForceLaw::paper) << "a flag's preset wins over the file's keys";
    EXPECT_EQ(over.patch.foundation, 0);
    EXPECT_EQ(over.patch.map, Map::lambertCylindrical) << "another flag wins over it";

    const Scene back = parsed(file, overrides({{"preset", "palpate"}}, {{"PALPATE_MAP", "gall-peters"}}));
    EXPECT_EQ(back.patch.map, Map::lambertAzimuthal) << "a flag's preset wins over the environment";
    EXPECT_EQ(back.patch.resampling, Resampling::logMean);
    EXPECT_EQ(back.patch.foundation, 0) << "palpate leaves the foundation to the file's preset";
    EXPECT_EQ(sceneJson(parsed(sceneJson(own))), sceneJson(own));
    EXPECT_TRUE(says(refusal(R"("preset": "papre")"), {"palpate or paper", "did you mean \"paper\"?"}));
}

TEST(Scene, PlainLengthsOfACommandLineAreInItsLengthUnitAndThoseOfFilesInMetres)
{
    const TemporaryFolder folder;
    const auto            scan = paintedScan(folder);
    SceneOverrides        line = overrides({{"length_unit", "mm"},
                                            {"place", "1,0.002m,0"},
                                            {"window", "20"},
                                            {"footprint_radius", "2"},
                                            {"thickness", "0.5"},
                                            {"from", "0,0,7"}},
                                           {{"PALPATE_START_HEIGHT", "0.004"}});
    line.flagsInLengthUnit     = true;
    line.flags["cloud"]        = scan.string();
    const Scene scene          = parsed("{}", line);
    EXPECT_NEAR(scene.place->x, 1e-3, 1e-18);
    EXPECT_EQ(scene.place->y, 0.002);
    EXPECT_NEAR(scene.patch.window, 20e-3, 1e-15);
    EXPECT_NEAR(scene.material.thickness, 0.5e-3, 1e-15);
    EXPECT_EQ(scene.from, glm::dvec3(0, 0, 7)) << "a direction has no unit";
    EXPECT_EQ(scene.startHeight, 0.004) << "the environment is in metres";

    line.flags.erase("cloud");
    line.flags.erase("length_unit");
    const std::string file = R"({"cloud": ")" + scan.string() + R"(", "length_unit": "mm", "start_height": 0.003})";
    EXPECT_NEAR(parsed(file, line).patch.window, 20e-3, 1e-15) << "the file's unit counts for the line";
    line.environment = nullptr;
    EXPECT_EQ(parsed(file, line).startHeight, 0.003) << "but not for its own numbers";

    SceneOverrides sample    = overrides({{"length_unit", "mm"}, {"thickness", "3"}});
    sample.flagsInLengthUnit = true;
    EXPECT_NEAR(parsed(R"({"cloud": "sample:skin"})", sample).material.thickness, 3e-3, 1e-15);
    EXPECT_EQ(parsed(R"({"cloud": "sample:skin"})", sample).reading.lengthUnit, "");
    sample.flags["length_unit"] = "parsec";
    EXPECT_TRUE(says(refusalOf([&] { static_cast<void>(parsed(R"({"cloud": "sample:skin"})", sample)); }),
                     {"--length-unit: expected m, mm", "parsec"}));
}

TEST(Scene, WithoutAPlaceAFilesCloudIsTouchedWhereItComesNearestToTheViewer)
{
    const TemporaryFolder folder;
    std::string           points;
    for (int i = 0; i < 400; ++i) {
        const double x = i % 20 - 10, y = i / 20 - 10;
        points += std::to_string(x) + " " + std::to_string(y) + " " +
                  std::to_string(9 - 0.02 * (x * x + (y - 3) * (y - 3))) + "\n";
    }
    static_cast<void>(folder.write("dome.xyz", points));
    const Scene     scene = parsed("{}", overrides({{"cloud", (folder / "dome.xyz").string()}, {"length_unit", "mm"}}));
    const HandPlace place = handPlace(scene, loadObject(scene).object);

    EXPECT_NEAR(place.point.x, 0, 1e-12);
    EXPECT_NEAR(place.point.y, 3e-3, 1e-12);
    EXPECT_GT(place.outward.z, 0.9);
}

TEST(Scene, TwoScenesHaveTheSameCloudUnlessAKeyThatDecidesItDiffers)
{
    const auto scene = [](const std::string& more) { return parsed(R"({"cloud": "sample:skin")" + more + "}"); };
    EXPECT_TRUE(haveSameCloud(scene(""), scene(R"(, "thickness": 0.001, "place": [0, 0, 0])")));
    EXPECT_FALSE(haveSameCloud(scene(""), scene(R"(, "points": 500)")));
    EXPECT_FALSE(haveSameCloud(scene(""), scene(R"(, "seed": 2)")));
    EXPECT_FALSE(haveSameCloud(scene(""), scene(R"(, "stiffness": "constant:value=1e5")")));
    const TemporaryFolder folder;
    const std::string     file  = paintedScan(folder).string();
    const auto            other = [&](const char* key, const char* value) {
        return parsed("{}", overrides({{"cloud", file}, {key, value}}));
    };
    EXPECT_FALSE(haveSameCloud(other("length_unit", "mm"), other("length_unit", "cm")));
    EXPECT_FALSE(haveSameCloud(other("uniform", "1kPa"), other("uniform", "2kPa")));
}

TEST(Scene, EachKeyThatHasBoundsSaysThem)
{
    const std::map<std::string_view, std::string_view> expected = {
        {"points", "a whole number from 16 to 10000000"},
        {"seed", "a whole number from 0 to 4294967295"},
        {"scatter", "auto, on, off, or a distance from 1e-6 to 1 m, such as 0.5 mm"},
        {"place", "a place X,Y,Z up to 1e9 m away, such as 10mm,0,35mm"},
        {"thickness", "a length from 1e-6 to 1 m, such as 4 mm"},
        {"poisson", "a number above -1 and below 0.5"},
        {"foundation", "a number from 0 to 1e15 Pa/m, such as 1.74 MPa/m"},
        {"stiffening", "a number from 0 to 1e5 1/m, such as 0.8 1/mm"},
        {"window", "object, auto, or a length from 1e-6 to 100 m, such as 70 mm"},
        {"cells", "an even number from 8 to 1024"},
        {"footprint_radius", "a length from 1e-6 to 10 m, such as 4 mm"},
        {"tolerance", "a number from 1e-7 to 0.1"},
        {"table_size", "0, 1, 3, 5 or 7"},
        {"deformation_rate", "a number from 1 to 1000 Hz"},
        {"static_friction", "a number from 0 to 10"},
        {"dynamic_friction", "a number from 0 to 10"},
        {"max_force", "a force from 0.01 to 8 N, such as 4 N"},
        {"stiffness_cap", "a number from 1 to 2000 N/m"},
        {"start_height", "a length from 0 to 1 m, such as 10 mm"},
        {"workspace_scale", "a number from 0.1 to 10"},
        {"clutch_button", "a whole number from 0 to 16"},
    };
    for (const SceneKey& key : sceneKeys()) {
        if (!key.bounds) continue;
        ASSERT_TRUE(expected.contains(key.name)) << key.name;
        EXPECT_EQ(key.expected(), expected.at(key.name));
        if (key.form.empty()) continue; // the sentence is no copy of the bounds
        const std::string least = plainNumber(std::abs(key.bounds->least)), most = plainNumber(key.bounds->most);
        EXPECT_TRUE(holds(key.expected(), {least, most})) << key.name;
    }
}

TEST(Scene, TheBoundsThemselvesAreTaken)
{
    const std::pair<const char*, const char*> taken[] = {{"max_force", "0.01"},
                                                         {"max_force", "8"},
                                                         {"thickness", "1 um"},
                                                         {"thickness", "1 m"},
                                                         {"cells", "8"},
                                                         {"cells", "1024"},
                                                         {"points", "16"},
                                                         {"points", "10000000"},
                                                         {"tolerance", "1e-7"},
                                                         {"tolerance", "0.1"},
                                                         {"deformation_rate", "1000"},
                                                         {"stiffness_cap", "1"},
                                                         {"seed", "0"},
                                                         {"seed", "4294967295"},
                                                         {"static_friction", "10"},
                                                         {"clutch_button", "16"},
                                                         {"foundation", "0"},
                                                         {"foundation", "1e15"},
                                                         {"start_height", "0"},
                                                         {"start_height", "1 m"},
                                                         {"stiffening", "1e5"},
                                                         {"place", "1e9,-1e9,0"},
                                                         {"window", "100 m"},
                                                         {"poisson", "-0.999999"}};
    for (const auto& [key, value] : taken) EXPECT_EQ(refusal("", overrides({{key, value}})), "");
}

TEST(Scene, ALongValueIsRefusedByItsBeginning)
{
    const std::string beginning(200, 'x');
    EXPECT_TRUE(says(refusal(R"("map": ")" + beginning + R"(yz")"), {"found \"" + beginning + "...\""}));
}

TEST(Scene, NumbersAreWrittenWithoutNeedlessSignsAndZeros)
{
    const std::pair<double, const char*> numbers[] = {{0.1, "0.1"},   {100, "100"},       {123456, "123456"},
                                                      {1e5, "1e5"},   {1e22, "1e22"},     {1e100, "1e100"},
                                                      {1e-7, "1e-7"}, {-2e-12, "-2e-12"}, {1e-100, "1e-100"}};
    for (const auto& [number, text] : numbers) EXPECT_EQ(plainNumber(number), text);
}

TEST(Scene, TextsAreWrittenAsTheyAre)
{
    EXPECT_EQ(quotedJson("Gr\xC3\xBC\xC3\x9F \"e\"\n"), "\"Gr\xC3\xBC\xC3\x9F \\\"e\\\"\\n\"");
    EXPECT_EQ(quotedJson("a\xFF"), "\"a\xEF\xBF\xBD\"") << "what is no UTF-8 is marked as unknown";
}

TEST(Scene, SlidersShowTheStandardValuesAndOfferNothingThatASceneRefuses)
{
    const Scene skin    = parsed(R"({"cloud": "sample:skin"})");
    int         sliders = 0;
    for (const SceneKey& key : sceneKeys()) {
        if (!key.control || key.control->most == key.control->least) continue;
        const KeyControl& slider = *key.control;
        const double      shown = key.number(skin) / slider.perUnit, inDigits = shown * std::pow(10, slider.decimals);
        const bool        own = slider.unit[0] == '\0' || slider.unit == key.unit;
        ++sliders;
        EXPECT_EQ(slider.perUnit, own ? 1 : parseQuantity(std::string("1 ") + slider.unit, key.dimension, "a test"))
            << key.name;
        EXPECT_GE(slider.least * slider.perUnit, key.bounds->least) << key.name;
        EXPECT_LE(slider.most * slider.perUnit, key.bounds->most) << key.name;
        EXPECT_GE(shown, slider.least) << key.name;
        EXPECT_LE(shown, slider.most) << key.name;
        EXPECT_NEAR(inDigits, std::round(inDigits), 1e-9) << key.name << " is rounded";
        EXPECT_NEAR(slider.step > 0 ? std::remainder(shown, slider.step) : 0, 0, 1e-9) << key.name;
    }
    EXPECT_EQ(sliders, 13);
}

TEST(Scene, KeysThatHadOtherNamesAreKnownByThem)
{
    EXPECT_EQ(keyNamedOnce("device"), "solver");
    EXPECT_EQ(keyNamedOnce("hand_over"), "compliance_law");
    EXPECT_EQ(keyNamedOnce("sampling"), "resampling");
    for (const SceneKey& key : sceneKeys()) EXPECT_FALSE(keyNamedOnce(key.name)) << key.name;
}

TEST(Scene, NamesOfFlagsAndVariablesAreUnique)
{
    std::set<std::string> names;
    for (const SceneKey& key : sceneKeys()) {
        EXPECT_TRUE(names.insert(flagOf(key.name)).second);
        EXPECT_FALSE(key.help.empty() || key.expected().empty()) << key.name;
    }
    EXPECT_EQ(flagOf("max_force"), "--max-force");
    EXPECT_EQ(variableOf("max_force"), "PALPATE_MAX_FORCE");
}

} // namespace
} // namespace palp
