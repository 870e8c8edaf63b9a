#include "engine/chart/curvature_field.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <iterator>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Dense>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "engine/chart/nearest_map.h"
#include "engine/core/contract.h"

namespace palp {
namespace {

constexpr int kLattice = 17, kMostLattice = 97; ///< places along a side of the window, least and most; see sideFor()
constexpr int kSurvey = 9;                      ///< the same for those from which the radius follows

constexpr double kLeastSpacings = 5;     ///< radius of a fit, at least [spacings]: some 80 points
constexpr double kSurveyError   = 1.2;   ///< that of the survey [1/m]: a twentieth of what a fingertip's surface has
constexpr double kSurveyShare   = 0.1;   ///< radius of the survey's fits, at least, over the window [1]: some 200 fits
constexpr double kWantedError   = 0.025; ///< that of the fits over the typical curvature [1]
constexpr double kFaces         = 0.26;  ///< cosine of 75 degrees: points that face farther away lie around an edge [1]

using Vector6 = Eigen::Matrix<double, 6, 1>;
using Matrix6 = Eigen::Matrix<double, 6, 6>;

/// A point in the frame of a fit: h ~ q0 + q1 a + q2 b + (q3 a^2 + 2 q4 a b + q5 b^2) / 2, in radii.
struct Sighting {
    Vector6 row;
    double  height = 0, share = 0; ///< [radii], [1]
};

/// Looks at a sheet from its normal at a place.
std::vector<Sighting> sightingsOf(const SurfaceSheet& sheet, std::span<const std::size_t> near,
                                  const glm::dvec3& centre, const Frame& axes, double radius)
{
    std::vector<Sighting> seen;
    seen.reserve(near.size());
    for (const std::size_t n : near) {
        const glm::dvec3 d = (sheet.places[n] - centre) / radius;
        const double     a = glm::dot(d, axes.east), b = glm::dot(d, axes.north), h = glm::dot(d, axes.normal);
        const double     rest = 1 - a * a - b * b;
        if (rest <= 0 || std::abs(h) > 1 || glm::dot(sheet.normals[n], axes.normal) < kFaces) continue;
        seen.push_back({{1, a, b, a * a / 2, a * b, b * b / 2}, h, rest * rest});
    }
    return seen;
}

struct Quadric {
    Vector6 of;       ///< coefficients
    double  sure = 0; ///< see LocalCurvature [1]
};

/// Returns the quadric of weighted points; empty if they do not determine one.
std::optional<Quadric> quadricOf(std::span<const Sighting> seen, std::span<const double> weights)
{
    constexpr double kDetermined = 1e-4, kFull = 0.02; // least over largest pivot [1]: of a full disc; half has 0.002
    Matrix6          normal = Matrix6::Zero();
    Vector6          right  = Vector6::Zero();
    for (std::size_t n = 0; n < seen.size(); ++n) {
        const double weight = seen[n].share * weights[n];
        normal.noalias() += (weight * seen[n].row) * seen[n].row.transpose();
        right += weight * seen[n].height * seen[n].row;
    }
    const Eigen::LDLT<Matrix6> factors(normal);
    const Vector6              pivots     = factors.vectorD();
    const double               determined = pivots.minCoeff() / pivots.maxCoeff();
    if (!(determined > kDetermined)) return {};
    return Quadric{factors.solve(right), std::min(1.0, determined / kFull)};
}

double medianOf(std::vector<double>& values)
{
    const auto middle = values.begin() + std::ptrdiff_t(values.size() / 2);
    std::ranges::nth_element(values, middle);
    return *middle;
}

/// Fits twice more, with less weight for points that lie far from the fit.
/// \source Beaton & Tukey 1974, the biweight, with 4.7 standard deviations
std::optional<Quadric> robustQuadricOf(std::span<const Sighting> seen)
{
    constexpr double    kFar = 4.7, kNormal = 1.48, kExact = 1e-12; // [1]; [1]; [radii]
    constexpr int       kReweights = 2;
    std::vector<double> weights(seen.size(), 1.0), apart(seen.size());
    auto                fit = quadricOf(seen, weights);
    for (int turn = 0; fit && turn < kReweights; ++turn) {
        for (std::size_t n = 0; n < seen.size(); ++n) apart[n] = std::abs(seen[n].height - seen[n].row.dot(fit->of));
        std::vector<double> sorted = apart;
        const double        far    = kFar * kNormal * medianOf(sorted);
        if (far < kExact) break;
        for (std::size_t n = 0; n < seen.size(); ++n) {
            const double rest = std::max(0.0, 1 - apart[n] * apart[n] / (far * far));
            weights[n]        = rest * rest;
        }
        fit = quadricOf(seen, weights);
    }
    return fit;
}

glm::dmat3 product(const glm::dvec3& a, const glm::dvec3& b)
{
    return glm::outerProduct(a, b);
}

/// Returns the second fundamental form of a fit whose slopes are small.
LocalCurvature curvatureOf(const Quadric& quadric, const Frame& axes, double radius)
{
    const Vector6&   fit   = quadric.of;
    const double     slope = std::sqrt(1 + fit[1] * fit[1] + fit[2] * fit[2]);
    const glm::dvec3 e = axes.east, n = axes.north;
    LocalCurvature   result;
    result.normal = glm::normalize(axes.normal - fit[1] * e - fit[2] * n);
    result.tensor = (fit[3] * product(e, e) + fit[4] * (product(e, n) + product(n, e)) + fit[5] * product(n, n)) *
                    (-1 / (radius * slope));
    result.sure = quadric.sure;
    return result;
}

/// Returns the points of a sheet within a distance.
std::vector<std::size_t> within(std::span<const glm::dvec3> places, const glm::dvec3& centre, double distance)
{
    std::vector<std::size_t> near;
    for (std::size_t n = 0; n < places.size(); ++n) {
        const glm::dvec3 d = places[n] - centre;
        if (glm::dot(d, d) < distance * distance) near.push_back(n);
    }
    return near;
}

/// Returns the mean normal of the points about a place, weighted as in a fit; empty if they have none.
std::optional<glm::dvec3> meanNormal(const SurfaceSheet& sheet, std::span<const std::size_t> near,
                                     const glm::dvec3& centre, double radius)
{
    glm::dvec3 sum{};
    for (const std::size_t n : near) {
        const glm::dvec3 d    = (sheet.places[n] - centre) / radius;
        const double     rest = std::max(0.0, 1 - glm::dot(d, d));
        sum += rest * rest * sheet.normals[n];
    }
    const double length = glm::length(sum);
    if (!(length > 0)) return {};
    return sum / length;
}

/// The tensor in a chart's axes [1/m].
struct ChartTensor {
    double x = 0, z = 0, xz = 0;

