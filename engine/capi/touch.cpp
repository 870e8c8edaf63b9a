#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include <glm/geometric.hpp>

#include "engine/capi/detail/border.h"
#include "engine/contact/contact.h"
#include "engine/perception/felt_map.h"
#include "engine/perception/scene_perception.h"
#include "engine/pipeline/deform.h"
#include "engine/pipeline/press.h"

// Touches without a device: one, many, and what a person would notice.

namespace palp::capi {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

/// Returns a direction of the caller as a unit vector; nothing for null.
/// \throws Error if it is none
std::optional<glm::dvec3> directionOf(const double* three, const char* what)
{
    if (!three) return std::nullopt;
    const glm::dvec3 v     = vectorOf(three);
    const double     scale = std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
    if (!(isFinite(v) && scale > 0))
        throw Error(std::string(what) + ": expected a direction that is finite and not zero, found " + shown(v));
    return glm::normalize(v / scale); // its length means nothing, and must not overflow
}

glm::dvec3 placeOf(const double* three)
{
    const glm::dvec3 place = vectorOf(&demand(three, "place"));
    if (!isFinite(place)) throw Error("place: expected finite numbers [m], found " + shown(place));
    return place;
}

/// \param settings  settledFor() the object
Contact contactAt(const palpate_object& object, const PatchSettings& settings, const double* place, const double* from)
{
    constexpr double kReach = 0.25; // of the window, as the command line takes it
    return touchAt(object.object, placeOf(place), directionOf(from, "from"), kReach * settings.window);
}

Patch patchAt(const palpate_object& object, const PatchSettings& settings, const double* place, const double* from,
              PlateSolver& solver)
{
    Patch patch = deform(object.object, contactAt(object, settings, place, from), settings, solver);
    demandDeformed(patch, "try a larger window");
    demandConverged(patch);
    return patch;
}

/// The path of palpate_perceive(), with what the caller leaves to us.
struct Path {
    Scene    scene; ///< touched in the path's middle
    FeltLine line;
    int      places = 41;
};

Path pathOf(const palpate_object& object, const palpate_path& given)
{
    constexpr double kShare  = 1.0 / 3; // of the window, beyond which the middle is not felt [1]
    constexpr int    kFewest = 3, kMost = 1001;
    Path             path{object.scene, {}};
    path.scene.patch = settledFor(object.object, path.scene.patch);
    if (given.place) path.scene.place = placeOf(given.place);
    if (given.from) path.scene.from = directionOf(given.from, "from");
    const double most  = object.object.cloud().bounds().diagonal();
    const double reach = given.reach == 0 ? kShare * bentSize(object.object, path.scene.patch) : given.reach;
    if (!(reach > 0 && reach <= most))
        throw Error("reach: expected a length above 0 and at most that of the object, " + std::to_string(most) +
                    " m, found " + std::to_string(reach));
    if (given.places != 0) path.places = given.places;
    if (path.places < kFewest || path.places > kMost)
        throw Error("places: expected 3 to 1001, found " + std::to_string(path.places));
    path.line = feltLine(path.scene, object.object, directionOf(given.direction, "direction"), reach);
    return path;
}

palpate_perception numbersOf(const ScenePerception& found, std::span<const double> felt)
{
    palpate_perception own{};
    const auto [softest, hardest] = std::ranges::minmax(felt);
    own.softest                   = softest;
    own.hardest                   = hardest;
    own.held                      = found.held();
    for (std::size_t n = 0; n < found.sliding.size(); ++n) {
        own.weber[n]   = found.sliding[n].weber;
        own.at_rest[n] = found.atRest[n].whole;
        own.sliding[n] = found.sliding[n].whole;
        own.passing[n] = found.sliding[n].passing;
        own.floor[n]   = found.sliding[n].floor;
        own.right[n]   = found.sliding[n].right;
    }
    return own;
}

} // namespace
} // namespace palp::capi

using namespace palp;
using namespace palp::capi;

