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

TEST(SceneControls, EveryKeyOfASceneIsThereOrCannotChangeWhileOneTouches)
{
    // What is touched, where, and with which solver: a new session, not another value. The law and the edges have
    // fields of their own, a preset and a material are the values that they set, and the size of the table follows from
    // the rate. How a material relaxes is the scene's, and so is what lies below it; which button of a device is its
    // clutch is settled before it touches; the theory, large deflections included, and what is held go with the edges.
    std::set<std::string_view> found{"cloud",      "points",       "seed",          "stiffness", "solver", "place",
                                     "from",       "start_height", "table_size",    "edges",     "preset", "material",
                                     "relaxation", "below",        "clutch_button", "theory",    "large",  "held"};
    for (const SceneKey& key : sceneKeys())
        if (key.cloud == SceneKey::For::file) found.insert(key.name);
    std::size_t controls = 0;
    for (const SceneControls& group : sceneControls())
        for (const auto& keys : {group.sliders, group.lists})
            for (const SceneKey* key : keys) {
                EXPECT_TRUE(found.insert(key->name).second) << key->name;
                ++controls;
            }
    EXPECT_EQ(controls, 20u);
    for (const SceneKey& key : sceneKeys()) EXPECT_TRUE(found.contains(key.name)) << key.name << " has no control";
}

TEST(SceneControls, EverySliderIsWithinWhatASceneTakes)
{
    for (const SceneControls& group : sceneControls())
        for (const SceneKey* key : group.sliders) {
            EXPECT_GE(key->control->least * key->control->perUnit, key->bounds->least * (1 - 1e-12)) << key->name;
            EXPECT_LE(key->control->most * key->control->perUnit, key->bounds->most * (1 + 1e-12)) << key->name;
        }
}

/// Both ends and a value between, as the slider sends them, are taken by a scene and come back as the same number.
TEST(SceneControls, ASliderSaysWhatASceneReads)
{
    for (const SceneControls& group : sceneControls())
        for (const SceneKey* key : group.sliders) {
            const KeyControl& control = *key->control;
            for (const double shown : {control.least, control.most, 0.3 * control.least + 0.7 * control.most}) {
                const std::string text = wishText(*key, shown);
                double            read = 0;
                ASSERT_NO_THROW(read = key->number(sceneWith(std::string(key->name), text)) / control.perUnit)
                    << key->name << " = " << text;
                // Six digits are sent; then there are whole steps.
                EXPECT_NEAR(read, shown, std::max(1e-5 * shown, control.step)) << key->name << " = " << text;
            }
        }
}

TEST(SceneControls, EveryOptionIsReadAndComesBack)
{
    for (const SceneControls& group : sceneControls())
        for (const SceneKey* key : group.lists) {
            EXPECT_GE(optionsOf(*key).size(), 2u) << key->name;
            for (const std::string& option : optionsOf(*key)) {
                ASSERT_NO_THROW(static_cast<void>(sceneWith(std::string(key->name), option)))
                    << key->name << " = " << option;
                EXPECT_EQ(optionNow(*key, sceneWith(std::string(key->name), option)), option) << key->name;
            }
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
