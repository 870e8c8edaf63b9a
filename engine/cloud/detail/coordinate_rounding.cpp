#include "engine/cloud/detail/coordinate_rounding.h"

#include <array>

#include "engine/cloud/neighbour_index.h"
#include "engine/core/quantity.h"

namespace palp {
namespace {

/// The part of the spacing above which rounding is felt as steps [1].
constexpr double kFelt = 0.25;

/// Returns about the spacing of a surface that fills its bounds once [m]; folded ones have more area and are coarser.
double guessedSpacing(const PointCloud& cloud)
{
    const glm::dvec3      size = cloud.bounds().high - cloud.bounds().low;
    std::array<double, 3> edges{size.x, size.y, size.z};
    std::sort(edges.begin(), edges.end());
    return std::sqrt(edges[1] * edges[2] / double(cloud.size()));
}

} // namespace

void warnOfRounding(LoadedCloud& loaded)
{
    const double step = loaded.report.coordinateRounding;
    if (step < kFelt / 4 * guessedSpacing(loaded.cloud)) return; // an index over the points takes time
    const double spacing = NeighbourIndex(loaded.cloud.positions()).spacing();
    if (!(spacing > 0) || !(step > kFelt * spacing)) return;
    loaded.report.warnings.push_back("the file's coordinates are rounded to steps of " + formatQuantity(step, "m") +
                                     ", but its points lie " + formatQuantity(spacing, "m") +
                                     " apart: single precision far from the origin; move the object to the origin "
                                     "before it is saved, or save double precision");
}

} // namespace palp
