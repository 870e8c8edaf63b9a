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

/// Returns the cosine of the angle from the contact at which a body is taken to be held [1]: where its surface turns
/// farthest away from there, the rim of a cap; of a body that turns all the way, just below its widest.
///
/// By a cap, or a sphere, with as large a share of its area that turns farther: the wall of a cut rim is a smaller one.
double rimOf(const SoftObject& object, const glm::dvec3& outward)
{
    constexpr std::size_t kAsked = 1000;             // points
    constexpr double      kShare = 0.15;             // [1]
    constexpr double    kClosed = 0.15, kOpen = 0.5; // cosines up to which it turns all the way, and from which not [1]
    constexpr double    kBelow = 0.2;                // cosine of 78 degrees, from the far end [1]
    const std::size_t   step   = object.size() / kAsked + 1;
    std::vector<double> turns; // cosines, of normals without a side
    for (std::size_t rank = 0; rank < object.size(); rank += step)
        turns.push_back(std::abs(glm::dot(object.survey().normalOfRank(rank), outward)));
    const auto most = turns.begin() + std::ptrdiff_t(kShare * double(turns.size()));
    std::ranges::nth_element(turns, most);
    const double rim  = 1 - (1 - *most) / (1 - kShare); // the cosine is spread evenly over a sphere's area
    const double open = std::clamp((rim - kClosed) / (kOpen - kClosed), 0.0, 1.0);
    return open < 1 ? std::lerp(-kBelow, kOpen, open) : rim;
}

/// The curvature of the surface across the window.
struct MeanCurvature {
    double gaussian = 0; ///< mean of the product of the principal ones [1/m^2]
    double largest  = 0; ///< mean of the square of the larger one [1/m^2]
};

MeanCurvature meanCurvature(const CurvatureField& field)
{
    MeanCurvature mean;
    const auto    nodes = double(field.x.values().size());
    for (std::size_t n = 0; n < field.x.values().size(); ++n) {
        const double x = field.x.values()[n], z = field.z.values()[n], xz = field.xz.values()[n];
        const double larger = std::abs(x + z) / 2 + std::hypot((x - z) / 2, xz);
        mean.gaussian += (x * z - xz * xz) / nodes;
        mean.largest += larger * larger / nodes;
    }
    return mean;
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
    // What is far away decides, not a bump at the contact: a hand that slides on meets no step.
    const auto [gaussian, largest] = meanCurvature(*patch.curvature);
    if (!(gaussian > kBothWays * largest)) return 0;
    const double nu = object.material().poissonRatio, radius = 1 / std::sqrt(gaussian);
    // Neither what bulges hardly more than one way, nor what is flat beside the body's size, is part of a dome.
    const double size   = object.cloud().bounds().diagonal() / 2;
    const double bulges = std::min(1.0, gaussian / largest / kBothWays - 1) * std::clamp(2 - radius / size, 0.0, 1.0);
    const double length = shellLengthRoot(object.material()) * std::sqrt(radius); // [m]
    const double rho    = std::pow(std::pow(0.95 * length, 4) + std::pow(0.43 * settings.footprintRadius, 4), 0.25);
    const double rim    = rimOf(object, patch.chart.frame.normal);
    if (!(rim < 1)) return 0;
    const double ways = std::log(2 * radius / rho) - 1 + heldAtRim(rim);
    const double give = geometricMean(patch.membraneCompliance.values()); // 1/(E h) [m/N]
    return bulges * std::max(0.0, ways) * (1 + nu) / (2 * std::numbers::pi) * give /
           (1 + settings.foundation * radius * radius * give);
}

void addToCompliances(ComplianceTable& table, double more, double slopeX, double slopeZ) noexcept
{
    constexpr double kLeast = 0.1; // of what it is in the middle, far down a slope [1]
    if (more == 0 && slopeX == 0 && slopeZ == 0) return;
    for (int i = 0; i < table.side; ++i)
        for (int j = 0; j < table.side; ++j) {
            ComplianceTable::Entry& entry = table.compliance[std::size_t(i * table.side + j)];
            const double            x = (i - table.side / 2) * table.spacing, z = (j - table.side / 2) * table.spacing;
            const double            there = more + slopeX * x + slopeZ * z, own = std::exp(entry.value);
            const bool              isOnSlope = there > kLeast * more;
            const double            sum       = own + (isOnSlope ? there : kLeast * more);
            entry                             = {std::log(sum), (entry.slopeX * own + (isOnSlope ? slopeX : 0)) / sum,
                                                 (entry.slopeZ * own + (isOnSlope ? slopeZ : 0)) / sum};
        }
}

} // namespace palp
