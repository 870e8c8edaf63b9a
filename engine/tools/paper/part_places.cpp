// The paper's experiment: an ellipsoid of 40 000 points whose rigidity varies along x, linearly or hyperbolically,
// pressed with the same force at several places.
#include <algorithm>
#include <cmath>

#include "engine/cloud/samples.h"
#include "engine/contact/contact.h"
#include "engine/core/quantity.h"
#include "engine/pipeline/deform.h"
#include "engine/pipeline/presets.h"
#include "engine/tools/paper/parts.h"
#include "engine/tools/plot/line_plot.h"
#include "engine/tools/plot/patch_pictures.h"
#include "engine/tools/render/cloud_figure.h"

namespace palp::report {
namespace {

constexpr double kForce        = 0.9;   ///< [N] keeps the softest place just below half the thickness
constexpr double kSoftest      = 0.3e6; ///< modulus at one end of the x axis [Pa]
constexpr double kStiffest     = 3e6;   ///< at the other [Pa]
constexpr double kWindow       = 30e-3; ///< [m] the dents of neighbouring places hardly touch
constexpr double kPlaces[]     = {-45e-3, -22.5e-3, 0, 22.5e-3, 45e-3}; ///< x of the contacts on the top [m]
constexpr double kExaggeration = 2;                                     ///< of the displacement in pictures [1]

struct Touch {
    double                x = 0; ///< place [m]
    Patch                 patch;
    std::optional<double> gridError; ///< see discretisationError [1]

    [[nodiscard]] int    middle() const { return patch.plate.grid.cellsX / 2; }
    [[nodiscard]] double rigidity() const { return patch.plate.rigidity(middle(), middle()); }      ///< [N m]
    [[nodiscard]] double deflection() const { return kForce * patch.response(middle(), middle()); } ///< [m]
};

/// One object pressed by one recipe at all places.
struct Series {
    std::string        law, preset;
    PatchSettings      settings;
    std::vector<Touch> touches;

