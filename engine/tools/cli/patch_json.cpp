#include "engine/tools/cli/patch_json.h"

#include <cmath>

#include <algorithm>

#include <nlohmann/json.hpp>

#include "engine/pipeline/deform.h"
#include "engine/pipeline/dent_length.h"
#include "engine/pipeline/patch_warnings.h"
#include "engine/pipeline/presets.h"
#include "engine/pipeline/press.h"
#include "engine/plate/load.h"

namespace palp {
namespace {

using Json = nlohmann::json;

Json vectorJson(const glm::dvec3& v)
{
    return {v.x, v.y, v.z};
}

template <class T>
Json orNull(const std::optional<T>& value)
{
    return value ? Json(*value) : Json(nullptr);
}

Json sphereJson(const SphereFitResult& sphere)
{
    const bool round = sphere.outcome == FitOutcome::sphere;
    return {{"outcome", name(sphere.outcome)},
            {"radius", round ? Json(sphere.fit.radius()) : Json(nullptr)},
            {"centre", round ? vectorJson(sphere.fit.centre()) : Json(nullptr)},
            {"curvature", sphere.fit.curvature},
            {"misfit", sphere.fit.misfit}};
}

Json chartJson(const Chart& chart)
{
    return {{"map", name(chart.map)},
            {"origin", vectorJson(chart.origin)},
            {"normal", vectorJson(chart.frame.normal)},
            {"east", vectorJson(chart.frame.east)},
            {"north", vectorJson(chart.frame.north)},
            {"signed_curvature", chart.curvature}};
}

Json windowJson(const Patch& patch)
{
    const PlateGrid& grid    = patch.window.grid;
    const auto [least, most] = rigiditiesOfSheet(patch);
    return {{"size", {grid.sizeX(), grid.sizeZ()}},
            {"cells", {grid.cellsX, grid.cellsZ}},
            {"spacing", grid.spacingX},
            {"points_gathered", patch.gathered.size()},
            {"points_near_side", patch.points.size()},
            {"points_touched", patch.touched},
            {"nodes_without_point", patch.nodesWithoutPoint},
            {"rigidity_min", least},
            {"rigidity_max", most},
            {"of", patch.covered.values().empty() || patch.isCut ? "contact" : "object"},
            {"beyond", patch.body                                      ? "body"
                       : patch.covered.values().empty() || patch.isCut ? "edges"
                                                                       : "nothing"},
            {"nodes_covered", nodesOfSheet(patch)},
            {"nodes_held", patch.heldNodes}};
}

/// What a touch with a shell says of it, flat ones included; null without one.
Json shellJson(const SoftObject& object, const Patch& patch, const PatchSettings& settings, PlateSolver& solver)
{
    const auto range = supportRange(object, patch, settings, solver);
    if (!patch.curvature && !range && !patch.body) return nullptr;
    const double below = settings.foundation / rigidityAtContact(patch);
    const bool   isEnded =
        patch.curvature &&
        std::isfinite(dentReach(patch.principal.first, patch.principal.second, object.material(), below).length);
    return {{"curvatures", {patch.principal.first, patch.principal.second}},
            {"flat", !patch.curvature},
            {"flat_because", patch.flatBecause.empty() ? Json() : Json(patch.flatBecause)},
            {"fit_radius", patch.curvature ? Json(patch.curvature->radius) : Json()},
            {"length", isEnded ? Json(patch.shellLength) : Json()},
            {"window_lengths", isEnded ? Json(bentSize(patch) / patch.shellLength) : Json()},
            {"body_compliance", bodyFelt(patch)},
            {"felt_stiffness_supported", orNull(range ? std::optional(range->supported) : std::nullopt)},
            {"felt_stiffness_clamped", orNull(range ? std::optional(range->clamped) : std::nullopt)},
            {"felt_stiffness_least", orNull(range ? std::optional(range->least) : std::nullopt)},
            {"least_in_window", orNull(range ? std::optional(range->width) : std::nullopt)},
            {"edges", edgesText(settings.edges)}};
}

/// What a touch says of deflections that are not small beside the thickness; null unless it was asked for.
Json largeJson(const Patch& patch, const PatchSettings& settings, double force)
{
    if (settings.large == Large::off) return nullptr;
    if (!patch.large) return {{"linear_because", patch.linearBecause}};
    const LargeLaw& law    = *patch.large;
    const DepthLaw  felt   = depthLawOf(patch);
    const double    most   = felt.force(DepthShape::kSteps * felt.shape.step); // [N] beyond it nothing is known
    const double    linear = force / patch.feltStiffness, depth = felt.depthOf(force);
    Json            curve = Json::array();
    for (std::size_t n = 0; n < law.force.size(); ++n)
        curve.push_back({double(n) * law.step, law.force[n], law.tangent[n]});
    return {{"depth_linear", linear},
            {"depth", force > most ? Json() : Json(depth)},
            {"felt_stiffness", force > most ? Json() : Json(depth > 0 ? force / depth : patch.feltStiffness)},
            {"trusted_force", most},
            {"trusted_deflection", law.reach()},
            {"plate", curve}};
}

Json timesJson(const StageTimes& t)
{
    return {{"gather", t.gather},   {"fit", t.fit},     {"project", t.project}, {"resample", t.resample},
            {"prepare", t.prepare}, {"solve", t.solve}, {"lift", t.lift},       {"total", t.total()}};
}

} // namespace

Json settingsJson(const Material& material, const PatchSettings& s)
{
    return {{"thickness", material.thickness},
            {"poisson", material.poissonRatio},
            {"stiffening", material.stiffening},
            {"relaxation", relaxationText(material.relaxation)},
            {"foundation", s.foundation},
            {"window", s.windowOf == WindowOf::object ? Json("object") : Json(s.window)},
            {"cells", s.cells},
            {"footprint_radius", s.footprintRadius},
            {"map", name(s.map)},
            {"neighbourhood", name(s.neighbourhood)},
            {"resampling", name(s.resampling)},
            {"force_law", name(s.forceLaw)},
            {"theory", name(s.theory)},
            {"large", name(s.large)},
            {"edges",
             {{"x0", name(s.edges.x0)}, {"x1", name(s.edges.x1)}, {"z0", name(s.edges.z0)}, {"z1", name(s.edges.z1)}}}};
}

Json patchJson(const SoftObject& object, const Patch& patch, const PatchSettings& settings, double force,
               PlateSolver& solver)
{
    const Material& material = object.material();
    Json            report{
        {"contact", {{"point", vectorJson(patch.contact.point)}, {"outward", vectorJson(patch.contact.outward)}}},
        {"force", force},
        {"settings", settingsJson(material, settings)},
        {"differences_from_paper", differencesFromPaper(settings)},
        {"sphere", sphereJson(patch.sphere)}};
    if (!patch.deformed()) return report;
    const PlateGrid& grid           = patch.plate.grid;
    const Press      press          = pressOf(patch, material, force);
    report["chart"]                 = chartJson(patch.chart);
    report["chart"]["unrolled"]     = patch.unrolled;
    report["noise"]                 = patch.noise;
    report["window"]                = windowJson(patch);
    report["shell"]                 = shellJson(object, patch, settings, solver);
    report["large"]                 = largeJson(patch, settings, force);
    report["rigidity_at_contact"]   = rigidityAtContact(patch);
    report["compliance"]            = patch.compliance;
    report["contact_stiffness"]     = patch.contactStiffness;
    report["felt_stiffness"]        = patch.feltStiffness;
    report["stiffening"]            = patch.stiffening;
    report["depth"]                 = press.depth;
    report["depth_relaxed"]         = press.later;
    report["deflection_at_contact"] = press.load * patch.response(grid.cellsX / 2, grid.cellsZ / 2);
    report["max_deflection"]        = press.load * mostResponse(patch);
    report["error"]                 = {{"discretisation", orNull(discretisationError(patch, settings, solver))},
                                       {"solver", orNull(patch.report.errorEstimate)}};
    report["solver"]                = {{"name", patch.report.solver},
                                       {"note", solver.note().empty() ? Json(nullptr) : Json(solver.note())},
                                       {"converged", patch.report.converged},
                                       {"iterations", orNull(patch.report.iterations)},
                                       {"work_units", orNull(patch.report.workUnits)},
                                       {"tolerance", settings.tolerance}};
    report["milliseconds"]          = timesJson(patch.times);
    report["warnings"]              = warnings(patch, settings, force, material);
    return report;
}

} // namespace palp
