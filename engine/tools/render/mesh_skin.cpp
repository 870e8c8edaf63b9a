#include "engine/tools/render/mesh_skin.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

#include "engine/chart/chart.h"
#include "engine/core/parallel.h"

namespace palp {
namespace {

/// Longest edge of a face over the spacing of the points [1]: a fingertip is four spacings wide, so two edges lie
/// across the half of its dent. Half of it makes four times the triangles and no better picture.
constexpr double kLongestEdge = 2;

/// Points that a corner looks at, and of which it follows as many as lie on its side [1].
constexpr std::size_t kLookedAt = 24, kFollowed = 12;

/// Cosine of the angle between normals up to which a point lies on the side of a corner [1].
constexpr double kSameSide = 0.3;

/// Fewest points for a plane; with fewer on its side a corner follows what is nearest.
constexpr std::size_t kFewest = 4;

/// Weight of a flat displacement against the points' slope [1]: where they lie on a line the slope across it is 0.
constexpr double kStiff = 1e-3;

/// A point around a corner, in the corner's tangent plane.
struct Around {
    std::uint32_t point = 0;
    double        u = 0, v = 0, distance = 0; ///< over the reach [1]
};

/// Returns for each point its part in the value, at the corner, of the plane that fits best.
/// \param around  at most kFollowed
std::array<double, kFollowed> planeWeights(std::span<const Around> around)
{
    std::array<double, kFollowed> weights{};
    glm::dmat3                    sums(0);
    for (std::size_t n = 0; n < around.size(); ++n) {
        const double near = 1 - around[n].distance * around[n].distance;
        weights[n]        = near * near;
        const glm::dvec3 basis(1, around[n].u, around[n].v);
        for (int k = 0; k < 3; ++k) sums[k] += weights[n] * basis[k] * basis;
    }
    const double soft = kStiff * sums[0][0];
    sums[1][1] += soft;
    sums[2][2] += soft;
    const glm::dvec3 plane = glm::inverse(sums) * glm::dvec3(1, 0, 0);
    for (std::size_t n = 0; n < around.size(); ++n)
        weights[n] *= glm::dot(plane, glm::dvec3(1, around[n].u, around[n].v));
    return weights;
}

bool onSide(const SurfaceSurvey& survey, std::uint32_t point, const glm::dvec3& normal)
{
    const double cosine = glm::dot(survey.normal(point), normal);
    return (survey.sided(point) ? cosine : std::abs(cosine)) > kSameSide;
}

/// Returns the points that a corner follows, of the nearest ones those on its side.
std::vector<Around> pointsAround(const SoftObject& object, const glm::dvec3& place, const glm::dvec3& normal)
{
    const auto          near = object.index().nearest(place, kLookedAt);
    std::vector<Around> around;
    for (const Neighbour& n : near)
        if (around.size() < kFollowed && onSide(object.survey(), n.point, normal))
            around.push_back({n.point, 0, 0, n.distance});
    if (around.size() < kFewest) {
        around.clear();
        for (const Neighbour& n : std::span(near).first(std::min(kFewest, near.size())))
            around.push_back({n.point, 0, 0, n.distance});
    }
    constexpr double kBeyond = 1.1; // the farthest one counts a little [1]
    const double     reach   = kBeyond * around.back().distance;
    const Frame      frame   = Frame::about(normal);
    for (Around& a : around) {
        const glm::dvec3 away = (object.positions()[a.point] - place) / reach;
        a.u                   = glm::dot(away, frame.east);
        a.v                   = glm::dot(away, frame.north);
        a.distance /= reach;
    }
    return around;
}

} // namespace

MeshSkin::MeshSkin(const SoftObject& object, std::size_t most)
{
    mesh_      = refined(creased(object.mesh()), kLongestEdge * object.spacing(), most);
    fans_      = Fans(mesh_.faces, mesh_.positions.size());
    positions_ = mesh_.positions;
    normals_   = mesh_.normals;
    deflections_.resize(positions_.size());
    hollows_.resize(positions_.size());
    relief_.resize(positions_.size());
    marked_.resize(positions_.size());
    radii_.assign(positions_.size(), object.spacing());
    pointResponse_.resize(object.size());
    pointHollow_.resize(object.size());
    bind(object);
    invert(object.size());
}

void MeshSkin::bind(const SoftObject& object)
{
    constexpr std::size_t     kPiece = 1000; // corners that are worth a thread
    std::vector<Follows>      each(kFollowed * positions_.size());
    std::vector<std::uint8_t> counts(positions_.size());
    inParallel(positions_.size(), kPiece, [&](std::size_t begin, std::size_t end) {
        for (std::size_t corner = begin; corner < end; ++corner) {
            const auto around  = pointsAround(object, mesh_.positions[corner], mesh_.normals[corner]);
            const auto weights = planeWeights(around);
            counts[corner]     = std::uint8_t(around.size());
            for (std::size_t n = 0; n < around.size(); ++n)
                each[kFollowed * corner + n] = {around[n].point, float(weights[n])};
        }
    });
    first_.assign(1, 0);
    for (std::size_t corner = 0; corner < counts.size(); ++corner) {
        const auto own = each.begin() + std::ptrdiff_t(kFollowed * corner);
        follows_.insert(follows_.end(), own, own + counts[corner]);
        first_.push_back(std::uint32_t(follows_.size()));
    }
}

void MeshSkin::invert(std::size_t points)
{
    firstCorner_.assign(points + 1, 0);
    for (const Follows& f : follows_) ++firstCorner_[f.point + 1];
    for (std::size_t n = 1; n < firstCorner_.size(); ++n) firstCorner_[n] += firstCorner_[n - 1];
    std::vector<std::uint32_t> next(firstCorner_.begin(), firstCorner_.end() - 1);
    cornersOf_.resize(follows_.size());
    for (std::uint32_t corner = 0; corner < positions_.size(); ++corner)
        for (const Follows& f : followed(corner)) cornersOf_[next[f.point]++] = corner;
}

std::vector<std::uint32_t> MeshSkin::cornersNear(std::span<const std::uint32_t> points)
{
    std::vector<std::uint32_t> corners;
    for (const std::uint32_t point : points)
        for (std::uint32_t n = firstCorner_[point]; n < firstCorner_[point + 1]; ++n)
            if (std::exchange(marked_[cornersOf_[n]], 1) == 0) corners.push_back(cornersOf_[n]);
    for (const std::uint32_t corner : corners) marked_[corner] = 0;
    return corners;
}

/// Adds the other corners at the same places, so that no gap opens, and sorts: those of a place follow each other.
void MeshSkin::addSiblings(std::vector<std::uint32_t>& corners)
{
    const auto& place = mesh_.placeOf;
    const auto  near  = corners.size();
    for (std::size_t n = 0; n < near; ++n) {
        for (std::uint32_t c = corners[n]; c > 0 && place[c - 1] == place[corners[n]];) corners.push_back(--c);
        for (std::uint32_t c = corners[n]; c + 1 < place.size() && place[c + 1] == place[corners[n]];)
            corners.push_back(++c);
    }
    std::ranges::sort(corners);
    corners.erase(std::unique(corners.begin(), corners.end()), corners.end());
}

/// Gives the moving corners of a place the mean of their values.
void MeshSkin::join(std::vector<double>& values) const
{
    for (std::size_t begin = 0, end = 0; begin < moving_.size(); begin = end) {
        double sum = 0;
        while (end < moving_.size() && mesh_.placeOf[moving_[end]] == mesh_.placeOf[moving_[begin]])
            sum += values[end++];
        std::fill(values.begin() + std::ptrdiff_t(begin), values.begin() + std::ptrdiff_t(end),
                  sum / double(end - begin));
    }
}

/// Finds the corners of all faces that have a moving corner.
void MeshSkin::findTurning()
{
    turning_.clear();
    for (const std::uint32_t corner : moving_)
        for (const std::uint32_t face : fans_.of(corner))
            for (const std::uint32_t other : mesh_.faces[face])
                if (std::exchange(marked_[other], 1) == 0) turning_.push_back(other);
    flat_.clear();
    for (const std::uint32_t corner : turning_) {
        marked_[corner] = 0;
        flat_.push_back(meanNormal(mesh_.positions, mesh_.faces, fans_.of(corner)));
    }
}

template <class Value>
double MeshSkin::valueOf(std::size_t corner, Value&& value) const
{
    double sum = 0, low = HUGE_VAL, high = -HUGE_VAL;
    for (const Follows& f : followed(corner)) {
        const double own = value(f.point);
        sum += double(f.weight) * own;
        low  = std::min(low, own);
        high = std::max(high, own);
    }
    return std::clamp(sum, low, high); // a plane through a step overshoots
}

void MeshSkin::take(const PatchSurface& surface)
{
    bend(0, 0);
    for (std::size_t n = 0; n < surface.moving.size(); ++n) {
        pointResponse_[surface.moving[n]] = surface.responses[n];
        pointHollow_[surface.moving[n]]   = surface.hollows[n];
    }
    moving_ = cornersNear(surface.moving);
    addSiblings(moving_);
    findTurning();
    inward_ = surface.inward;
    responses_.clear();
    dentHollows_.clear();
    for (const std::uint32_t corner : moving_) {
        const double side = glm::dot(mesh_.normals[corner], inward_) < 0 ? 1 : -1;
        responses_.push_back(valueOf(corner, [&](std::uint32_t point) { return pointResponse_[point]; }));
        dentHollows_.push_back(side * valueOf(corner, [&](std::uint32_t point) { return pointHollow_[point]; }));
    }
    join(responses_);
    for (const std::uint32_t point : surface.moving) pointResponse_[point] = pointHollow_[point] = 0;
}

void MeshSkin::bend(double force, double exaggeration)
{
    for (std::size_t n = 0; n < moving_.size(); ++n) {
        const std::uint32_t corner = moving_[n];
        deflections_[corner]       = force * responses_[n];
        positions_[corner]         = mesh_.positions[corner] + exaggeration * deflections_[corner] * inward_;
        hollows_[corner]           = relief_[corner] + exaggeration * force * dentHollows_[n];
    }
    // The faces may be coarse and seen as smooth: the change of their normal counts, not the normal.
    for (std::size_t n = 0; n < turning_.size(); ++n) {
        const std::uint32_t corner = turning_[n];
        const glm::dvec3    turned = meanNormal(positions_, mesh_.faces, fans_.of(corner)) - flat_[n];
        const double        side   = glm::dot(flat_[n], mesh_.normals[corner]) < 0 ? -1 : 1;
        normals_[corner] =
            turned == glm::dvec3(0) ? mesh_.normals[corner] : glm::normalize(mesh_.normals[corner] + side * turned);
    }
}

void MeshSkin::paint(std::span<const double> points)
{
    std::vector<std::uint32_t> changed;
    paintedFrom_.resize(points.size()); // 0 at first, which no value is
    logarithms_.resize(points.size());
    painted_.resize(positions_.size());
    for (std::uint32_t n = 0; n < points.size(); ++n)
        if (points[n] != paintedFrom_[n]) {
            paintedFrom_[n] = points[n];
            logarithms_[n]  = std::log(points[n]);
            changed.push_back(n);
        }
    for (const std::uint32_t corner : cornersNear(changed))
        painted_[corner] = std::exp(valueOf(corner, [&](std::uint32_t point) { return logarithms_[point]; }));
}

void MeshSkin::relieve(std::span<const double> relief, std::span<const glm::dvec3> sides)
{
    for (std::size_t corner = 0; corner < positions_.size(); ++corner)
        relief_[corner] = valueOf(corner, [&](std::uint32_t point) {
            return glm::dot(sides[point], mesh_.normals[corner]) < 0 ? -relief[point] : relief[point];
        });
    hollows_ = relief_;
}

} // namespace palp
