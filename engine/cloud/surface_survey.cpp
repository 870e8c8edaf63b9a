#include "engine/cloud/surface_survey.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include <glm/geometric.hpp>

#include "engine/cloud/detail/local_shape.h"
#include "engine/cloud/local_spacing.h"
#include "engine/cloud/neighbourhoods.h"
#include "engine/cloud/touch_scale.h"
#include "engine/core/contract.h"

namespace palp {
namespace {

/// Radius of the neighbourhood of a normal [spacings]: 28 points of a random sheet, some thirty.
constexpr double kReach = 3;

/// Points lie along a line if their extents along the surface have a smaller ratio, squared [1]: of the 28 points of a
/// random sheet one in 10^5 does. The ball then grows by kGrowth until the ratio reaches kPlanar.
constexpr double kNarrow = 0.08, kPlanar = 0.3, kGrowth = 1.4;

/// Points besides the middle one that the first ball of a point on a line holds at least [1]: at its very end twelve,
/// as the spacing follows from the sixth neighbour. A stray has fewer: its ball would grow until it reached the object,
/// and every hand would meet it in the air.
constexpr std::size_t kFewestInLine = 4;

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

/// The same for one face of a thin body [1]: wider balls about a rim take in more of its bend, slowly.
constexpr double kSettledOnFace = 1.15;

/// Deviations with a smaller kurtosis are those of the two faces of a thin body [1], which has 1 to 1.4; evenly spread
/// noise has 1.8.
constexpr double kTwoFaces = 1.6;

/// A ball's deviation is noise if the quietest share of its points deviates from close shapes of their own by no less
/// than this part of it [1]: by 0.74 of Gaussian noise. About the walls of a clean thin body they deviate by nothing.
constexpr double      kQuietShare = 0.2, kOverQuiet = 4;
constexpr double      kClose  = 2;  ///< radius of those shapes [spacings]
constexpr std::size_t kAsked  = 32; ///< points of a ball that are asked
constexpr std::size_t kEnough = 8;  ///< points of which a deviation tells something

constexpr double kWidest = 32; ///< largest ball of a search for noise, and for lines [spacings]
/// Medians over the neighbours, one after the other: the noise then varies by some per cent only.
constexpr int kMedians = 2;

constexpr std::size_t kTogether   = 8;   ///< points along the curve that share a search for noise
constexpr double      kNearMiddle = 0.5; ///< [radius] within which they do: where the curve jumps, the next is far away
constexpr std::size_t kMostOfBall = 512; ///< points of a wide ball that are looked at

/// A ball that holds more points than this is not searched for noise: it has reached into a part that is far denser, as
/// the balls of many points may do. The widest one holds 3200 on a surface, and 31'000 in a volume.
constexpr std::size_t kMostInNoise = std::size_t(1) << 16;

} // namespace

/// The survey of some runs of a cloud, all by rank: each thread has its own.
class SurfaceSurvey::Measuring {
public:
    /// \param points  by rank
    /// \param given   normals of the points, if there are any
    /// \param faces   takes the normals of points on noisy thin bodies [1], by rank
    Measuring(SurfaceSurvey& survey, const NeighbourIndex& index, std::span<const std::uint32_t> points,
              std::span<const glm::vec3> given, std::span<glm::vec3> faces)
        : survey_(survey), positions_(index.positionsByRank()), points_(points), given_(given), faces_(faces),
          index_(index), neighbourhoods_(index)
    {
    }

    void measureShapes(const RankRun& run);
    void adoptSides(const RankRun& run, std::span<const std::uint8_t> sided);
    void measureNoise(const RankRun& run);
    void settleNoise(const RankRun& run, std::span<const float> raw);

private:
    LocalShape                shapeWithin(std::uint32_t point, double radius);
    std::optional<LocalShape> faceWithin(std::uint32_t point, double radius);
    void                      takeAway(std::uint32_t point);
    LocalShape                widened(std::uint32_t point, LocalShape shape);

    /// The shape of a wide ball, as far as it is one.
    struct WideShape {
        LocalShape    shape;
        std::uint32_t middle = 0; ///< rank
        double        radius = 0; ///< [m]
    };
    WideShape settledShape(std::uint32_t point);
    bool      isNoiseEverywhere(const WideShape& wide);
    void      take(std::uint32_t point, const WideShape& wide);

    SurfaceSurvey&              survey_;
    std::span<const glm::dvec3> positions_; ///< [m]

