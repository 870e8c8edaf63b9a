// What flatness costs: objects that are curved, bent as a plate, as a shell, and whole in finite elements.
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "engine/cloud/samples.h"
#include "engine/contact/contact.h"
#include "engine/core/quantity.h"
#include "engine/pipeline/deform.h"
#include "engine/tools/paper/bunny.h"
#include "engine/tools/paper/parts.h"
#include "engine/tools/plot/line_plot.h"

namespace palp::report {
namespace {

constexpr double     kModulus = 1e6; ///< of ellipsoid and bunny [Pa]
constexpr double     kPoisson = 0.45;
constexpr double     kThin    = 1e-3; ///< of the bunny's skin [m]
constexpr PlateEdges kClamped{};
constexpr PlateEdges kSupported{Edge::supported, Edge::supported, Edge::supported, Edge::supported};
constexpr PlateEdges kFromItsRoot{Edge::free, Edge::free, Edge::free, Edge::clamped};

/// A whole closed ellipsoid of the sample's axes, pressed at its top by a fingertip of 4 mm, in solid elements.
/// \source tests/pipeline/calculix_shells.py: CalculiX 2.20, C3D20R, error of the mesh below 0.2 %
struct WholeEllipsoid {
    double thickness = 0; ///< [m]
    double stiffness = 0; ///< 1/c [N/m]
};
constexpr std::array<WholeEllipsoid, 3> kWholeEllipsoids{{{1e-3, 38.496}, {2e-3, 140.41}, {3e-3, 301.1}}};

/// One window about one place, bent in both ways.
struct Pair {
    double      window = 0;             ///< edge [m]
    double      length = 0;             ///< l of the shell [m]
    double      plate = 0, clamped = 0; ///< 1/c of a clamped plate; of a clamped shell [N/m]
    double      shell = 0;              ///< of a shell that is cut from a larger one [N/m]
    std::string flatBecause;            ///< why it bent as a plate nevertheless; empty: it did not

