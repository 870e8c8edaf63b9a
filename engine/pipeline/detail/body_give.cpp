#include "engine/pipeline/detail/body_give.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include <glm/geometric.hpp>

#include "engine/core/extremes.h"
#include "engine/pipeline/dent_length.h"

namespace palp {
namespace {

/// Returns the cosine of the angle from the contact at which a body is taken to be held [1]: about where its surface turns
/// farthest away from there, the rim of a cap; of a body that turns all the way, just below its widest.
double rimOf(const SoftObject& object, const glm::dvec3& outward)
{
    constexpr std::size_t kAsked  = 1000; // points
    constexpr double      kNearly = 0.02; // of them may be strays [1]
    constexpr double    kClosed = 0.05; // cosine from which it turns all the way: the scatter of points is not felt [1]
    constexpr double    kBelow  = 0.2;  // cosine of 78 degrees, from the far end [1]
    const std::size_t   step    = object.size() / kAsked + 1;
    std::vector<double> turns; // cosines, of normals without a side
    for (std::size_t rank = 0; rank < object.size(); rank += step)
        turns.push_back(std::abs(glm::dot(object.survey().normalOfRank(rank), outward)));
    const auto most = turns.begin() + std::ptrdiff_t(kNearly * double(turns.size()));
    std::ranges::nth_element(turns, most);
    return (1 + kBelow) * std::max(0.0, *most - kClosed) / (1 - kClosed) - kBelow;
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
    const double bulges =
        std::min(1.0, least / most / kOneWay - 1); // no step where a hand comes to what bulges one way [1]

    const double nu = object.material().poissonRatio, radius = 1 / std::sqrt(most * least);
    const double length = std::sqrt(radius * object.material().thickness) / std::pow(12 * (1 - nu * nu), 0.25); // [m]
    const double rho    = std::pow(std::pow(0.95 * length, 4) + std::pow(0.43 * settings.footprintRadius, 4), 0.25);
    const double rim    = rimOf(object, patch.chart.frame.normal);
    if (!(rim < 1)) return 0;
    const double ways = std::log(2 * radius / rho) - 1 + heldAtRim(rim);
    const double give = geometricMean(patch.membraneCompliance.values()); // 1/(E h) [m/N]
    return bulges * std::max(0.0, ways) * (1 + nu) / (2 * std::numbers::pi) * give /
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