    std::span<const std::uint32_t> points_; ///< by rank
    std::span<const glm::vec3>     given_;  ///< [1] of any length, by point; empty: none
    std::span<glm::vec3>           faces_;  ///< [1] by rank

    const NeighbourIndex&      index_;
    Neighbourhoods             neighbourhoods_;
    ShapeFitter                fitter_;
    std::vector<glm::dvec3>    away_;
    std::vector<std::uint32_t> found_, some_;
    std::vector<float>         values_;
};

LocalShape SurfaceSurvey::Measuring::shapeWithin(std::uint32_t point, double radius)
{
    index_.gatherRanks(positions_[point], radius, found_);
    takeAway(point);
    return fitter_.fit(away_, radius, survey_.spacings_[point]);
}

/// Does the same for the face of a thin body on which the point lies: without the points whose given normals are
/// opposite, or by the heights of the points. Nothing if the ball holds too many points.
std::optional<LocalShape> SurfaceSurvey::Measuring::faceWithin(std::uint32_t point, double radius)
{
    if (!index_.gatherRanks(positions_[point], radius, kMostInNoise, found_)) return {};
    if (!given_.empty()) {
        const glm::vec3 side = given_[points_[point]];
        std::erase_if(found_, [&](std::uint32_t other) { return glm::dot(given_[points_[other]], side) < 0; });
    }
    takeAway(point);
    return fitter_.fitFace(away_, radius, survey_.spacings_[point]);
}

/// Sets away_ from the points found, of very many evenly spread ones: by rank, neighbours follow one another.
void SurfaceSurvey::Measuring::takeAway(std::uint32_t point)
{
    const std::size_t step = (found_.size() + kMostOfBall - 1) / kMostOfBall;
    away_.clear();
    for (std::size_t k = 0; k < found_.size(); k += step) away_.push_back(positions_[found_[k]] - positions_[point]);
}

/// Widens the ball of a point on a line until its points span a plane, and takes the spacing of the lines. The ball of
/// a stray stays as it is.
/// \param shape  of the points that away_ holds
LocalShape SurfaceSurvey::Measuring::widened(std::uint32_t point, LocalShape shape)
{
    if (away_.size() <= kFewestInLine) return shape;
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
        // Of the layers along the point's normal and against it: its height over them [m], their noise [m].
        double     height[2] = {}, noise[2] = {}, weight[2] = {};
        glm::dvec3 normal[2] = {};
        for (const NearCandidate& candidate : near) {
            const double share = 1 - candidate.distance2 / (radius(point) * radius(point));
            if (!sided[candidate.rank] || share <= 0) continue;
            const glm::dvec3 n     = survey_.normals_[candidate.rank];
            const int        layer = glm::dot(n, glm::dvec3(survey_.normals_[point])) < 0;
            height[layer] += share * std::abs(glm::dot(n, candidate.away));
            noise[layer] += share * survey_.noises_[candidate.rank];
            weight[layer] += share;
            normal[layer] += share * n;
        }
        for (const int k : {0, 1})
            height[k] = weight[k] > 0 ? height[k] / weight[k] : kReach * survey_.spacings_[point];
        const int own = height[1] < height[0];
        if (!(weight[own] > 1) || height[own] > kOwnLayer * height[1 - own]) return;
        survey_.normals_[point] = glm::normalize(normal[own]);
        survey_.sided_[point]   = 1;
        // What it deviated by was the other layer; the own one's deviation is worth a search, or nothing.
        const double scatter   = noise[own] / weight[own];
        survey_.noises_[point] = scatter > kClean * survey_.spacings_[point] ? float(scatter) : 0;
    });
}

/// Returns the shape about a point whose neighbours scatter, in the ball where a wider one no longer enlarges the
/// deviation, which is then noise; a deviation of 0 if it grows with every ball, as that of an edge does.
SurfaceSurvey::Measuring::WideShape SurfaceSurvey::Measuring::settledShape(std::uint32_t point)
{
    const double    spacing = survey_.spacings_[point];
    const WideShape none{{}, point, 2 * kReach * spacing};
    const auto      first = faceWithin(point, kReach * spacing);
    if (!first) return none;
    LocalShape narrow  = *first;
    int        settled = 0;
    for (double radius = 2 * kReach * spacing; radius <= kWidest * spacing; radius *= 2) {
        const auto found = faceWithin(point, radius);
        if (!found) return none;
        const LocalShape wide = *found;
        const double     most = wide.apart > 0 ? kSettledOnFace : kSettled;
        settled               = wide.residual < most * narrow.residual ? settled + 1 : 0;
        if (settled > 0 && wide.tails < kTwoFaces) return none;
        if (settled == 2 || (settled == 1 && 2 * radius > kWidest * spacing)) return {wide, point, radius};
        narrow = wide;
    }
    return none;
}

