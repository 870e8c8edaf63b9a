#include "engine/pipeline/detail/touched_surface.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <utility>

#include <glm/geometric.hpp>

#include "engine/chart/chart.h"
#include "engine/cloud/surface_flood.h"
#include "engine/cloud/surface_links.h"

namespace palp {
namespace {

constexpr double kUneven = 2; ///< the cloud's own spacing is taken up to this ratio of the two [1]

/// Radius about the contact within which the surface is smoothed to find the anchor [spacings]: 28 points.
constexpr double kNear = 3;

/// Radius of the same over the noise [1]: hundreds of points then take part.
constexpr double kNoisyNear = 18;

/// Radius about the contact whose normals give the mean one, over that of the ball [1].
constexpr double kFacing = 0.25;

constexpr double kTurned = 0.26, kFaces = 0.76; ///< cosines of 75 and 40 degrees [1]

/// Returns the mean of the normals near the contact.
glm::dvec3 meanNormal(const TouchedSurface& surface, const glm::dvec3& centre, double radius)
{
    glm::dvec3 sum{};
    surface.eachNear(centre, radius, [&](const glm::dvec3& place, const glm::dvec3& normal) {
        const glm::dvec3 d     = place - centre;
        const double     share = std::max(0.0, 1 - glm::dot(d, d) / (radius * radius));
        sum += share * share * normal;
    });
    const double length = glm::length(sum);
    return length > 0 ? sum / length : glm::dvec3(0);
}

/// Moves the contact onto the surface of the points around it.
glm::dvec3 anchorOf(const TouchedSurface& surface, const glm::dvec3& contact)
{
    const double            radius = std::max(kNear * surface.spacing, kNoisyNear * surface.noise);
    std::vector<glm::dvec3> near;
    surface.eachNear(contact, radius, [&](const glm::dvec3& place, const glm::dvec3&) { near.push_back(place); });
    const SphereFitResult fit = fitSphere(near);
    if (!fit.usable()) return contact;
    const glm::dvec3 foot = fit.fit.foot(contact);
    return glm::length(foot - contact) <= radius ? foot : contact;
}

/// Fits the sphere to a share of the surface's points.
SphereFitResult fitSphereTo(const TouchedSurface& surface, double radius, const EvenShare& chosen)
{
    std::vector<glm::dvec3> points;
    std::vector<double>     weights;
    for (std::size_t k = 0; k < surface.size(); ++k) {
        const std::uint32_t rank = surface.rank(k);
        if (!chosen.has(rank)) continue;
        const glm::dvec3 p     = surface.place(k);
        const glm::dvec3 d     = p - surface.anchor;
        const double     share = std::max(0.0, 1 - glm::dot(d, d) / (radius * radius));
        const double     faces =
            std::clamp((glm::dot(surface.normalAt(k), surface.normal) - kTurned) / (kFaces - kTurned), 0.0, 1.0);
        if (share * faces == 0) continue;
        points.push_back(p);
        weights.push_back(chosen.weightOf(rank) * share * share * faces);
    }
    return fitSphereThrough(surface.anchor, points, weights);
}

/// Fits the sphere to the surface: to an even share of very many points, which say what all of them would.
SphereFitResult fitSphereTo(const TouchedSurface& surface, double radius)
{
    constexpr std::size_t kEnough = 2000; // points: felt stiffness then moves by less than 1e-4
    return fitSphereTo(surface, radius, EvenShare::of(surface.size(), kEnough));
}

/// Fills in what follows from places and normals.
void describe(TouchedSurface& surface, const glm::dvec3& contact, double radius)
{
    surface.anchor = anchorOf(surface, contact);
    surface.normal = meanNormal(surface, surface.anchor, kFacing * radius);
    surface.sphere = fitSphereTo(surface, radius);
}

/// What all points of a ball have in common.
struct WholeBall {
    glm::dvec3 first{};       ///< normal of the nearest one, towards the finger [1]
    double     least     = 1; ///< cosine of the largest angle between it and a normal, whatever their signs [1]
    double     widest    = 0; ///< spacing [m]
    double     mostNoise = 0; ///< [m]
};

/// Looks at all points of the ball; empty if their normals turn too far from the nearest one's, if some are known to
/// face the other way, or if there are none.
std::optional<WholeBall> wholeBall(const SoftObject& object, const Contact& contact, const Ball& ball,
                                   std::uint32_t nearest)
{
    if (ball.ranks.empty()) return {};
    constexpr double     kAlike = 0.3; // cosine of 73 degrees [1]
    const SurfaceSurvey& survey = object.survey();
    const double         side   = glm::dot(survey.normal(nearest), contact.outward) < 0 ? -1 : 1;
    WholeBall            whole{side * survey.normal(nearest)};
    bool                 outward = false, inward = false;
    const auto           look = [&](std::span<const std::uint32_t> ranks) { // without branches
        float noise = 0;
        for (const std::uint32_t rank : ranks) {
                      const double cosine = glm::dot(survey.normalOfRank(rank), whole.first);
                      const bool   sided  = survey.sidedOfRank(rank);
                      whole.least         = std::min(whole.least, std::abs(cosine));
                      outward |= sided & (cosine > 0);
                      inward |= sided & !(cosine > 0);
                      whole.widest = std::max(whole.widest, survey.spacingOfRank(rank));
                      noise        = std::max(noise, float(survey.noiseOfRank(rank)));
        }
        whole.mostNoise = std::max(whole.mostNoise, double(noise));
    };
    constexpr std::size_t kPiece = 256; // points: after each it is seen whether to go on
    for (std::span<const std::uint32_t> left = ball.ranks; !left.empty();) {
        const auto piece = left.first(std::min(left.size(), kPiece));
        look(piece);
        if (!(whole.least >= kAlike) || (outward && inward)) return {};
        left = left.subspan(piece.size());
    }
    return whole;
}

/// Returns true if the points, seen along a normal, nowhere lie one over the other: the heights within a square of two
/// spacings differ by no more than those of a slope of 45 degrees and noise. Sheets so near to each other that they
/// pass are told apart by the sides that the survey knows.
bool isOneSheet(const TouchedSurface& surface, const WholeBall& whole, const Ball& ball)
{
    constexpr double   kSquare = 2, kSteep = 2.9, kNoisy = 8; // [spacings], [spacings], [standard deviations of noise]
    constexpr int      kMostSquares = 1024;                   // along a side
    const double       widest = whole.widest, noise = whole.mostNoise, radius = ball.radius;
    const int          side = std::clamp(int(2 * radius / (kSquare * widest)), 1, kMostSquares);
    const Frame        axes = Frame::about(glm::normalize(whole.first));
    std::vector<float> low(std::size_t(side * side), std::numeric_limits<float>::max()); // [m] heights in each square
    std::vector<float> high(low.size(), std::numeric_limits<float>::lowest());
    const double       perSquare = side / (2 * radius);
    const auto         place = [&](double along) { return std::clamp(int((along + radius) * perSquare), 0, side - 1); };
    for (std::size_t k = 0; k < surface.size(); ++k) {
        const glm::dvec3 d      = surface.place(k) - ball.centre;
        const auto       square = std::size_t(place(glm::dot(d, axes.east)) * side + place(glm::dot(d, axes.north)));
        const auto       height = float(glm::dot(d, axes.normal));
        low[square]             = std::min(low[square], height);
        high[square]            = std::max(high[square], height);
    }
    const double most = std::max(kSteep * widest, kSteep / kSquare * 2 * radius / side) + kNoisy * noise;
    for (std::size_t k = 0; k < low.size(); ++k)
        if (double(high[k]) - double(low[k]) > most) return false;
    return true;
}

} // namespace

TouchedSurface::TouchedSurface(const SoftObject& object, const Ball& ball, const glm::dvec3& first, double least)
    : object_(&object), ball_(&ball), positions_(object.index().positionsByRank()), whole_(true), first_(first),
      least_(least)
{
}

TouchedSurface::TouchedSurface(const SoftObject& object, const Ball& ball, std::span<const std::uint32_t> inBall,
                               std::span<const glm::dvec3> normals)
    : object_(&object), ball_(&ball), positions_(object.index().positionsByRank()),
      inBall_(inBall.begin(), inBall.end()), normals_(normals.begin(), normals.end())
{
}

bool TouchedSurface::allFace() const
{
    // Angles add up at most; the reserve is for normals that floats round.
    constexpr double kReserve = 1e-3; // [rad]
    const auto       angle    = [](double cosine) { return std::acos(std::clamp(cosine, -1.0, 1.0)); };
    return whole_ && angle(least_) + angle(glm::dot(first_, normal)) < std::numbers::pi / 2 - kReserve;
}

template <class Visit>
void TouchedSurface::eachNear(const glm::dvec3& centre, double radius, Visit&& visit) const
{
    // Few of very many points: the index finds them, unless it would find some that are not of the ball.
    if (whole_ && glm::length(centre - ball_->centre) + radius < ball_->radius) {
        std::vector<std::uint32_t> near;
        object_->index().gatherRanks(centre, radius, near);
        for (const std::uint32_t rank : near) visit(positions_[rank], normalOfRank(rank));
        return;
    }
    for (std::size_t k = 0; k < size(); ++k)
        if (glm::length(place(k) - centre) <= radius) visit(place(k), normalAt(k));
}

void TouchedSurface::turnOver()
{
    normal = -normal;
    first_ = -first_;
    for (glm::dvec3& n : normals_) n = -n;
}

Ball ballOf(const SoftObject& object, const glm::dvec3& centre, double radius)
{
    Ball ball{{}, {}, centre, radius};
    object.index().gatherRanks(ball.centre, ball.radius, ball.ranks);
    object.index().pointsOf(ball.ranks, ball.points);
    return ball;
}

double spacingAt(const SoftObject& object, const glm::dvec3& place)
{
    object.survey().expectSurface();
    const double here = object.survey().spacing(object.index().nearest(place, 1).front().point);
    const double all  = object.spacing();
    return here > kUneven * all || all > kUneven * here ? here : all;
}

TouchedSurface pieceOf(const SoftObject& object, const Contact& contact, const Ball& ball, std::size_t enough)
{
    object.survey().expectSurface();
    const std::uint32_t nearest = object.index().nearest(contact.point, 1).front().point;
    if (const auto whole = wholeBall(object, contact, ball, nearest)) {
        TouchedSurface surface(object, ball, whole->first, whole->least);
        if (isOneSheet(surface, *whole, ball)) return surface;
    }
    SurfaceFlood flood(object);
    if (ball.ranks.size() <= 2 * enough) {
        const auto numbers = flood.reachIn(ball.ranks, contact.point, contact.outward);
        return {object, ball, numbers, flood.normals()};
    }
    constexpr double kThin = 0.5; // longest step over the thickness [1]
    const double     step  = kLongestStep * object.survey().spacing(nearest) / (kThin * object.material().thickness);
    const auto       all   = double(ball.ranks.size());
    const EvenShare  chosen =
        EvenShare::of(ball.ranks.size(), std::max(enough, std::size_t(std::min(all, all * step * step))));
    std::vector<std::uint32_t> some, ranks; // numbers in the ball; along the index
    for (std::uint32_t k = 0; k < ball.ranks.size(); ++k) {
        if (!chosen.has(ball.ranks[k])) continue;
        some.push_back(k);
        ranks.push_back(ball.ranks[k]);
    }
    const double               sparser = std::sqrt(all / double(std::max<std::size_t>(1, some.size())));
    std::vector<std::uint32_t> numbers;
    for (const std::uint32_t k : flood.reachIn(ranks, contact.point, contact.outward, sparser))
        numbers.push_back(some[k]);
    return {object, ball, numbers, flood.normals()};
}

TouchedSurface touchedSurface(const SoftObject& object, const Contact& contact, const Ball& ball)
{
    TouchedSurface surface = pieceOf(object, contact, ball);
    surface.spacing        = spacingAt(object, contact.point);
    surface.noise          = object.survey().noise(object.index().nearest(contact.point, 1).front().point);
    describe(surface, contact.point, ball.radius);
    return surface;
}

} // namespace palp