int palpate_touch(const palpate_object* object, const double place[3], const double from[3],
                  palpate_touch_result* result)
{
    return guarded([&] {
        static_cast<void>(taken(result, "palpate_touch_result"));
        const palpate_object& of = demand(object, "object");
        PlateSolver           solver(of.scene.solver);
        const PatchSettings   settings = settledFor(of.object, of.scene.patch);
        const Patch           patch    = patchAt(of, settings, place, from, solver);
        palpate_touch_result  own{};
        own.felt_stiffness       = patch.feltStiffness;
        own.compliance           = patch.compliance;
        own.contact_stiffness    = patch.contactStiffness;
        own.rigidity             = rigidityAtContact(patch);
        own.solver_error         = patch.report.errorEstimate.value_or(kNone);
        own.discretisation_error = discretisationError(patch, settings, solver).value_or(kNone);
        own.stiffening           = patch.stiffening;
        put(patch.contact.point, own.place);
        put(patch.chart.frame.normal, own.normal);
        give(result, own);
        keepTakeover(solver.takeoverSince(0));
    });
}

int palpate_touch_displaced(const palpate_object* object, const double place[3], const double from[3], double force,
                            double* xyz, size_t count)
{
    return guarded([&] {
        const palpate_object& of = demand(object, "object");
        demandRoom(count, of.object.size());
        demand(xyz, "xyz");
        if (!std::isfinite(force)) throw Error("force: expected a finite number [N], found " + std::to_string(force));
        PlateSolver  solver(of.scene.solver);
        const Patch  patch = patchAt(of, settledFor(of.object, of.scene.patch), place, from, solver);
        const double load  = pressOf(patch, of.object.material(), std::abs(force)).load;
        const auto   moved = displaced(of.object.cloud(), patch, std::copysign(load, force));
        for (std::size_t n = 0; n < moved.size(); ++n) put(moved[n], xyz + 3 * n);
        keepTakeover(solver.takeoverSince(0));
    });
}

int palpate_felt_map(const palpate_object* object, const double* places, const double* from, size_t count, double* felt,
                     size_t* failed)
{
    return guarded([&] {
        const palpate_object& of = demand(object, "object");
        if (failed) *failed = 0;
        if (count == 0) return;
        demand(places, "places"), demand(felt, "felt");
        const PatchSettings settings = settledFor(of.object, of.scene.patch);
        const auto          at       = [&](std::size_t n) {
            return contactAt(of, settings, places + 3 * n, from ? from + 3 * n : nullptr);
        };
        const FeltTouches all = feltTouches(of.object, settings, count, at, of.scene.solver);
        std::ranges::copy(all.stiffness, felt);
        if (failed) *failed = all.leftOut;
        keepTakeover(all.takeover);
    });
}

int palpate_felt_map_every(const palpate_object* object, double spacing, double* felt, size_t count, size_t* touched)
{
    return guarded([&] {
        const palpate_object& of = demand(object, "object");
        demandRoom(count, of.object.size());
        demand(felt, "felt");
        const FeltMap map = feltMapEvery(of.object, of.scene.patch, spacing, of.scene.solver);
        std::ranges::copy(map.atPoints, felt);
        if (touched) *touched = map.places.size();
        keepTakeover(map.takeover);
    });
}

int palpate_perceive(const palpate_object* object, const palpate_path* path, palpate_perception* result, double* along,
                     double* felt, size_t count)
{
    return guarded([&] {
        const palpate_object& of = demand(object, "object");
        static_cast<void>(taken(result, "palpate_perception"));
        const Path asked = pathOf(of, path ? taken(path, "palpate_path") : palpate_path{});
        if ((along || felt) && count < std::size_t(asked.places))
            throw Error("count: expected room for " + std::to_string(asked.places) + " places, found " +
                        std::to_string(count));
        PlateSolver           solver(of.scene.solver);
        const ScenePerception found = perceive(asked.scene, of.object, asked.line, asked.places, solver);
        std::vector<double>   stiffness;
        for (const FeltPlace& place : found.places) stiffness.push_back(place.felt(asked.scene.patch.forceLaw));
        give(result, numbersOf(found, stiffness));
        if (felt) std::ranges::copy(stiffness, felt);
        if (along) std::ranges::transform(found.places, along, &FeltPlace::along);
        std::string takeover = solver.takeoverSince(0);
        keepTakeover(takeover.empty() ? found.takeover : std::move(takeover));
    });
}