/// Returns whether the deviation of the two faces in the ball that was gathered last is that of most of its points.
/// About the wall of a clean thin body two faces fit well but for the wall, in every wider ball; points off the wall do
/// not deviate. Some points tell that, in balls too small for both faces. Of a single sheet noise may well end in the
/// middle of a ball.
bool SurfaceSurvey::Measuring::isNoiseEverywhere(const WideShape& wide)
{
    if (!(wide.shape.apart > 0)) return true;
    some_.clear();
    for (std::size_t k = 0; k < kAsked; ++k) some_.push_back(found_[k * found_.size() / kAsked]);
    values_.clear();
    for (const std::uint32_t rank : some_)
        if (const LocalShape close = shapeWithin(rank, kClose * survey_.spacings_[rank]); close.count > kEnough)
            values_.push_back(float(close.residual));
    if (values_.empty()) return true;
    const auto quiet = values_.begin() + std::ptrdiff_t(double(values_.size()) * kQuietShare);
    std::nth_element(values_.begin(), quiet, values_.end());
    return wide.shape.residual < kOverQuiet * *quiet;
}

/// Gives a point the noise of a wide shape that was fitted about a point close to it, and notes its normal if that is a
/// face of a thin body; the point may lie on the other one.
void SurfaceSurvey::Measuring::take(std::uint32_t point, const WideShape& wide)
{
    survey_.noises_[point] = float(wide.shape.residual);
    if (!(wide.shape.apart > 0)) {
        if (point == wide.middle && !survey_.sided_[point]) survey_.normals_[point] = wide.shape.normal;
        return;
    }
    const glm::dvec3 away  = positions_[point] - positions_[wide.middle];
    const bool       other = wide.shape.heightOf(away, wide.radius) < -wide.shape.apart / 2;
    faces_[point]          = (other ? -1.0 : 1.0) * wide.shape.normalAt(away, wide.radius);
}

void SurfaceSurvey::Measuring::measureNoise(const RankRun& run)
{
    std::size_t since = kTogether;
    WideShape   last;
    for (std::uint32_t point = run.begin; point < run.end; ++point) {
        if (!(survey_.noises_[point] > kClean * survey_.spacings_[point])) continue;
        const glm::dvec3 away = positions_[point] - positions_[last.middle];
        if (++since > kTogether || glm::length(away) > kNearMiddle * last.radius) {
            last = settledShape(point);
            if (!isNoiseEverywhere(last)) last.shape = {};
            since = 1;
        }
        if (last.shape.residual > 0)
            take(point, last);
        else
            survey_.noises_[point] = 0;
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
    spacings_ = localSpacingsByRank(index);
    std::vector<glm::vec3> faces(points.size()); // [1] 0: none found
    const auto             eachRun = [&](auto&& measure) {
        inCurveRuns(index.size(), [&] {
            return
                [&, m = Measuring(*this, index, points, given, faces)](const RankRun& run) mutable { measure(m, run); };
        });
    };
    // Most runs have nothing to do in all but the first of these, and say so quickly.
    eachRun([](Measuring& m, const RankRun& run) { m.measureShapes(run); });
    const auto adoptSides = [&] {
        const std::vector<std::uint8_t> layered = sided_;
        eachRun([&](Measuring& m, const RankRun& run) { m.adoptSides(run, layered); });
    };
    adoptSides();
    eachRun([](Measuring& m, const RankRun& run) { m.measureNoise(run); });
    for (int round = 0; round < kMedians; ++round) {
        const std::vector<float> raw = noises_;
        eachRun([&](Measuring& m, const RankRun& run) { m.settleNoise(run, raw); });
    }
    // Faces count where there is noise: a ball about the rim of a clean body has two as well.
    bool found = false;
    for (std::size_t rank = 0; rank < points.size(); ++rank) {
        if (faces[rank] == glm::vec3(0) || !(noises_[rank] > kNoisySpacings * spacings_[rank])) continue;
        normals_[rank] = faces[rank];
        sided_[rank]   = 1;
        found          = true;
    }
    // One search in a hundred finds no faces, because the deviations of some hundred points scatter by some per cent.
    if (found) adoptSides();
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
                    "to touch; are there duplicates, or is the length unit another?");
}

} // namespace palp
