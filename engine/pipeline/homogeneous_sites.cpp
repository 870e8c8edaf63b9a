#include "engine/pipeline/homogeneous_sites.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <tuple>

#include <glm/geometric.hpp>

#include "engine/body/body_shell.h"
#include "engine/core/parallel.h"

namespace palp {
namespace {

/// A piece of the surface.
struct Piece {
    glm::dvec3 point{};        ///< [m] mean of its points, by area
    double     area       = 0; ///< [m^2]
    double     lnRigidity = 0; ///< mean of ln D, by area
    double     lnFirmer   = 0; ///< mean of ln of the foundation's shape, by area
    double     stiffening = 0; ///< mean of b, by area [1/m]
};

std::vector<Piece> piecesOf(const SoftObject& object, double cell)
{
    const bool uneven = !object.survey().spacings().empty(); // else there is no surface, and nothing to touch
    std::map<std::tuple<long, long, long>, Piece> cubes;
    for (std::size_t n = 0; n < object.size(); ++n) {
        const glm::dvec3 p    = object.positions()[n];
        const auto       at   = [&](double x) { return long(std::floor(x / cell)); };
        const double     area = uneven ? object.survey().spacing(n) * object.survey().spacing(n) : 1;
        Piece&           cube = cubes[{at(p.x), at(p.y), at(p.z)}];
        cube.point += area * p;
        cube.area += area;
        cube.lnRigidity += area * std::log(object.rigidity(n));
        if (!object.stiffening().empty()) cube.stiffening += area * object.stiffening()[n];
        if (!object.foundationShape().empty()) cube.lnFirmer += area * std::log(object.foundationShape()[n]);
    }
    std::vector<Piece> pieces;
    for (auto& [key, cube] : cubes) {
        cube.point /= cube.area;
        cube.lnRigidity /= cube.area;
        cube.lnFirmer /= cube.area;
        cube.stiffening /= cube.area;
        pieces.push_back(cube);
    }
    return pieces;
}

/// Returns the mean of one of a piece's means about a place, weighted by a Gaussian.
double meanAbout(const glm::dvec3& place, double deviation, const std::vector<Piece>& pieces,
                 const std::vector<std::uint32_t>& near, double Piece::*ofPiece)
{
    double sum = 0, weights = 0;
    for (const std::uint32_t n : near) {
        const glm::dvec3 away   = pieces[n].point - place;
        const double     weight = pieces[n].area * std::exp(-glm::dot(away, away) / (2 * deviation * deviation));
        sum += weight * pieces[n].*ofPiece;
        weights += weight;
    }
    return sum / weights;
}

/// A place at which the body was pressed.
struct Pressed {
    glm::dvec3 place{};          ///< [m]
    double     lnCompliance = 0; ///< of c [m/N]
};

std::vector<Pressed> pressedAllOver(const BodyShell& body, double radius)
{
    constexpr std::size_t               kPlaces = 64;
    const std::vector<BodyNode>&        nodes   = body.mesh().nodes;
    const std::size_t                   places  = std::min(kPlaces, nodes.size());
    std::vector<std::optional<Pressed>> found(places);
    inParallel(places, 8, [&](std::size_t begin, std::size_t end) {
        for (std::size_t k = begin; k < end; ++k) {
            const BodyNode& node =
                nodes[(2 * k + 1) * nodes.size() / (2 * places)]; // those of the outlines, then the others in no order
            const auto moves = body.under(node.place, node.normal, radius);
            if (moves && moves->give > 0) found[k] = Pressed{node.place, std::log(moves->give)};
        }
    });
    std::vector<Pressed> pressed;
    for (const auto& one : found)
        if (one) pressed.push_back(*one);
    return pressed;
}

/// Lets sites give way as the body does, where that is more.
void giveAsBody(std::vector<HomogeneousLaw::Site>& sites, const SoftObject& object, double radius)
{
    constexpr std::size_t      kNearest = 5;
    const auto                 body     = bodyShellOf(object);
    const std::vector<Pressed> pressed  = body ? pressedAllOver(*body, radius) : std::vector<Pressed>{};
    std::vector<glm::dvec3>    places;
    for (const Pressed& one : pressed) places.push_back(one.place);
    if (places.empty()) return;
    const NeighbourIndex near(places);
    for (HomogeneousLaw::Site& site : sites) {
        double       sum = 0, weights = 0;
        const auto   around   = near.nearest(site.point, kNearest);
        const double farthest = around.back().distance;
        for (const auto& [place, distance] : around) {
            const double share = farthest > 0 ? 1.01 - distance / farthest : 1;
            sum += share * share * pressed[place].lnCompliance;
            weights += share * share;
        }
        site.lnCompliance = std::max(site.lnCompliance, sum / weights);
    }
}

} // namespace

HomogeneousLaw homogeneousLaw(const SoftObject& object, const FootprintLattice& lattice, const PatchSettings& settings)
{
    constexpr double      kReach  = 3;   // [deviations]
    constexpr std::size_t kFewest = 500; // pieces that are worth a thread
    const double          radius = lattice.shape.radius, cell = std::max(radius / 2, object.spacing());
    // A mean square radius is twice a Gaussian's variance; that of a footprint, (1 - r^2/R^2)^2, is R^2 / 4.
    const double under = radius / std::sqrt(8.0), felt = std::max(under, lattice.feltRadius / std::sqrt(2.0));

    const std::vector<Piece> pieces = piecesOf(object, cell);
    std::vector<glm::dvec3>  points;
    for (const Piece& piece : pieces) points.push_back(piece.point);
    const NeighbourIndex              index(points);
    std::vector<HomogeneousLaw::Site> sites(points.size());
    inParallel(points.size(), kFewest, [&](std::size_t begin, std::size_t end) {
        std::vector<std::uint32_t> near;
        for (std::size_t n = begin; n < end; ++n) {
            index.gather(points[n], kReach * felt, near);
            const auto mean = [&](double deviation, double Piece::*ofPiece) {
                return meanAbout(points[n], deviation, pieces, near, ofPiece);
            };
            const double bends = mean(felt, &Piece::lnRigidity), lies = mean(under, &Piece::lnRigidity);
            const double firmer = lattice.onFoundation() ? mean(felt, &Piece::lnFirmer) : 0;
            // s times the foundation and D are 1/s times as compliant as the foundation and D/s.
            sites[n] = {points[n], lattice.lnCompliance(std::exp(bends - firmer)) - firmer,
                        std::log(lattice.shape.contactPerRigidity) + lies,
                        object.stiffening().empty() ? 0 : mean(under, &Piece::stiffening)};
        }
    });
    if (isCutFromBody(object, settings)) giveAsBody(sites, object, radius);
    return {std::move(sites), cell, !object.stiffening().empty()};
}

} // namespace palp