    /// Returns the principal curvature that is larger by size [1/m].
    [[nodiscard]] double largest() const noexcept { return std::abs(x + z) / 2 + std::hypot((x - z) / 2, xz); }
};

ChartTensor inChart(const LocalCurvature& here, const Frame& frame)
{
    const Frame carried = frame.carriedTo(here.normal);
    return {glm::dot(carried.east, here.tensor * carried.east), glm::dot(carried.north, here.tensor * carried.north),
            glm::dot(carried.east, here.tensor * carried.north)};
}

/// A site in the chart.
struct Sited {
    ChartPoint  place; ///< [m]
    ChartTensor tensor;
    double      share = 0; ///< [1]
};

/// Returns the tensor at a place by linear regression over the sites within a radius; empty where there are none.
std::optional<ChartTensor> regressionAt(const ChartPoint& place, std::span<const Sited> sites, double radius)
{
    constexpr double kFlatter = 0.02; // of the weight, against slopes that hardly any site determines [1]
    Eigen::Matrix3d  normal   = Eigen::Matrix3d::Zero();
    Eigen::Matrix3d  right    = Eigen::Matrix3d::Zero();
    for (const Sited& site : sites) {
        const double x = (site.place.x - place.x) / radius, z = (site.place.z - place.z) / radius;
        const double squared = x * x + z * z;
        if (squared >= 1) continue;
        const double          weight = site.share * (1 - squared) * (1 - squared);
        const Eigen::Vector3d row(1, x, z);
        normal += weight * row * row.transpose();
        right += weight * row * Eigen::RowVector3d(site.tensor.x, site.tensor.z, site.tensor.xz);
    }
    if (!(normal(0, 0) > 0)) return {};
    normal(1, 1) += kFlatter * normal(0, 0);
    normal(2, 2) += kFlatter * normal(0, 0);
    const Eigen::RowVector3d found = normal.ldlt().solve(right).row(0);
    return ChartTensor{found[0], found[1], found[2]};
}

using Lattice = std::vector<ChartTensor>; ///< row by row along z

/// What is left of the tensors of sites whose fits are noisy.
struct Quietened {
    ChartTensor mean{}, kept{}; ///< of the sites, and without those principal curvatures that noise may have made
    double      varying = 1;    ///< share that is kept of what a tensor differs from the mean by [1]

