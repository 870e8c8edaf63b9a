#include "engine/session/scene_schema.h"

#include <algorithm>
#include <cmath>

#include <nlohmann/json.hpp>

#include "engine/session/scene_keys.h"

// Descriptions of the keys for editors and for pages.

namespace palp {
namespace {

using Json = nlohmann::ordered_json;

/// Returns a bound as JSON: whole numbers without a point.
Json boundJson(double value)
{
    return value == std::floor(value) && std::abs(value) < 1e15 ? Json(std::int64_t(value)) : Json(value);
}

Json numberSchema(const SceneKey& key)
{
    Json json{{"type", key.kind == SceneKey::Kind::count ? "integer" : "number"}};
    if (!key.bounds) return json;
    json[key.bounds->open ? "exclusiveMinimum" : "minimum"] = boundJson(key.bounds->least);
    json[key.bounds->open ? "exclusiveMaximum" : "maximum"] = boundJson(key.bounds->most);
    if (key.bounds->multipleOf != 1) json["multipleOf"] = key.bounds->multipleOf;
    return json;
}

Json listSchema(int count)
{
    return {{"type", "array"}, {"items", {{"type", "number"}}}, {"minItems", count}, {"maxItems", count}};
}

Json orText(const Json& first)
{
    Json json;
    json["anyOf"] = Json::array();
    json["anyOf"].push_back(first);
    json["anyOf"].push_back({{"type", "string"}});
    return json;
}

Json valueSchema(const SceneKey& key)
{
    if (!key.schema.empty()) {
        std::string schema = key.schema;
        std::ranges::replace(schema, '\n', ' '); // the source breaks its lines also within texts
        return Json::parse(schema);
    }
    switch (key.kind) {
    case SceneKey::Kind::word:
        return {{"enum", key.words}};
    case SceneKey::Kind::number:
        return orText(numberSchema(key));
    case SceneKey::Kind::count: {
        if (key.words.empty()) return numberSchema(key);
        Json numbers;
        for (const std::string& word : key.words) numbers["enum"].push_back(std::stoi(word));
        return numbers;
    }
    case SceneKey::Kind::yesNo:
        return {{"type", "boolean"}};
    case SceneKey::Kind::point:
        return orText(listSchema(3));
    case SceneKey::Kind::range:
        return orText(listSchema(2));
    default:
        return {{"type", "string"}};
    }
}

} // namespace

std::string sceneSchema(const std::vector<SceneKey>* toolKeys)
{
    Json properties{{"$schema", {{"description", "this schema, for editors"}, {"type", "string"}}}};
    for (const SceneKey* key : sceneKeysWith(toolKeys)) {
        Json& property = properties[std::string(key->name)];
        property       = {{"description", key->help}, {"unit", key->unit}};
        property.update(valueSchema(*key));
    }
    Json schema;
    schema["$schema"]     = "https://json-schema.org/draft/2020-12/schema";
    schema["title"]       = "A Palpate scene";
    schema["description"] = "What is touched, how it bends, how that becomes a force. Plain numbers are in the unit of "
                            "their key; a text may carry another of the same dimension, such as \"4 mm\". Comments are "
                            "allowed.";
    schema["type"]        = "object";
    schema["required"]    = {"cloud"};
    schema["additionalProperties"] = false;
    schema["properties"]           = properties;
    return schema.dump(1) + "\n";
}

std::string sceneKeyTable(const std::vector<SceneKey>* toolKeys)
{
    std::string table = "| key | unit | takes | means |\n|---|---|---|---|\n";
    for (const SceneKey* key : sceneKeysWith(toolKeys))
        table += "| `" + std::string(key->name) + "` | " + std::string(key->unit == "1" ? "" : key->unit) + " | " +
                 key->expected() + " | " + std::string(key->help) + " |\n";
    return table;
}

} // namespace palp
