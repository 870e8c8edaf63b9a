#include "engine/tools/study/hunt_scene.h"

#include <memory>
#include <utility>

#include "engine/core/contract.h"
#include "engine/session/scene_place.h"

namespace palp::study {
namespace {

// clang-format off
inline constexpr std::string_view kHuntSchema = R"({"anyOf": [{"type": "object", "additionalProperties": false, "properties": {"nodules":
{"description": "each a ball of another modulus, that fades out from 0.75 to 1.25 of its radius",
"type": "array", "minItems": 1, "maxItems": 64, "items": {"type": "object", "additionalProperties":
false, "required": ["at", "radius", "modulus"], "properties": {"at": {"description": "its middle, on
the object [m]", "anyOf": [{"type": "array", "items": {"type": "number"}, "minItems": 3, "maxItems":
3}, {"type": "string"}]}, "depth": {"description": "of its middle below the surface [m], with the key
below; absent: in the sheet", "anyOf": [{"type": "number", "minimum": 1e-05, "maximum": 1}, {"type":
"string"}]}, "radius": {"description": "[m]", "anyOf": [{"type": "number", "minimum":
1e-05, "maximum": 1}, {"type": "string"}]}, "modulus": {"description": "Young's, in its middle
[Pa]", "anyOf": [{"type": "number", "minimum": 1, "maximum": 1000000000000.0}, {"type":
"string"}]}}}}, "random": {"description": "nodules at random places, in place of a list", "type":
"object", "additionalProperties": false, "required": ["count", "radius", "modulus"], "properties":
{"count": {"type": "integer", "minimum": 1, "maximum": 64}, "depth": {"description": "the least and
the most of a middle below the surface [m]; absent: in the sheet", "type": "array", "items":
{"anyOf": [{"type": "number", "minimum": 1e-05, "maximum": 1}, {"type": "string"}]}, "minItems": 2,
"maxItems": 2}, "radius": {"description": "the least and
the most [m]", "type": "array", "items": {"anyOf": [{"type": "number", "minimum": 1e-05, "maximum":
1}, {"type": "string"}]}, "minItems": 2, "maxItems": 2}, "modulus": {"description": "the least and
the most [Pa]", "type": "array", "items": {"anyOf": [{"type": "number", "minimum": 1, "maximum":
1000000000000.0}, {"type": "string"}]}, "minItems": 2, "maxItems": 2}}}, "ground": {"description":
"radius about the scene's place in which nodules lie [m]; absent: all of the object", "anyOf":
[{"type": "number", "minimum": 1e-05, "maximum": 1}, {"type": "string"}]}, "press_force":
{"description": "from here on a finger that goes along an edge traces it [N]", "anyOf": [{"type":
"number", "minimum": 0.001, "maximum": 8}, {"type": "string"}]}, "too_hard": {"description": "a
trainer's limit [N]", "anyOf": [{"type": "number", "minimum": 0.001, "maximum": 8}, {"type":
"string"}]}}, "oneOf": [{"required": ["nodules"]}, {"required": ["random"]}]}, {"type": "string"}]})";
// clang-format on

void readHunt(Scene& scene, const WrittenValue& given)
{
    auto hidden   = std::make_shared<HiddenNodules>();
    hidden->hunt  = parseHunt(given.text, given.what);
    scene.overlay = std::move(hidden);
}

/// Reads the seed, which comes after the hunt.
void readSeed(Scene& scene, const WrittenValue& given)
{
    const HiddenNodules* const hidden = hiddenIn(scene);
    if (!hidden)
        throw Error(given.what + ": expected a key \"hunt\" beside it, found none; nothing is hidden in this scene");
    auto seeded   = std::make_shared<HiddenNodules>(*hidden);
    seeded->seed  = given.count();
    scene.overlay = std::move(seeded);
}

} // namespace

std::vector<Nodule> HiddenNodules::nodules(const PointCloud& cloud, const Scene& scene) const
{
    return hiddenNodules(hunt, seed, cloud, placeOf(scene, cloud), scene.patch.footprintRadius);
}

PointCloud HiddenNodules::over(const PointCloud& cloud, const Scene& scene) const
{
    return withNodules(cloud, nodules(cloud, scene), scene.material);
}

std::vector<BuriedNodule> HiddenNodules::below(const PointCloud& cloud, const Scene& scene) const
{
    std::vector<BuriedNodule> buried;
    for (const Nodule& n : nodules(cloud, scene))
        if (n.depth > 0) buried.push_back({n.centre, n.depth, n.radius, n.modulus});
    return buried;
}

const HiddenNodules* hiddenIn(const Scene& scene)
{
    return dynamic_cast<const HiddenNodules*>(scene.overlay.get());
}

const std::vector<SceneKey>& huntKeys()
{
    static const std::vector<SceneKey> keys = {
        {.name         = "hunt",
         .help         = "nodules that are hidden under the surface, and what counts when somebody looks for them",
         .kind         = SceneKey::Kind::object,
         .form         = "a hunt such as {\"nodules\":[{\"at\":[0,0,0],\"radius\":4e-3,\"modulus\":3e6}]}",
         .schema       = std::string(kHuntSchema),
         .decidesCloud = true,
         .read         = readHunt,
         .write        = [](const Scene& s) { return hiddenIn(s) ? huntJson(hiddenIn(s)->hunt) : std::string(); }},
        {.name         = "hunt_seed",
         .help         = "hides the nodules anew, at other places for each number [where the hunt has them]",
         .kind         = SceneKey::Kind::count,
         .unit         = "1",
         .bounds       = KeyBounds{0, 4294967295},
         .decidesCloud = true,
         .read         = readSeed,
         .write =
             [](const Scene& s) {
                 return hiddenIn(s) && hiddenIn(s)->seed ? std::to_string(*hiddenIn(s)->seed) : std::string();
             }},
    };
    return keys;
}

} // namespace palp::study
