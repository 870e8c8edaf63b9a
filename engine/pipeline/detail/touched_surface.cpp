#include "engine/pipeline/detail/touched_surface.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>
#include <utility>

#include <glm/geometric.hpp>

#include "engine/chart/chart.h"
#include "engine/cloud/surface_flood.h"

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
    for (std::size_t k = 0; k < surface.places.size(); ++k) {
        const glm::dvec3 d     = surface.places[k] - centre;
        const double     share = std::max(0.0, 1 - glm::dot(d, d) / (radius * radius));
        sum += share * share * surface.normals[k];
    }
    const double length = glm::length(sum);
    return length > 0 ? sum / length : glm::dvec3(0);
}

/// Moves the contact onto the surface of the points around it.
glm::dvec3 anchorOf(const TouchedSurface& surface, const glm::dvec3& contact)
{
    const double            radius = std::max(kNear * surface.spacing, kNoisyNear * surface.noise);
    std::vector<glm::dvec3> near;
    for (const glm::dvec3& place : surface.places)
        if (glm::length(place - contact) <= radius) near.push_back(place);
    const SphereFitResult fit = fitSphere(near);
    if (!fit.usable()) return contact;
    const glm::dvec3 foot = fit.fit.foot(contact);
    return glm::length(foot - contact) <= radius ? foot : contact;
}

/// Chooses an even share of the points, the same ones wherever the finger is.
class EvenShare {
public:
    /// \param share  [1] from 2 on: all points, with the weight 1
    explicit EvenShare(double share) : share_(share) {}

    /// Returns 1 for points of the share, 0 for others, and in between at its limit, so that points come and go gently
    /// where the share changes [1].
    [[nodiscard]] double weightOf(std::uint32_t point) const
    {
        constexpr double        kLimit  = 0.1;         // of the share [1]
        constexpr std::uint32_t kGolden = 2654435769U; // 2^32 over the golden ratio: multiples are evenly spread
        const double            place   = (point * kGolden) * 0x1p-32;
        return std::clamp((share_ - place) / (kLimit * share_), 0.0, 1.0);
    }

private:
    double share_; ///< [1]
};

/// Fits the sphere to a share of the surface's points.
/// \param ball  the points that the surface's numbers are of
SphereFitResult fitSphereTo(const TouchedSurface& surface, std::span<const std::uint32_t> ball, double radius,
                            const EvenShare& chosen)
{
    std::vector<glm::dvec3> points;
    std::vector<double>     weights;
    for (std::size_t k = 0; k < surface.places.size(); ++k) {
        const double taken = chosen.weightOf(ball[surface.inBall[k]]);
        if (taken == 0) continue;
        const glm::dvec3 p     = surface.places[k];
        const glm::dvec3 d     = p - surface.anchor;
        const double     share = std::max(0.0, 1 - glm::dot(d, d) / (radius * radius));
        const double     faces =
            std::clamp((glm::dot(surface.normals[k], surface.normal) - kTurned) / (kFaces - kTurned), 0.0, 1.0);
        if (share * faces == 0) continue;
        points.push_back(p);
        weights.push_back(taken * share * share * faces);
    }
    return fitSphereThrough(surface.anchor, points, weights);
}

/// Fits the sphere to the surface: to an even share of very many points if they lie on a sphere so well that the others
/// would say the same.
SphereFitResult fitSphereTo(const TouchedSurface& surface, std::span<const std::uint32_t> ball, double radius)
{
    constexpr double kEnough = 2000; // points
    constexpr double kClose  = 0.02; // [1] misfit over the radius: felt stiffness then moves by less than 1e-4
    const auto       count   = double(surface.places.size());
    if (count > 2 * kEnough) {
        SphereFitResult few = fitSphereTo(surface, ball, radius, EvenShare(kEnough / count));
        if (few.usable() && few.fit.misfit < kClose * radius) return few;
    }
    return fitSphereTo(surface, ball, radius, EvenShare(2));
}

/// Fills in what follows from places and normals.
void describe(TouchedSurface& surface, std::span<const std::uint32_t> ball, const glm::dvec3& contact, double radius)
{
    surface.anchor = anchorOf(surface, contact);
    surface.normal = meanNormal(surface, surface.anchor, kFacing * radius);
    surface.sphere = fitSphereTo(surface, ball, radius);
}

/// All points of a ball, as one surface.
struct WholeBall {
    TouchedSurface surface;
    double         widest    = 0; ///< spacing [m]
    double         mostNoise = 0; ///< [m]
};