    [[nodiscard]] ChartTensor operator()(const ChartTensor& t) const noexcept
    {
        return {kept.x + varying * (t.x - mean.x), kept.z + varying * (t.z - mean.z),
                kept.xz + varying * (t.xz - mean.xz)};
    }
};

/// Returns the tensor without the principal curvatures that are below 1.5 times an error, and less of those below 3
/// times.
ChartTensor withoutNoise(const ChartTensor& t, double error)
{
    const double mean = (t.x + t.z) / 2, half = (t.x - t.z) / 2, apart = std::hypot(half, t.xz);
    const auto   kept = [&](double k) {
        const double sure = std::clamp(std::abs(k) / (1.5 * error) - 1, 0.0, 1.0);
        return k * sure * sure * (3 - 2 * sure);
    };
    const double larger = kept(mean + apart), smaller = kept(mean - apart);
    if (!(apart > 0)) return {larger, larger, 0};
    const double m = (larger + smaller) / 2, share = (larger - smaller) / 2 / apart;
    return {m + share * half, m - share * half, share * t.xz};
}

/// Takes noise off tensors. A panel that is held along one side bends without stretching: a second curvature that noise
/// made, or one that differs from place to place, makes it several times as stiff. So where the tensors of the sites
/// scatter by no more than noise explains, their mean is taken, and what varies more is kept in that measure.
/// \param error  that noise makes of a fit, the root of its mean square [1/m]
Quietened quietened(std::span<const Sited> sites, double error)
{
    constexpr double     kSitesOfAFit = 5; // that share their points [1]
    constexpr double     kBorders     = 2; // scatter of fits of all places over that of full discs, squares [1]
    constexpr std::array parts{&ChartTensor::x, &ChartTensor::z, &ChartTensor::xz};
    Quietened            result;
    if (!(error > 0)) return result;
    double sum = 0, squares = 0;
    for (const Sited& site : sites) {
        sum += site.share;
        for (double ChartTensor::*part : parts) result.mean.*part += site.share * site.tensor.*part;
    }
    for (double ChartTensor::*part : parts) result.mean.*part /= sum;
    for (const Sited& site : sites) {
        const double x = site.tensor.x - result.mean.x, z = site.tensor.z - result.mean.z;
        const double xz = site.tensor.xz - result.mean.xz;
        squares += site.share / sum * (x * x + z * z + 2 * xz * xz);
    }
    const double fits = std::max(1.0, double(sites.size()) / kSitesOfAFit);
    result.varying    = squares > 0 ? std::max(0.0, 1 - kBorders * error * error / squares) : 0;
    result.kept       = withoutNoise(result.mean, error / std::sqrt(fits));
    return result;
}

constexpr double kAround =
    1.0; ///< radius of the regression over that of the fits [1]: some ten sites, three of a survey

/// Finds the curvature by the fits of one rung on a lattice over the window; empty without any.
/// \param error  that noise makes of a fit [1/m]; 0: it is left
Lattice latticeOf(const PatchWindow& window, int side, const Frame& frame, const CurvatureSites& sitesOf, int rung,
                  FitsFor what, double error)
{
    std::vector<Sited> sites;
    for (const CurvatureSite& site : sitesOf(rung, what)) // errors of fits go as 1 / sure
        sites.push_back({site.place, inChart(site.here, frame), site.share * site.here.sure * site.here.sure});
    if (sites.empty()) return {};
    const Quietened quiet  = quietened(sites, error);
    const double    radius = kAround * rungRadius(rung);
    const PlateGrid places{side - 1, side - 1, window.grid.sizeX() / (side - 1), window.grid.sizeZ() / (side - 1)};
    std::vector<ChartPoint> ofSites;
    for (const Sited& site : sites) ofSites.push_back(site.place);
    const std::vector<std::uint32_t> nearest = nearestPoint(places, window.corner, ofSites);
    Lattice                          lattice;
    std::vector<Sited>               beside; // of a row
    for (int i = 0; i < side; ++i) {
        const double x = window.corner.x + window.grid.sizeX() * i / (side - 1);
        beside.clear();
        std::ranges::copy_if(sites, std::back_inserter(beside),
                             [&](const Sited& site) { return std::abs(site.place.x - x) < radius; });
        for (int j = 0; j < side; ++j) {
            const ChartPoint place{x, window.corner.z + window.grid.sizeZ() * j / (side - 1)};
            const auto       found = regressionAt(place, beside, radius);
            lattice.push_back(quiet(found ? *found : sites[nearest[lattice.size()]].tensor));
        }
    }
    return lattice;
}

/// Returns how many places of a lattice lie along a side of the window: 2.5 mm apart in 40 mm. Where that is farther
/// than the radius of the fits, as of an object that the window spans, half of it: in a window of 200 mm lumps of 6 mm
/// were smeared, and felt 6 to 43 % too stiff as the object was turned.
int sideFor(const PatchWindow& window, double radius)
{
    const double size = std::max(window.grid.sizeX(), window.grid.sizeZ());
    if (size <= (kLattice - 1) * radius) return kLattice;
    return int(std::min(std::ceil(2 * size / radius) + 1, double(kMostLattice))); // a ratio may be no int
}

constexpr double kRung = 1e-3, kRungs = 1.3; ///< the first radius [m]; their ratio [1]

/// Finds the curvature with fits of a radius, between those of two rungs; empty where there are none.
Lattice latticeBetween(const PatchWindow& window, int side, const Frame& frame, const CurvatureSites& sites,
                       double radius, const CurvatureSettings& settings)
{
    const double rung  = rungOf(radius);
    const int    below = int(std::floor(rung));
    const auto   of    = [&](int on) {
        const double error = kFitNoiseError * settings.noise * settings.spacing / std::pow(rungRadius(on), 3);
        return latticeOf(window, side, frame, sites, on, FitsFor::field, error);
    };
    Lattice       lattice = of(below);
    const Lattice wider   = of(below + 1);
    if (lattice.empty() || wider.empty()) return wider;
    for (std::size_t n = 0; n < lattice.size(); ++n)
        for (double ChartTensor::*part : {&ChartTensor::x, &ChartTensor::z, &ChartTensor::xz})
            lattice[n].*part = std::lerp(lattice[n].*part, wider[n].*part, rung - below);
    return lattice;
}

/// What a survey finds in the window [1/m].
struct Bend {
    double typical = 0, largest = 0;
};

Bend bendOf(const Lattice& lattice, double noise)
{
    double squares = 0, largest = 0;
    for (const ChartTensor& here : lattice) {
        squares += here.largest() * here.largest();
        largest = std::max(largest, here.largest());
    }
    constexpr double kFlat = 1e-6; // a plane, whatever the object [1/m]
    return {std::sqrt(std::max(kFlat * kFlat, squares / double(lattice.size()) - noise * noise)), largest};
}

/// Returns the radius of all fits [m], see curvatureField(); empty where the points determine no quadric.
std::optional<double> radiusFor(const PatchWindow& window, const Frame& frame, const CurvatureSites& sites,
                                const CurvatureSettings& settings)
{
    const double least  = kLeastSpacings * settings.spacing;
    const double most   = std::max(least, settings.mostRadius);
    const double cube   = kFitNoiseError * settings.noise * settings.spacing;
    const double coarse = std::max(least, kSurveyShare * std::max(window.grid.sizeX(), window.grid.sizeZ()));
    const double radius = std::clamp(std::cbrt(cube / kSurveyError), coarse, std::max(coarse, most));
    int          rung   = int(std::lround(rungOf(radius)));
    const auto   fits   = [&](int of) { return latticeOf(window, kSurvey, frame, sites, of, FitsFor::survey, 0); };
    Lattice      survey = fits(rung);
    while (survey.empty() && rungRadius(rung - 2) > least) survey = fits(rung -= 2); // of a narrow object
    if (survey.empty()) return {};
    const Bend   bend      = bendOf(survey, cube / std::pow(rungRadius(rung), 3));
    const double felt      = settings.lengthRoot / std::sqrt(bend.typical);
    const double quiet     = std::cbrt(cube / (kWantedError * bend.typical));
    const double following = 0.5 / std::max(bend.largest, bend.typical);
    const double wanted    = std::min(std::max(felt, quiet), following);
    return std::clamp(wanted, least, most);
}

/// Returns the curvature that a fiftieth of the surface exceeds [1/m], without what noise makes of it.
/// \param error  that noise makes of a fit [1/m]
double sharpOf(const std::vector<CurvatureSite>& sites, const Frame& frame, double error)
{
    constexpr double kRest = 0.02, kDeviations = 3; // [1]; a fiftieth of normal numbers exceeds 2.3 of them
    std::vector<std::pair<double, double>> found;   // curvature [1/m], share of the surface [1]
    double                                 all = 0;
    for (const CurvatureSite& site : sites) {
        const double share = site.share * site.here.sure * site.here.sure;
        found.emplace_back(inChart(site.here, frame).largest(), share);
        all += share;
    }
    std::ranges::sort(found, std::greater());
    double left = kRest * all, sharp = 0;
    for (const auto& [curvature, share] : found) {
        sharp = curvature;
        if ((left -= share) < 0) break;
    }
    return std::sqrt(std::max(0.0, sharp * sharp - kDeviations * kDeviations * error * error));
}

/// Returns the radius of fits for what is most curved in a wide window [m]; infinite where nothing is curved more than
/// noise says.
double radiusForSharp(const Frame& frame, const CurvatureSites& sites, const CurvatureSettings& settings)
{
    constexpr double kWantedOfSharp = 0.06; // error over that curvature [1]
    const double     cube           = kFitNoiseError * settings.noise * settings.spacing;
    const double     least          = std::max(kLeastSpacings * settings.spacing, std::cbrt(cube / kSurveyError));
    const int        rung           = int(std::ceil(rungOf(least)));
    const double     sharp          = sharpOf(sites(rung, FitsFor::field), frame, cube / std::pow(rungRadius(rung), 3));
    if (!(sharp > 0)) return std::numeric_limits<double>::infinity();
    return std::max({least, settings.lengthRoot / std::sqrt(sharp), std::cbrt(cube / (kWantedOfSharp * sharp))});
}

/// A place along one axis of the lattice: weights of four nodes.
struct Along {
    int                   first = 0;
    std::array<double, 4> weights{};
};

/// Returns the weights of cubic interpolation through values and central slopes; at the ends the curve goes on
/// straight.
/// \param t  place along the lattice, 0 to side - 1 [lattice spacings]
Along alongAt(double t, int side)
{
    const int    before = std::clamp(int(t), 0, side - 2);
    const double u = t - before, v = 1 - u;
    Along        result{std::clamp(before - 1, 0, side - 4), {}};
    const auto   add = [&](int node, double weight) { result.weights.at(std::size_t(node - result.first)) += weight; };
    const auto   put = [&](int node, double weight) {
        if (node < 0) {
            add(0, 2 * weight);
            add(1, -weight);
        } else if (node >= side) {
            add(side - 1, 2 * weight);
            add(side - 2, -weight);
        } else {
            add(node, weight);
        }
    };
    put(before - 1, -0.5 * u * v * v);
    put(before, v * (1 + u - 1.5 * u * u));
    put(before + 1, u * (1 + v - 1.5 * v * v));
    put(before + 2, -0.5 * v * u * u);
    return result;
}

CurvatureField interpolated(const PatchWindow& window, const std::vector<ChartTensor>& lattice, int side)
{
    CurvatureField field{NodeField(window.grid), NodeField(window.grid), NodeField(window.grid)};
    const int      cellsX = window.grid.cellsX, cellsZ = window.grid.cellsZ;
    for (int i = 0; i <= cellsX; ++i)
        for (int j = 0; j <= cellsZ; ++j) {
            const Along x = alongAt(double(i) * (side - 1) / cellsX, side);
            const Along z = alongAt(double(j) * (side - 1) / cellsZ, side);
            for (std::size_t m = 0; m < 4; ++m)
                for (std::size_t n = 0; n < 4; ++n) {
                    const double       weight = x.weights[m] * z.weights[n];
                    const std::size_t  row    = (std::size_t(x.first) + m) * std::size_t(side);
                    const ChartTensor& here   = lattice[row + std::size_t(z.first) + n];
                    field.x(i, j) += weight * here.x;
                    field.z(i, j) += weight * here.z;
                    field.xz(i, j) += weight * here.xz;
                }
        }
    return field;
}

/// Returns a frame carried to the fitted normal next to its own place. A sphere that is fitted beside the border of a
/// tube leans by up to ten degrees, and axes that were carried from there to the tube's far ends came out turned by
/// five.
Frame uprightAt(const Frame& frame, const std::vector<CurvatureSite>& sites)
{
    const auto nearest = std::ranges::min_element(
        sites, {}, [](const CurvatureSite& site) { return std::hypot(site.place.x, site.place.z); });
    return nearest == sites.end() ? frame : frame.carriedTo(nearest->here.normal);
}

} // namespace

double rungRadius(int rung) noexcept
{
    return kRung * std::pow(kRungs, rung);
}

double rungOf(double radius) noexcept
{
    return std::log(radius / kRung) / std::log(kRungs);
}

// Heights less K(a, a) |K a|^2 / 8, which a sphere and a cylinder have beyond a quadric, were tried: fits of up to 0.9
// of their radius are right to 1 % then, in place of 17 and 10 % too strong. But at the tip of an ellipsoid, whose
// curvature falls away from it, that error makes up for part of the other one: of 1500 points (60, 45, 35 mm) it went
// from -5 to -13 %.
std::optional<LocalCurvature> fitCurvature(const SurfaceSheet& sheet, const glm::dvec3& centre, double radius)
{
    constexpr double kDiagonal = 1.42; // a point within the radius along the surface and in height is within this [1]
    constexpr int    kTurns    = 2;
    PALP_EXPECT(sheet.places.size() == sheet.normals.size(), std::to_string(sheet.places.size()) + " places and " +
                                                                 std::to_string(sheet.normals.size()) + " normals");
    const auto near  = within(sheet.places, centre, kDiagonal * radius);
    const auto first = meanNormal(sheet, near, centre, radius);
    if (!first) return {};
    LocalCurvature result{*first};
    for (int turn = 0; turn < kTurns; ++turn) {
        constexpr std::size_t kFewest = 12; // points for six unknowns
        const Frame           axes    = Frame::about(result.normal);
        const auto            seen    = sightingsOf(sheet, near, centre, axes, radius);
        if (seen.size() < kFewest) return {};
        const std::vector<double> alike(seen.size(), 1.0);
        const auto                fit = turn + 1 < kTurns ? quadricOf(seen, alike) : robustQuadricOf(seen);
        if (!fit) return {};
        result = curvatureOf(*fit, axes, radius);
    }
    return result;
}

std::optional<CurvatureField> curvatureField(const PatchWindow& window, const Frame& of, const CurvatureSites& sites,
                                             const CurvatureSettings& settings)
{
    PALP_EXPECT(settings.spacing > 0, std::to_string(settings.spacing) + " m between the points");
    auto wanted = radiusFor(window, of, sites, settings);
    if (!wanted) return {};
    if (settings.isWide) wanted = std::min(*wanted, radiusForSharp(of, sites, settings));
    const Frame frame = settings.isWide ? uprightAt(of, sites(int(std::floor(rungOf(*wanted))), FitsFor::field)) : of;
    // Of what is hardly curved fits would be as wide as may be, and wider than a narrow object, which then decides
    // nothing.
    for (double radius = *wanted;; radius /= 2) {
        const int     side    = sideFor(window, radius);
        const Lattice lattice = latticeBetween(window, side, frame, sites, radius, settings);
        if (lattice.empty() && radius > kLeastSpacings * settings.spacing) continue;
        if (lattice.empty()) return {};
        CurvatureField field = interpolated(window, lattice, side);
        field.radius         = radius;
        return field;
    }
}

} // namespace palp
