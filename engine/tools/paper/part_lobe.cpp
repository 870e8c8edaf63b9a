// The dip in a thin lobe: held all around as in the paper, and held at its root only.
#include <algorithm>
#include <cmath>

#include "engine/cloud/samples.h"
#include "engine/contact/contact.h"
#include "engine/core/quantity.h"
#include "engine/pipeline/deform.h"
#include "engine/tools/paper/cantilever.h"
#include "engine/tools/paper/parts.h"
#include "engine/tools/plot/line_plot.h"
#include "engine/tools/render/cloud_figure.h"

namespace palp::report {
namespace {

constexpr double     kForce  = 0.02;           ///< [N] moves the free tip by a third of the thickness
constexpr double     kWindow = 28e-3;          ///< [m] as wide as the lobe
constexpr glm::dvec3 kPlace{0, -4e-3, 1.5e-3}; ///< on the lobe [m]: the window about it ends at the tip

/// The lobe hangs from its root, the side z1 of the window.
constexpr PlateEdges kFromItsRoot{Edge::free, Edge::free, Edge::free, Edge::clamped};

struct Bent {
    std::string   name;
    PatchSettings settings;
    Patch         patch;

    [[nodiscard]] double at(int j) const ///< deflection on the middle line, j nodes from the tip [m]
    {
        return kForce * patch.response(patch.plate.grid.cellsX / 2, j);
    }
};

Bent bend(const std::string& name, const PlateEdges& edges, const SoftObject& object, const ReportRun& run)
{
    const Sample& sample = sampleNamed("ear-lobe");
    PatchSettings settings{
        .window = kWindow, .cells = run.quick ? 32 : 64, .footprintRadius = sample.footprintRadius, .edges = edges};
    const Contact contact = touchAt(object, kPlace, glm::dvec3(0, 0, 1), 5e-3);
    return {name, settings, deform(object, contact, settings, run.solver)};
}

std::vector<double> alongMiddle(const Bent& bent)
{
    std::vector<double> values;
    for (int j = 0; j <= bent.settings.cells; ++j) values.push_back(bent.at(j));
    return values;
}

/// Plots the deflection along the middle, from root to tip, with the beam's.
std::string profileOf(const std::vector<Bent>& all, const std::vector<double>& beam)
{
    std::vector<PlotSeries> plot;
    const auto              add = [&](const std::string& name, const std::vector<double>& w, SeriesStyle style) {
        PlotSeries   series{name, {}, {}, style};
        const double spacing = all.front().patch.plate.grid.spacingZ;
        for (std::size_t j = w.size(); j-- > 0;) {
            series.x.push_back(double(w.size() - 1 - j) * spacing);
            series.y.push_back(w[j]);
        }
        plot.push_back(std::move(series));
    };
    for (const Bent& bent : all) add(bent.name, alongMiddle(bent), SeriesStyle::lineAndMarkers);
    add("cantilever beam", beam, SeriesStyle::reference);
    LinePlotSettings settings;
    settings.title = "Along the lobe under " + formatQuantity(kForce, "N");
    settings.x     = {"from the root", "m", Scale::linear, {}};
    settings.y     = {"deflection", "m", Scale::linear, {}};
    return linePlotSvg(plot, settings);
}

void addFigures(Section& section, const PointCloud& cloud, const std::vector<Bent>& all, const ReportRun& run)
{
    const double factor = 2;
    for (const Bent& bent : all) {
        const PressedPatch pressed{&bent.patch, kForce, ""};
        section.figures.push_back(
            {"The lobe, " + bent.name + ", displacements twice as large.",
             surfaceSvg(cloud, {&pressed, 1}, {"Ear lobe, " + bent.name, factor, {0.9, 0.55, -0.55}, false},
                        run.renderer)});
    }
}

} // namespace

Section lobePart(const ReportRun& run)
{
    const Sample&     sample = sampleNamed("ear-lobe");
    const SoftObject  object(makeSample(sample, run.quick ? sample.points / 4 : sample.points, 1), sample.material);
    std::vector<Bent> all;
    all.push_back(bend("clamped all around", {}, object, run));
    run.step(1, 2);
    all.push_back(bend("free but for its root", kFromItsRoot, object, run));

    const Bent &              held = all[0], &hung = all[1];
    const int                 cells = hung.settings.cells, middle = cells / 2;
    const std::vector<double> beam           = cantilever(hung.patch.plate, kForce);
    const double              tipOverContact = hung.at(0) / hung.at(middle);
    const double              slip           = (hung.at(0) / beam.front()) - 1;

    Section section{'b', "The dip in a thin lobe", {}, {}, {}, {}, {}, {}};
    section.text = {
        "An ear lobe of two sheets of skin, 3 mm apart, pressed 14 mm from its tip. In the paper the rim of "
        "the neighbourhood is clamped: the dip stays inside it, and the tip, which is free in life, does not "
        "move. With the sides and the tip free and the root clamped it bends like a cantilever, and the tip "
        "goes farther than the finger.",
        "The beam beside it is the textbook's, of the lobe's own rigidity, averaged across each "
        "cross-section. A plate as wide as it is long bends a little less than a beam: near "
        "its root it cannot curl up across."};
    section.numbers.push_back({"force", "N", {kForce}});
    section.numbers.push_back({"clamped/deflection_along", "m", alongMiddle(held)});
    section.numbers.push_back({"free/deflection_along", "m", alongMiddle(hung)});
    section.numbers.push_back({"beam/deflection_along", "m", beam});
    section.numbers.push_back({"clamped/compliance", "m/N", {held.patch.compliance}});
    section.numbers.push_back({"free/compliance", "m/N", {hung.patch.compliance}});
    section.numbers.push_back({"free/tip_over_contact", "1", {tipOverContact}});
    section.numbers.push_back({"free/tip_over_beam", "1", {hung.at(0) / beam.front()}});
    section.tables.push_back({"Under " + formatQuantity(kForce, "N") + ".",
                              {"edges", "under the finger", "at the tip", "felt stiffness"},
                              {{held.name, formatQuantity(held.at(middle), "m"), formatQuantity(held.at(0), "m"),
                                formatQuantity(held.patch.feltStiffness, "N/m")},
                               {hung.name, formatQuantity(hung.at(middle), "m"), formatQuantity(hung.at(0), "m"),
                                formatQuantity(hung.patch.feltStiffness, "N/m")},
                               {"cantilever beam", formatQuantity(beam[std::size_t(middle)], "m"),
                                formatQuantity(beam.front(), "m"), "-"}}});
    section.figures.push_back(
        {"The clamped dip ends where the patch window ends; the free lobe bends as a whole.", profileOf(all, beam)});
    addFigures(section, object.cloud(), all, run);
    section.claims.push_back(
        {"A thin lobe gets a realistic dip, with all edges of the neighbourhood fixed.",
         "Clamped: " + formatQuantity(held.at(middle), "m") +
             " under the finger and nothing at the tip. Free: " + formatQuantity(hung.at(middle), "m") +
             ", and the tip moves " + fixed(tipOverContact, 2) + " times as far.",
         "the same touch with two kinds of edges; a textbook beam beside the free one, which differs by " +
             percent(std::abs(slip)) + " at the tip",
         Verdict::inPart,
         "There is a dip, but fixed edges make the lobe " + fixed(hung.patch.compliance / held.patch.compliance, 0) +
             " times too stiff and cannot bend it; free edges do."});
    return section;
}

} // namespace palp::report
