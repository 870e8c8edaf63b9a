#include "engine/report/scene_perception.h"

namespace palp::report {
namespace {

std::array<NoticedSteps, 3> stepsOf(const FeltRange& felt, const FeltRange& artefact)
{
    std::array<NoticedSteps, 3> all;
    for (std::size_t n = 0; n < all.size(); ++n) {
        const double weber = kWeberFractions[n];
        all[n]             = {weber, noticeableSteps(felt.whole, weber), noticeableSteps(felt.passing, weber),
                              noticeableSteps(artefact.whole, weber), rightAnswers(noticeableSteps(felt.whole, weber))};
    }
    return all;
}

} // namespace

ScenePerception perceive(const Scene& scene, const PointCloud& cloud, const NeighbourIndex& index, const FeltLine& line,
                         int places, PlateDevice& device)
{
    const PointCloud plain = homogeneous(cloud);
    const ForceLaw   law   = scene.patch.forceLaw;
    ScenePerception  result{line,
                           windowsAlong(cloud, index, scene.patch, line, places, device),
                           strokeAlong(cloud, index, scene, line),
                           strokeAlong(plain, index, scene, line),
                           {},
                           {}};
    const auto       rest = windowsAlong(plain, index, scene.patch, line, places, device);
    result.atRest         = stepsOf(rangeOf(result.places, law), rangeOf(rest, law));
    result.sliding        = stepsOf(rangeOf(result.stroke), rangeOf(result.floor));
    return result;
}

} // namespace palp::report