/// Takes all points of the ball, their normals turned to the finger's side; empty if they turn too far from the nearest
/// one's, if some are known to face the other way, or if there are none.
std::optional<WholeBall> wholeBall(const SoftObject& object, const Contact& contact,
                                   std::span<const std::uint32_t> ball, std::uint32_t nearest)
{
    if (ball.empty()) return {};
    constexpr double     kAlike = 0.3; // cosine of 73 degrees [1]
    const SurfaceSurvey& survey = object.survey();
    const double         side   = glm::dot(survey.normal(nearest), contact.outward) < 0 ? -1 : 1;
    const glm::dvec3     first  = side * survey.normal(nearest);
    WholeBall            whole;
    TouchedSurface&      surface = whole.surface;
    bool                 outward = false, inward = false;
    surface.normals.resize(ball.size());
    surface.places.resize(ball.size());
    for (std::size_t k = 0; k < ball.size(); ++k) {
        const std::uint32_t point  = ball[k];
        const glm::dvec3    normal = survey.normal(point);
        const double        cosine = glm::dot(normal, first);
        if (std::abs(cosine) < kAlike) return {};
        (cosine > 0 ? outward : inward) |= survey.sided(point);
        if (outward && inward) return {};
        surface.normals[k] = cosine < 0 ? -normal : normal;
        surface.places[k]  = object.positions()[point];
        whole.widest       = std::max(whole.widest, survey.spacing(point));
        whole.mostNoise    = std::max(whole.mostNoise, survey.noise(point));
    }
    surface.inBall.resize(ball.size());
    std::iota(surface.inBall.begin(), surface.inBall.end(), 0);
    return whole;
}

/// Returns true if the points, seen along a normal, nowhere lie one over the other: the heights within a square of two
/// spacings differ by no more than those of a slope of 45 degrees and noise. Sheets so near to each other that they pass
/// are told apart by the sides that the survey knows.
bool isOneSheet(const WholeBall& whole, const glm::dvec3& centre, double radius)
{
    constexpr double kSquare = 2, kSteep = 2.9, kNoisy = 8; // [spacings], [spacings], [standard deviations of noise]
    constexpr int    kMostSquares = 1024;                   // along a side
    const TouchedSurface& surface = whole.surface;
    const double          widest = whole.widest, noise = whole.mostNoise;
    const int             side = std::clamp(int(2 * radius / (kSquare * widest)), 1, kMostSquares);
    const Frame           axes = Frame::about(surface.normals.front());
    std::vector<float> low(std::size_t(side * side), std::numeric_limits<float>::max()); // [m] heights in each square
    std::vector<float> high(low.size(), std::numeric_limits<float>::lowest());
    const auto         place = [&](double along) {
        return std::size_t(std::clamp(int((along + radius) / (2 * radius) * side), 0, side - 1));
    };
    for (const glm::dvec3& p : surface.places) {
        const glm::dvec3  d      = p - centre;
        const std::size_t square = place(glm::dot(d, axes.east)) * std::size_t(side) + place(glm::dot(d, axes.north));
        const auto        height = float(glm::dot(d, axes.normal));
        low[square]              = std::min(low[square], height);
        high[square]             = std::max(high[square], height);
    }
    const double most = std::max(kSteep * widest, kSteep / kSquare * 2 * radius / side) + kNoisy * noise;
    for (std::size_t k = 0; k < low.size(); ++k)
        if (double(high[k]) - double(low[k]) > most) return false;
    return true;
}

} // namespace

double spacingAt(const SoftObject& object, const glm::dvec3& place)
{
    object.survey().expectSurface();
    const double here = object.survey().spacing(object.index().nearest(place, 1).front().point);
    const double all  = object.spacing();
    return here > kUneven * all || all > kUneven * here ? here : all;
}

TouchedSurface touchedSurface(const SoftObject& object, const Contact& contact, std::span<const std::uint32_t> ball,
                              double radius)
{
    object.survey().expectSurface();
    const std::uint32_t nearest = object.index().nearest(contact.point, 1).front().point;
    const double        spacing = spacingAt(object, contact.point), noise = object.survey().noise(nearest);
    const auto          finished = [&](TouchedSurface& surface) {
        surface.spacing = spacing;
        surface.noise   = noise;
        describe(surface, ball, contact.point, radius);
        return std::move(surface);
    };
    if (auto whole = wholeBall(object, contact, ball, nearest); whole && isOneSheet(*whole, contact.point, radius))
        return finished(whole->surface);
    SurfaceFlood   flood(object);
    TouchedSurface surface;
    const auto     numbers = flood.reachIn(ball, contact.point, contact.outward);
    const auto     normals = flood.normals();
    surface.inBall.assign(numbers.begin(), numbers.end());
    surface.normals.assign(normals.begin(), normals.end());
    surface.places.reserve(numbers.size());
    for (const std::uint32_t number : numbers) surface.places.push_back(object.positions()[ball[number]]);
    return finished(surface);
}

} // namespace palp
