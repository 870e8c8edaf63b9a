#include "engine/contact/detail/contact_points.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <optional>

#include <glm/geometric.hpp>

#include "engine/cloud/touch_scale.h"
#include "engine/contact/detail/surface_projector.h"
#include "engine/core/parallel.h"

namespace palp {
namespace {

/// Least distance of the chosen points [scales]: one then stands for one square scale.
constexpr double kApart = 0.95;

/// Share of points that lie on another one from which on they are looked for [1], and how many are looked at. Fewer do
/// no harm, as a median over neighbours decides how close points are.
constexpr double      kStacked = 0.02;
constexpr std::size_t kTried   = 1000;

/// A point has the side of those within the first that agree, on whose planes it lies but for the second [spacings]. A
/// sheet half a spacing behind is not on them.
constexpr double kVoters  = 3;
constexpr double kOnPlane = 0.2;

/// Length of the sum of their normals over their number that makes them agree [1].
constexpr double kAgreeing = 0.7;

/// Least share of noisy points in the ball of a fit [1]: fewer are an edge, or two layers seen as one.
constexpr double kMostlyNoisy = 0.6;

constexpr std::uint32_t kItself = 0xffffffff; ///< stands for itself

constexpr std::size_t kPiece = 256; ///< least chosen points of a thread

bool isStacked(std::span<const glm::dvec3> positions, const NeighbourIndex& index)
{
    const std::size_t tried   = std::min(kTried, positions.size());
    std::size_t       stacked = 0;
    for (std::size_t k = 0; k < tried; ++k) {
        const auto two = index.nearest(positions[positions.size() * k / tried], 2);
        stacked += two.size() == 2 && two[1].distance == 0;
    }
    return double(stacked) > kStacked * double(tried);
}

/// Returns the first of the points at each place, in their order.
std::vector<std::uint32_t> firstOfEachPlace(std::span<const glm::dvec3> positions)
{
    std::vector<std::uint32_t> order(positions.size());
    std::iota(order.begin(), order.end(), 0U);
    const auto key = [&](std::uint32_t i) { return std::array{positions[i].x, positions[i].y, positions[i].z}; };
    std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
        const auto ka = key(a), kb = key(b);
        return ka != kb ? ka < kb : a < b;
    });
    const auto same = [&](std::uint32_t a, std::uint32_t b) { return positions[a] == positions[b]; };
    order.erase(std::unique(order.begin(), order.end(), same), order.end());
    std::sort(order.begin(), order.end());
    return order;
}

} // namespace

/// What the points are made from.
struct ContactPoints::Source {
    std::span<const glm::dvec3> positions;
    const NeighbourIndex*       index;
    const SurfaceSurvey*        survey;

    [[nodiscard]] bool   noisy(std::size_t i) const { return survey->noise(i) > kNoisySpacings * survey->spacing(i); }
    [[nodiscard]] double scale(std::size_t i) const { return touchScale(survey->noise(i), survey->spacing(i)); }
};

ContactPoints::ContactPoints(const SoftObject& object)
{
    Source source{object.positions(), &object.index(), &object.survey()};
    if (isStacked(source.positions, *source.index)) unstack(source);
    source.survey->expectSurface();
    positions_ = source.positions;
    spacings_  = source.survey->spacings();
    usual_     = source.index->spacing();
    markSides(source);
    smooth(source);
}

/// Builds index and survey again from one point of each place.
void ContactPoints::unstack(Source& source)
{
    std::vector<glm::vec3> normals;
    for (const std::uint32_t i : firstOfEachPlace(source.positions)) {
        ownPositions_.push_back(source.positions[i]);
        normals.push_back(source.survey->given(i) ? glm::vec3(source.survey->normal(i)) : glm::vec3(0));
    }
    ownIndex_  = std::make_unique<const NeighbourIndex>(ownPositions_);
    ownSurvey_ = std::make_unique<const SurfaceSurvey>(*ownIndex_, normals);
    source     = {ownPositions_, ownIndex_.get(), ownSurvey_.get()};
}