    [[nodiscard]] double tooSoft() const { return shell / plate; }
};

PatchSettings settingsOf(double window, Theory theory, const PlateEdges& edges, const ReportRun& run)
{
    return {.window = window, .cells = run.quick ? 32 : 64, .theory = theory, .edges = edges};
}

Pair bendBothWays(const SoftObject& object, const Contact& contact, double window, const ReportRun& run)
{
    const auto bend = [&](Theory theory, const PlateEdges& edges) {
        return deform(object, contact, settingsOf(window, theory, edges, run), run.solver);
    };
    const Patch plate = bend(Theory::plate, kClamped), shell = bend(Theory::shell, kSupported);
    demandDeformed(plate);
    demandDeformed(shell);
    return {window,
            shell.shellLength,
            1 / plate.compliance,
            1 / bend(Theory::shell, kClamped).compliance,
            1 / shell.compliance,
            shell.flatBecause};
}

SoftObject ellipsoid(double thickness, const ReportRun& run)
{
    const Sample& sample = sampleNamed("ellipsoid");
    SpatialLaw    even;
    even.from = kModulus;
    return SoftObject(makeSample(sample, run.quick ? sample.points / 4 : sample.points, 1, even),
                      {.thickness = thickness, .poissonRatio = kPoisson});
}

std::vector<Pair> windowsAtItsTop(double thickness, const ReportRun& run)
{
    const SoftObject object = ellipsoid(thickness, run);
    const Contact    contact =
        touchAt(object, boundsOf(sampleNamed("ellipsoid")).high * glm::dvec3(0, 0, 1), glm::dvec3(0, 0, 1), 5e-3);
    std::vector<Pair> pairs;
    for (const double window : run.quick ? std::vector{40e-3, 60e-3} : std::vector{30e-3, 40e-3, 50e-3, 60e-3, 70e-3})
        pairs.push_back(bendBothWays(object, contact, window, run));
    return pairs;
}

std::string plotOf(const std::vector<Pair>& pairs, const WholeEllipsoid& whole)
{
    PlotSeries plate{"flat plate, clamped", {}, {}, SeriesStyle::lineAndMarkers}, shell = plate, clamped = plate,
                                                                                  truth = plate;
    shell.name                                                                          = "shell, supported";
    clamped.name                                                                        = "shell, clamped";
    truth.name  = "whole object, finite elements";
    truth.style = SeriesStyle::reference;
    for (const Pair& pair : pairs) {
        for (PlotSeries* series : {&plate, &shell, &clamped, &truth}) series->x.push_back(pair.window);
        plate.y.push_back(pair.plate);
        shell.y.push_back(pair.shell);
        clamped.y.push_back(pair.clamped);
        truth.y.push_back(whole.stiffness);
    }
    LinePlotSettings settings;
    settings.title = "An ellipsoid of " + formatQuantity(whole.thickness, "m") + " under a finger";
    settings.x     = {"patch window", "m", Scale::linear, {}};
    settings.y     = {"stiffness 1/c", "N/m", Scale::logarithmic, {}};
    return linePlotSvg(std::vector{plate, clamped, shell, truth}, settings);
}

std::string signedPercent(double ratio)
{
    return (ratio < 1 ? "-" : "+") + percent(std::abs(ratio - 1));
}

/// Returns the largest error of a theory beside the whole object [1].
double worst(const std::vector<Pair>& pairs, double Pair::*theory, double truth)
{
    double most = 0;
    for (const Pair& pair : pairs) most = std::max(most, std::abs(pair.*theory / truth - 1));
    return most;
}

std::vector<Pair> addEllipsoid(Section& section, const WholeEllipsoid& whole, const ReportRun& run)
{
    const std::vector<Pair> pairs = windowsAtItsTop(whole.thickness, run);
    Table table{"The top of a closed ellipsoid of 120 x 90 x 70 mm, " + formatQuantity(whole.thickness, "m") +
                    " thick, 1 MPa. The whole object is felt as " + formatQuantity(whole.stiffness, "N/m") + ".",
                {"patch window", "in lengths l", "flat plate", "off by", "shell", "off by", "shell, clamped"},
                {}};
    const std::string stem = "ellipsoid/" + fixed(1e3 * whole.thickness, 0) + "_mm/";
    Quantity windows{stem + "window", "m", {}}, plate{stem + "plate", "N/m", {}}, shell{stem + "shell", "N/m", {}};
    for (const Pair& pair : pairs) {
        table.rows.push_back({formatQuantity(pair.window, "m"), fixed(pair.window / pair.length, 1),
                              formatQuantity(pair.plate, "N/m"), signedPercent(pair.plate / whole.stiffness),
                              formatQuantity(pair.shell, "N/m"), signedPercent(pair.shell / whole.stiffness),
                              formatQuantity(pair.clamped, "N/m")});
        windows.values.push_back(pair.window);
        plate.values.push_back(pair.plate);
        shell.values.push_back(pair.shell);
    }
    for (Quantity* quantity : {&windows, &plate, &shell}) section.numbers.push_back(*quantity);
    section.numbers.push_back({stem + "whole", "N/m", {whole.stiffness}});
    section.tables.push_back(std::move(table));
    section.figures.push_back(
        {"A plate has no answer of its own: the larger its window, the softer it is. A shell has.",
         plotOf(pairs, whole)});
    return pairs;
}

/// The lobe's faces bulge to either side, so that its middle is flat: a touch that is asked for a shell sees that, and
/// bends it as the plate that it is.
void addLobe(Section& section, const ReportRun& run)
{
    const Sample&    sample = sampleNamed("ear-lobe");
    const SoftObject object(makeSample(sample, run.quick ? sample.points / 4 : sample.points, 1), sample.material);
    const Contact    contact = touchAt(object, {0, -4e-3, 1.5e-3}, glm::dvec3(0, 0, 1), 5e-3);
    Table table{"The ear lobe of part b, held at its root alone. It is one sheet with two faces that bulge to either "
                "side and turn "
                "back at its rim: its middle surface is flat. A shell of the touched face's curvature would be far too "
                "stiff, so a "
                "touch that is asked for a shell bends a plate, and says so.",
                {"patch window", "plate", "asked for a shell", "ratio"},
                {}};
    const auto bend = [&](Theory theory) {
        PatchSettings settings   = settingsOf(28e-3, theory, kFromItsRoot, run);
        settings.footprintRadius = sample.footprintRadius;
        return deform(object, contact, settings, run.solver);
    };
    const Patch  plate = bend(Theory::plate), shell = bend(Theory::shell);
    const double ratio = plate.compliance / shell.compliance;
    table.rows.push_back({"28 mm", formatQuantity(1 / plate.compliance, "N/m"),
                          formatQuantity(1 / shell.compliance, "N/m"), fixed(ratio, 3)});
    section.numbers.push_back({"lobe/shell_over_plate", "1", {ratio}});
    section.tables.push_back(std::move(table));
}

} // namespace

Section flatnessPart(const ReportRun& run)
{
    Section section{'i', "What flatness costs", {}, {}, {}, {}, {}, {}};
    section.text = {
        "The paper flattens the neighbourhood and bends it as a plate. A thin object that bulges also resists by "
        "forces in its surface, as an egg does. The length l over which its dent dies away says how much: l is the "
        "root of radius times thickness over (12 (1 - nu^2))^(1/4), and a plate is right only where its window "
        "is not much larger than l, or the object nearly flat.",
        "Both theories bend the same points with the same rigidity. The clamped plate is the paper's; the shell is "
        "Marguerre's, supported where the window cuts it from the rest of the object."};
    std::string ours;
    for (const WholeEllipsoid& whole : kWholeEllipsoids) {
        const std::vector<Pair> pairs = addEllipsoid(section, whole, run);
        ours += (ours.empty() ? "On an ellipsoid of " : "; of ") + formatQuantity(whole.thickness, "m") +
                " the plate is off by up to " + percent(worst(pairs, &Pair::plate, whole.stiffness)) +
                ", the shell by " + percent(worst(pairs, &Pair::shell, whole.stiffness));
    }
    section.claims.push_back(
        {"The neighbourhood is mapped to a flat square, which bends as a plate.", ours + ".",
         "patch windows of several widths about the same place, beside the whole object in solid finite elements",
         Verdict::inPart,
         "The map is right; what is flattened loses the forces in its surface, which carry most of the load "
         "where an object is thin and bulges."});
    addLobe(section, run);
    return section;
}

void addCurvedBunny(Section& flatness, const std::filesystem::path& file, const ReportRun& run)
{
    const PointCloud    read = readBunny(file).cloud;
    const SoftObject    skin(PointCloud({read.positions().begin(), read.positions().end()},
                                        std::vector<double>(read.size(), kModulus), StiffnessKind::modulus),
                             {.thickness = kThin, .poissonRatio = kPoisson});
    const std::size_t   places = run.quick ? 6 : 40;
    std::vector<double> times, lengths;
    for (std::size_t n = 0; n < places; ++n) {
        const glm::dvec3 place = skin.positions()[n * skin.positions().size() / places];
        const Pair       pair  = bendBothWays(skin, touchAt(skin, place, {}, 5e-3), 30e-3, run);
        if (!pair.flatBecause.empty()) continue;
        times.push_back(pair.tooSoft());
        lengths.push_back(pair.window / pair.length);
    }
    flatness.numbers.push_back({"bunny/shell_over_plate", "1", times});
    flatness.numbers.push_back({"bunny/places", "1", {double(places)}});
    flatness.text.push_back(bunnyTerms());
    std::sort(times.begin(), times.end());
    std::sort(lengths.begin(), lengths.end());
    if (times.empty()) return;
    flatness.tables.push_back({"The bunny as a skin of 1 mm of 1 MPa, patch windows of 30 mm about " +
                                   std::to_string(places) + " places; at " + std::to_string(places - times.size()) +
                                   " of them the points tell no curvature, or one too large for a shallow shell.",
                               {"", "least", "median", "most"},
                               {{"patch window in lengths l", fixed(lengths.front(), 1),
                                 fixed(lengths[lengths.size() / 2], 1), fixed(lengths.back(), 1)},
                                {"shell over flat plate", fixed(times.front(), 2), fixed(times[times.size() / 2], 2),
                                 fixed(times.back(), 2)}}});
}

} // namespace palp::report
