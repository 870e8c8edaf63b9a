#include "engine/pipeline/detail/curvature_sites.h"

#include <algorithm>
#include <cmath>
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

/// Area of the surface that has a site, over the square of the radius of the fits [1]: of a field, and of a survey,
/// which only finds the radius. Where the points are noisy it is a fourth of that: fits differ then, and a hand would
/// feel each come and go (measured: with the whole area a tube is felt four times as uneven).
constexpr double kSiteArea = 0.2, kSurveySiteArea = 0.8, kMostSites = 4;

/// Error that noise makes of a fit, in inverse radii, above which points count as noisy [1]: a hundredth of what may
/// bend.
constexpr double kQuiet = 0.0015;

/// Area of a cube's points over that of a site from which on they have one [1]: of many cubes the surface cuts off a
/// corner.
constexpr double kCorner = 0.3;

/// Side of the cubes over the root of a site's area [1]: their points are shared out to some three to twelve sites.
constexpr double kCubes = 2;

/// Returns how many points of a ball a fit needs: some hundred say how a clean surface bends, and of noisy ones as many
/// as keep what noise adds below 0.004 of the inverse radius, a twentieth of what may bend within it.
/// \param noise  of the points [m]
std::size_t enoughFor(double noise, double radius)
{
    constexpr double kFewest = 600, kMost = 1e6,
                     kSlope = 17 / 0.004; // points; the same; root of 2 pi 9.5^2, over that share
    const double wanted     = kSlope * noise / radius;
    return std::size_t(std::clamp(2 * wanted * wanted, kFewest, kMost));
}

/// Makes a site of that of some points which is nearest to their mean.
void addSite(CurvatureNotes::Level& level, const SoftObject& object, std::span<const std::uint32_t> ranks)
{
    const auto positions = object.index().positionsByRank();
    glm::dvec3 mean{};
    for (const std::uint32_t rank : ranks) mean += positions[rank] / double(ranks.size());
    const auto away = [&](std::uint32_t rank) {
        const glm::dvec3 d = positions[rank] - mean;
        return glm::dot(d, d);
    };
    const std::uint32_t site = *std::ranges::min_element(ranks, {}, away);
    level.isSite[site]       = true;
    level.share[site]        = float(ranks.size());
}

/// Some points that face alike.
struct Facing {
    std::vector<std::uint32_t> ranks;
    double                     area  = 0; ///< [m^2]
    double                     noise = 0; ///< times the spacing, mean [m^2]
};

/// \param begin, end  ranks
/// \param alike       to the first of them, or the other way
Facing facing(const SoftObject& object, std::uint32_t begin, std::uint32_t end, bool alike)
{
    const SurfaceSurvey& survey = object.survey();
    const glm::dvec3     first  = survey.normalOfRank(begin);
    Facing               result;
    for (std::uint32_t rank = begin; rank < end; ++rank) {
        if ((glm::dot(survey.normalOfRank(rank), first) >= 0) != alike) continue;
        const double spacing = survey.spacingOfRank(rank);
        result.ranks.push_back(rank);
        result.area += spacing * spacing;
        result.noise += survey.noiseOfRank(rank) * spacing;
    }
    result.noise /= double(std::max<std::size_t>(1, result.ranks.size()));
    return result;
}

/// Chooses the sites of a cube, separately of the points that face alike, for a thin body has two faces in it: those of
/// each are cut along the curve, which keeps neighbours together, into as many pieces as have the area of a site.
/// \param begin, end  ranks
/// \param area        of a site among clean points [m^2]
void addSites(CurvatureNotes::Level& level, const SoftObject& object, std::uint32_t begin, std::uint32_t end,
              double area, double radius)
{
    for (const bool alike : {true, false}) {
        const Facing points = facing(object, begin, end, alike);
        const double noisy  = kFitNoiseError * points.noise / (radius * radius * kQuiet); // [1]
        const double each   = area / std::clamp(noisy, 1.0, kMostSites);
        if (points.ranks.empty() || points.area < kCorner * each) continue;
        const auto pieces =
            std::clamp<std::size_t>(std::size_t(std::lround(points.area / each)), 1, points.ranks.size());
        const auto edge = [&](std::size_t piece) { return points.ranks.size() * piece / pieces; };
        for (std::size_t piece = 0; piece < pieces; ++piece)
            addSite(level, object, std::span(points.ranks).subspan(edge(piece), edge(piece + 1) - edge(piece)));
    }
}

CurvatureNotes::Level levelOf(const SoftObject& object, double radius, FitsFor what)
{
    CurvatureNotes::Level level;
    level.isSite.resize(object.size());
    const double area  = (what == FitsFor::field ? kSiteArea : kSurveySiteArea) * radius * radius; // [m^2]
    const auto   edges = object.index().cubes(kCubes * std::sqrt(area));
    for (std::size_t n = 0; n + 1 < edges.size(); ++n) addSites(level, object, edges[n], edges[n + 1], area, radius);
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

double fitError(double noise, double spacing, double radius) noexcept
{
    return kFitNoiseError * noise * spacing / (radius * radius * radius);
}

double quietFitRadius(double noise, double spacing) noexcept
{
    constexpr double kMost = 0.5; // [1/m]
    return std::cbrt(kFitNoiseError / kMost * noise * spacing);
}

std::pair<double, double> principalOf(const LocalCurvature& fit) noexcept
{
    const glm::dmat3& t       = fit.tensor;
    const double      trace   = t[0][0] + t[1][1] + t[2][2];
    double            squares = 0; // of all its numbers: the sum of the squared principal curvatures
    for (int i = 0; i < 3; ++i) squares += glm::dot(t[i], t[i]);
    const double apart  = std::sqrt(std::max(0.0, 2 * squares - trace * trace));
    const double larger = std::copysign((std::abs(trace) + apart) / 2, trace);
    return {larger, trace - larger};
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
        if (glm::dot(fit->normal, points.normals[k]) < 0) fit = LocalCurvature{-fit->normal, -fit->tensor, fit->sure};
        result.push_back({points.positions[k], *fit, double(level.share.at(points.ranks[k]))});
    }
    return result;
}

} // namespace palp
