#include "engine/tools/study/hunt.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <glm/geometric.hpp>
#include <nlohmann/json.hpp>

#include "engine/cloud/neighbour_index.h"
#include "engine/core/contract.h"
#include "engine/core/json_object.h"
#include "engine/core/quantity.h"
#include "engine/core/uniform.h"
#include "engine/force/governor.h"

namespace palp::study {
namespace {

using Json = nlohmann::json;

constexpr std::size_t kMostNodules = 64;              ///< more would be a texture
constexpr double      kLeastRadius = 1e-5, kMost = 1; ///< of a nodule and of the ground [m]
constexpr double      kSoftest = 1, kStiffest = 1e12; ///< moduli [Pa]: softer than any gel, stiffer than diamond
constexpr double      kLeastForce = 1e-3;             ///< [N]

using Limits = JsonObject::QuantityLimits;
constexpr Limits kRadius{Dimension::length, kLeastRadius, kMost, "a length from 1e-5 to 1 m, such as 4 mm"};
constexpr Limits kModulus{Dimension::pressure, kSoftest, kStiffest, "a modulus from 1 to 1e12 Pa, such as 3 MPa"};
static_assert(GovernorSettings::kMostForce == 8, "the next sentence and the schema of a hunt say so");
constexpr Limits kForce{Dimension::force, kLeastForce, GovernorSettings::kMostForce,
                        "a force from 1e-3 to 8 N, such as 2 N"};

/// Reads both ends of a range, each a number or a text.
std::array<double, 2> range(const JsonObject& object, const char* key, const Limits& limits)
{
    const Json list = Json::parse(object.json(key));
    if (!list.is_array() || list.size() != 2) object.refuse(key, "a list of two, the least and the most");
    std::array<double, 2> ends{};
    for (std::size_t k = 0; k < 2; ++k)
        ends[k] = JsonObject::parse(Json{{key, list[k]}}.dump(), object.where()).quantity(key, limits);
    if (ends[0] > ends[1]) object.refuse(key, "the least first, then the most");
    return ends;
}

Nodule noduleOf(const JsonObject& object)
{
    object.allowOnly({"at", "depth", "radius", "modulus"});
    Nodule nodule;
    nodule.centre  = object.point("at");
    nodule.radius  = object.quantity("radius", kRadius);
    nodule.modulus = object.quantity("modulus", kModulus);
    if (object.has("depth")) nodule.depth = object.quantity("depth", kRadius);
    return nodule;
}

std::vector<Nodule> nodulesIn(const JsonObject& hunt)
{
    std::vector<Nodule> nodules;
    for (const JsonObject& one :
         hunt.objects("nodules", kMostNodules, "nodule",
                      "a list of 1 to 64 nodules, each with \"at\", \"radius\" and \"modulus\""))
        nodules.push_back(noduleOf(one));
    return nodules;
}

std::string length(double metres)
{
    return formatQuantity(metres, "m");
}

/// Returns the distance from the middle at which the fading edge ends [m].
double reachOf(const Nodule& nodule)
{
    return (1 + Nodule::kFade) * nodule.radius;
}

void demandApart(const std::vector<Nodule>& nodules)
{
    for (std::size_t i = 0; i < nodules.size(); ++i)
        for (std::size_t k = 0; k < i; ++k) {
            const double apart  = glm::distance(nodules[i].centre, nodules[k].centre);
            const double needed = reachOf(nodules[i]) + reachOf(nodules[k]);
            if (apart < needed)
                throw Error("hunt: nodules " + std::to_string(k + 1) + " and " + std::to_string(i + 1) +
                            " overlap: expected middles at least " + length(needed) +
                            " apart (each fades out at 1.25 of its radius), found " + length(apart));
        }
}

/// A search for places of nodules on the points of a cloud.
class HidingPlaces {
public:
    HidingPlaces(const Hunt& hunt, const PointCloud& cloud, const glm::dvec3& place, double footprintRadius)
        : hunt_(hunt), cloud_(cloud), index_(cloud.positions()), place_(place), footprint_(footprintRadius)
    {
    }

    void demandOnObject(const std::vector<Nodule>& nodules) const
    {
        constexpr double kSpacings = 2; // [spacings] a smaller radius has too few points across to show an edge
        for (std::size_t i = 0; i < nodules.size(); ++i) {
            const std::string which = "hunt: nodule " + std::to_string(i + 1) + ": ";
            const double      off   = index_.nearest(nodules[i].centre, 1).front().distance;
            if (off > nodules[i].radius / 2)
                throw Error(which + "expected a middle on the object, found one that is " + length(off) +
                            " beside its nearest point");
            if (nodules[i].radius < kSpacings * index_.spacing())
                throw Error(which + "expected a radius of at least two spacings of the cloud, " +
                            length(kSpacings * index_.spacing()) + ", found " + length(nodules[i].radius) +
                            "; a denser cloud shows smaller ones");
        }
    }

