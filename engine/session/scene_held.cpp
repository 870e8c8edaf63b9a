#include "engine/session/scene_held.h"

#include <algorithm>
#include <iterator>

#include <glm/geometric.hpp>
#include <nlohmann/json.hpp>

#include "engine/cloud/neighbour_index.h"
#include "engine/core/contract.h"
#include "engine/core/json_object.h"
#include "engine/core/quantity.h"

namespace palp {
namespace {

using Json   = nlohmann::ordered_json;
using Limits = JsonObject::QuantityLimits;

/// In all regions together, for each place is asked for at each point; more would be a property of the points.
constexpr std::size_t kMostRegions = 64, kMostPlaces = 10'000;
constexpr Limits      kRadius{Dimension::length, 1e-6, 100, "a length from 1e-6 to 100 m, such as 5 mm"};

std::vector<glm::dvec3> placesOf(const JsonObject& object, std::string_view key)
{
    std::vector<glm::dvec3> places;
    for (const std::vector<double>& row : object.rows(key, 3)) places.emplace_back(row[0], row[1], row[2]);
    if (places.empty() || places.size() > kMostPlaces)
        object.refuse(key, "1 to " + std::to_string(kMostPlaces) + " places [x, y, z] in metres");
    return places;
}

SceneHeld::Region regionOf(const JsonObject& object)
{
    object.allowOnly({"box", "ball", "points", "radius"});
    if (const int kinds = int(object.has("box")) + int(object.has("ball")) + int(object.has("points")); kinds != 1)
        throw Error(object.where() + ": expected one of the keys box, ball and points, found " +
                    (kinds == 0 ? "none" : std::to_string(kinds) + " of them; give each a region of its own"));
    if (object.has("box")) {
        object.allowOnly({"box"});
        SceneHeld::Region box{true, placesOf(object, "box"), 0};
        if (box.places.size() != 2) object.refuse("box", "two opposite corners [[x, y, z], [x, y, z]] in metres");
        const glm::dvec3 a = box.places[0], b = box.places[1];
        box.places = {glm::min(a, b), glm::max(a, b)};
        return box;
    }
    const bool isBall = object.has("ball");
    return {false, isBall ? std::vector{object.point("ball")} : placesOf(object, "points"),
            object.quantity("radius", kRadius)};
}

Json jsonOf(const glm::dvec3& p)
{
    return {p.x, p.y, p.z};
}

Json jsonOf(const SceneHeld::Region& region)
{
    Json places = Json::array();
    for (const glm::dvec3& place : region.places) places.push_back(jsonOf(place));
    if (region.isBox) return {{"box", places}};
    if (region.places.size() == 1) return {{"ball", places[0]}, {"radius", region.radius}};
    return {{"points", places}, {"radius", region.radius}};
}

// clang-format off
constexpr std::string_view kRegion = R"({"type": "object", "additionalProperties": false, "properties": {"box":
{"description": "two opposite corners [m]", "type": "array", "minItems": 2, "maxItems": 2, "items": {"type": "array",
"items": {"type": "number"}, "minItems": 3, "maxItems": 3}}, "ball": {"description": "its middle [m]", "anyOf": [{"type": "array",
"items": {"type": "number"}, "minItems": 3, "maxItems": 3}, {"type": "string"}]}, "points": {"description": "middles of balls [m]", "type": "array", "minItems": 1, "maxItems": 10000,
"items": {"type": "array", "items": {"type": "number"}, "minItems": 3, "maxItems": 3}}, "radius": {"description":
"of the ball, or of those about the points [m]", "anyOf": [{"type": "number", "minimum": 1e-06, "maximum": 100}, {"type": "string"}]}}})";
// clang-format on

