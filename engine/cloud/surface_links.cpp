#include "engine/cloud/surface_links.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <glm/geometric.hpp>

#include "engine/cloud/neighbourhoods.h"

namespace palp {

bool runsAlongSheet(const glm::dvec3& from, const glm::dvec3& to, const glm::dvec3& step, double noise) noexcept
{
    constexpr double kSteepest = 0.55; // sine of the angle [1]
    constexpr double kNoisy    = 3;    // standard deviations
    if (glm::dot(to, to) == 0) return true;
    const glm::dvec3 mean = glm::dot(from, to) < 0 ? from - to : from + to;
    const double     rise = std::abs(glm::dot(mean, step)) / glm::length(mean);
    return rise <= kSteepest * glm::length(step) + kNoisy * noise;
}

SurfaceLinks::SurfaceLinks(std::shared_ptr<const NeighbourIndex> index, std::shared_ptr<const SurfaceSurvey> survey)
    : index_(std::move(index)), survey_(std::move(survey)), runs_(index_->size() / kRun + 1)
{
}

void SurfaceLinks::prepare(std::span<const std::uint32_t> ranks)
{
    const std::lock_guard lock(mutex_);
    for (const std::uint32_t rank : ranks)
        if (auto& run = runs_[rank / kRun]; !run) run = runFrom(rank / kRun * kRun);
}

std::span<const std::uint32_t> SurfaceLinks::from(std::uint32_t rank) const noexcept
{
    const Run&        run = *runs_[rank / kRun];
    const std::size_t k   = rank % kRun;
    return std::span(run.to).subspan(run.begin[k], run.begin[k + 1] - run.begin[k]);
}

std::unique_ptr<const SurfaceLinks::Run> SurfaceLinks::runFrom(std::uint32_t first) const
{
    constexpr double kReach = 1.3; // of a search over a point's own longest step: density changes slowly [1]
    const auto       stepOf = [&](std::uint32_t rank) { return kLongestStep * survey_->spacingOfRank(rank); };
    const auto       last   = std::uint32_t(std::min<std::size_t>(index_->size(), first + kRun));
    auto             run    = std::make_unique<Run>();
    Neighbourhoods   around(*index_);
    around.each(
        {first, last}, [&](std::uint32_t rank) { return kReach * stepOf(rank); },
        [&](std::uint32_t rank, std::span<const NearCandidate> near) {
            const glm::dvec3 own = survey_->normalOfRank(rank);
            for (const NearCandidate& other : near) {
                const double step = std::max(stepOf(rank), stepOf(other.rank));
                if (other.rank == rank || other.distance2 > step * step) continue;
                const double noise = std::max(survey_->noiseOfRank(rank), survey_->noiseOfRank(other.rank));
                if (glm::dot(own, own) == 0 ||
                    runsAlongSheet(own, survey_->normalOfRank(other.rank), other.away, noise))
                    run->to.push_back(other.rank);
            }
            run->begin.at(rank - first + 1) = std::uint32_t(run->to.size());
        });
    for (std::uint32_t k = last - first; k < kRun; ++k) run->begin.at(k + 1) = run->begin.at(last - first);
    return run;
}

} // namespace palp
