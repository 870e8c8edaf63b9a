#include "engine/session/scene_below.h"

#include <nlohmann/json.hpp>

#include "engine/cloud/soft_object.h"
#include "engine/core/contract.h"
#include "engine/core/json_limits.h"
#include "engine/core/json_object.h"
#include "engine/core/quantity.h"
#include "engine/session/scene.h"

namespace palp {
namespace {

using Json   = nlohmann::ordered_json;
using Limits = JsonObject::QuantityLimits;

constexpr std::size_t kMostNodules = 64; ///< more would be a texture
constexpr Limits      kLength{Dimension::length, 1e-5, 1, "a length from 1e-5 to 1 m, such as 15 mm"};
constexpr Limits      kModulus{Dimension::pressure, 1, 1e12, "a modulus from 1 to 1e12 Pa, such as 20 kPa"};

BuriedNodule noduleOf(const JsonObject& object)
{
    object.allowOnly({"at", "depth", "radius", "modulus"});
    return {object.point("at"), object.quantity("depth", kLength), object.quantity("radius", kLength),
            object.quantity("modulus", kModulus)};
}

/// Returns the law of a volume, checked but for its file.
std::string volumeOf(const JsonObject& below)
{
    const std::string law =
        below.kind("volume") == JsonObject::Kind::text ? below.text("volume") : below.json("volume");
    const SpatialLaw read = [&] {
        try {
            return parseSpatialLaw(law, {-1, -1, -1}, {1, 1, 1}, SpatialLaw::Space::volume, LawFiles::left);
        } catch (const Error& error) {
            throw Error(below.where() + ": key \"volume\": " + error.what());
        }
    }();
    if (read.kind != SpatialLaw::Kind::grid || read.along != SpatialLaw::Along::points)
        below.refuse("volume", "a law grid without \"along\", such as {\"law\":\"grid\",\"file\":\"fat.nii.gz\"}");
    return law;
}

/// Returns the law of the foundation, checked but for its file.
std::string foundationLawOf(const JsonObject& below)
{
    const bool        isText = below.kind("foundation") == JsonObject::Kind::text;
    const std::string law    = isText ? below.text("foundation") : below.json("foundation");
    try {
        static_cast<void>(parseSpatialLaw(law, {-1, -1, -1}, {1, 1, 1}, SpatialLaw::Space::volume, LawFiles::left));
    } catch (const Error& error) {
        throw Error(below.where() + ": key \"foundation\": " + error.what());
    }
    return law;
}

/// Returns the foundation below each point over that of the scene [1].
std::vector<double> shapeOf(const SoftObject& object, const Scene& scene, std::span<const double> ofFile)
{
    std::vector<double> shape(ofFile.begin(), ofFile.end());
    if (scene.below.isOwn && shape.empty())
        throw Error("own: expected a property foundation [Pa/m] of the points, found none; see palpate info");
    if (!scene.below.isOwn) {
        const Bounds&    bounds = object.cloud().bounds();
        const SpatialLaw law =
            parseSpatialLaw(scene.below.foundation, bounds.low, bounds.high, SpatialLaw::Space::volume);
        shape.clear();
        for (const glm::dvec3& p : object.positions())
            shape.push_back(law.valueAt(p, "point " + std::to_string(shape.size())));
    }
    for (double& value : shape) value /= scene.patch.foundation;
    return shape;
}

// clang-format off
constexpr std::string_view kSchema = R"({"anyOf": [{"type": "object", "additionalProperties": false, "required": ["depth", "modulus"], "properties":
{"depth": {"description": "of the tissue between the sheet and what does not give [m]", "anyOf": [{"type": "number",
"minimum": 1e-05, "maximum": 1}, {"type": "string"}]}, "modulus": {"description": "Young's, of the tissue whose
foundation the scene states [Pa]", "anyOf": [{"type": "number", "minimum": 1, "maximum": 1000000000000.0}, {"type":
"string"}]}, "volume": {"description": "moduli of the tissue where they vary: a law grid [Pa]", "anyOf": [{"type":
"object"}, {"type": "string"}]}, "nodules": {"description": "balls of another modulus in it", "type": "array",
"minItems": 1, "maxItems": 64, "items": {"type": "object", "additionalProperties": false, "required": ["at", "depth",
"radius", "modulus"], "properties": {"at": {"description": "a place on the object above its middle [m]", "anyOf":
[{"type": "array", "items": {"type": "number"}, "minItems": 3, "maxItems": 3}, {"type": "string"}]}, "depth":
{"description": "of its middle below the surface [m]", "anyOf": [{"type": "number", "minimum": 1e-05, "maximum": 1},
{"type": "string"}]}, "radius": {"description": "[m]", "anyOf": [{"type": "number", "minimum": 1e-05, "maximum": 1},
{"type": "string"}]}, "modulus": {"description": "Young's [Pa]", "anyOf": [{"type": "number", "minimum": 1, "maximum":
1000000000000.0}, {"type": "string"}]}}}}}}, {"type": "object",
"additionalProperties": false, "required": ["foundation"], "properties": {"foundation": {"description": "a law of the
foundation over the cloud [Pa/m]", "anyOf": [{"type": "object"}, {"type": "string"}]}}}, {"type": "string"}]})";
// clang-format on

} // namespace

SceneBelow parseBelow(std::string_view text, const std::string& what)
{
    SceneBelow below;
    below.isOwn = text == "own";
    if (text == "none" || below.isOwn) return below;
    const JsonObject object = JsonObject::parse(text, what);
    object.allowOnly({"depth", "modulus", "volume", "nodules", "foundation"});
    if (object.has("foundation")) {
        object.allowOnly({"foundation"});
        below.foundation = foundationLawOf(object);
        return below;
    }
    below.tissue.depth   = object.quantity("depth", kLength);
    below.tissue.modulus = object.quantity("modulus", kModulus);
    if (object.has("volume")) below.volume = volumeOf(object);
    if (!object.has("nodules")) return below;
    for (const JsonObject& one :
         object.objects("nodules", kMostNodules, "nodule",
                        "a list of 1 to 64 nodules, each with \"at\", \"depth\", \"radius\" and \"modulus\""))
        below.tissue.nodules.push_back(noduleOf(one));
    return below;
}

std::string belowJson(const SceneBelow& below)
{
    if (!below.isThere()) return {};
    if (below.isOwn) return "\"own\"";
    const auto lawJson = [](const std::string& law) {
        return law.starts_with('{') ? Json::parse(law, nullptr, true, true) : Json(law);
    };
    if (!below.foundation.empty()) return Json{{"foundation", lawJson(below.foundation)}}.dump();
    Json json{{"depth", below.tissue.depth}, {"modulus", below.tissue.modulus}};
    if (!below.volume.empty()) json["volume"] = lawJson(below.volume);
    for (const BuriedNodule& n : below.tissue.nodules)
        json["nodules"].push_back(
            {{"at", {n.at.x, n.at.y, n.at.z}}, {"depth", n.depth}, {"radius", n.radius}, {"modulus", n.modulus}});
    return json.dump();
}

std::string_view belowSchema()
{
    return kSchema;
}

std::string belowWithFileIn(const std::string& text, const std::filesystem::path& folder)
{
    if (excessOf(text)) return text; // whoever reads it refuses it
    try {
        nlohmann::json below =
            nlohmann::json::parse(text, nullptr, true, true); // in order each key is looked for in all
        for (const char* key : {"volume", "foundation"}) {
            if (!below.contains(key)) continue;
            nlohmann::json&   value = below[key];
            const std::string law   = value.is_string() ? value.get<std::string>() : value.dump();
            value                   = lawWithFileIn(law, folder);
        }
        return below.dump();
    } catch (const Json::exception&) {
        return text; // the reader refuses it, and says why
    }
}

std::vector<std::string> beyondComparedTissue(const Scene& scene)
{
    const TissueBelow& tissue = scene.below.tissue;
    if (!scene.below.isTissue() || (tissue.nodules.empty() && scene.below.volume.empty() && !scene.overlay)) return {};
    std::vector<std::string> said;
    const auto compare = [&](const std::string& what, double value, double least, double most, const char* unit) {
        constexpr double kRounding = 1e-9;
        if (value >= least * (1 - kRounding) && value <= most * (1 + kRounding)) return;
        const auto shown = [&](double v) { return formatQuantity(v, unit); };
        said.push_back(what + " is " + shown(value) + ", and solids were computed for " + shown(least) + " to " +
                       shown(most) + ": how much of the tissue below is felt is a guess here");
    };
    const double sheet = scene.material.thickness;
    compare("the sheet over the tissue", sheet, 1.5e-3, 4e-3, "m");
    compare("the fingertip's radius", scene.patch.footprintRadius, 2.4e-3, 6e-3, "m");
    compare("the depth of the tissue", tissue.depth, 15e-3, 25e-3, "m");
    for (std::size_t n = 0; n < tissue.nodules.size(); ++n) {
        const BuriedNodule& nodule = tissue.nodules[n];
        const std::string   of     = " of nodule " + std::to_string(n + 1);
        compare("the radius" + of, nodule.radius, 2.5e-3, 7e-3, "m");
        compare("what lies between the sheet and the top" + of, nodule.depth - nodule.radius - sheet, 1e-3, 5e-3, "m");
        compare("the modulus" + of + " over that of the tissue", nodule.modulus / tissue.modulus, 0.1, 50, "");
    }
    return said;
}

SoftObject onTissue(const SoftObject& object, const Scene& scene, std::span<const double> ofFile)
{
    TissueBelow tissue = scene.below.tissue;
    const auto  hidden = scene.overlay ? scene.overlay->below(object.cloud(), scene) : std::vector<BuriedNodule>();
    if (!scene.below.isThere()) {
        if (hidden.empty()) return object;
        throw Error(
            "hunt: a nodule with a depth lies in the tissue below the sheet, and the scene has none; expected a key "
            "\"below\" with the depth and the modulus of that tissue");
    }
    if (scene.patch.foundation == 0)
        throw Error(openingOf(scene, "below") +
                    ": expected a foundation above 0, which the tissue makes firmer or softer, found 0; give the key "
                    "\"foundation\"");
    if (!scene.below.isTissue() && !hidden.empty())
        throw Error(
            "hunt: a nodule with a depth lies in tissue of a depth and a modulus, and the scene's key \"below\" "
            "states the foundation by itself");
    tissue.nodules.insert(tissue.nodules.end(), hidden.begin(), hidden.end());
    if (!scene.below.volume.empty()) {
        const Bounds& bounds = object.cloud().bounds();
        tissue.volume        = parseSpatialLaw(scene.below.volume, bounds.low, bounds.high, SpatialLaw::Space::volume);
    }
    try {
        if (!scene.below.isTissue()) return object.withFoundation(shapeOf(object, scene, ofFile));
        return object.withFoundation(foundationShape(object, tissue, scene.patch.footprintRadius));
    } catch (const Error& error) {
        throw Error(openingOf(scene, "below") + ": " + error.what());
    }
}

} // namespace palp
