#include "engine/pipeline/deform.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include <glm/geometric.hpp>

#include "engine/chart/exponential_map.h"
#include "engine/cloud/surface_links.h"
#include "engine/core/contract.h"
#include "engine/core/quantity.h"
#include "engine/pipeline/detail/body_give.h"
#include "engine/pipeline/detail/body_on_window.h"
#include "engine/pipeline/detail/coarser_grid.h"
#include "engine/pipeline/detail/contact_chart.h"
#include "engine/pipeline/detail/grid_part.h"
#include "engine/pipeline/detail/other_face.h"
#include "engine/pipeline/detail/patch_response.h"
#include "engine/pipeline/detail/places_followed.h"
#include "engine/pipeline/detail/shell_patch.h"
#include "engine/pipeline/detail/stage_clock.h"
#include "engine/pipeline/detail/touched_surface.h"
#include "engine/pipeline/detail/whole_object.h"
#include "engine/pipeline/detail/window_turn.h"

// The paper's section 2. Each step fills in its part of the patch; deform() below gives their order.

namespace palp {
namespace {

// --- 2.1: the neighbourhood

/// Returns the edge of a cell of the grid [m].
double cellOf(const PatchSettings& settings)
{
    return settings.window / settings.cells;
}

/// Returns the radius of the ball that holds every point which can matter to the window [m].
///
/// Chord and chart distance agree in the azimuthal map. In the cylindrical ones
/// chord^2 = 2 r^2 (1 - cos a cos b) <= r^2 (a^2 + 2 sin^2 b), which is x^2 + 2 z^2 (Lambert) or 2 x^2 + z^2
/// (Gall-Peters).
double gatherRadius(const PatchSettings& settings, double spacing)
{
    const double half  = settings.window / 2;
    const double chord = settings.map == Map::lambertAzimuthal ? std::sqrt(2.0) * half : std::sqrt(3.0) * half;
    return chord + kernelReach(spacing, cellOf(settings));
}

Ball gatherPoints(Patch& patch, const SoftObject& object, const Contact& contact, const PatchSettings& settings)
{
    const StageClock clock(patch.times.gather);
    patch.contact   = contact;
    patch.thickness = object.material().thickness;
    patch.spacing   = spacingAt(object, contact.point);
    return ballOf(object, contact.point, gatherRadius(settings, patch.spacing));
}

/// Keeps, of the ball, the surface that the finger touches; everything, in the paper's way.
TouchedSurface touchedSurface(Patch& patch, const SoftObject& object, const Ball& ball, const PatchSettings& settings)
{
    if (settings.neighbourhood == Neighbourhood::ball) return {};
    const StageClock clock(patch.times.gather);
    TouchedSurface   surface = touchedSurface(object, patch.contact, ball);
    patch.noise              = surface.noise;
    return surface;
}

/// Adds those of the points that the sphere's map has a place for.
void projectPoints(Patch& patch, const SoftObject& object, std::span<const std::uint32_t> points)
{
    for (const std::uint32_t point : points)
        if (const auto position = patch.chart.project(object.positions()[point])) {
            patch.points.push_back(point);
            patch.positions.push_back(*position);
        }
}

/// Unrolls the touched surface onto the chart's plane.
std::vector<std::optional<ChartPoint>> unroll(const Patch& patch, const SoftObject& object,
                                              const TouchedSurface& surface, const PatchSettings& settings)
{
    std::vector<glm::dvec3> places(surface.size()), normals(surface.size());
    std::vector<double>     steps(surface.size());
    for (std::size_t k = 0; k < surface.size(); ++k) {
        places[k]  = surface.place(k);
        normals[k] = surface.normalAt(k);
        steps[k]   = kLongestStep * object.survey().spacing(surface.point(k));
    }
    const double careful = settings.window / 2 + kernelReach(patch.spacing, cellOf(settings)); // beyond, nothing counts
    return exponentialMap(patch.chart.origin, patch.chart.frame, places, normals, steps,
                          gatherRadius(settings, patch.spacing), careful);
}

/// Returns the mean over the window of a function of the cosine between a point's normal and the sphere's.
template <class Function>
double meanAgainstSphere(const Patch& patch, const TouchedSurface& surface, const PatchSettings& settings,
                         const Function& of)
{
    const double          side = glm::dot(patch.sphere.fit.normal(surface.anchor), surface.normal) < 0 ? -1 : 1;
    double                sum = 0, all = 0;
    constexpr std::size_t kEnough = 8000; // points: a share is then right to 0.001
    const EvenShare       chosen  = EvenShare::of(surface.size(), kEnough);
    for (std::size_t k = 0; k < surface.size(); ++k) {
        if (!chosen.has(surface.rank(k))) continue;
        const glm::dvec3 p = surface.place(k);
        if (glm::length(p - surface.anchor) > settings.window / 2) continue;
        sum += of(side * glm::dot(surface.normalAt(k), patch.sphere.fit.normal(p)));
        ++all;
    }
    return all > 0 ? sum / all : 0;
}

/// Returns the share of the window's points whose normal is turned away from the sphere's, fully from 60 degrees on.
double turnedShare(const Patch& patch, const TouchedSurface& surface, const PatchSettings& settings)
{
    constexpr double kAlong = 0.77, kTurned = 0.5; // cosines of 40 and 60 degrees [1]
    return meanAgainstSphere(patch, surface, settings, [](double cosine) {
        return std::clamp((kAlong - cosine) / (kAlong - kTurned), 0.0, 1.0);
    });
}

/// Returns by how much the surface lies off the sphere, over the window [1]. With a share e it slopes against it by
/// some 4 e, which shortens lengths by 8 e^2. Of an object that the window spans the slopes tell: it may be far
/// narrower one way, as gutters are, whose stiffness goes with the fifth power of their width; so they count 2.5 times.
double offSphere(const Patch& patch, const TouchedSurface& surface, const PatchSettings& settings)
{
    const double misfit = patch.sphere.fit.misfit, noise = patch.noise;
    if (settings.windowOf == WindowOf::object) {
        constexpr double kWeight  = 2.5;
        constexpr double kOfNoise = 0.1; // noise tilts normals by (noise / spacing)^2 / 20, and so is taken off [1]
        const double     rough    = noise / patch.spacing;
        const auto       shorter  = [](double cosine) { return std::max(0.0, 1 - std::abs(cosine)); };
        const double     slopes   = meanAgainstSphere(patch, surface, settings, shorter) - kOfNoise * rough * rough;
        return kWeight * std::sqrt(std::max(0.0, slopes) / 8);
    }
    return std::sqrt(std::max(0.0, misfit * misfit - noise * noise)) / settings.window;
}

/// Returns the share of the exponential map in the positions: none where the sphere follows the surface, all of it on
/// fingers, edges and folds, and in between a blend, so that no step is felt where one gives way to the other. In a
/// window lengths are shorter by 0.3 % at the first bound of offSphere(), and by 2 % at the second.
///
/// Where a part of the window stands against the sphere by some 50 degrees, as behind a sharp rim, the misfit need not
/// be large: then that part decides, before it comes to lie over the rest.
double unrolledShare(const Patch& patch, const TouchedSurface& surface, const PatchSettings& settings)
{
    if (settings.map != Map::lambertAzimuthal) return 0; // the user has chosen how a sphere is laid flat
    if (patch.normalFelt) return 1;
    constexpr double kFollows = 0.02, kAstray = 0.05; // of offSphere() [1]
    constexpr double kFew = 0.02, kMany = 0.06;       // share of the points that stand against the sphere [1]
    const auto       risen = [](double x, double from, double to) {
        const double t = std::clamp((x - from) / (to - from), 0.0, 1.0);
        return t * t * (3 - 2 * t);
    };
    return std::max(risen(offSphere(patch, surface, settings), kFollows, kAstray),
                    risen(turnedShare(patch, surface, settings), kFew, kMany));
}

/// The points of a ball whose place in the chart is found.
struct Laid {
    std::vector<std::uint32_t> touched; ///< ranks of those of the touched surface
    std::vector<glm::dvec3>    normals; ///< of the same [1], towards the finger
    std::vector<std::uint32_t> others;  ///< points that are not of it
};

/// Finds the places of a whole ball's points by the sphere's map.
/// \return true if all have one
bool projectWhole(Patch& patch, const TouchedSurface& surface)
{
    constexpr std::size_t            kPiece = 256; // points: their numbers stay in the nearest cache
    std::array<glm::dvec3, kPiece>   places;       // [m]
    std::array<std::uint8_t, kPiece> on;           // 1: has a place
    std::size_t                      found = 0;
    patch.positions.resize(surface.size());
    for (std::size_t from = 0; from < surface.size(); from += kPiece) {
        const std::size_t piece = std::min(kPiece, surface.size() - from);
        for (std::size_t k = 0; k < piece; ++k) places[k] = surface.place(from + k);
        patch.chart.project(std::span(places).first(piece), std::span(patch.positions).subspan(from, piece),
                            std::span(on).first(piece));
        for (std::size_t k = 0; k < piece; ++k) found += on[k];
    }
    return found == surface.size();
}

/// Finds the places of a piece's points, by the sphere's map, by the exponential map, or by both in parts.
std::vector<std::optional<ChartPoint>> placesOf(const Patch& patch, const SoftObject& object,
                                                const TouchedSurface& surface, const PatchSettings& settings)
{
    std::vector<std::optional<ChartPoint>> places(surface.size());
    if (patch.unrolled > 0) places = unroll(patch, object, surface, settings);
    if (patch.unrolled == 1) return places;
    for (std::size_t k = 0; k < surface.size(); ++k) {
        if (!(glm::dot(surface.normalAt(k), surface.normal) > 0)) continue;
        const auto onSphere = patch.chart.project(surface.place(k));
        if (onSphere && places[k])
            places[k] = ChartPoint{std::lerp(onSphere->x, places[k]->x, patch.unrolled),
                                   std::lerp(onSphere->z, places[k]->z, patch.unrolled)};
        else if (patch.unrolled == 0)
            places[k] = onSphere;
    }
    return places;
}

/// Lays a piece of the ball flat. An object that the window spans is unrolled up to its rim, not around it.
Laid layPiece(Patch& patch, const SoftObject& object, const Ball& ball, const TouchedSurface& surface,
              const PatchSettings& settings)
{
    const auto        places = placesOf(patch, object, surface, settings);
    std::vector<bool> behind(surface.size());
    if (settings.windowOf == WindowOf::object)
        behind = onOtherFace(surface, places, patch.chart.frame.normal, patch.thickness);
    std::vector<bool> known(ball.points.size());
    Laid              laid;
    for (std::size_t k = 0; k < surface.size(); ++k) {
        const auto& position = places[k];
        if (!position || behind[k]) continue;
        known[surface.inBall(k)] = true;
        laid.touched.push_back(surface.rank(k));
        laid.normals.push_back(surface.normalAt(k));
        patch.points.push_back(surface.point(k));
        patch.positions.push_back(*position);
    }
    for (std::size_t k = 0; k < known.size(); ++k)
        if (!known[k]) laid.others.push_back(ball.points[k]);
    return laid;
}

/// Lays all of a ball flat by the sphere's map.
/// \return the points that have a place; nothing says which way they face
Laid layBall(Patch& patch, const Ball& ball, const SoftObject& object)
{
    Laid laid;
    for (std::size_t k = 0; k < ball.points.size(); ++k)
        if (const auto position = patch.chart.project(object.positions()[ball.points[k]])) {
            laid.touched.push_back(ball.ranks[k]);
            patch.points.push_back(ball.points[k]);
            patch.positions.push_back(*position);
        }
    patch.touched = patch.points.size();
    return laid;
}

/// Makes the chart, and lays the points flat in it, those of the touched surface first.
/// \return the ranks and normals of these
Laid layFlat(Patch& patch, const SoftObject& object, const Ball& ball, TouchedSurface surface,
             const PatchSettings& settings, const std::optional<Frame>& carried)
{
    const StageClock clock(patch.times.project);
    patch.chart       = chartAt(patch, object, settings.map, carried);
    patch.flatBecause = whyFlat(patch, object, settings);
    if (settings.neighbourhood == Neighbourhood::ball) return layBall(patch, ball, object);
    if (glm::dot(surface.normal, patch.chart.frame.normal) < 0) surface.turnOver(); // the finger's side was a guess
    if (patch.flatBecause.empty()) patch.chart.frame = turnedToBend(patch.chart, object, surface, settings);
    patch.unrolled = unrolledShare(patch, surface, settings);
    if (patch.unrolled == 0 && surface.allFace() && projectWhole(patch, surface)) {
        patch.points  = ball.points;
        patch.touched = patch.points.size();
        Laid laid{ball.ranks, {}, {}};
        if (settings.theory == Theory::shell)
            for (std::size_t k = 0; k < surface.size(); ++k) laid.normals.push_back(surface.normalAt(k));
        return laid;
    }
    patch.positions.clear();
    Laid laid     = layPiece(patch, object, ball, surface, settings);
    patch.touched = patch.points.size();
    // The rest of the ball, the other side of a thin body above all, moves with the touched side but does not count.
    projectPoints(patch, object, laid.others);
    return laid;
}

// --- 2.4: a grid takes over the rigidity of the points

constexpr const char* kWindowHint = "; check --length-unit and --window";

/// Refuses a window that holds next to nothing of the touched surface: it would still give an answer, and the usual
/// reason is a wrong unit.
void refuseIfFew(const Patch& patch, const PatchSettings& settings)
{
    constexpr std::ptrdiff_t kFewestPoints = 9; // 3 by 3: less is no field of rigidity
    const auto               touched       = std::span(patch.positions).first(patch.touched);
    std::ptrdiff_t           held          = 0;
    for (std::size_t k = 0; k < touched.size() && held < kFewestPoints; ++k) held += patch.window.holds(touched[k]);
    if (held < kFewestPoints)
        throw Error(placeText(patch.contact) + ": the patch window of " + formatQuantity(settings.window, "m") +
                    " holds " + std::to_string(held) + " points of the touched surface, which are " +
                    formatQuantity(patch.spacing, "m") + " apart; expected at least " + std::to_string(kFewestPoints) +
                    kWindowHint);
}

/// Refuses a window most of whose nodes have no point nearby, unless a hand feels a surface there: a rim, a wire or the
/// tip of a cone is narrow, and yet it is touched.
void refuseIfEmpty(const Patch& patch, const PatchSettings& settings)
{
    constexpr double kMostUncovered = 0.9; // of the nodes: a corner of a sheet leaves three quarters [1]
    if (patch.contact.felt || settings.windowOf == WindowOf::object) return;
    if (double(patch.nodesWithoutPoint) > kMostUncovered * double(patch.plate.grid.nodes()))
        throw Error(placeText(patch.contact) + ": the patch window of " + formatQuantity(settings.window, "m") +
                    " is almost empty: " + std::to_string(patch.nodesWithoutPoint) + " of its " +
                    std::to_string(patch.plate.grid.nodes()) + " grid nodes have no point of the cloud nearby" +
                    kWindowHint);
}

/// Refuses an object that nothing holds: it would move off as a whole.
void refuseIfLoose(const Patch& patch, const PatchSettings& settings)
{
    if (!isLoose(patch, settings)) return;
    throw Error(placeText(patch.contact) + ": the piece of surface that is touched reaches " +
                std::to_string(patch.heldNodes) + " nodes that are held, expected at least " +
                std::to_string(kFewestHeld) + "; hold more of it with the key held, or give it a foundation");
}

/// Returns the largest value below which no more than a share of all squares lies; reorders.
/// \param share  [1] from 0 to 1
double quantileOfSquares(std::span<double> values, double share)
{
    const auto squares = [](std::span<const double> some) {
        double sum = 0;
        for (const double value : some) sum += value * value;
        return sum;
    };
    double left = share * squares(values); // what may yet lie below the value
    while (values.size() > 1) {
        const std::size_t half = values.size() / 2;
        std::ranges::nth_element(values, values.begin() + std::ptrdiff_t(half));
        const double below = squares(values.first(half));
        values             = below <= left ? values.subspan(half) : values.first(half);
        if (below <= left) left -= below;
    }
    return values.front();
}

/// The areas that points stand for [m^2].
struct Areas {
    double all = 0, closer = 0,
           sparser = 0; ///< of all, of those closer than a spacing, and of those sparser than another
};

/// \param close, sparse  these spacings [m]
[[gnu::noinline]] Areas areasOf(const SurfaceSurvey& survey, std::span<const std::uint32_t> ranks, double close,
                                double sparse)
{
    double all = 0, closer = 0, sparser = 0;
    for (const std::uint32_t rank : ranks) {
        const double s = survey.spacingOfRank(rank);
        all += s * s;
        closer += s < close ? s * s : 0;
        sparser += s > sparse ? s * s : 0;
    }
    return {all, closer, sparser};
}

/// Returns the spacings of the closest and of the sparsest points of the touched surface [m]: the patch's own for both,
/// unless the density varies. Each point counts by the area that it stands for, and a twentieth of it may be closer or
/// sparser still.
/// \param ranks  of these points
std::pair<double, double> spacingsOf(const Patch& patch, const SoftObject& object, std::span<const std::uint32_t> ranks)
{
    constexpr double     kUneven = 2, kRest = 0.05; // [1] ratio to the patch's own; share of the area
    const SurfaceSurvey& survey = object.survey();
    const Areas          area   = areasOf(survey, ranks, patch.spacing / kUneven, patch.spacing * kUneven);
    const bool           close = area.closer > kRest * area.all, sparse = area.sparser > kRest * area.all;
    if (!close && !sparse) return {patch.spacing, patch.spacing};
    std::vector<double> spacings(ranks.size());
    std::ranges::transform(ranks, spacings.begin(), [&](std::uint32_t rank) { return survey.spacingOfRank(rank); });
    return {close ? quantileOfSquares(spacings, kRest) : patch.spacing,
            sparse ? quantileOfSquares(spacings, 1 - kRest) : patch.spacing};
}

/// Computes the rigidities of some points [N m]: with nothing but a load and a product for each, many loads are under
/// way.
void rigiditiesOf(const SoftObject& object, std::span<const std::uint32_t> points, std::span<double> rigidities)
{
    const auto   stiffness = object.cloud().stiffness();
    const double perUnit   = object.cloud().kind() == StiffnessKind::modulus ? object.material().rigidity(1) : 1;
    for (std::size_t k = 0; k < points.size(); ++k) rigidities[k] = stiffness[points[k]] * perUnit;
}

/// Takes the border back that a window has none of, which is cut from a body: all of it is sheet, and nothing is held.
void fillWindow(Patch& patch)
{
    const bool isHeld = std::ranges::any_of(patch.held.values(), [](double share) { return share > 0; });
    if (isHeld || std::ranges::any_of(patch.covered.values(), [](double share) { return share < 1; })) return;
    patch.covered = patch.inside = {};
    patch.beyond                 = 1;
}

/// \param ranks  of the points of the touched surface
void fillRigidity(Patch& patch, const SoftObject& object, std::span<const std::uint32_t> ranks,
                  const PatchSettings& settings)
{
    const StageClock    clock(patch.times.resample);
    std::vector<double> rigidities(patch.touched);
    const auto          touched = std::span(patch.points).first(patch.touched);
    const auto          places  = std::span(patch.positions).first(patch.touched);
    patch.window                = PatchWindow::square(settings.window, settings.cells);
    refuseIfFew(patch, settings);
    rigiditiesOf(object, touched, rigidities);
    const auto [finest, sparsest] = spacingsOf(patch, object, ranks);

    std::vector<PointValues>         values{rigidities};
    std::vector<std::vector<double>> others;
    const auto                       add = [&](std::span<const double> ofPoints, auto asRatio) {
        std::vector<double>& own = others.emplace_back(touched.size());
        for (std::size_t k = 0; k < touched.size(); ++k) own[k] = asRatio(ofPoints[touched[k]]);
        values.emplace_back(own);
    };
    const bool isTissue = !object.foundationShape().empty() && settings.foundation > 0;
    if (isTissue) add(object.foundationShape(), [](double shape) { return shape; });
    if (!object.held().empty())
        add(object.held(), [](double share) { return std::exp(share); }); // of which the log-mean
    if (!object.stiffening().empty()) add(object.stiffening(), growthOf);

    // Beyond an object's border there is next to nothing of what its nearest point has, and six cells away none.
    constexpr double       kBeyond   = 6;
    const bool             ends      = settings.windowOf == WindowOf::object || settings.outside == Outside::body;
    const double           exact     = ends ? kBeyond * cellOf(settings) : std::numeric_limits<double>::infinity();
    std::vector<Resampled> resampled = resampleAll(patch.window, places, values, settings.resampling, finest, sparsest,
                                                   patch.coarse ? Sampling::means : Sampling::places, exact);
    patch.nodesWithoutPoint          = resampled[0].nodesWithoutPoint;
    patch.bareFrom                   = resampled[0].bareFrom;
    patch.plate = {patch.window.grid, edgesOfWindow(settings), object.material().poissonRatio, settings.foundation,
                   std::move(resampled[0].rigidity)};
    refuseIfEmpty(patch, settings);
    auto next = resampled.begin() + 1;
    if (isTissue) patch.plate.foundationShape = std::move((next++)->rigidity);
    patch.below = meanFoundation(patch.plate);
    if (ends) {
        cutOut(patch, sparsest);
        findApart(patch, unitLoad(patch, settings));
    }
    if (!object.held().empty()) {
        NodeField held = std::move((next++)->rigidity);
        for (double& share : held.values()) share = std::log(share);
        holdNodes(patch, held, resamplingWidth(finest, patch.window.grid.spacingX), settings.foundation,
                  unitLoad(patch, settings));
    }
    patch.isCut = settings.outside == Outside::body;
    if (patch.isCut) fillWindow(patch);
    if (settings.theory == Theory::shell && !patch.covered.values().empty()) findSheared(patch);
    refuseIfLoose(patch, settings);
    if (object.stiffening().empty()) return;
    patch.stiffeningAtNodes = std::move(next->rigidity);
    for (double& growth : patch.stiffeningAtNodes.values()) growth = stiffeningOf(growth);
}

constexpr double kCubes[] = {1, 4}; ///< along a cell, of which one point each is taken, the first that will do [1]

/// Cubes of which one point each may stand for all.
struct Cubes {
    double side     = 0; ///< [m] a power of two, as the sides of cubes are
    double sparsest = 0; ///< [m] spacing of the points below which they will do
};

/// Returns the cubes for cells of this width: the largest that are no wider, whose means are smoothed as the points
/// would be; and wider ones for points that are dense for the cell but not for those.
std::array<Cubes, 2> cubesFor(double cell)
{
    constexpr double kWidest = 1.42; // [cells]
    const double     side    = std::exp2(std::floor(std::log2(cell)));
    return {{{side, 0.45 * side}, {2 * side, 2 * side < kWidest * cell ? 0.3 * cell : 0}}};
}

/// Returns the side of the cubes for points of this spacing and noise [m]; 0: they are not dense or quiet enough for
/// any. Noise must not reach from one cube into the next, or the surface would become two.
double sideFor(double cell, double spacing, double noise)
{
    constexpr double kQuiet = 0.1; // noise over the side of the cubes [1]
    for (const auto& [side, sparsest] : cubesFor(cell))
        if (spacing < sparsest && noise < kQuiet * side) return side;
    return 0;
}

/// What the surface is like within a few cubes of a place.
struct Surroundings {
    double spacing  = 0;     ///< on average [m]
    bool   isSmooth = false; ///< it hardly turns, so that the cubes' mean points show what it is
};

Surroundings surroundingsOf(const SoftObject& object, std::uint32_t nearest, const glm::dvec3& place, double side)
{
    constexpr double           kReach = 3, kAlike = 0.77, kFew = 0.02; // [cubes], cosine of 40 degrees, share [1]
    constexpr std::size_t      kLooked = 500;                          // points
    const SurfaceSurvey&       survey  = object.survey();
    std::vector<std::uint32_t> near;
    object.index().gatherRanks(place, kReach * side, near);
    const std::size_t step   = near.size() / kLooked + 1;
    double            turned = 0, spacings = 0, all = 0;
    for (std::size_t k = 0; k < near.size(); k += step, ++all) {
        turned += std::abs(glm::dot(survey.normalOfRank(near[k]), survey.normal(nearest))) < kAlike;
        spacings += survey.spacingOfRank(near[k]);
    }
    return {spacings / all, turned <= kFew * all};
}

/// Returns the object of a point or so per cell where the points are much denser than that, or a finer one beside a
/// rim; else nothing.
std::shared_ptr<const CoarseObject> coarseFor(const SoftObject& object, const Contact& contact,
                                              const PatchSettings& settings)
{
    // A single point's spacing scatters: the mean decides, or touches side by side would differ.
    constexpr double     kNearly = 1.5;
    const SurfaceSurvey& survey  = object.survey();
    if (settings.neighbourhood == Neighbourhood::ball || survey.spacings().empty()) return {};
    const std::uint32_t nearest = object.index().nearest(contact.point, 1).front().point;
    const double        noise   = survey.noise(nearest);
    for (const double cubes : kCubes) {
        const double cell = cellOf(settings) / cubes, likely = sideFor(cell, survey.spacing(nearest) / kNearly, noise);
        if (likely == 0) continue;
        Surroundings about = surroundingsOf(object, nearest, contact.point, likely);
        const double side  = sideFor(cell, about.spacing, noise);
        if (side == 0) continue;
        if (side != likely) about = surroundingsOf(object, nearest, contact.point, side);
        if (about.isSmooth) return object.coarse(side);
    }
    return {};
}

/// Does everything up to the plate, as far as the points determine a surface.
/// \param whole  whose points `object` has, or the means of
void makePlate(Patch& patch, const SoftObject& object, const SoftObject& whole, const Contact& contact,
               const PatchSettings& settings, const std::optional<Frame>& carried)
{
    Ball           ball    = gatherPoints(patch, object, contact, settings); // 2.1: the points near the contact,
    TouchedSurface surface = touchedSurface(patch, object, ball, settings);  // on the side that is touched,
    fitSphereTo(patch, object, ball, surface, settings);                     // 2.2: lie close to a sphere,
    if (patch.deformed()) {
        const Laid laid = layFlat(patch, object, ball, std::move(surface), settings,
                                  carried);                  // 2.3: which an equal-area map lays flat,
        fillRigidity(patch, object, laid.touched, settings); // 2.4: where a grid takes over their rigidity
        const StageClock clock(patch.times.resample);
        curvePatch(patch, object, {laid.touched, std::span(patch.positions).first(patch.touched), laid.normals},
                   settings); //      and, if it is to be a shell, their curvature
        patch.followed = placesFollowed(patch, object, laid.normals);
        if (patch.isCut)
            patch.body = bodyOnWindow(patch, whole, object, settings);
        else
            patch.bodyCompliance = bodyCompliance(patch, object, settings);
    }
    patch.gathered = std::move(ball.points);
}

} // namespace

void prepareTouch(const SoftObject& object, const PatchSettings& given)
{
    const PatchSettings settings = settledFor(object, given);
    if (settings.neighbourhood == Neighbourhood::ball) return;
    const SurfaceSurvey& survey = object.survey();
    if (survey.spacings().empty()) return;
    constexpr std::size_t kLooked = 500; // points
    const std::size_t     step    = object.size() / kLooked + 1;
    double                noise = 0, all = 0; // [m] on average
    for (std::size_t point = 0; point < object.size(); point += step, ++all) noise += survey.noise(point);
    for (const double cubes : kCubes)
        if (const double side = sideFor(cellOf(settings) / cubes, object.spacing(), noise / all); side > 0)
            static_cast<void>(object.coarse(side));
}

Patch windowAbout(const SoftObject& object, const Contact& contact, const PatchSettings& given,
                  const std::optional<Frame>& carried)
{
    const PatchSettings settings = settledFor(object, given);
    Patch               patch;
    patch.coarse = coarseFor(object, contact, settings);
    makePlate(patch, usedOf(patch, object), object, contact, settings, carried);
    return patch;
}

Patch deform(const SoftObject& object, const Contact& contact, const PatchSettings& given, PlateSolver& solver,
             const std::optional<Frame>& carried)
{
    const PatchSettings settings = settledFor(object, given);
    Patch               patch    = windowAbout(object, contact, settings, carried);
    if (!patch.deformed()) return patch;
    bendPlate(patch, settings, solver);                   // 2.5: and bends as a plate under a unit force;
    movePoints(patch);                                    // 2.6: the plate moves the points,
    findStiffness(patch, usedOf(patch, object), settings, //      and with the contact it is what the hand feels,
                  Footprint(unitLoad(patch.plate.grid, settings, {})));
    pressDeeper(patch, settings, solver, false); //      also where it is pressed far.
    return patch;
}

Patch deform(const SoftObject& object, const Contact& contact, const PatchSettings& settings)
{
    PlateSolver reference("reference");
    return deform(object, contact, settings, reference);
}

PatchWithTable deformWithTable(const SoftObject& object, const Contact& contact, const PatchSettings& settings,
                               const FootprintLattice& lattice, PlateSolver& solver,
                               const std::optional<Frame>& carried)
{
    PatchWithTable  result;
    ComplianceTable table;
    result.patch = deformWithTable(object, contact, settings, lattice, solver, carried, table);
    if (result.patch.deformed()) result.table = table;
    return result;
}

Patch deformWithTable(const SoftObject& object, const Contact& contact, const PatchSettings& given,
                      const FootprintLattice& lattice, PlateSolver& solver, const std::optional<Frame>& carried,
                      ComplianceTable& table)
{
    const PatchSettings settings = settledFor(object, given);
    Patch               patch    = windowAbout(object, contact, settings, carried);
    if (!patch.deformed()) return patch;
    bendPlate(patch, settings, lattice, solver, table);
    movePoints(patch);
    findStiffness(patch, usedOf(patch, object), settings, lattice.loads[lattice.loads.size() / 2]);
    pressDeeper(patch, settings, solver, true);
    return patch;
}

namespace {

/// Returns the compliance on a grid of twice the spacing; empty if it cannot be solved there.
std::optional<double> coarseCompliance(const Patch& patch, const PatchSettings& settings, PlateSolver& solver)
{
    Shell shell = shellOf(patch);
    // Of an object that ends in the window every node has a sheet or none: nothing is blurred into its border.
    if (settings.resampling == Resampling::logMean && patch.covered.values().empty())
        blurAsIfCoarser(shell, patch.coarse ? 0 : patch.spacing); // of means as of all points
    shell = everySecondOf(shell);
    if (whyUnsolvable(shell.bending)) return {};
    const GridPart   part = GridPart(patch).everySecond();
    const PlateGrid& grid = shell.bending.grid;
    const Footprint  finger =
        part.of(Footprint(unitLoad(grid, settings, everySecondOf(patch.covered, grid), pressedPlace(patch))));
    const auto of = [&](const auto& what) {
        return solver.solveFootprints(what, {&finger, 1}, 0, settings.tolerance, PlateSolver::kAsWorks)
            .responses.front()
            .work;
    };
    return patch.curvature ? of(part.of(shell)) : of(part.of(shell.bending));
}

} // namespace

std::optional<double> discretisationError(const Patch& patch, const PatchSettings& settings, PlateSolver& solver)
{
    if (!patch.deformed() || !hasCoarseGrid(patch, settings)) return {};
    const auto compliance = coarseCompliance(patch, settings, solver);
    if (!compliance) return {};
    return std::abs(*compliance * patch.curvedBending + bodyFelt(patch) + patch.twist - patch.compliance) / 3 /
           patch.compliance;
}

std::optional<SupportRange> supportRange(const SoftObject& object, const Patch& patch, const PatchSettings& settings,
                                         PlateSolver& solver)
{
    if (settings.theory != Theory::shell || !patch.deformed() || !patch.covered.values().empty() || patch.isCut)
        return {};
    constexpr double kWider = 1.25, kSofter = 0.98, kMostBare = 0.1; // [1]; of the nodes, for which there is no object
    PatchSettings    held = settledFor(object, settings);
    held.large            = Large::off;
    const auto touch      = [&](Edge edge) {
        held.edges = {edge, edge, edge, edge};
        return deform(object, patch.contact, held, solver, patch.chart.frame);
    };
    const auto felt = [&](Edge edge) {
        return patch.plate.edges == PlateEdges{edge, edge, edge, edge} ? patch.feltStiffness
                                                                       : touch(edge).feltStiffness;
    };
    const auto filled = [](const Patch& of) {
        return double(of.nodesWithoutPoint) <= kMostBare * double(of.window.grid.nodes());
    };
    SupportRange range{felt(Edge::supported), felt(Edge::clamped), 0, held.window};
    range.least         = range.supported;
    const double widest = object.cloud().bounds().diagonal();
    for (bool isFilled = filled(patch); isFilled && kWider * held.window < widest;) {
        held.window *= kWider;
        try {
            const Patch wider = touch(Edge::supported);
            isFilled = wider.deformed() && filled(wider) && wider.report.converged && wider.flatBecause.empty() &&
                       wider.feltStiffness < kSofter * range.least;
            if (isFilled) range.least = wider.feltStiffness;
        } catch (const Error&) { // what nobody asked for is no error
            return range;
        }
        if (isFilled) range.width = held.window;
    }
    return range;
}

} // namespace palp
