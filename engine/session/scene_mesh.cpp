#include "engine/session/scene_mesh.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include <glm/geometric.hpp>

#include "engine/cloud/mesh_points.h"
#include "engine/core/contract.h"
#include "engine/core/counted.h"
#include "engine/core/quantity.h"

namespace palp {
namespace {

/// Parts of the fingertip: the most spacing of vertices that are kept, and the distance of points in their place [1].
/// Points at a least distance have 1.15 times that as their spacing, so both are about the same density.
constexpr double kKeptPart = 4, kScatteredPart = 5;

/// Longest edge of a triangle between vertices that are kept, over their spacing [1].
constexpr double kLongEdge = 4;

/// Most points that may lie in no face for the faces to be the surface: a share of all, or a few that were left over
/// [1].
constexpr double kStrayShare = 0.1, kStrayPoints = 100;

/// Points on distance^2 that scatterOver() makes [1].
constexpr double kDensity = 0.76;

/// The sizes of a mesh that decide.
struct MeshSize {
    double      area = 0, longestEdge = 0; ///< [m^2], [m]
    std::size_t corners = 0;               ///< points that are corners of triangles
};

MeshSize sizeOf(const LoadedCloud& loaded)
{
    const auto                positions = loaded.cloud.positions();
    std::vector<std::uint8_t> isCorner(positions.size());
    MeshSize                  size;
    for (const Triangle& face : loaded.faces) {
        const glm::dvec3 a = positions[face[0]], u = positions[face[1]] - a, v = positions[face[2]] - a;
        size.area += 0.5 * glm::length(glm::cross(u, v));
        size.longestEdge = std::max({size.longestEdge, glm::length(u), glm::length(v), glm::length(v - u)});
        for (const std::uint32_t corner : face) isCorner[corner] = 1;
    }
    size.corners = std::size_t(std::ranges::count(isCorner, 1));
    return size;
}

bool isDenseEnough(const MeshSize& size, double spacing, double fingertip)
{
    const double most = fingertip / kKeptPart;
    return spacing <= most && size.longestEdge <= std::max(kLongEdge * spacing, most);
}

} // namespace

std::optional<ScatterPlan> scatterPlan(const Scene& scene, const LoadedCloud& loaded)
{
    if (scene.scatter == Scatter::off) return std::nullopt;
    const MeshSize size  = sizeOf(loaded);
    const bool     asked = scene.scatter == Scatter::on;
    if (!(size.area > 0)) {
        if (!asked) return std::nullopt;
        throw Error(openingOf(scene, "scatter") +
                    ": expected a cloud with faces to scatter points over, found none in " + cloudName(scene) +
                    "; omit scatter");
    }
    const auto points = double(loaded.cloud.size());
    if (!asked && points - double(size.corners) > std::max(kStrayShare * points, kStrayPoints)) return std::nullopt;
    ScatterPlan plan;
    plan.area        = size.area;
    plan.longestEdge = size.longestEdge;
    plan.spacing     = std::sqrt(size.area / double(size.corners));
    plan.fingertip   = scene.patch.footprintRadius;
    if (!asked && isDenseEnough(size, plan.spacing, plan.fingertip)) return std::nullopt;
    plan.wanted   = scene.scatterDistance > 0 ? scene.scatterDistance : plan.fingertip / kScatteredPart;
    plan.distance = scatterDistance(loaded.cloud.positions(), loaded.faces, {.distance = plan.wanted});
    plan.points   = std::size_t(kDensity * plan.area / (plan.distance * plan.distance)) + 1;
    return plan;
}

std::string scatterRefusal(const ScatterPlan& plan)
{
    if (plan.distance <= std::max(plan.wanted, plan.fingertip)) return {};
    return "expected faces that " + std::to_string(kMostMeshPoints) +
           " points can stand for (fewer where triangles are long and thin), no farther apart than the fingertip's "
           "radius of " +
           formatQuantity(plan.fingertip, "m") + ", found " + formatQuantity(plan.distance, "m") +
           " between them; is length_unit right? scatter = off touches the vertices";
}

Scene withPointsOfFile(Scene scene)
{
    const auto stated = scene.origins.find("scatter");
    if (stated == scene.origins.end() || stated->second.origin == Origin::standard) scene.scatter = Scatter::off;
    return scene;
}

void scatterOverFaces(LoadedCloud& loaded, const ScatterPlan& plan)
{
    CloudFileReport&    report    = loaded.report;
    MeshPoints          points    = scatterOver(loaded.cloud.positions(), loaded.faces, {.distance = plan.wanted});
    std::vector<double> stiffness = logInterpolated(points, loaded.faces, loaded.cloud.stiffness());
    if (!loaded.stiffening.empty()) {
        loaded.stiffening = interpolated(points, loaded.faces, loaded.stiffening);
        for (double& b : loaded.stiffening) b = std::clamp(b, 0.0, kMostStiffening); // weights are rounded
    }
    if (!loaded.foundation.empty()) loaded.foundation = logInterpolated(points, loaded.faces, loaded.foundation);
    if (!loaded.held.empty()) {
        loaded.held = interpolated(points, loaded.faces, loaded.held);
        for (double& share : loaded.held) share = std::clamp(share, 0.0, 1.0);
    }
    report.scatteredPoints = points.size();
    report.scatterDistance = points.distance;
    if (points.distance > plan.wanted)
        report.warnings.push_back("points are scattered over the faces " + formatQuantity(points.distance, "m") +
                                  " apart instead of " + formatQuantity(plan.wanted, "m") + ", because no more than " +
                                  std::to_string(kMostMeshPoints) +
                                  " are made, and fewer where triangles are long and thin; is the object as large as "
                                  "this, or its length unit another one?");
    if (points.degenerate > 0)
        report.warnings.push_back(
            std::to_string(points.degenerate) + " of " + counted(loaded.faces.size(), "triangle") +
            (points.degenerate == 1 ? " has" : " have") + " no area, so that no points lie there");
    if (const std::size_t strays = loaded.cloud.size() - sizeOf(loaded).corners; strays > 0)
        report.warnings.push_back(counted(strays, "point") + (strays == 1 ? " lies" : " lie") +
                                  " in no face and cannot be felt, because points are scattered over the faces; "
                                  "scatter = off touches the points of the file");
    loaded.normals.assign(points.normals.begin(), points.normals.end());
    const auto vertices = loaded.cloud.positions();
    loaded.mesh         = {{vertices.begin(), vertices.end()}, std::exchange(loaded.faces, {})};
    loaded.cloud        = PointCloud(std::move(points.positions), std::move(stiffness), loaded.cloud.kind());
    loaded.pointOfRow.clear();
}

} // namespace palp
