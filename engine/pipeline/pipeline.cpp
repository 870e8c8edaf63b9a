#include "engine/pipeline/pipeline.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <numbers>

#include <glm/geometric.hpp>

#include "engine/core/contract.h"
#include "engine/core/quantity.h"
#include "engine/plate/load.h"

namespace palp {
namespace {

class Stopwatch {
public:
    /// Milliseconds since construction or the last call.
    double lap()
    {
        const auto   now  = std::chrono::steady_clock::now();
        const double past = std::chrono::duration<double, std::milli>(now - last_).count();
        last_             = now;
        return past;
    }

private:
    std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
};

/// Radius of the ball that holds every point which can matter to the window [m].
///
/// Chord and chart distance agree in the azimuthal map. In the cylindrical ones
/// chord^2 = 2 r^2 (1 - cos a cos b) <= r^2 (a^2 + 2 sin^2 b), which is x^2 + 2 z^2 (Lambert) or 2 x^2 + z^2
/// (Gall-Peters).
double gatherRadius(const PatchSettings& settings, double spacing)
{
    const double half  = settings.window / 2;
    const double chord = settings.map == Map::lambertAzimuthal ? std::sqrt(2.0) * half : std::sqrt(3.0) * half;
    return chord + kernelReach(spacing, settings.window / settings.cells);
}

SphereFitResult fitTo(const PointCloud& cloud, const std::vector<std::uint32_t>& gathered)
{
    std::vector<glm::dvec3> points;
    points.reserve(gathered.size());
    for (std::uint32_t point : gathered) points.push_back(cloud.positions()[point]);
    return fitSphere(points);
}

std::string formatDirection(const glm::dvec3& d)
{
    char text[64];
    std::snprintf(text, sizeof text, "%.2f,%.2f,%.2f", d.x, d.y, d.z);
    return text;
}

std::string degrees(double cosine)
{
    return std::to_string(std::lround(std::acos(std::clamp(cosine, -1.0, 1.0)) * 180 / std::numbers::pi)) + " degrees";
}

/// Whether the cloud has another side behind the contact: points in a tube inwards, beyond the surface itself.
bool isClosedBehind(const PointCloud& cloud, const glm::dvec3& contact, const glm::dvec3& outward, double spacing)
{
    const double reach = 3 * spacing; // radius of the tube, and where it begins: some ten points across a surface [m]
    return std::any_of(cloud.positions().begin(), cloud.positions().end(), [&](const glm::dvec3& p) {
        const double depth = glm::dot(contact - p, outward);
        return depth > reach && glm::length(p + depth * outward - contact) < reach;
    });
}

/// The chart on the hand's side of the surface; sets patch.sideUnsure.
///
/// A known direction decides unless it runs along the surface. A guessed one decides only where it is within 60 degrees
/// of the normal; elsewhere the surface is an open sheet, which has no outside: there it is touched from the positive
/// side of the world axis nearest to its normal, so that all of a sheet is touched from one side.
Chart chartAt(const SoftObject& object, Patch& patch, const PatchSettings& settings,
              const std::optional<Frame>& carried)
{
    constexpr double kSteep = 0.17, kClear = 0.5; // cosines of 80 and 60 degrees [1]
    const Contact    contact = patch.contact;
    const auto       around  = [&](const glm::dvec3& side) {
        return Chart::around(patch.sphere.fit, contact.point, side, settings.map, carried);
    };
    const Chart  chart  = around(contact.outward);
    const auto&  normal = chart.frame.normal;
    const double cosine = glm::dot(normal, contact.outward);
    if (contact.outwardKnown && cosine < kSteep)
        throw Error("contact: the direction from which the finger comes is " + degrees(cosine) +
                    " from the surface's normal (" + formatDirection(normal) +
                    "), expected at most 80, or the side is not clear; try that normal or its opposite");
    if (contact.outwardKnown) return chart;
    patch.sideUnsure = !isClosedBehind(object.cloud(), contact.point, normal, object.spacing());
    if (!patch.sideUnsure || cosine >= kClear) return chart;
    int axis = 0;
    for (int k = 1; k < 3; ++k)
        if (std::abs(normal[k]) > std::abs(normal[axis])) axis = k;
    patch.contact.outward = {axis == 0, axis == 1, axis == 2};
    return around(patch.contact.outward);
}

/// Fills in the points of the near side and their places in the chart.
void project(const PointCloud& cloud, Patch& patch)
{
    for (std::uint32_t point : patch.gathered)
        if (const auto position = patch.chart.project(cloud.positions()[point])) {
            patch.points.push_back(point);
            patch.positions.push_back(*position);
        }
}

Resampled resample(const SoftObject& object, const Patch& patch, const PatchSettings& settings)
{
    std::vector<double> rigidities;
    rigidities.reserve(patch.points.size());
    for (std::uint32_t point : patch.points) rigidities.push_back(object.rigidity(point));
    return resampleRigidity(patch.window, patch.positions, rigidities, settings.sampling, object.spacing());
}

/// A window that holds next to nothing of the cloud would still give an answer, and a wrong unit is the usual reason.
void refuseIfEmpty(const Patch& patch, const PatchSettings& settings)
{
    constexpr std::ptrdiff_t kFewestPoints  = 9;   // 3 by 3: less is no field of rigidity [1]
    constexpr double         kMostUncovered = 0.9; // of the nodes: a corner of a sheet leaves three quarters [1]
    const auto               held           = std::count_if(patch.positions.begin(), patch.positions.end(),
                                                            [&](const ChartPoint& p) { return patch.window.holds(p); });
    const std::string        what           = "touch: the window of " + formatQuantity(settings.window, "m");
    const char* const        hint           = "; check --unit and --window";
    if (held < kFewestPoints)
        throw Error(what + " holds " + std::to_string(held) + " points of the cloud, which are " +
                    formatQuantity(patch.spacing, "m") + " apart; expected at least " + std::to_string(kFewestPoints) +
                    hint);
    if (double(patch.nodesWithoutPoint) > kMostUncovered * double(patch.plate.grid.nodes()))
        throw Error(what + " is almost empty: " + std::to_string(patch.nodesWithoutPoint) + " of its " +
                    std::to_string(patch.plate.grid.nodes()) + " grid nodes have no point of the cloud nearby" + hint);
}

/// Force of 1 N on the footprint about the middle node.
NodeField unitLoad(const PlateGrid& grid, const PatchSettings& settings)
{
    return footprintLoad(grid, 1, grid.sizeX() / 2, grid.sizeZ() / 2, settings.footprintRadius);
}

/// Width beyond which the edges of a window on a foundation are not felt [m]; empty without a foundation.
///
/// 10 characteristic lengths l = (D/k)^(1/4) hold the compliance to 0.1 %, and 12 where D varies by more than 10;
/// measured against windows of 24 l for warts. D is the geometric mean over the window.
std::optional<double> windowWanted(const Plate& plate)
{
    if (plate.foundation <= 0) return {};
    double logarithm = 0;
    for (double d : plate.rigidity.values()) logarithm += std::log(d);
    const double mean        = std::exp(logarithm / double(plate.rigidity.values().size()));
    const auto [least, most] = std::minmax_element(plate.rigidity.values().begin(), plate.rigidity.values().end());
    return (*most > 10 * *least ? 12 : 10) * std::pow(mean / plate.foundation, 0.25);
}

double largest(const NodeField& field)
{
    return *std::max_element(field.values().begin(), field.values().end());
}

/// Largest value on the sides of the grid.
double edgeDeflection(const NodeField& field)
{
    double    most  = 0;
    const int lastI = field.nodesX() - 1, lastJ = field.nodesZ() - 1;
    for (int i = 0; i <= lastI; ++i) most = std::max({most, field(i, 0), field(i, lastJ)});
    for (int j = 0; j <= lastJ; ++j) most = std::max({most, field(0, j), field(lastI, j)});
    return most;
}

/// Response of the points by bilinear interpolation; outside the window nothing moves.
std::vector<double> lift(const Patch& patch)
{
    std::vector<double> response;
    response.reserve(patch.positions.size());
    for (const ChartPoint& p : patch.positions)
        response.push_back(patch.window.holds(p) ? interpolate(patch.window.grid, patch.response,
                                                               p.x - patch.window.corner.x, p.z - patch.window.corner.z)
                                                 : 0.0);
    return response;
}

/// All that precedes the plate's bending.
Patch restPatch(const SoftObject& object, const Contact& contact, const PatchSettings& settings,
                const std::optional<Frame>& carried, Stopwatch& watch)
{
    Patch patch;

    // The neighbourhood (the paper's section 2.1) ...
    patch.contact = contact;
    object.index().gather(contact.point, gatherRadius(settings, object.spacing()), patch.gathered);
    patch.times.gather = watch.lap();

    // ... is close to a sphere (2.2, equations 1 to 3), ...
    patch.sphere    = fitTo(object.cloud(), patch.gathered);
    patch.times.fit = watch.lap();
    if (!patch.sphere.usable()) return patch;

    // ... which an equal-area map lays flat about the contact (2.3, equation 4), ...
    patch.chart = chartAt(object, patch, settings, carried);
    project(object.cloud(), patch);
    patch.times.project = watch.lap();

    // ... where a grid takes over the rigidity of the points (2.4) ...
    patch.window              = PatchWindow::square(settings.window, settings.cells);
    const Resampled resampled = resample(object, patch, settings);
    patch.nodesWithoutPoint   = resampled.nodesWithoutPoint;
    patch.plate               = {patch.window.grid, settings.edges, object.material().poissonRatio, settings.foundation,
                                 resampled.rigidity};
    patch.spacing             = object.spacing();
    patch.thickness           = object.material().thickness;
    refuseIfEmpty(patch, settings);
    patch.times.resample = watch.lap();
    return patch;
}

/// What follows from the bent plate: it moves the points (2.6, equation 9), and with the contact is what the hand
/// feels.
void bend(Patch& patch, const SoftObject& object, const PatchSettings& settings, PlateSolution solution,
          double compliance, Stopwatch& watch)
{
    patch.response      = std::move(solution.deflection);
    patch.report        = std::move(solution.report);
    patch.compliance    = compliance;
    patch.times.prepare = patch.report.setUpMilliseconds;
    patch.times.solve   = watch.lap() - patch.times.prepare;

    patch.pointResponse    = lift(patch);
    const int    middle    = settings.cells / 2;
    const double modulus   = object.material().modulus(patch.plate.rigidity(middle, middle));
    patch.contactStiffness = contactStiffness(modulus, settings.footprintRadius, object.material().thickness);
    patch.feltStiffness    = feltStiffness(settings.forceLaw, patch.contactStiffness, patch.compliance);
    patch.times.lift       = watch.lap();
}

} // namespace

Patch deform(const SoftObject& object, const Contact& contact, const PatchSettings& settings)
{
    PlateSolver reference("reference");
    return deform(object, contact, settings, reference);
}

Patch deform(const SoftObject& object, const Contact& contact, const PatchSettings& settings, PlateSolver& device,
             const std::optional<Frame>& carried)
{
    Stopwatch watch;
    Patch     patch = restPatch(object, contact, settings, carried, watch);
    if (!patch.deformed()) return patch;

    // ... and bends as a plate under a unit force (2.5, equations 6 to 8).
    const NodeField load     = unitLoad(patch.plate.grid, settings);
    PlateSolution   solution = device.solve(patch.plate, load, settings.tolerance);
    const double    softness = work(load, solution.deflection);
    bend(patch, object, settings, std::move(solution), softness, watch);
    return patch;
}

FootprintLattice footprintLattice(const SoftObject& object, const PatchSettings& settings, int side,
                                  PlateSolver& device)
{
    double logarithm = 0;
    for (std::size_t point = 0; point < object.size(); ++point) logarithm += std::log(object.rigidity(point));
    const PlateGrid grid = PatchWindow::square(settings.window, settings.cells).grid;
    const Plate     homogeneous{grid, settings.edges, object.material().poissonRatio, settings.foundation,
                            NodeField(grid, std::exp(logarithm / double(object.size())))};
    const double    perRigidity =
        contactStiffness(object.material().modulus(1), settings.footprintRadius, object.material().thickness);
    return footprintLattice(homogeneous, {settings.footprintRadius, side, perRigidity}, device, settings.tolerance);
}

PatchWithTable deformWithTable(const SoftObject& object, const Contact& contact, const PatchSettings& settings,
                               const FootprintLattice& lattice, PlateSolver& device,
                               const std::optional<Frame>& carried)
{
    Stopwatch      watch;
    PatchWithTable result{restPatch(object, contact, settings, carried, watch), {}};
    Patch&         patch = result.patch;
    if (!patch.deformed()) return result;
    TableSolution solved = solveTable(patch.plate, lattice, device, settings.tolerance);
    result.table         = solved.table;
    result.table->chart  = patch.chart;
    bend(patch, object, settings, std::move(solved.middle), solved.compliance, watch);
    return result;
}

std::vector<double> deflections(const PointCloud& cloud, const Patch& patch, double force)
{
    std::vector<double> result(cloud.size(), 0.0);
    for (std::size_t n = 0; n < patch.points.size(); ++n) result[patch.points[n]] = force * patch.pointResponse[n];
    return result;
}

std::vector<glm::dvec3> displaced(const PointCloud& cloud, const Patch& patch, double force)
{
    std::vector<glm::dvec3> result(cloud.positions().begin(), cloud.positions().end());
    for (std::size_t n = 0; n < patch.points.size(); ++n)
        result[patch.points[n]] += force * patch.pointResponse[n] * patch.forceDirection();
    return result;
}

std::optional<double> discretisationError(const Patch& patch, const PatchSettings& settings, PlateSolver& device)
{
    const PlateGrid& fine = patch.plate.grid;
    if (!patch.deformed() || settings.cells % 4 != 0 || settings.footprintRadius < 2 * fine.spacingX) return {};
    Plate coarse    = patch.plate;
    coarse.grid     = {fine.cellsX / 2, fine.cellsZ / 2, 2 * fine.spacingX, 2 * fine.spacingZ};
    coarse.rigidity = NodeField(coarse.grid);
    for (int i = 0; i < coarse.grid.nodesX(); ++i)
        for (int j = 0; j < coarse.grid.nodesZ(); ++j) coarse.rigidity(i, j) = patch.plate.rigidity(2 * i, 2 * j);
    if (whyUnsolvable(coarse)) return {};
    const NodeField load       = unitLoad(coarse.grid, settings);
    const double    compliance = work(load, device.solve(coarse, load, settings.tolerance).deflection);
    return std::abs(compliance - patch.compliance) / 3 / patch.compliance;
}

std::vector<std::string> warnings(const Patch& patch, const PatchSettings& settings, double force)
{
    std::vector<std::string> result;
    if (!patch.deformed()) return result;
    if (!patch.report.converged)
        result.push_back("the plate's solution is not as good as asked for: its error is about " +
                         formatNumber(patch.report.errorEstimate.value_or(1)) +
                         " or more, relative; try fewer cells or less contrast");
    const double deepest = std::abs(force) * largest(patch.response);
    const double half    = patch.thickness / 2;
    if (deepest > half)
        result.push_back("the deflection of " + formatQuantity(deepest, "m") + " exceeds half the thickness (" +
                         formatQuantity(half, "m") +
                         "): Kirchhoff plate theory does not hold here; press with less than " +
                         formatQuantity(std::abs(force) * half / deepest, "N"));
    if (patch.nodesWithoutPoint > 0)
        result.push_back(
            std::to_string(patch.nodesWithoutPoint) + " of " + std::to_string(patch.plate.grid.nodes()) +
            " grid nodes have no point nearby (a hole, a border or the far side): they carry the rigidity of "
            "the nearest point");
    if (settings.footprintRadius < 2 * patch.spacing)
        result.push_back("the points are " + formatQuantity(patch.spacing, "m") +
                         " apart and the footprint's radius is " + formatQuantity(settings.footprintRadius, "m") +
                         ": rigidity between the points is interpolated, finer detail is not in the data");
    if (patch.sideUnsure)
        result.push_back("the cloud has no other side behind this place, so the finger's side is a guess (" +
                         formatDirection(patch.chart.frame.normal) + "); set --from");
    constexpr double kFarOffSphere =
        0.05; // of the window: surfaces then slope by a tenth and more against the sphere [1]
    if (patch.sphere.fit.misfit > kFarOffSphere * settings.window)
        result.push_back("the points lie " + formatQuantity(patch.sphere.fit.misfit, "m") +
                         " (rms) off the fitted sphere, more than 5 % of the window: a smaller window follows the "
                         "surface better");
    if (const double moving = edgeDeflection(patch.response) / largest(patch.response); moving > 0.02)
        result.push_back("the window's edge moves by " + std::to_string(std::lround(100 * moving)) +
                         " % of the largest deflection and nothing moves beyond it: the deformed cloud is torn there");
    if (settings.foundation == 0)
        result.push_back("there is no foundation, so the size of the window decides: compliance grows with its area");
    if (const auto width = windowWanted(patch.plate); width && settings.window < *width)
        result.push_back("the window of " + formatQuantity(settings.window, "m") + " is narrower than the " +
                         formatQuantity(*width, "m") +
                         " that this rigidity and foundation ask for: its edges are felt");
    return result;
}

PatchSettings withPreset(PatchSettings settings, Preset preset)
{
    const bool paper  = preset == Preset::paper;
    settings.map      = paper ? Map::gallPeters : Map::lambertAzimuthal;
    settings.sampling = paper ? Resampling::nearest : Resampling::logMean;
    settings.forceLaw = paper ? ForceLaw::paper : ForceLaw::series;
    settings.edges    = {};
    if (paper) settings.foundation = 0;
    return settings;
}

std::vector<std::string> differencesFromPaper(const PatchSettings& settings)
{
    std::vector<std::string> lines;
    if (settings.map != Map::gallPeters)
        lines.push_back(std::string("map ") + name(settings.map) +
                        ", the paper's is gall-peters: it stretches by sqrt 2 at the contact");
    if (settings.sampling != Resampling::nearest)
        lines.push_back(std::string("rigidity by ") + name(settings.sampling) +
                        ", the paper's by nearest: it jitters while the grid slides");
    if (settings.edges != PlateEdges{}) lines.push_back("edges other than clamped, the paper's are clamped");
    if (settings.foundation != 0)
        lines.push_back("elastic foundation of " + formatQuantity(settings.foundation, "Pa/m") +
                        ", the paper has none: its window is felt");
    if (settings.forceLaw != ForceLaw::paper)
        lines.push_back(std::string("force law ") + name(settings.forceLaw) +
                        ", the paper's is E A/h: the plate is not felt");
    return lines;
}

} // namespace palp