    [[nodiscard]] std::string  title() const { return law + " rigidity, " + preset; }
    [[nodiscard]] const Touch& middle() const { return touches[touches.size() / 2]; }
};

PointCloud ellipsoid(SpatialLaw::Kind kind, bool quick)
{
    const Sample& sample = sampleNamed("ellipsoid");
    const Bounds  bounds = boundsOf(sample);
    SpatialLaw    law;
    law.kind  = kind;
    law.from  = kSoftest;
    law.to    = kStiffest;
    law.start = {bounds.low.x, 0, 0};
    law.end   = {bounds.high.x, 0, 0};
    return makeSample(sample, quick ? sample.points / 5 : sample.points, 1, law);
}

Series press(const SoftObject& object, const std::string& law, Preset preset, const ReportRun& run)
{
    const glm::dvec3 axes = boundsOf(sampleNamed("ellipsoid")).high;
    Series           series{law, palp::name(preset), {}, {}};
    series.settings.window = kWindow;
    if (run.quick) series.settings.cells = 32;
    series.settings = withPreset(series.settings, preset);
    for (const double x : kPlaces) {
        const glm::dvec3 place{x, 0, axes.z * std::sqrt(1 - x * x / (axes.x * axes.x))};
        const Contact    contact = touchAt(object, place, glm::dvec3(0, 0, 1), 5e-3);
        Touch            touch{x, deform(object, contact, series.settings, run.solver), {}};
        touch.gridError = discretisationError(touch.patch, series.settings, run.solver);
        series.touches.push_back(std::move(touch));
    }
    return series;
}

std::string placeName(double x)
{
    return "x = " + fixed(1e3 * x, 1) + " mm";
}

Figure surfaceFigure(const PointCloud& cloud, const Series& series, const ReportRun& run)
{
    std::vector<PressedPatch> pressed;
    for (const Touch& touch : series.touches) pressed.push_back({&touch.patch, kForce, ""});
    return {"The ellipsoid under " + formatQuantity(kForce, "N") + " at five places, displacements twice as large; " +
                series.title() + ". Softer to the left.",
            surfaceSvg(cloud, pressed, {"Deflection: " + series.title(), kExaggeration, {0.15, 0.75, -0.65}, false},
                       run.renderer)};
}

Figure profileFigure(const Series& series)
{
    std::vector<PressedPatch> pressed;
    for (const Touch& touch : series.touches) pressed.push_back({&touch.patch, kForce, placeName(touch.x)});
    return {"From west to east through each contact.", profilesSvg(pressed, "Deflection: " + series.title())};
}

/// Plots deflection against rigidity; `product` multiplies them, which shows the distance from 1/D.
std::string againstRigidity(const std::vector<Series>& all, bool product)
{
    std::vector<PlotSeries> plot;
    double                  low = HUGE_VAL, high = 0, mean = 0;
    for (const Series& series : all)
        for (const Touch& touch : series.touches) {
            mean += touch.deflection() * touch.rigidity() / double(all.size() * series.touches.size());
            low  = std::min(low, touch.rigidity());
            high = std::max(high, touch.rigidity());
        }
    for (const Series& series : all) {
        PlotSeries line{series.law + ", " + series.preset, {}, {}, SeriesStyle::lineAndMarkers};
        for (const Touch& touch : series.touches) {
            line.x.push_back(touch.rigidity());
            line.y.push_back(touch.deflection() * (product ? touch.rigidity() / mean : 1));
        }
        plot.push_back(std::move(line));
    }
    plot.push_back(
        {"1 / rigidity", {low, high}, {product ? 1 : mean / low, product ? 1 : mean / high}, SeriesStyle::reference});
    LinePlotSettings settings;
    settings.title = product ? "How far from 1 / rigidity" : "Deflection falls as rigidity grows";
    settings.x     = {"flexural rigidity at the contact", "N m", Scale::logarithmic, {}};
    settings.y     = product ? PlotAxis{"deflection × rigidity / mean", "", Scale::linear, {}}
                             : PlotAxis{"deflection at the contact", "m", Scale::logarithmic, {}};
    return linePlotSvg(plot, settings);
}

void addNumbers(Section& section, const Series& series)
{
    std::vector<double> rigidity, deflection, compliance, contact, felt, radius, error;
    for (const Touch& touch : series.touches) {
        rigidity.push_back(touch.rigidity());
        deflection.push_back(touch.deflection());
        compliance.push_back(touch.patch.compliance);
        contact.push_back(touch.patch.contactStiffness);
        felt.push_back(touch.patch.feltStiffness);
        radius.push_back(touch.patch.sphere.fit.radius());
        error.push_back(touch.gridError.value_or(std::nan("")));
    }
    const auto add = [&](const char* what, const char* unit, std::vector<double>& values) {
        section.numbers.push_back({series.law + "/" + series.preset + "/" + what, unit, std::move(values)});
    };
    add("rigidity", "N m", rigidity);
    add("deflection", "m", deflection);
    add("compliance", "m/N", compliance);
    add("contact_stiffness", "N/m", contact);
    add("felt_stiffness", "N/m", felt);
    add("sphere_radius", "m", radius);
    add("grid_error", "1", error);
}

Table tableOf(const std::vector<Series>& all)
{
    Table table{"Under " + formatQuantity(kForce, "N") +
                    ". Deflection is that of the contact point; compliance is the "
                    "mean under the fingertip; grid error: change of compliance "
                    "against half as many cells, over 3.",
                {"rigidity", "recipe", "place x", "rigidity at the contact", "deflection", "compliance",
                 "felt stiffness", "grid error"},
                {}};
    for (const Series& series : all)
        for (const Touch& touch : series.touches)
            table.rows.push_back(
                {series.law, series.preset, formatQuantity(touch.x, "m"), formatQuantity(touch.rigidity(), "N m"),
                 formatQuantity(touch.deflection(), "m"), formatQuantity(touch.patch.compliance, "m/N"),
                 formatQuantity(touch.patch.feltStiffness, "N/m"), touch.gridError ? percent(*touch.gridError) : "-"});
    return table;
}

Claim claimOf(const std::vector<Series>& all)
{
    bool   falls  = true;
    double spread = 0; // of deflection x rigidity about 1/rigidity [1]
    for (const Series& series : all)
        for (std::size_t n = 0; n < series.touches.size(); ++n) {
            const Touch& touch = series.touches[n];
            if (n > 0) falls = falls && touch.deflection() < series.touches[n - 1].deflection();
            const Touch& middle = series.middle();
            spread              = std::max(
                             spread,
                             std::abs(touch.deflection() * touch.rigidity() / (middle.deflection() * middle.rigidity()) - 1));
        }
    const auto& soft = all.front().touches.front();
    const auto& hard = all.front().touches.back();
    return {"Under the same force the surface deflects less where it is more rigid, with linear and with hyperbolic "
            "rigidity (ellipsoid, 40 000 points).",
            "Linear, paper's recipe: " + formatQuantity(soft.deflection(), "m") + " down to " +
                formatQuantity(hard.deflection(), "m") + " as the rigidity grows " +
                fixed(hard.rigidity() / soft.rigidity(), 1) + " times; deflection × rigidity stays within " +
                percent(spread) + " of that in the middle.",
            "20 touches through the whole pipeline, both recipes, error of the grid beside each",
            falls ? Verdict::holds : Verdict::fails,
            falls ? "Deflection falls at every step, by both recipes, as 1 / rigidity to within a few per cent."
                  : "At some place deflection does not fall."};
}

} // namespace

Section placesPart(const ReportRun& run)
{
    Section section{'a', "The same force at several places of an ellipsoid", {}, {}, {}, {}, {}, {}};
    section.text = {"The modulus rises along x from " + formatQuantity(kSoftest, "Pa") + " to " +
                        formatQuantity(kStiffest, "Pa") +
                        ", linearly, or hyperbolically, so that its inverse falls linearly. The recipe paper is the "
                        "published one (Gall-Peters map, nearest point, E A/h as felt stiffness), palpate is ours "
                        "(azimuthal equal-area map, log-mean, plate and contact in series).",
                    "The finger feels the rigidity of its surroundings too: that is why linear rigidity lies a little "
                    "above 1 / rigidity and hyperbolic a little below. Felt stiffness of the paper's recipe is that of "
                    "the contact alone, although the plate beneath gives way more easily."};
    section.numbers.push_back({"places", "m", {std::begin(kPlaces), std::end(kPlaces)}});
    section.numbers.push_back({"force", "N", {kForce}});

    std::vector<Series> all;
    std::vector<Figure> surfaces;
    for (const auto& [law, kind] :
         {std::pair("linear", SpatialLaw::Kind::linear), std::pair("hyperbolic", SpatialLaw::Kind::hyperbolic)}) {
        const SoftObject object(ellipsoid(kind, run.quick), sampleNamed("ellipsoid").material);
        for (const Preset preset : {Preset::paper, Preset::palpate}) {
            run.step(all.size(), 4);
            all.push_back(press(object, law, preset, run));
            addNumbers(section, all.back());
            surfaces.push_back(surfaceFigure(object.cloud(), all.back(), run));
        }
    }
    section.claims.push_back(claimOf(all));
    section.figures.push_back(
        {"Both axes are logarithmic; the four curves all but coincide.", againstRigidity(all, false)});
    section.figures.push_back({"The same with that law divided out.", againstRigidity(all, true)});
    for (const Series& series : all)
        if (series.preset == "palpate") section.figures.push_back(profileFigure(series));
    for (Figure& figure : surfaces) section.figures.push_back(std::move(figure));
    section.tables.push_back(tableOf(all));
    return section;
}

} // namespace palp::report
