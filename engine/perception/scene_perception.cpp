#include "engine/perception/scene_perception.h"

namespace palp {
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

ScenePerception perceive(const Scene& scene, const SoftObject& object, const FeltLine& line, int places,
                         PlateSolver& solver, const std::function<void(std::size_t, std::size_t)>& onStep)
{
    constexpr std::size_t kStages = 4;
    const auto            step    = [&](std::size_t done) {
        if (onStep) onStep(done, kStages);
    };
    const SoftObject plain = homogeneous(object);
    const ForceLaw   law   = scene.patch.forceLaw;
    ScenePerception  result;
    result.line   = line;
    result.places = windowsAlong(object, scene.patch, line, places, solver);
    step(1);
    const auto rest = windowsAlong(plain, scene.patch, line, places, solver);
    step(2);
    FeltStroke stroke = strokeAlong(object, scene, line);
    step(3);
    FeltStroke floor = strokeAlong(plain, scene, line);
    result.takeover  = stroke.takeover.empty() ? std::move(floor.takeover) : std::move(stroke.takeover);
    result.stroke    = std::move(stroke.ticks);
    result.floor     = std::move(floor.ticks);
    result.atRest    = stepsOf(rangeOf(result.places, law), rangeOf(rest, law));
    result.sliding   = stepsOf(rangeOf(result.stroke), rangeOf(result.floor));
    return result;
}

} // namespace palp
