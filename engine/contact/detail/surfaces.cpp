#include "engine/contact/detail/surfaces.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

namespace palp {
namespace {

/// Width over a flat sheet, beyond the nearest point, of the ball that gives the outward direction [spacings].
constexpr double kView = 2;

/// Number of fits at the point that was seen, before one at the foot of the proxy.
constexpr int kFitsAtPoint = 3;

/// Points this many times sparser than those here tell where the surface is by their own spacing only [1]. A random
/// cloud has hardly any.
constexpr double kSparser = 2;

/// A plane whose cosine to a known one is lower, and which passes through it here, is the known one from below [1]:
/// 134 degrees. Noise that looks like a ceiling faces the floor; a wall that leans over it by 45 degrees need not.
constexpr double kFromBelow = -0.7;

/// Least support of a surface seen from afar [1]: points all around. With less it lies past a border or an edge.
constexpr double kSureSupport = 0.9;

/// Support that a surface of points of both sides has more where one of a single side ends wrongly [1].
constexpr double kClearlyMore = 0.1;

/// Planes whose Gram matrix has a smaller determinant are too nearly parallel to define an edge or a corner [1].
constexpr double kParallel = 1e-6;

/// Computes the multipliers of the planes in a set: the sum of multiplier x normal moves `place` onto all of them.
/// \return  false if the set is empty or nearly parallel
bool multipliers(std::span<const SurfacePlane> planes, unsigned set, const glm::dvec3& place,
                 std::array<double, Surfaces::kMost>& lambda) noexcept
{
    int    member[Surfaces::kMost];
    double missing[Surfaces::kMost];
    int    count = 0;
    for (int j = 0; j < int(planes.size()); ++j) {
        if (!(set >> j & 1U)) continue;
        missing[count]  = -planes[std::size_t(j)].height(place);
        member[count++] = j;
    }
    const auto gram = [&](int i, int j) {
        return glm::dot(planes[std::size_t(member[i])].normal, planes[std::size_t(member[j])].normal);
    };
    lambda = {};
    if (count == 1) {
        lambda[std::size_t(member[0])] = missing[0];
        return true;
    }
    if (count == 2) {
        const double c = gram(0, 1), determinant = 1 - c * c;
        if (determinant < kParallel) return false;
        lambda[std::size_t(member[0])] = (missing[0] - c * missing[1]) / determinant;
        lambda[std::size_t(member[1])] = (missing[1] - c * missing[0]) / determinant;
        return true;
    }
    if (count != 3) return false;
    // The diagonal is 1; a, b and c are the cosines. Cramer's rule.
    const double a = gram(0, 1), b = gram(0, 2), c = gram(1, 2);
    const double determinant = 1 + 2 * a * b * c - a * a - b * b - c * c;
    if (determinant < kParallel) return false;
    const double x = missing[0], y = missing[1], z = missing[2];
    lambda[0] = (x * (1 - c * c) + y * (b * c - a) + z * (a * c - b)) / determinant;
    lambda[1] = (x * (b * c - a) + y * (1 - b * b) + z * (a * b - c)) / determinant;
    lambda[2] = (x * (a * c - b) + y * (a * b - c) + z * (1 - a * a)) / determinant;
    return true;
}

glm::dvec3 moved(std::span<const SurfacePlane> planes, const std::array<double, Surfaces::kMost>& lambda,
                 glm::dvec3 place) noexcept
{
    for (std::size_t j = 0; j < planes.size(); ++j) place += lambda[j] * planes[j].normal;
    return place;
}

double deepest(std::span<const SurfacePlane> planes, const glm::dvec3& place) noexcept
{
    double height = 0;
    for (const SurfacePlane& plane : planes) height = std::min(height, plane.height(place));
    return -height;
}

/// Returns the place, raised to the height over the known surfaces from which on points are not hidden by them. From
/// the foot of a wall a ball reaches few points of it that high, of a random one at times none, or a single one that
/// tells little of where the wall faces; from here it reaches half a disc.
glm::dvec3 aboveSurfaces(const Surfaces& surfaces, glm::dvec3 place) noexcept
{
    for (const SurfacePlane& plane : surfaces.all())
        place += std::max(0.0, kNoHeight * surfaces.spacing - plane.height(place)) * plane.normal;
    return place;
}

} // namespace

void Surfaces::remove(int which) noexcept
{
    std::copy(planes.begin() + which + 1, planes.begin() + count, planes.begin() + which);
    --count;
}

RestPoint restPointOn(std::span<const SurfacePlane> planes, const glm::dvec3& hip) noexcept
{
    RestPoint    best{hip, {}};
    double       behind = deepest(planes, hip); // of the best, [m]
    const double scale  = behind;
    if (!(behind > 0)) return best;
    constexpr double kRounding = 1e-12; // [1] of the depth
    double           reach     = 0;     // [m] of the best that is behind nothing
    bool             found     = false;
    for (unsigned set = 1; set < 1U << planes.size(); ++set) {
        std::array<double, Surfaces::kMost> lambda{};
        if (!multipliers(planes, set, hip, lambda)) continue;
        if (*std::min_element(lambda.begin(), lambda.end()) < 0) continue;
        const glm::dvec3 point  = moved(planes, lambda, hip);
        const double     depth  = deepest(planes, point);
        const double     length = glm::length(point - hip);
        const bool       free   = depth <= kRounding * scale;
        // If the planes contradict each other, the least wrong set is taken.
        if (found ? free && length < reach : free || depth < behind) {
            best   = {point, lambda};
            behind = depth;
            reach  = length;
            found  = free;
        }
    }
    return best;
}

glm::dvec3 ontoLoaded(std::span<const SurfacePlane> planes, const RestPoint& rest, const glm::dvec3& place) noexcept
{
    unsigned set = 0;
    for (std::size_t j = 0; j < planes.size(); ++j) set |= rest.load[j] > 0 ? 1U << j : 0;
    std::array<double, Surfaces::kMost> lambda{};
    return multipliers(planes, set, place, lambda) ? moved(planes, lambda, place) : place;
}

SurfaceTracker::VisiblePoints SurfaceTracker::findVisible(const Surfaces& surfaces, const glm::dvec3& place)
{
    // Points that a fit of a known surface may still weigh are none of another one.
    const auto isVisible = [&](const NearPoint& point) {
        const bool   sparse = point.spacing > kSparser * surfaces.spacing;
        const double hidden = kNoHeight * (sparse ? point.spacing : surfaces.spacing);
        for (const SurfacePlane& plane : surfaces.all())
            if (plane.height(point.position) <= hidden) return false;
        return true;
    };
    const auto faces = [&](const NearPoint& point) {
        return !point.mark.facing.known() || point.mark.facing.along(place - point.position) >= 0;
    };
    VisiblePoints visible;
    double        best   = kBall; // [1] distance over the point's spacing
    bool          facing = false; // the nearest one does
    points_.holding(place, [&](const NearPoint& point, double d2) {
        const double distance = std::sqrt(d2) / point.spacing;
        visible.sparsest      = std::max(visible.sparsest, point.spacing);
        const bool better     = faces(point) == facing ? distance < best : !facing;
        if (!better || !isVisible(point)) return;
        best            = distance;
        facing          = faces(point);
        visible.nearest = point;
        visible.any     = true;
    });
    if (!visible.any) return visible;
    if (visible.nearest.mark.facing.known()) visible.side = facing ? 1 : -1;
    const double s = visible.nearest.spacing;
    const double r = s * std::sqrt(best * best + kView * kView);
    points_.inside(place, r, s, [&](const NearPoint& point, double d2) {
        const double distance = std::sqrt(d2);
        if (distance > 0 && faces(point) == facing && isVisible(point))
            visible.outward += (r / distance - 1) * (place - point.position);
    });
    return visible;
}

/// Finds in which points' own balls the place of a trial lies, among the points near its plane.
SurfaceTracker::NearbyPoints SurfaceTracker::pointsNear(const TrialPlane& trial) const noexcept
{
    NearbyPoints near;
    double       best = kBall; // [1] distance over the point's spacing
    points_.holding(trial.place, [&](const NearPoint& point, double d2) {
        if (std::abs(glm::dot(trial.normal, point.position - trial.place)) > kFullHeight * point.spacing) return;
        const bool   sparser  = point.spacing > kSparser * trial.spacing;
        const double distance = std::sqrt(d2) / point.spacing;
        near.alike            = near.alike || !sparser;
        if (!sparser || distance >= best) return;
        best         = distance;
        near.sparser = point.spacing;
    });
    return near;
}

/// Fits a plane to the points of its side. Where they seem to end and with the others they do not, sides are ignored:
/// faces of a file may be flipped.
std::optional<PlaneFit> SurfaceTracker::fitPlane(const TrialPlane& trial, std::span<const SurfacePlane> others) noexcept
{
    auto found = fitAnyDensity(trial, others);
    if (trial.side == 0 || (found && found->plane.support >= 1)) return found;
    TrialPlane either = trial;
    either.side       = 0;
    auto anySide      = fitAnyDensity(either, others);
    if (!anySide || (found && anySide->plane.support < found->plane.support + kClearlyMore)) return found;
    anySide->plane.side = trial.side;
    return anySide;
}

/// Fits a plane, with a larger spacing where the surface goes on with sparser points: an apparent border is none
/// then. Returns the fit with the most support.
std::optional<PlaneFit> SurfaceTracker::fitAnyDensity(const TrialPlane&             trial,
                                                      std::span<const SurfacePlane> others) noexcept
{
    if (!points_.mixed()) return fitter_.fit(trial.place, trial.normal, trial.spacing, others, trial.side);
    std::optional<PlaneFit> best;
    TrialPlane              wider = trial;
    for (bool last = false; !last;) { // at most once per doubling of the spacing
        const NearbyPoints near = pointsNear(wider);
        if (near.alike || !(near.sparser > 0)) {
            const auto found = fitter_.fit(wider.place, wider.normal, wider.spacing, others, wider.side);
            if (found && (!best || found->plane.support > best->plane.support)) best = found;
        }
        last          = !(near.sparser > 0) || (best && best->plane.support >= 1);
        wider.spacing = near.sparser;
    }
    return best;
}

bool SurfaceTracker::addSurface(Surfaces& surfaces, const VisiblePoints& visible, const glm::dvec3& place,
                                const glm::dvec3& seed) noexcept
{
    const NearPoint& nearest = visible.nearest;
    const double     length  = glm::length(seed);
    if (!(length > 0) || visible.side * nearest.mark.facing.along(seed) < 0) return false;
    SurfacePlane plane{seed / length, nearest.position, 0, visible.side};
    double       spacing = surfaces.spacing;
    // Noise of sparse points is no ceiling over a floor of dense ones.
    const double coarse = points_.mixed() ? std::max(spacing, visible.sparsest) : spacing;
    for (int k = 0; k <= kFitsAtPoint; ++k) {
        const glm::dvec3 at = k < kFitsAtPoint ? nearest.position : place;
        const auto       found =
            fitPlane({at - plane.height(at) * plane.normal, plane.normal, spacing, plane.side}, surfaces.all());
        if (!found) return false;
        plane = found->plane;
    }
    // A plane that misses the point that was seen belongs to a sheet hidden behind it, or is the floor from below.
    if (!(plane.support > 0 && std::abs(plane.height(nearest.position)) < kFullHeight * spacing &&
          plane.height(place) > -kFullHeight * spacing))
        return false;
    for (const SurfacePlane& known : surfaces.all()) {
        const double c = glm::dot(known.normal, plane.normal);
        if (c > kSameSurface) return false;
        if (c < kFromBelow && known.height(plane.foot) < kFullHeight * coarse) return false;
    }
    if (surfaces.count == 0) surfaces.seen = plane.normal;
    surfaces.planes[std::size_t(surfaces.count++)] = plane;
    return true;
}

bool SurfaceTracker::discover(Surfaces& surfaces, const glm::dvec3& place, const glm::dvec3& towards) noexcept
{
    if (surfaces.count == Surfaces::kMost) return false;
    const VisiblePoints visible = findVisible(surfaces, aboveSurfaces(surfaces, place));
    if (!visible.any) {
        if (surfaces.count == 0) surfaces.seen = {};
        return false;
    }
    if (surfaces.count == 0) surfaces.spacing = visible.nearest.spacing;
    // A surface is seen better from further away: near a hole the nearest points are all on one side.
    const Surfaces before = surfaces;
    if (surfaces.count == 0 && addSurface(surfaces, visible, place, surfaces.seen)) {
        if (surfaces.planes[0].support >= kSureSupport) return true;
        surfaces = before;
    }
    const glm::dvec3 faced = double(visible.side) * visible.nearest.mark.facing.normal(); // 0 if not known
    for (const glm::dvec3& seed : {faced, visible.outward, place - towards, place - visible.nearest.position})
        if (addSurface(surfaces, visible, place, seed)) break;
    return true;
}

/// Drops the later of two surfaces that contradict each other. Noise can look like a ceiling, and points would then be
/// split between it and the floor; one that has come down to a known floor is none.
void SurfaceTracker::dropContradicting(Surfaces& surfaces) noexcept
{
    for (int j = surfaces.count - 1; j > 0; --j)
        for (int k = 0; k < j; ++k) {
            const SurfacePlane &floor = surfaces.planes[std::size_t(k)], &ceiling = surfaces.planes[std::size_t(j)];
            if (glm::dot(floor.normal, ceiling.normal) >= kFromBelow) continue;
            if (floor.height(ceiling.foot) >= kFullHeight * surfaces.spacing) continue;
            surfaces.remove(j);
            break;
        }
}

double SurfaceTracker::refresh(Surfaces& surfaces, const glm::dvec3& place) noexcept
{
    double furthest = 0;
    double spacing  = 0;
    int    fitted   = 0;
    for (int j = 0; j < surfaces.count; ++j) {
        SurfacePlane&                             plane = surfaces.planes[std::size_t(j)];
        std::array<SurfacePlane, Surfaces::kMost> others;
        std::size_t                               count = 0;
        for (int k = 0; k < surfaces.count; ++k)
            if (k != j) others[count++] = surfaces.planes[std::size_t(k)];
        const auto found =
            fitPlane({place - plane.height(place) * plane.normal, plane.normal, surfaces.spacing, plane.side},
                     {others.data(), count});
        if (!found || !(found->plane.support > 0)) {
            plane.support = 0;
            continue;
        }
        plane    = found->plane;
        furthest = std::max(furthest, std::abs(found->raised));
        spacing += found->spacing;
        ++fitted;
    }
    dropContradicting(surfaces);
    constexpr double kFollow = 0.5; // [1] share of the way per fit: a step in density must not jump
    if (fitted > 0) surfaces.spacing += kFollow * (spacing / fitted - surfaces.spacing);
    return furthest;
}

} // namespace palp
