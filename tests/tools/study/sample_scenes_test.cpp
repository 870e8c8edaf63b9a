// The scenes in samples/scenes: each reads, its README's numbers hold, and the schema knows what the reader knows.
#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "engine/contact/contact.h"
#include "engine/force/relaxing_contact.h"
#include "engine/pipeline/deform.h"
#include "engine/session/hand_path.h"
#include "engine/tools/study/hunt_scene.h"
#include "tests/support/temporary_folder.h"

namespace palp {
namespace {

using Json = nlohmann::json;

const std::filesystem::path kScenes = PALPATE_SCENES;

/// With the keys of hunts, as every command reads it.
Scene sceneOf(const std::filesystem::path& file)
{
    return readScene(file, {.toolKeys = &study::huntKeys()});
}

/// A row of the README's table.
struct Row {
    std::string name;
    glm::dvec3  soft{}, stiff{};                       ///< [m]
    double      softStiffness = 0, stiffStiffness = 0; ///< felt K [N/m]
    double      forceAtHalf = 0;                       ///< deflects the soft place by half the thickness [N]
    double      steps       = 0;                       ///< J [1]
};

std::vector<Row> readme()
{
    std::vector<Row>   rows;
    std::istringstream text(contentsOf(kScenes / "README.md"));
    for (std::string line; std::getline(text, line);) {
        if (line.starts_with("| nodule | ") || line.starts_with("| key | ")) break; // another table
        if (!line.starts_with("| ") || line.starts_with("| scene")) continue;
        std::ranges::replace(line, '|', ' ');
        std::ranges::replace(line, ',', ' ');
        std::istringstream words(line);
        Row                row;
        words >> row.name;
        for (glm::dvec3* place : {&row.soft, &row.stiff}) words >> place->x >> place->y >> place->z;
        words >> row.softStiffness >> row.stiffStiffness >> row.forceAtHalf >> row.steps;
        EXPECT_TRUE(words) << line;
        rows.push_back(row);
    }
    return rows;
}

std::vector<std::filesystem::path> sceneFiles()
{
    std::vector<std::filesystem::path> files;
    for (const auto& entry : std::filesystem::directory_iterator(kScenes))
        if (entry.path().extension() == ".json" && entry.path().filename() != "scene.schema.json")
            files.push_back(entry.path());
    return files;
}

TEST(SampleScenes, EveryFileHasARowInTheReadmeAndNoRowIsWithoutAFile)
{
    std::set<std::string> files, rows;
    for (const auto& file : sceneFiles()) files.insert(file.stem().string());
    for (const Row& row : readme()) rows.insert(row.name);

    EXPECT_EQ(files, rows);
    EXPECT_EQ(files.size(), 13u);
}

TEST(SampleScenes, TheFingerFeelsWhatTheReadmeSays)
{
    constexpr double kRounding = 0.005; // relative: the README gives two or three digits, and seeds are fixed
    for (const Row& row : readme()) {
        SCOPED_TRACE(row.name);
        const Scene      scene  = sceneOf(kScenes / (row.name + ".json"));
        const SoftObject object = loadObject(scene).object;
        const auto       touch  = [&](const glm::dvec3& place) {
            return deform(object, touchAt(object, place, scene.from, 10e-3), scene.patch);
        };

        const Patch soft = touch(row.soft), stiff = touch(row.stiff);

        EXPECT_NEAR(soft.feltStiffness, row.softStiffness, kRounding * row.softStiffness);
        EXPECT_NEAR(stiff.feltStiffness, row.stiffStiffness, kRounding * row.stiffStiffness);
        EXPECT_NEAR(scene.material.thickness / 2 / (soft.compliance - soft.bodyCompliance), row.forceAtHalf,
                    kRounding * row.forceAtHalf + 0.005);
        EXPECT_NEAR(std::log(stiff.feltStiffness / soft.feltStiffness) / std::log(1.07), row.steps, 0.05);
        EXPECT_LT(stiff.feltStiffness, scene.stiffnessCap) << "a contrast that the cap clips is not felt";
    }
}

TEST(SampleScenes, AHeldFingerLosesTheForceThatTheReadmeSays)
{
    std::istringstream text(contentsOf(kScenes / "README.md"));
    int                found = 0;
    bool               held  = false; // inside the table
    for (std::string line; std::getline(text, line);) {
        if (!line.starts_with("|")) held = false;
        if (line.starts_with("| held |")) held = true;
        if (!held || line.starts_with("| held |") || line.starts_with("|-")) continue;
        std::ranges::replace(line, '|', ' ');
        std::istringstream    words(line);
        std::string           name;
        double                depth = 0;
        std::array<double, 3> forces{};
        words >> name >> depth >> forces[0] >> forces[1] >> forces[2];
        ASSERT_TRUE(words) << line;
        SCOPED_TRACE(name);
        const auto       rows   = readme();
        const auto       row    = std::ranges::find(rows, name, &Row::name);
        const Scene      scene  = sceneOf(kScenes / (name + ".json"));
        const SoftObject object = loadObject(scene).object;
        const Patch      soft   = deform(object, touchAt(object, row->soft, scene.from, 10e-3), scene.patch);

        const DepthLaw   law = DepthLaw::capped(soft.feltStiffness, scene.material.stiffening, scene.stiffnessCap);
        RelaxingContact  contact(scene.material.relaxation, scene.patch.footprintRadius);
        constexpr double kRounding = 0.005; // as above, and three digits
        for (int tick = 0; tick <= 10'000; ++tick) {
            const double force = contact.step({law, depth * 1e-3, {}, tick == 0 ? 0 : 1e-3}).force;
            const auto   which = tick == 0 ? 0 : tick == 1000 ? 1 : tick == 10'000 ? 2 : -1;
            if (which < 0) continue;
            EXPECT_NEAR(force, forces[std::size_t(which)], kRounding * force) << tick;
        }
        ++found;
    }
    EXPECT_EQ(found, 2);
}

TEST(SampleScenes, ThePlaceOfEachSceneIsOnItsCloud)
{
    for (const auto& file : sceneFiles()) {
        const Scene      scene  = sceneOf(file);
        const SoftObject object = loadObject(scene).object;

        EXPECT_LT(object.index().nearest(scene.place.value(), 1).front().distance, 2 * object.spacing()) << file;
    }
}

TEST(SampleScenes, TheSchemaAndTheReadmesTableAreThoseOfTheKeys)
{
    EXPECT_EQ(contentsOf(kScenes / "scene.schema.json"), sceneSchema(&study::huntKeys()))
        << "palpate info --schema >samples/scenes/scene.schema.json";
    EXPECT_NE(contentsOf(kScenes / "README.md").find(sceneKeyTable(&study::huntKeys())), std::string::npos)
        << "palpate info --keys prints the table of samples/scenes/README.md";

    const Json            schema = Json::parse(sceneSchema(&study::huntKeys()));
    std::set<std::string> described, read{"$schema"};
    for (const auto& [key, value] : schema["properties"].items()) described.insert(key);
    for (const SceneKey* key : sceneKeysWith(&study::huntKeys())) read.insert(std::string(key->name));
    EXPECT_EQ(described, read);
    EXPECT_EQ(schema["additionalProperties"], false);
    EXPECT_EQ(schema["$schema"], "https://json-schema.org/draft/2020-12/schema");
}

TEST(SampleScenes, EveryNameInTheSchemaIsReadAndBoundsAreThoseOfTheReader)
{
    const Json properties = Json::parse(contentsOf(kScenes / "scene.schema.json"))["properties"];
    const auto scene      = [](const std::string& key, const Json& value) {
        Json       object = {{"cloud", "sample:skin"}, {"static_friction", 10}, {"dynamic_friction", 0}};
        const auto known  = std::ranges::find(sceneKeys(), key, &SceneKey::name);
        if (known != sceneKeys().end() && known->cloud == SceneKey::For::file)
            object["cloud"] = (kScenes / "nodule_hunt_hand.csv").string(); // any that is there: nobody reads it
        if (key == "hunt_seed")
            object["hunt"] = {{"random", {{"count", 1}, {"radius", {3e-3, 4e-3}}, {"modulus", {1e6, 2e6}}}}};
        object[key] = value;
        return refusalOf(
            [&] { static_cast<void>(parseScene(object.dump(), "s.json", ".", {.toolKeys = &study::huntKeys()})); });
    };
    for (const auto& [key, property] : properties.items()) {
        if (key == "cloud" || key == "$schema" || key == "log_range") continue; // no bounds; not alone
        if (property.contains("enum")) {
            for (const Json& value : property["enum"]) EXPECT_EQ(scene(key, value), "") << key;
        }
        const Json& bounds = property.contains("anyOf") ? property["anyOf"][0] : property;
        for (const char* bound : {"minimum", "maximum"}) {
            if (!bounds.contains(bound)) continue;
            const double value = bounds[bound], beyond = bound == std::string("minimum") ? -1 : 1;
            if (key == "window" && beyond < 0) continue;           // narrower than the footprint
            if (key == "footprint_radius" && beyond > 0) continue; // wider than the window
            const bool counts  = bounds["type"] == "integer";
            const Json outside = value + beyond * std::max(1e-9, std::abs(value) * 1e-3);
            EXPECT_EQ(scene(key, bounds[bound]), "") << key << " at its " << bound;
            EXPECT_NE(scene(key, counts ? Json(std::int64_t(value + 2 * beyond)) : outside), "")
                << key << " beyond its " << bound;
        }
        for (const char* bound : {"exclusiveMinimum", "exclusiveMaximum"}) {
            if (!bounds.contains(bound)) continue;
            EXPECT_NE(scene(key, bounds[bound]), "") << key << " at its " << bound;
        }
    }
}

} // namespace
} // namespace palp
