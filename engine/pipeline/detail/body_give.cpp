#include "engine/pipeline/detail/body_give.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>

#include "engine/core/extremes.h"
#include "engine/pipeline/dent_length.h"

namespace palp {
namespace {

/// Returns how far an object's box reaches below a place [m].
double depthBelow(const Bounds& box, const glm::dvec3& place, const glm::dvec3& outward)
{
    double deepest = 0;
    for (int corner = 0; corner < 8; ++corner) {
        glm::dvec3 p;
        for (int axis = 0; axis < 3; ++axis) p[axis] = (corner >> axis & 1 ? box.high : box.low)[axis];
        deepest = std::max(deepest, -glm::dot(p - place, outward));
    }
    return deepest;
}

/// Returns what being held at a rim at this angle from the contact adds to ln(2 R / rho) - 1, which is of 90 degrees.
double heldAtRim(double cosine)
{
    const double sine2 = 1 - cosine * cosine;
    return std::log(std::sqrt((1 - cosine) / (1 + cosine))) - cosine / sine2;
}

} // namespace

double bodyCompliance(const Patch& patch, const SoftObject& object, const PatchSettings& settings)
{
    if (!patch.curvature || !patch.covered.values().empty()) return 0;
    const auto [most, least] = patch.principal;
    if (!(least / most > kOneWay)) return 0;

    const double nu = object.material().poissonRatio, radius = 1 / std::sqrt(most * least);
    const double length = std::sqrt(radius * object.material().thickness) / std::pow(12 * (1 - nu * nu), 0.25); // [m]
    const double rho    = std::hypot((0.57 - 0.54 * nu) * length, (0.58 - 0.33 * nu) * settings.footprintRadius);
    const double below  = depthBelow(object.cloud().bounds(), patch.chart.origin, patch.chart.frame.normal);
    const double rim    = std::max(0.0, 1 - below / radius); // cosine of its angle from the contact [1]
    if (!(rim < 1)) return 0;
    const double ways = std::log(2 * radius / rho) - 1 + heldAtRim(rim);
    const double give = geometricMean(patch.membraneCompliance.values()); // 1/(E h) [m/N]
    return std::max(0.0, ways) * (1 + nu) / (2 * std::numbers::pi) * give /
           (1 + settings.foundation * radius * radius * give);
}

double bodyFelt(const Patch& patch) noexcept
{
    const PlateEdges& edges = patch.plate.edges;
    for (const Edge edge : {edges.x0, edges.x1, edges.z0, edges.z1})
        if (edge != Edge::supported) return 0;
    return patch.bodyCompliance;
}

void addToCompliances(ComplianceTable& table, double more) noexcept
{
    if (more == 0) return;
    for (int n = 0; n < table.side * table.side; ++n) {
        ComplianceTable::Entry& entry = table.compliance[std::size_t(n)];
        const double            own = std::exp(entry.value), share = own / (own + more);
        entry = {std::log(own + more), entry.slopeX * share, entry.slopeZ * share};
    }
}

} // namespace palp
