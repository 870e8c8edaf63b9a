#include "engine/cloud/surface_survey.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

#include "engine/cloud/detail/local_shape.h"
#include "engine/cloud/local_spacing.h"
#include "engine/cloud/neighbourhoods.h"
#include "engine/core/contract.h"

namespace palp {
namespace {

/// Radius of the neighbourhood of a normal [spacings]: 28 points of a random sheet, some thirty.
constexpr double kReach = 3;

/// Points lie along a line if their extents along the surface have a smaller ratio, squared [1]: of the 28 points of a
/// random sheet one in 10^5 does. The ball then grows by kGrowth until the ratio reaches kPlanar.
constexpr double kNarrow = 0.08, kPlanar = 0.3, kGrowth = 1.4;

/// Points within a spacing of each other that share the shape about one of them.
constexpr std::size_t kSharing = 8;

/// Returns whether that is so for any point of a run.
template <class Holds>
bool anyOf(const RankRun& run, Holds&& holds)
{
    for (std::uint32_t point = run.begin; point < run.end; ++point)
        if (holds(point)) return true;
    return false;
}

/// Returns whether two spacings are nearly the same.
bool alike(double a, double b)
{
    return std::abs(a - b) < 0.15 * b;
}

/// A point belongs to a layer whose tangent planes it lies this many times nearer to than to the other's [1].
constexpr double kOwnLayer = 0.4;

/// Deviations up to this share of the spacing need no second look [1]: contact and charts bear them.
constexpr double kClean = 0.1;

/// Noise is found where the deviation grows by less than this while the ball doubles, twice in a row [1]. That of an
/// edge doubles, but for one ball that just reaches over it.
constexpr double kSettled = 1.35;

/// Deviations with a smaller kurtosis are those of the two faces of a thin body [1], which has 1 to 1.4; evenly spread
/// noise has 1.8.
constexpr double kTwoFaces = 1.6;

constexpr double kWidest = 32; ///< largest ball of a search for noise, and for lines [spacings]
/// Medians over the neighbours, one after the other: the noise then varies by some per cent only.
constexpr int kMedians = 2;

constexpr std::size_t kTogether   = 8;   ///< points along the curve that share a search for noise
constexpr std::size_t kMostOfBall = 512; ///< points of a wide ball that are looked at

} // namespace

/// The survey of some runs of a cloud, all by rank: each thread has its own.
class SurfaceSurvey::Measuring {
public:
    Measuring(SurfaceSurvey& survey, const NeighbourIndex& index)
        : survey_(survey), positions_(index.positionsByRank()), index_(index), neighbourhoods_(index)
    {
    }

    void measureShapes(const RankRun& run);
    void adoptSides(const RankRun& run, std::span<const std::uint8_t> sided);
    void measureNoise(const RankRun& run);
    void settleNoise(const RankRun& run, std::span<const float> raw);

private:
    LocalShape shapeWithin(std::uint32_t point, double radius);
    LocalShape widened(std::uint32_t point, LocalShape shape);
    float      noiseAbout(std::uint32_t point);

