#include "engine/cloud/tissue_below.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include <glm/geometric.hpp>

#include "engine/cloud/soft_object.h"
#include "engine/core/contract.h"
#include "engine/core/parallel.h"
#include "engine/core/quantity.h"
#include "engine/core/volume_grid.h"

namespace palp {
namespace {

/// The share of the energy that even tissue stores above a depth.
class EnergyAbove {
public:
    EnergyAbove(double depth, double decay) : depth_(depth), q_(std::min(decay, kMost / depth)) {}

    /// \param z  [m] below the sheet
    [[nodiscard]] double operator()(double z) const { return 1 - left(std::clamp(z, 0.0, depth_)) / left(0); }

private:
    static constexpr double kMost = 300; ///< of q H, beyond which its cosh is not finite [1]

    /// The integral of cosh^2 (q (H - t)) from z to H, over q.
    [[nodiscard]] double left(double z) const
    {
        const double x = q_ * (depth_ - z);
        return 2 * x + std::sinh(2 * x);
    }

    double depth_, q_;
};

struct Ball {
    glm::dvec3 middle{}, outward{}; ///< [m]; above it, unit
    double     radius  = 0;         ///< [m]
    double     stiffer = 1;         ///< modulus over that of the tissue [1]
};

std::string nodule(std::size_t n)
{
    return "below: nodule " + std::to_string(n + 1) + ": ";
}

Ball ballOf(const SoftObject& object, const TissueBelow& below, std::size_t n)
{
    const BuriedNodule& one     = below.nodules[n];
    const auto          nearest = object.index().nearest(one.at, 1).front();
    const double        sheet   = object.material().thickness;
    if (nearest.distance > one.radius)
        throw Error(nodule(n) + "expected a place on the object, found one that is " +
                    formatQuantity(nearest.distance, "m") + " beside its nearest point");
    if (one.depth - one.radius < sheet || one.depth + one.radius > sheet + below.depth)
        throw Error(nodule(n) + "expected a ball between the sheet's underside at " + formatQuantity(sheet, "m") +
                    " and the end of the tissue at " + formatQuantity(sheet + below.depth, "m") + ", found one from " +
                    formatQuantity(one.depth - one.radius, "m") + " to " + formatQuantity(one.depth + one.radius, "m"));
    glm::dvec3       normal = object.survey().normal(nearest.point);
    const glm::dvec3 out    = object.positions()[nearest.point] - object.cloud().bounds().centre();
    if (!object.survey().sided(nearest.point) && glm::dot(normal, out) < 0) normal = -normal;
    return {object.positions()[nearest.point] - one.depth * normal, normal, one.radius, one.modulus / below.modulus};
}

/// The column below a point.
struct Column {
    glm::dvec3 top{}, inward{}; ///< [m], unit; at the sheet's underside
    double     depth = 0;       ///< [m]

    /// Returns the depths between which it runs in a ball [m]; equal ones if it misses it.
    [[nodiscard]] std::array<double, 2> within(const Ball& ball) const
    {
        const glm::dvec3 to   = ball.middle - top;
        const double     z    = glm::dot(to, inward);
        const double     half = ball.radius * ball.radius - glm::dot(to, to) + z * z;
        if (half <= 0) return {0, 0};
        return {std::clamp(z - std::sqrt(half), 0.0, depth), std::clamp(z + std::sqrt(half), 0.0, depth)};
    }
};

constexpr double kSeries = 0.85; ///< exponent of the mean over a column: 1 is springs in series [1]

/// A point of the sheet, and how thick it is.
struct Place {
    glm::dvec3 point{}, normal{}; ///< [m], unit
    bool       sided = false;     ///< the normal is known to point outwards
    double     sheet = 0;         ///< [m]
    double     depth = 0;         ///< of the tissue below it [m]