/// Sets the shares of the points that a region holds to 1.
void hold(std::vector<double>& shares, std::span<const glm::dvec3> positions, const SceneHeld::Region& region)
{
    constexpr std::size_t kMany = 32; // places from which on a search takes less time than looking at each
    if (region.isBox || region.places.size() < kMany) {
        for (std::size_t n = 0; n < positions.size(); ++n)
            if (region.holds(positions[n])) shares[n] = 1;
        return;
    }
    SceneHeld::Region box{true, {positions[0], positions[0]}, 0}; // beyond it no place holds a point
    for (const glm::dvec3& p : positions) box.places = {glm::min(box.places[0], p), glm::max(box.places[1], p)};
    box.places[0] -= region.radius;
    box.places[1] += region.radius;
    std::vector<glm::dvec3> near;
    std::ranges::copy_if(region.places, std::back_inserter(near), [&](const glm::dvec3& at) { return box.holds(at); });
    if (near.empty()) return;
    const NeighbourIndex places(near);
    for (std::size_t n = 0; n < positions.size(); ++n)
        if (glm::distance(near[places.nearest(positions[n], 1)[0].point], positions[n]) <= region.radius) shares[n] = 1;
}

} // namespace

bool SceneHeld::Region::holds(const glm::dvec3& point) const noexcept
{
    if (isBox) return glm::clamp(point, places[0], places[1]) == point;
    return std::ranges::any_of(places, [&](const glm::dvec3& at) { return glm::distance(at, point) <= radius; });
}

SceneHeld parseHeld(const std::string& text, const std::string& what)
{
    SceneHeld held;
    held.isOwn = text == "own";
    if (text == "none" || held.isOwn) return held;
    if (!text.starts_with('[')) {
        held.regions.push_back(regionOf(JsonObject::parse(text, what)));
        return held;
    }
    constexpr std::string_view kKey = ": key \"held\""; // which the list has here too
    const JsonObject           list = JsonObject::parse("{\"held\":" + text + "}",
                                              what.ends_with(kKey) ? what.substr(0, what.size() - kKey.size()) : what);
    for (const JsonObject& one : list.objects("held", kMostRegions, "held region", "a list of 1 to 64 regions"))
        held.regions.push_back(regionOf(one));
    std::size_t places = 0;
    for (const SceneHeld::Region& region : held.regions) places += region.isBox ? 0 : region.places.size();
    if (places > kMostPlaces)
        throw Error(what + ": expected at most " + std::to_string(kMostPlaces) + " places in all regions, found " +
                    std::to_string(places));
    return held;
}

std::string heldJson(const SceneHeld& held)
{
    if (held.isOwn) return "\"own\"";
    if (held.regions.empty()) return "";
    if (held.regions.size() == 1) return jsonOf(held.regions[0]).dump();
    Json list = Json::array();
    for (const SceneHeld::Region& region : held.regions) list.push_back(jsonOf(region));
    return list.dump();
}

std::string_view heldSchema()
{
    static const std::string whole = [] {
        const Json region = Json::parse(kRegion);
        const Json list{{"type", "array"}, {"minItems", 1}, {"maxItems", kMostRegions}, {"items", region}};
        return Json{{"anyOf", {region, list, {{"type", "string"}}}}}.dump();
    }();
    return whole;
}

std::vector<double> heldShares(std::span<const glm::dvec3> positions, const SceneHeld& held,
                               std::span<const double> ofFile, const std::string& what)
{
    if (held.isOwn && ofFile.empty())
        throw Error(what + ": own: expected a property held of the points, from 0 to 1, found none; see palpate info");
    std::vector<double> shares(ofFile.begin(), ofFile.end());
    if (!held.isOwn) shares.assign(positions.size(), 0);
    for (const SceneHeld::Region& region : held.regions) hold(shares, positions, region);
    constexpr double kHeld = 0.5;
    if (std::ranges::none_of(shares, [](double share) { return share > kHeld; }))
        throw Error(what + ": expected at least one point of the object in what holds it, found none of " +
                    std::to_string(positions.size()) +
                    "; places are in metres, as palpate info prints the object's bounds");
    return shares;
}

} // namespace palp