    SurfaceSurvey&              survey_;
    std::span<const glm::dvec3> positions_; ///< [m]
    const NeighbourIndex&       index_;
    Neighbourhoods              neighbourhoods_;
    ShapeFitter                 fitter_;
    std::vector<glm::dvec3>     away_;
    std::vector<std::uint32_t>  found_;
    std::vector<float>          values_;
};

LocalShape SurfaceSurvey::Measuring::shapeWithin(std::uint32_t point, double radius)
{
    index_.gatherRanks(positions_[point], radius, found_);
    const std::size_t step = (found_.size() + kMostOfBall - 1) / kMostOfBall;
    away_.clear();
    for (std::size_t k = 0; k < found_.size(); k += step) away_.push_back(positions_[found_[k]] - positions_[point]);
    return fitter_.fit(away_, radius, survey_.spacings_[point]);
}

/// Widens the ball of a point on a line until its points span a plane, and takes the spacing of the lines.
LocalShape SurfaceSurvey::Measuring::widened(std::uint32_t point, LocalShape shape)
{
    const double spacing = survey_.spacings_[point];
    double       radius  = kReach * spacing;
    while (shape.narrow < kPlanar && radius < kWidest * spacing) {
        radius *= kGrowth;
        shape = shapeWithin(point, radius);
    }
    if (shape.narrow >= kPlanar) survey_.spacings_[point] = radius / kReach;
    return shape;
}

/// Measures the shape about some points. Where it is smooth, those that follow share it: their own would be over nearly
/// the same points.
void SurfaceSurvey::Measuring::measureShapes(const RankRun& run)
{
    for (std::uint32_t point = run.begin, end = 0; point < run.end; point = end) {
        const double spacing = survey_.spacings_[point], radius = kReach * spacing;
        LocalShape   shape = shapeWithin(point, radius);
        end                = point + 1;
        if (shape.smooth && !shape.sided) {
            for (; end < run.end && end - point < kSharing; ++end) {
                const glm::dvec3 away = positions_[end] - positions_[point];
                if (!alike(survey_.spacings_[end], spacing) || glm::dot(away, away) > spacing * spacing) break;
                survey_.normals_[end] = shape.normalAt(away, radius);
                survey_.noises_[end]  = float(shape.residual);
            }
        }
        if (shape.narrow < kNarrow && !shape.sided) shape = widened(point, shape);
        survey_.normals_[point] = shape.normal;
        survey_.noises_[point]  = float(shape.residual);
        survey_.sided_[point]   = shape.sided;
    }
}

/// Gives a point whose own layer was not found that of its neighbours: of those on either side, the ones in whose
/// tangent planes it lies.
void SurfaceSurvey::Measuring::adoptSides(const RankRun& run, std::span<const std::uint8_t> sided)
{
    if (!anyOf(run, [&](std::uint32_t point) { return sided[point] != 0; })) return;
    const auto radius = [&](std::uint32_t point) { return kReach * survey_.spacings_[point]; };
    neighbourhoods_.each(run, radius, [&](std::uint32_t point, std::span<const NearCandidate> near) {
        if (sided[point]) return;
        double     height[2] = {}, weight[2] = {}; // [m] of the point over the layers along its normal and against it
        glm::dvec3 normal[2] = {};
        for (const NearCandidate& candidate : near) {
            const double share = 1 - candidate.distance2 / (radius(point) * radius(point));
            if (!sided[candidate.rank] || share <= 0) continue;
            const glm::dvec3 n     = survey_.normals_[candidate.rank];
            const int        layer = glm::dot(n, glm::dvec3(survey_.normals_[point])) < 0;
            height[layer] += share * std::abs(glm::dot(n, candidate.away));
            weight[layer] += share;
            normal[layer] += share * n;
        }
        for (const int k : {0, 1})
            height[k] = weight[k] > 0 ? height[k] / weight[k] : kReach * survey_.spacings_[point];
        const int own = height[1] < height[0];
        if (!(weight[own] > 1) || height[own] > kOwnLayer * height[1 - own]) return;
        survey_.normals_[point] = glm::normalize(normal[own]);
        survey_.sided_[point]   = 1;
        survey_.noises_[point]  = 0; // what it deviated by was the other layer
    });
}

/// Returns the noise about a point whose neighbours scatter: the deviation that a wider ball does not enlarge; 0 if the
/// deviation grows with every ball, as that of an edge does.
float SurfaceSurvey::Measuring::noiseAbout(std::uint32_t point)
{
    const double spacing = survey_.spacings_[point];
    LocalShape   narrow  = shapeWithin(point, kReach * spacing);
    int          settled = 0;
    for (double radius = 2 * kReach * spacing; radius <= kWidest * spacing; radius *= 2) {
        const LocalShape wide = shapeWithin(point, radius);
        settled               = wide.residual < kSettled * narrow.residual ? settled + 1 : 0;
        if (settled > 0 && wide.tails < kTwoFaces) return 0;
        if (settled == 2 || (settled == 1 && 2 * radius > kWidest * spacing)) {
            survey_.normals_[point] = wide.normal;
            return float(wide.residual);
        }
        narrow = wide;
    }
    return 0;
}

void SurfaceSurvey::Measuring::measureNoise(const RankRun& run)
{
    std::size_t since = kTogether;
    float       last  = 0;
    for (std::uint32_t point = run.begin; point < run.end; ++point) {
        if (survey_.sided_[point] || !(survey_.noises_[point] > kClean * survey_.spacings_[point])) continue;
        if (++since > kTogether) {
            last  = noiseAbout(point);
            since = 1;
        }
        survey_.noises_[point] = last;
    }
}

void SurfaceSurvey::Measuring::settleNoise(const RankRun& run, std::span<const float> raw)
{
    if (!anyOf(run, [&](std::uint32_t point) { return raw[point] > kClean * survey_.spacings_[point]; })) return;
    const auto radius = [&](std::uint32_t point) { return kReach * survey_.spacings_[point]; };
    neighbourhoods_.each(run, radius, [&](std::uint32_t point, std::span<const NearCandidate> near) {
        values_.clear();
        for (const NearCandidate& candidate : near) values_.push_back(raw[candidate.rank]);
        const auto middle = values_.begin() + std::ptrdiff_t(values_.size() / 2);
        std::nth_element(values_.begin(), middle, values_.end());
        survey_.noises_[point] = *middle;
    });
}

SurfaceSurvey::SurfaceSurvey(const NeighbourIndex& index, std::span<const glm::vec3> given)
    : ranks_(index.size()), normals_(index.size()), noises_(index.size()), sided_(index.size())
{
    PALP_EXPECT(given.empty() || given.size() == index.size(), "normals of other points");
    const std::vector<std::uint32_t> points = index.pointsByRank();
    for (std::size_t rank = 0; rank < points.size(); ++rank) ranks_[points[rank]] = std::uint32_t(rank);
    if (!(index.spacing() > 0)) return;
    spacings_          = localSpacingsByRank(index);
    const auto eachRun = [&](auto&& measure) {
        inCurveRuns(index.size(),
                    [&] { return [&, m = Measuring(*this, index)](const RankRun& run) mutable { measure(m, run); }; });
    };
    // Most runs have nothing to do in all but the first of these, and say so quickly.
    eachRun([](Measuring& m, const RankRun& run) { m.measureShapes(run); });
    const std::vector<std::uint8_t> layered = sided_;
    eachRun([&](Measuring& m, const RankRun& run) { m.adoptSides(run, layered); });
    eachRun([](Measuring& m, const RankRun& run) { m.measureNoise(run); });
    for (int round = 0; round < kMedians; ++round) {
        const std::vector<float> raw = noises_;
        eachRun([&](Measuring& m, const RankRun& run) { m.settleNoise(run, raw); });
    }
    byPoint_.resize(points.size());
    for (std::size_t rank = 0; rank < points.size(); ++rank) byPoint_[points[rank]] = spacings_[rank];
    takeSides(given);
}

/// Takes the side, but not the direction, from given normals: where they are the better ones is not known, and ours fit
/// the points.
void SurfaceSurvey::takeSides(std::span<const glm::vec3> given)
{
    for (std::size_t i = 0; i < given.size(); ++i) {
        if (!(glm::dot(given[i], given[i]) > 0)) continue;
        const std::uint32_t rank   = ranks_[i];
        glm::vec3&          normal = normals_[rank];
        if (glm::dot(normal, given[i]) < 0) normal = -normal;
        if (glm::dot(normal, normal) == 0) normal = glm::normalize(given[i]);
        sided_[rank] = kGiven;
    }
}

void SurfaceSurvey::expectSurface() const
{
    if (spacings_.empty())
        throw Error("the cloud has fewer than seven points or most of them coincide, so there is no surface "
                    "to touch; are there duplicates?");
}

} // namespace palp
