#include "engine/tools/gui/scene_controls.h"

#include <algorithm>
#include <set>

#include <gtest/gtest.h>

namespace palp {
namespace {

/// Room for every value alone: a wide window, a small fingertip, and friction that slides less than it holds.
Scene sceneWith(const std::string& key, const std::string& text)
{
    SceneOverrides overrides;
    overrides.flags[key] = text;
    return parseScene(R"({"cloud": "sample:palm", "window": 1, "footprint_radius": 1e-5, "static_friction": 10,
                          "dynamic_friction": 0})",
                      "a test", ".", overrides);
}

TEST(SceneControls, EveryKeyIsOneOfAScene)
{
    for (const SceneControls& group : sceneControls()) {
        for (const SceneNumber& number : group.numbers)
            EXPECT_NE(std::ranges::find(sceneKeys(), number.key, &SceneKey::name), sceneKeys().end()) << number.key;
        for (const SceneChoice& choice : group.choices)
            EXPECT_NE(std::ranges::find(sceneKeys(), choice.key, &SceneKey::name), sceneKeys().end()) << choice.key;
    }
}

TEST(SceneControls, EveryKeyOfASceneIsThereOrCannotChangeWhileOneTouches)
{
    // What is touched, where, and on which device: a new session, not another value. The law and the edges have fields
    // of their own, and the size of the table follows from the rate.
    std::set<std::string_view> found{"cloud",  "points", "seed",     "length_unit",  "stiffness",
                                     "device", "place",  "from",     "start_height", "table_size",
                                     "edges",  "hunt",   "hunt_seed"};
    for (const SceneControls& group : sceneControls()) {
        for (const SceneNumber& number : group.numbers) EXPECT_TRUE(found.insert(number.key).second) << number.key;
        for (const SceneChoice& choice : group.choices) EXPECT_TRUE(found.insert(choice.key).second) << choice.key;
    }
    for (const SceneKey& key : sceneKeys()) EXPECT_TRUE(found.contains(key.name)) << key.name << " has no control";
}

/// Both ends and a value between, as the slider sends them, are taken by a scene and come back as the same number.
TEST(SceneControls, ASliderSaysWhatASceneReads)
{
    for (const SceneControls& group : sceneControls())
        for (const SceneNumber& number : group.numbers)
            for (const double shown : {number.least, number.most, 0.3 * number.least + 0.7 * number.most}) {
                const std::string text = wishText(number, shown);
                double            read = 0;
                ASSERT_NO_THROW(read = number.of(sceneWith(std::string(number.key), text)) / number.perUnit)
                    << number.key << " = " << text;
                // Six digits are sent; then there are whole steps.
                EXPECT_NEAR(read, shown, std::max(1e-5 * shown, number.step)) << number.key << " = " << text;
            }
}

TEST(SceneControls, EveryOptionIsReadAndComesBack)
{
    for (const SceneControls& group : sceneControls())
        for (const SceneChoice& choice : group.choices)
            for (const char* option : choice.options) {
                ASSERT_NO_THROW(static_cast<void>(sceneWith(std::string(choice.key), option)))
                    << choice.key << " = " << option;
                EXPECT_EQ(choice.of(sceneWith(std::string(choice.key), option)), option) << choice.key;
            }
}

TEST(SceneControls, EveryLawToStartFromSpansTheCloud)
{
    const Scene      scene = parseScene(R"({"cloud": "sample:palm", "points": 500})", "a test", ".");
    const PointCloud cloud = loadCloud(scene).cloud;
    const auto [low, high] = std::ranges::minmax(cloud.stiffness());
    for (const char* law : {"constant", "linear", "hyperbolic", "gaussian"}) {
        SceneOverrides overrides;
        overrides.flags["stiffness"] = lawPreset(law, scene, cloud);
        const Scene       changed = parseScene(R"({"cloud": "sample:palm", "points": 500})", "a test", ".", overrides);
        const LoadedCloud made    = loadCloud(changed);
        for (const double modulus : made.cloud.stiffness()) {
            ASSERT_GE(modulus, 0.99 * low) << law << ": three digits are written";
            ASSERT_LE(modulus, 1.01 * high) << law << ": three digits are written";
        }
    }
}

} // namespace
} // namespace palp