/// Marks the points whose side the survey knows, and those that lie on the planes of such points about them.
void ContactPoints::markSides(const Source& source)
{
    const SurfaceSurvey& survey = *source.survey;
    std::size_t          sided  = 0;
    for (std::size_t i = 0; i < positions_.size(); ++i) sided += survey.sided(i);
    if (sided == 0) return;
    marks_.resize(positions_.size());
    inParallel(positions_.size(), kPiece, [&](std::size_t begin, std::size_t end) {
        std::vector<std::uint32_t> near;
        for (std::size_t i = begin; i < end; ++i) {
            glm::dvec3 votes = survey.sided(i) ? survey.normal(i) : glm::dvec3(0);
            double     count = survey.sided(i);
            if (!survey.sided(i)) {
                source.index->gather(positions_[i], kVoters * spacings_[i], near);
                for (const std::uint32_t j : near) {
                    const double height = glm::dot(survey.normal(j), positions_[i] - positions_[j]);
                    if (!survey.sided(j) || std::abs(height) > kOnPlane * spacings_[i]) continue;
                    votes += survey.normal(j);
                    ++count;
                }
            }
            const double length = glm::length(votes);
            if (length > kAgreeing * count) marks_[i].facing = Facing(votes / length);
        }
    });
}

/// Puts smoothed points in the place of noisy ones.
void ContactPoints::smooth(const Source& source)
{
    std::vector<std::uint32_t> clean, chosen;
    for (std::size_t i = 0; i < source.positions.size(); ++i)
        if (!source.noisy(i)) clean.push_back(std::uint32_t(i));
    if (clean.size() == source.positions.size()) return;

    const auto opposite = [&](std::uint32_t i, std::uint32_t j) {
        return !marks_.empty() && marks_[i].facing.along(marks_[j].facing.normal()) < 0;
    };
    // A greedy choice along a curve: each chosen point stands for those within its distance.
    constexpr std::uint32_t    kNone = kItself - 1;
    std::vector<std::uint32_t> standsFor(source.positions.size(), kNone); // number of the chosen one, for each
    std::vector<std::uint32_t> near;
    for (const std::uint32_t i : clean) standsFor[i] = kItself;
    for (const std::uint32_t i : source.index->pointsByRank()) {
        if (standsFor[i] != kNone) continue;
        source.index->gather(source.positions[i], kApart * source.scale(i), near);
        for (const std::uint32_t j : near)
            if (standsFor[j] == kNone && !opposite(i, j)) standsFor[j] = std::uint32_t(chosen.size());
        chosen.push_back(i);
    }

    std::vector<std::optional<glm::dvec3>> projected(chosen.size());
    inParallel(chosen.size(), kPiece, [&](std::size_t begin, std::size_t end) {
        SurfaceProjector           projector;
        std::vector<std::uint32_t> found;
        for (std::size_t k = begin; k < end; ++k) {
            const std::uint32_t i     = chosen[k];
            const double        scale = source.scale(i);
            source.index->gather(source.positions[i], projector.reach(scale), found);
            projector.clear();
            std::size_t noisy = 0;
            for (const std::uint32_t j : found) {
                if (opposite(i, j)) continue;
                projector.add(source.positions[j] - source.positions[i]);
                noisy += standsFor[j] != kItself;
            }
            if (double(noisy) < kMostlyNoisy * double(projector.size())) continue;
            if (const auto way = projector.wayToSurface(scale)) projected[k] = source.positions[i] + *way;
        }
    });

    std::vector<glm::dvec3> positions;
    std::vector<double>     spacings;
    std::vector<PointMark>  marks;
    const auto              add = [&](const glm::dvec3& position, double spacing, std::uint32_t i, bool smoothed) {
        positions.push_back(position);
        spacings.push_back(spacing);
        marks.push_back({marks_.empty() ? Facing() : marks_[i].facing, std::uint16_t(smoothed)});
    };
    for (std::size_t i = 0; i < source.positions.size(); ++i)
        if (standsFor[i] == kItself || !projected[standsFor[i]])
            add(source.positions[i], source.survey->spacing(i), std::uint32_t(i), false);
    for (std::size_t k = 0; k < chosen.size(); ++k)
        if (projected[k]) add(*projected[k], source.scale(chosen[k]), chosen[k], true);
    ownPositions_ = std::move(positions);
    ownSpacings_  = std::move(spacings);
    marks_        = std::move(marks);
    positions_    = ownPositions_;
    spacings_     = ownSpacings_;
}

} // namespace palp
