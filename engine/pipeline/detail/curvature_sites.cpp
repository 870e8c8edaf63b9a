#include "engine/pipeline/detail/curvature_sites.h"

#include <algorithm>
#include <limits>
#include <mutex>
#include <numbers>
#include <optional>

#include <glm/geometric.hpp>

#include "engine/core/contract.h"
#include "engine/core/parallel.h"
#include "engine/pipeline/detail/touched_surface.h"

namespace palp {
namespace {

/// Side of the cubes that have a site on each face, over the radius of the fits [1]; the index takes it to 1.4 more or less.
/// With 0.75 in place of 0.5 a field has half as many, and a tube of noisy points is felt three times as uneven.
constexpr double kCube = 0.5, kSurveyCube = 1;

/// Area of a cube's points over its side's from which on they have a site [1]: of many cubes the surface cuts off but a
/// corner. With 0.25 a noisy ridge is felt a third more uneven.
constexpr double kCorner = 0.1;

/// Returns how many points of a ball a fit needs: some hundred say how a clean surface bends, and of noisy ones as many as
/// keep what noise adds below 0.004 of the inverse radius, a twentieth of what may bend within it.
/// \param noise  of the points [m]
std::size_t enoughFor(double noise, double radius)
{
    constexpr double kFewest = 600, kMost = 1e6,
                     kSlope = 17 / 0.004; // points; the same; root of 2 pi 9.5^2, over that share
    const double wanted     = kSlope * noise / radius;
    return std::size_t(std::clamp(2 * wanted * wanted, kFewest, kMost));
}

/// Chooses the points of a cube nearest to the mean of those that face alike: a thin body has two faces in it.
/// \param begin, end  ranks
void addSites(CurvatureNotes::Level& level, const SoftObject& object, std::uint32_t begin, std::uint32_t end,
              double leastArea)
{
    const auto       positions = object.index().positionsByRank();
    const glm::dvec3 first     = object.survey().normalOfRank(begin);
    for (const bool alike : {true, false}) {
        const auto isOf = [&](std::uint32_t rank) {
            return (glm::dot(object.survey().normalOfRank(rank), first) >= 0) == alike;
        };
        glm::dvec3 sum{};
        float      count = 0;
        double     area  = 0; // [m^2]
        for (std::uint32_t rank = begin; rank < end; ++rank) {
            if (!isOf(rank)) continue;
            sum += positions[rank];
            ++count;
            area += object.survey().spacingOfRank(rank) * object.survey().spacingOfRank(rank);
        }
        if (count == 0 || area < leastArea) continue;
        std::uint32_t nearest = begin;
        double        least   = std::numeric_limits<double>::infinity();
        for (std::uint32_t rank = begin; rank < end; ++rank) {
            const glm::dvec3 d = positions[rank] - sum / double(count);
            if (!isOf(rank) || glm::dot(d, d) >= least) continue;
            least   = glm::dot(d, d);
            nearest = rank;
        }
        level.isSite[nearest] = true;
        level.share[nearest]  = count;
    }
}

CurvatureNotes::Level levelOf(const SoftObject& object, double radius, FitsFor what)
{
    CurvatureNotes::Level level;
    level.isSite.resize(object.size());
    const double side  = (what == FitsFor::field ? kCube : kSurveyCube) * radius; // [m]
    const auto   edges = object.index().cubes(side);
    for (std::size_t n = 0; n + 1 < edges.size(); ++n)
        addSites(level, object, edges[n], edges[n + 1], kCorner * side * side);
    return level;
}

} // namespace

std::optional<LocalCurvature> faceCurvature(const SoftObject& object, const glm::dvec3& place,
                                            const glm::dvec3& outward, double radius)
{
    try {
        const double            noise   = object.survey().noise(object.index().nearest(place, 1).front().point);
        const std::size_t       enough  = enoughFor(noise, radius);
        const Ball              ball    = ballOf(object, place, std::numbers::sqrt2 * radius);
        const TouchedSurface    surface = pieceOf(object, {.point = place, .outward = outward}, ball, enough);
        const EvenShare         chosen  = EvenShare::of(surface.size(), enough);
        std::vector<glm::dvec3> around, normals;
        for (std::size_t k = 0; k < surface.size(); ++k) {
            if (!chosen.has(surface.rank(k))) continue;
            around.push_back(surface.place(k));
            normals.push_back(surface.normalAt(k));
        }
        return fitCurvature({around, normals}, place, radius);
    } catch (const Error&) { // a place without a surface
        return {};
    }
}

std::vector<CurvatureSite> curvatureSites(const SoftObject& object, const LaidPoints& points, int rung, FitsFor what)
{
    const double     radius = rungRadius(rung);
    CurvatureNotes&  notes  = object.curvatureNotes();
    std::unique_lock lock(notes.mutex);
    const std::pair  key(rung, what == FitsFor::survey);
    auto             found = notes.levels.find(key);
    if (found == notes.levels.end()) found = notes.levels.emplace(key, levelOf(object, radius, what)).first;
    CurvatureNotes::Level&     level = found->second;
    std::vector<std::size_t>   sites; // among the points
    std::vector<std::uint32_t> missing;
    for (std::size_t k = 0; k < points.ranks.size(); ++k) {
        if (!level.isSite[points.ranks[k]]) continue;
        sites.push_back(k);
        if (!level.fits.contains(points.ranks[k])) missing.push_back(points.ranks[k]);
    }
    lock.unlock();
    std::vector<std::optional<LocalCurvature>> fits(missing.size());
    inParallel(missing.size(), 4, [&](std::size_t begin, std::size_t end) {
        for (std::size_t n = begin; n < end; ++n)
            fits[n] = faceCurvature(object, object.index().positionsByRank()[missing[n]],
                                    object.survey().normalOfRank(missing[n]), radius);
    });
    lock.lock();
    for (std::size_t n = 0; n < missing.size(); ++n) level.fits.emplace(missing[n], fits[n]);
    std::vector<CurvatureSite> result;
    for (const std::size_t k : sites) {
        auto fit = level.fits.at(points.ranks[k]);
        if (!fit) continue;
        if (glm::dot(fit->normal, points.normals[k]) < 0) fit = LocalCurvature{-fit->normal, -fit->tensor};
        result.push_back({points.positions[k], *fit, double(level.share.at(points.ranks[k]))});
    }
    return result;
}

} // namespace palp
