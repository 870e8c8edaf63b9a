#include "engine/session/deformation.h"

#include <algorithm>

#include "engine/core/contract.h"

namespace palp {

Deformation::Deformation(const PointCloud& cloud, const NeighbourIndex& index, const Scene& scene)
    : cloud_(cloud), index_(index), law_(scene.handOver), settings_(scene.patch),
      device_(scene.device, 0, SoftwareBits::ofTheHost),
      lattice_(footprintLattice(cloud, settings_, scene.handOver == HandOverLaw::table ? scene.tableSize : 1, device_))
{
}

std::optional<PatchNews> Deformation::solve(const Touch& touch, double period)
{
    const glm::dvec3 ahead = aheadOf(law_, touch.point, touch.velocity, period);
    if (auto news = solveAt(ahead, touch)) return news;
    return ahead == touch.point ? std::nullopt : solveAt(touch.point, touch);
}

std::optional<PatchNews> Deformation::solveAt(const glm::dvec3& place, const Touch& touch)
{
    try {
        PatchWithTable solved = deformWithTable(cloud_, index_, {place, touch.outward}, settings_, lattice_, device_);
        if (!solved.table) {
            why_ = "the points around the contact determine no surface";
            return {};
        }
        Patch& patch    = solved.patch;
        settings_.frame = patch.chart.frame;
        PatchNews news{*solved.table};
        news.table.sequence = touch.sequence;
        news.table.time     = touch.time;
        const auto& w       = patch.response.values();
        const int   middle  = settings_.cells / 2;
        news.rigidity       = patch.plate.rigidity(middle, middle);
        news.mostResponse   = *std::max_element(w.begin(), w.end());
        news.errorEstimate  = patch.report.errorEstimate.value_or(0);
        news.iterations     = patch.report.iterations.value_or(0);
        patch_              = std::move(patch);
        return news;
    } catch (const Error& error) { // the window is off the object, or the plate has no solution there
        why_ = error.what();
        return {};
    }
}

} // namespace palp
