// The three equal-area maps on the same cap of a sphere, all of one stiffness: a round poke should make a round dent.
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "engine/cloud/samples.h"
#include "engine/contact/contact.h"
#include "engine/core/quantity.h"
#include "engine/pipeline/deform.h"
#include "engine/plate/load.h"
#include "engine/tools/paper/dent_shape.h"
#include "engine/tools/paper/parts.h"
#include "engine/tools/plot/heat_map.h"
#include "engine/tools/plot/line_plot.h"

namespace palp::report {
namespace {

constexpr std::array<Map, 3> kMaps      = {Map::gallPeters, Map::lambertCylindrical, Map::lambertAzimuthal};
constexpr double             kRadius    = 50e-3;                 ///< of the sphere [m]
constexpr double             kHalfAngle = std::numbers::pi / 18; ///< of the cap: 10 degrees [rad]
constexpr double             kModulus   = 0.6e6;                 ///< [Pa]
constexpr double   kPoke = 0.1 * kRadius * kHalfAngle; ///< of the poke, round on the sphere: nearly a point [m]
constexpr Material kSkin{};

/// A dent of 1 N in one map, and the window in which it was computed.
struct Dent {
    Map         map;
    Chart       chart;
    PatchWindow window;
    NodeField   response; ///< [m/N]
    DentShape   shape;
};

Chart chartOf(Map map)
{
    return {map, {0, 0, kRadius}, {}, 1 / kRadius};
}

/// Returns the rectangle of the chart that the cap's square fills: from -10 to 10 degrees along either axis.
PatchWindow capIn(const Chart& chart, int cells)
{
    const auto at = [&](double alpha, double beta) {
        return *chart.project(
            kRadius * glm::dvec3(std::cos(beta) * std::sin(alpha), std::sin(beta), std::cos(beta) * std::cos(alpha)));
    };
    const double halfX = at(kHalfAngle, 0).x, halfZ = at(0, kHalfAngle).z;
    return {{cells, cells, 2 * halfX / cells, 2 * halfZ / cells}, {-halfX, -halfZ}};
}

/// Returns a poke of 1 N that is round on the sphere: (1 - (d/R)^2)^2. The maps keep areas, so pressures are unchanged.
NodeField roundPoke(const Chart& chart, const PatchWindow& window)
{
    NodeField load(window.grid);
    double    sum = 0;
    for (int i = 0; i < window.grid.nodesX(); ++i)
        for (int j = 0; j < window.grid.nodesZ(); ++j) {
            const double d = distanceOnObject(chart, {window.corner.x + i * window.grid.spacingX,
                                                      window.corner.z + j * window.grid.spacingZ}) /
                             kPoke;
            load(i, j) = d < 1 ? (1 - d * d) * (1 - d * d) * nodeArea(window.grid, i, j) : 0;
            sum += load(i, j);
        }
    for (double& force : load.values()) force /= sum;
    return load;
}

/// Computes the dent of the same cap of the object, clamped at its rim.
Dent dentOfCap(Map map, const ReportRun& run)
{
    constexpr double  kExact = 1e-6; // small, because maps are compared, not solvers [1]
    const Chart       chart  = chartOf(map);
    const PatchWindow window = capIn(chart, run.quick ? 64 : 128);
    const Plate       plate{window.grid, {}, kSkin.poissonRatio, 0, NodeField(window.grid, kSkin.rigidity(kModulus))};
    NodeField         w     = run.solver.solve(plate, roundPoke(chart, window), kExact).deflection;
    const auto        shape = dentShape(chart, window, w);
    return {map, chart, window, std::move(w), shape};
}

/// Computes the dent in the pipeline's own window: the same metres of chart in every map, and a footprint that is round
/// in the chart.
Dent dentOfWindow(Map map, const SoftObject& object, const ReportRun& run)
{
    PatchSettings settings{.window = 24e-3, .footprintRadius = 3e-3, .map = map};
    if (run.quick) settings.cells = 32;
    const Patch patch =
        deform(object, touchAt(object, {0, 0, kRadius}, glm::dvec3(0, 0, 1), 5e-3), settings, run.solver);
    return {map, patch.chart, patch.window, patch.response, dentShape(patch.chart, patch.window, patch.response)};
}

/// Draws the dent as it lies on the object: on the axes of the undistorted azimuthal map.
std::string onObject(const Dent& dent, double deepest)
{
    constexpr int     kCells = 96;
    const Chart       flat   = chartOf(Map::lambertAzimuthal);
    const PatchWindow window = capIn(flat, kCells);
    HeatMapSettings   settings;
    settings.title           = name(dent.map);
    settings.quantity        = "deflection per force";
    settings.unit            = "m/N";
    settings.nodeStyle       = NodeStyle::smooth;
    settings.grid            = window.grid;
    settings.corner          = window.corner;
    settings.contact         = ChartPoint{0, 0};
    settings.footprintRadius = kPoke;
    settings.range           = ValueRange{0, deepest};
    settings.markExtremes    = false;
    NodeField field(window.grid, std::nan(""));
    for (int i = 0; i <= kCells; ++i)
        for (int j = 0; j <= kCells; ++j) {
            const auto place =
                flat.lift({window.corner.x + i * window.grid.spacingX, window.corner.z + j * window.grid.spacingZ});
            const auto there = place ? dent.chart.project(*place) : std::nullopt;
            field(i, j)      = there && dent.window.holds(*there)
                                   ? interpolate(dent.window.grid, dent.response, there->x - dent.window.corner.x,
                                                 there->z - dent.window.corner.z)
                                   : 0;
        }
    return heatMapSvg(field, settings);
}

void addNumbers(Section& section, const char* where, const Dent& dent, const Dent& best)
{
    const std::string stem = std::string(where) + "/" + name(dent.map) + "/";
    section.numbers.push_back({stem + "depth", "m/N", {dent.shape.deepest}});
    section.numbers.push_back({stem + "depth_over_azimuthal", "1", {dent.shape.deepest / best.shape.deepest}});
    section.numbers.push_back({stem + "half_width_east", "m", {dent.shape.alongEast}});
    section.numbers.push_back({stem + "half_width_north", "m", {dent.shape.alongNorth}});
    section.numbers.push_back({stem + "elongation", "1", {dent.shape.elongation()}});
}

void addRow(Table& table, const char* where, const Dent& dent, const Dent& best)
{
    table.rows.push_back({where, name(dent.map), formatQuantity(dent.shape.deepest, "m/N"),
                          fixed(100 * dent.shape.deepest / best.shape.deepest, 1) + " %",
                          formatQuantity(dent.shape.alongEast, "m"), formatQuantity(dent.shape.alongNorth, "m"),
                          fixed(dent.shape.elongation(), 3)});
}

} // namespace

Section mapsPart(const ReportRun& run)
{
    const Sample&     sample = sampleNamed("hemisphere");
    const SoftObject  object(makeSample(sample, run.quick ? sample.points / 5 : sample.points, 1,
                                        SpatialLaw{.kind = SpatialLaw::Kind::constant, .from = kModulus}),
                             kSkin);
    std::vector<Dent> caps, windows;
    for (const Map map : kMaps) {
        run.step(caps.size(), kMaps.size());
        caps.push_back(dentOfCap(map, run));
        windows.push_back(dentOfWindow(map, object, run));
    }

    Section section{'f', "Three equal-area maps on the same cap", {}, {}, {}, {}, {}, {}};
    section.text = {
        "A sphere of radius 50 mm, all of one stiffness, is poked from above; a round poke must make a round "
        "dent. The maps all preserve areas. Gall-Peters shrinks by the square root of 2 one way and "
        "stretches by it the other, right under the finger, and the plate equation knows nothing of that.",
        "Same cap: the square from -10 to 10 degrees is clamped at its rim, and the poke is round on the "
        "sphere. Own patch window: the pipeline's, 24 mm of chart in every map, so that the plate is the same and "
        "with it the depth; on the object the dent is still oblong."};
    Table table{"Half widths are where the dent is half as deep, along the sphere. Elongation 1 is round.",
                {"patch window", "map", "depth per newton", "of the azimuthal", "half width east", "half width north",
                 "elongation"},
                {}};
    for (const Dent& dent : caps) {
        addRow(table, "same cap", dent, caps.back());
        addNumbers(section, "cap", dent, caps.back());
    }
    for (const Dent& dent : windows) {
        addRow(table, "own patch window", dent, windows.back());
        addNumbers(section, "window", dent, windows.back());
    }
    double deepest = 0;
    for (const Dent& dent : caps) deepest = std::max(deepest, dent.shape.deepest);
    for (const Dent& dent : caps)
        section.figures.push_back({std::string("The dent as it lies on the object, seen from above; the circle is the "
                                               "poke. Map: ") +
                                       name(dent.map) + ".",
                                   onObject(dent, deepest)});
    const DentShape &gall = caps.front().shape, &own = windows.front().shape;
    section.claims.push_back(
        {"The Gall-Peters map lays the surface flat for the plate equation because it preserves area.",
         "Same cap: the dent is " + fixed(gall.elongation(), 2) + " times as long as wide and " +
             fixed(100 * (1 - gall.deepest / caps.back().shape.deepest), 0) +
             " % too shallow. Own patch window: right depth, " + fixed(own.elongation(), 2) + " times as long as wide.",
         "the same plate, poke and sphere in three maps", Verdict::inPart,
         "It preserves area and distorts shape; Lambert's azimuthal map preserves area too and its dent is round "
         "(elongation " +
             fixed(caps.back().shape.elongation(), 3) + ")."});
    section.tables.push_back(std::move(table));
    return section;
}

} // namespace palp::report