    /// Checks that the nodules lie within the ground, because they are searched only there.
    void demandInGround(const std::vector<Nodule>& nodules) const
    {
        for (std::size_t i = 0; hunt_.ground > 0 && i < nodules.size(); ++i)
            if (const double away = glm::distance(nodules[i].centre, place_); away > hunt_.ground)
                throw Error("hunt: nodule " + std::to_string(i + 1) +
                            ": key \"at\": expected a middle within the \"ground\", " + length(hunt_.ground) +
                            " about the scene's place, found one that is " + length(away) + " from it");
    }

    /// Returns random middles for nodules of these radii; the largest come first, because they need most room.
    void scatter(std::vector<Nodule>& nodules, Uniform& random) const
    {
        constexpr int kTries = 4000; // far more than a half full ground needs
        std::ranges::stable_sort(nodules, std::greater<>(), &Nodule::radius);
        for (std::size_t i = 0; i < nodules.size(); ++i) {
            int tries = 0;
            for (; tries < kTries; ++tries) {
                const auto point  = std::size_t(random() * double(cloud_.size()));
                nodules[i].centre = cloud_.positions()[std::min(point, cloud_.size() - 1)];
                if (isFree(nodules, i)) break;
            }
            if (tries == kTries)
                throw Error("hunt: expected room for " + std::to_string(nodules.size()) + " nodules of up to " +
                            length(nodules.front().radius) + ", found none for number " + std::to_string(i + 1) +
                            "; take fewer, smaller ones, or a larger ground");
        }
    }

private:
    [[nodiscard]] bool isFree(const std::vector<Nodule>& nodules, std::size_t i) const
    {
        const Nodule& one = nodules[i];
        if (hunt_.ground > 0 && glm::distance(one.centre, place_) > hunt_.ground - one.radius) return false;
        for (std::size_t k = 0; k < i; ++k)
            if (glm::distance(one.centre, nodules[k].centre) < reachOf(one) + reachOf(nodules[k]) + footprint_)
                return false;
        return isInside(one);
    }

    /// Returns true if no border of the object is near. With a border at t radii of the ball the mean of the points is
    /// off the middle by (2/3) (1 - t^2)^(3/2) / (pi - acos t + t sqrt(1 - t^2)) of the radius: a quarter where the
    /// border touches the nodule.
    [[nodiscard]] bool isInside(const Nodule& nodule) const
    {
        // The limit is a share of the radius [1]: more than a bent surface (a tenth on a ball of 50 mm) and chance
        // give, and four standard deviations of 400 points below a quarter.
        constexpr double kOff   = 0.15;
        const double     radius = 2 * (nodule.radius + footprint_);
        const auto       near   = index_.gather(nodule.centre, radius);
        glm::dvec3       mean(0);
        for (const std::uint32_t point : near) mean += cloud_.positions()[point] - nodule.centre;
        return glm::length(mean) / double(near.size()) < kOff * radius; // the middle is one of the points
    }