    [[nodiscard]] Column columnAlong(const glm::dvec3& inward) const { return {point + sheet * inward, inward, depth}; }
};

double shapeBelow(const Place& place, const std::vector<Ball>& balls, const EnergyAbove& above)
{
    double stiff = 0, soft = 0; // what stiff balls take from s^-kSeries, and soft ones from s [1]
    for (const Ball& ball : balls) {
        const bool turned     = !place.sided && glm::dot(place.normal, ball.outward) < 0;
        const auto [from, to] = place.columnAlong(turned ? place.normal : -place.normal).within(ball);
        const double share    = above(to) - above(from);
        if (ball.stiffer > 1)
            stiff += share * (1 - std::pow(ball.stiffer, -kSeries));
        else
            soft += share * (1 - ball.stiffer);
    }
    constexpr double kLeast = 1e-3; // where balls overlap, or one fills all of the column [1]
    return std::max(kLeast, 1 - soft) * std::pow(std::max(kLeast, 1 - stiff), -1 / kSeries);
}

constexpr int kParts = 24; ///< of a column in a volume: a jump of the modulus is seen to 4 % of the depth

glm::dvec3 partOf(const Column& column, int n)
{
    return column.top + column.depth * (n + 0.5) / kParts * column.inward;
}

/// Returns how many parts of a column have a value of their own.
int measuredParts(const SpatialLaw& volume, const Column& column)
{
    int parts = 0;
    for (int n = 0; n < kParts; ++n) parts += volume.volume->at(partOf(column, n)).at == VolumeGrid::At::inside;
    return parts;
}

/// Returns the modulus of a column over `modulus` [1], in series.
double inSeries(const Column& column, const TissueBelow& below, const EnergyAbove& above, const std::string& what)
{
    double compliance = 0;
    for (int n = 0; n < kParts; ++n) {
        const double share = above(column.depth * (n + 1) / kParts) - above(column.depth * n / kParts);
        compliance += share * below.modulus / below.volume->valueAt(partOf(column, n), what);
    }
    return 1 / compliance;
}

/// Returns the modulus of the tissue below a place over `modulus` [1]; where the outside is not known, on the side
/// where the volume has more values.
double volumeBelow(const Place& place, const TissueBelow& below, const EnergyAbove& above, const std::string& what)
{
    const SpatialLaw& volume = *below.volume;
    const Column      inside = place.columnAlong(-place.normal), other = place.columnAlong(place.normal);
    if (place.sided) return inSeries(inside, below, above, what);
    const int here = measuredParts(volume, inside), there = measuredParts(volume, other);
    if (here != there) return inSeries(here > there ? inside : other, below, above, what);
    constexpr double kSame = 1e-6; // what floats in a volume round, and more [1]
    const double     value = inSeries(inside, below, above, what);
    if (here > 0 && std::abs(inSeries(other, below, above, what) / value - 1) > kSame)
        throw volume.sideUnknown(place.point, what, "");
    return value;
}

} // namespace

std::vector<double> foundationShape(const SoftObject& object, const TissueBelow& below, double fingertip)
{
    constexpr double      kDecay = 0.45; // over the sheet and half the fingertip; see the header [1]
    constexpr std::size_t kPiece = 4096;
    PALP_EXPECT(below.depth > 0 && below.modulus > 0 && fingertip > 0, "tissue has a depth and a modulus");
    object.survey().expectSurface();
    const double      sheet = object.material().thickness;
    const EnergyAbove above(below.depth, kDecay / (sheet + fingertip / 2));
    std::vector<Ball> balls;
    for (std::size_t n = 0; n < below.nodules.size(); ++n) balls.push_back(ballOf(object, below, n));

    std::vector<double> shape(object.size());
    const auto          fill = [&](std::size_t begin, std::size_t end) {
        for (std::size_t n = begin; n < end; ++n) {
            const Place place{object.positions()[n], object.survey().normal(n), object.survey().sided(n), sheet,
                              below.depth};
            shape[n] = shapeBelow(place, balls, above);
            if (below.volume)
                shape[n] *= volumeBelow(place, below, above, "the tissue below point " + std::to_string(n));
        }
    };
    if (below.volume)
        fill(0, object.size()); // the first point without a value is named
    else
        inParallel(object.size(), kPiece, fill);
    return shape;
}

} // namespace palp