    const Hunt&       hunt_;
    const PointCloud& cloud_;
    NeighbourIndex    index_;
    glm::dvec3        place_;     ///< [m]
    double            footprint_; ///< [m]
};

/// Checks that a nodule can be felt.
/// \param change  largest relative change of the stiffness [1]
void demandFelt(std::size_t nodule, const Nodule& one, double change)
{
    constexpr double kLeast = 1e-3; // [1] a seventieth of the change that a finger notices (Weber fraction 0.07)
    if (change < kLeast)
        throw Error("hunt: nodule " + std::to_string(nodule + 1) +
                    ": key \"modulus\": expected another than the object has there, found " +
                    formatQuantity(one.modulus, "Pa") + ", which nobody can feel");
}

/// Returns a random value, evenly distributed in the logarithm.
double between(double low, double high, Uniform& random)
{
    return low * std::pow(high / low, random());
}

} // namespace

double Nodule::share(double distance) const noexcept
{
    const double t = std::clamp((distance / radius - (1 - kFade)) / (2 * kFade), 0.0, 1.0);
    return 1 - t * t * (3 - 2 * t);
}

Hunt parseHunt(std::string_view text, const std::string& what)
{
    const JsonObject object = JsonObject::parse(text, what);
    object.allowOnly({"nodules", "random", "ground", "press_force", "too_hard"});
    if (object.has("nodules") == object.has("random"))
        throw Error(what + ": expected either \"nodules\" or \"random\", found " +
                    (object.has("random") ? "both" : "neither"));
    Hunt hunt;
    if (object.has("nodules")) {
        hunt.nodules = nodulesIn(object);
        demandApart(hunt.nodules);
    } else {
        const JsonObject random = object.object("random");
        random.allowOnly({"count", "depth", "radius", "modulus"});
        hunt.count       = std::size_t(random.wholeNumber("count", 1, int(kMostNodules)));
        const auto radii = range(random, "radius", kRadius), moduli = range(random, "modulus", kModulus);
        hunt.leastRadius = radii[0], hunt.mostRadius = radii[1];
        hunt.leastModulus = moduli[0], hunt.mostModulus = moduli[1];
        if (random.has("depth")) {
            const auto depths = range(random, "depth", kRadius);
            hunt.leastDepth = depths[0], hunt.mostDepth = depths[1];
        }
    }
    if (object.has("ground")) hunt.ground = object.quantity("ground", kRadius);
    if (object.has("press_force")) hunt.pressForce = object.quantity("press_force", kForce);
    if (object.has("too_hard")) hunt.tooHard = object.quantity("too_hard", kForce);
    if (hunt.pressForce > hunt.tooHard)
        throw Error(what + ": key \"press_force\": expected at most \"too_hard\", " +
                    formatQuantity(hunt.tooHard, "N") + ", found " + formatQuantity(hunt.pressForce, "N"));
    return hunt;
}

std::string huntJson(const Hunt& hunt)
{
    nlohmann::ordered_json json;
    for (const Nodule& n : hunt.nodules) {
        json["nodules"].push_back(
            {{"at", {n.centre.x, n.centre.y, n.centre.z}}, {"radius", n.radius}, {"modulus", n.modulus}});
        if (n.depth > 0) json["nodules"].back()["depth"] = n.depth;
    }
    if (hunt.nodules.empty())
        json["random"] = {{"count", hunt.count},
                          {"radius", {hunt.leastRadius, hunt.mostRadius}},
                          {"modulus", {hunt.leastModulus, hunt.mostModulus}}};
    if (hunt.nodules.empty() && hunt.mostDepth > 0) json["random"]["depth"] = {hunt.leastDepth, hunt.mostDepth};
    if (hunt.ground > 0) json["ground"] = hunt.ground;
    json["press_force"] = hunt.pressForce;
    json["too_hard"]    = hunt.tooHard;
    return json.dump();
}

std::vector<Nodule> hiddenNodules(const Hunt& hunt, const std::optional<std::uint64_t>& seed, const PointCloud& cloud,
                                  const glm::dvec3& place, double footprintRadius)
{
    const HidingPlaces  places(hunt, cloud, place, footprintRadius);
    std::vector<Nodule> nodules = hunt.nodules;
    if (seed || nodules.empty()) {
        Uniform random(seed.value_or(1));
        for (std::size_t i = nodules.size(); i < hunt.count; ++i) {
            const double radius = between(hunt.leastRadius, hunt.mostRadius, random);
            nodules.push_back({{}, radius, between(hunt.leastModulus, hunt.mostModulus, random)});
            if (hunt.mostDepth > 0) nodules.back().depth = between(hunt.leastDepth, hunt.mostDepth, random);
        }
        places.scatter(nodules, random);
    }
    places.demandOnObject(nodules);
    places.demandInGround(nodules);
    return nodules;
}

PointCloud withNodules(const PointCloud& cloud, const std::vector<Nodule>& nodules, const Material& material)
{
    std::vector<double> stiffness(cloud.stiffness().begin(), cloud.stiffness().end());
    for (std::size_t n = 0; n < nodules.size(); ++n) {
        const Nodule& nodule = nodules[n];
        if (nodule.depth > 0) continue; // it lies below the sheet
        double       change = 0;
        const double there =
            cloud.kind() == StiffnessKind::modulus ? nodule.modulus : material.rigidity(nodule.modulus);
        for (std::size_t i = 0; i < stiffness.size(); ++i) {
            const double share = nodule.share(glm::distance(cloud.positions()[i], nodule.centre));
            if (share <= 0) continue;
            change = std::max(change, std::abs(there / stiffness[i] - 1));
            stiffness[i] *= std::pow(there / stiffness[i], share);
        }
        demandFelt(n, nodule, change);
    }
    return {{cloud.positions().begin(), cloud.positions().end()}, std::move(stiffness), cloud.kind()};
}

} // namespace palp::study
