// The paper's experiment: an ellipsoid of 40 000 points whose rigidity varies along x, linearly or hyperbolically,
// pressed with the same force at several places. Shows that deflection falls as rigidity grows, by the paper's recipe
// and by ours. Usage: paper_experiment FOLDER
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <iostream>
#include <sstream>

#include <nlohmann/json.hpp>

#include "engine/cloud/point_cloud_io.h"
#include "engine/cloud/samples.h"
#include "engine/core/contract.h"
#include "engine/core/file.h"
#include "engine/core/progress.h"
#include "engine/core/quantity.h"
#include "engine/picture/line_plot.h"
#include "engine/picture/patch_pictures.h"
#include "engine/pipeline/pipeline.h"

using namespace palp;

namespace {

constexpr const char* kUsage =
    "usage: paper_experiment FOLDER\n\nPresses the ellipsoid of the paper at five places, by its recipe and by ours, "
    "and "
    "writes pictures,\ntables and deformed clouds into FOLDER; FOLDER/index.html shows them.\n";

constexpr double kForce        = 0.9;   ///< [N] keeps the softest place just below half the thickness
constexpr double kSoftest      = 0.3e6; ///< modulus at one end of the x axis [Pa]
constexpr double kStiffest     = 3e6;   ///< at the other [Pa]
constexpr double kWindow       = 30e-3; ///< [m] the dents of neighbouring places hardly touch
constexpr double kPlaces[]     = {-45e-3, -22.5e-3, 0, 22.5e-3, 45e-3}; ///< x of the contacts on the top [m]
constexpr double kExaggeration = 2;                                     ///< of the displacement in pictures [1]

struct Touch {
    double x = 0; ///< place [m]
    Patch  patch;

    [[nodiscard]] double rigidity() const ///< at the contact [N m]
    {
        const int middle = patch.plate.grid.cellsX / 2;
        return patch.plate.rigidity(middle, middle);
    }
    [[nodiscard]] double deepest() const ///< largest deflection under kForce [m]
    {
        return kForce * *std::max_element(patch.response.values().begin(), patch.response.values().end());
    }
    [[nodiscard]] double deflection() const ///< at the contact under kForce [m]
    {
        const int middle = patch.plate.grid.cellsX / 2;
        return kForce * patch.response(middle, middle);
    }
};

/// One object pressed by one recipe at all places.
struct Series {
    std::string        law, preset;
    PatchSettings      settings;
    std::vector<Touch> touches;

    [[nodiscard]] std::string  name() const { return law + "_" + preset; }
    [[nodiscard]] std::string  title() const { return law + " rigidity, preset " + preset; }
    [[nodiscard]] const Touch& middle() const { return touches[touches.size() / 2]; }
};

PatchSettings settingsFor(Preset preset)
{
    PatchSettings settings;
    settings.material = sampleNamed("ellipsoid").material;
    settings.window   = kWindow;
    return withPreset(settings, preset);
}

PointCloud ellipsoid(SpatialLaw::Kind kind)
{
    const Sample& sample = sampleNamed("ellipsoid");
    const Bounds  bounds = boundsOf(sample);
    SpatialLaw    law;
    law.kind  = kind;
    law.from  = kSoftest;
    law.to    = kStiffest;
    law.start = {bounds.low.x, 0, 0};
    law.end   = {bounds.high.x, 0, 0};
    return makeSample(sample, sample.points, 1, law);
}

Series press(const PointCloud& cloud, const NeighbourIndex& index, const std::string& law, Preset preset,
             PlateDevice& device)
{
    const glm::dvec3 axes = boundsOf(sampleNamed("ellipsoid")).high;
    Series           series{law, palp::name(preset), settingsFor(preset), {}};
    for (double x : kPlaces) {
        const glm::dvec3 place{x, 0, axes.z * std::sqrt(1 - x * x / (axes.x * axes.x))};
        const Contact    contact = touchAt(cloud, index, place, glm::dvec3(0, 0, 1), 5e-3);
        series.touches.push_back({x, deform(cloud, index, contact, series.settings, device)});
    }
    return series;
}

void write(const std::filesystem::path& path, const std::string& text)
{
    writeFileWhole(path, [&](std::ostream& file) { file << text; });
}

/// The cloud with the dents of all places, for other programs.
void writeDeformed(const std::filesystem::path& path, const PointCloud& cloud, const Series& series)
{
    std::vector<glm::dvec3> positions(cloud.positions().begin(), cloud.positions().end());
    std::vector<double>     depth(cloud.size(), 0.0);
    for (const Touch& touch : series.touches)
        for (std::size_t n = 0; n < touch.patch.points.size(); ++n) {
            const double w = kForce * touch.patch.pointResponse[n];
            depth[touch.patch.points[n]] += w;
            positions[touch.patch.points[n]] += w * touch.patch.forceDirection();
        }
    const NamedField field{"deflection", "m", depth};
    writeCloud(path, PointCloud(positions, {cloud.stiffness().begin(), cloud.stiffness().end()}, cloud.kind()),
               {&field, 1});
}

std::string placeName(double x)
{
    char text[32];
    std::snprintf(text, sizeof text, "x = %g mm", 1e3 * x);
    return text;
}

/// \param deepest  end of the colours of the deflection chart [m]
void writePictures(const std::filesystem::path& folder, const PointCloud& cloud, const Series& series, double deepest)
{
    std::vector<PressedPatch> pressed;
    for (const Touch& touch : series.touches) pressed.push_back({&touch.patch, kForce, ""});
    const std::string newtons = formatQuantity(kForce, "N");
    write(folder / (series.name() + "_surface.svg"),
          surfaceSvg(cloud, pressed,
                     {"Deflection under " + newtons + " at five places: " + series.title() + " (displacement x 2)",
                      kExaggeration,
                      {0.15, 0.75, -0.65},
                      false}));
    for (std::size_t n = 0; n < pressed.size(); ++n) pressed[n].label = placeName(series.touches[n].x);
    write(folder / (series.name() + "_profiles.svg"),
          profilesSvg(pressed, "Deflection through each contact under " + newtons + ": " + series.title()));

    const std::string where = series.title() + ", " + placeName(series.middle().x);
    write(folder / (series.name() + "_rigidity.svg"),
          rigidityChartSvg(series.middle().patch, series.settings, "Rigidity around the contact: " + where));
    write(folder / (series.name() + "_deflection.svg"),
          deflectionChartSvg(series.middle().patch, series.settings, kForce,
                             "Deflection under " + newtons + ": " + where, deepest));
}

/// Deflection against rigidity, both logarithmic, with the slope -1 of a plate of uniform rigidity.
std::string summaryPlot(const std::vector<Series>& all)
{
    std::vector<PlotSeries> plot;
    double                  low = 1e300, high = 0, product = 0;
    for (const Series& series : all) {
        PlotSeries line{series.law + ", " + series.preset, {}, {}, SeriesStyle::lineAndMarkers};
        for (const Touch& touch : series.touches) {
            line.x.push_back(touch.rigidity());
            line.y.push_back(touch.deflection());
            low  = std::min(low, touch.rigidity());
            high = std::max(high, touch.rigidity());
        }
        if (series.preset == "palpate" && series.law == "linear") product = line.x[2] * line.y[2];
        plot.push_back(std::move(line));
    }
    plot.push_back({"1 / rigidity", {low, high}, {product / low, product / high}, SeriesStyle::reference});
    LinePlotSettings settings;
    settings.title = "Deflection falls as rigidity grows (" + formatQuantity(kForce, "N") + ")";
    settings.x     = {"flexural rigidity at the contact", "N m", Scale::logarithmic, {}};
    settings.y     = {"deflection at the contact", "m", Scale::logarithmic, {}};
    return linePlotSvg(plot, settings);
}

/// Deflection times rigidity over its mean: 1 everywhere if deflection were exactly one over rigidity.
std::string productPlot(const std::vector<Series>& all)
{
    double mean = 0; // [N m^2]
    for (const Series& series : all)
        for (const Touch& touch : series.touches)
            mean += touch.deflection() * touch.rigidity() / double(all.size() * series.touches.size());
    std::vector<PlotSeries> plot;
    double                  low = HUGE_VAL, high = 0;
    for (const Series& series : all) {
        PlotSeries line{series.law + ", " + series.preset, {}, {}, SeriesStyle::lineAndMarkers};
        for (const Touch& touch : series.touches) {
            line.x.push_back(touch.rigidity());
            line.y.push_back(touch.deflection() * touch.rigidity() / mean);
            low  = std::min(low, touch.rigidity());
            high = std::max(high, touch.rigidity());
        }
        plot.push_back(std::move(line));
    }
    plot.push_back({"1 / rigidity", {low, high}, {1, 1}, SeriesStyle::reference});
    LinePlotSettings settings;
    settings.title = "How far from 1 / rigidity: deflection x rigidity, over its mean";
    settings.x     = {"flexural rigidity at the contact", "N m", Scale::logarithmic, {}};
    settings.y     = {"deflection x rigidity / mean", "", Scale::linear, {}};
    return linePlotSvg(plot, settings);
}

nlohmann::json numbers(const std::vector<Series>& all, PlateDevice& device)
{
    nlohmann::json rows = nlohmann::json::array();
    for (const Series& series : all)
        for (const Touch& touch : series.touches) {
            const auto error = discretisationError(touch.patch, series.settings, device);
            rows.push_back({{"law", series.law},
                            {"preset", series.preset},
                            {"x", touch.x},
                            {"rigidity", touch.rigidity()},
                            {"deflection", touch.deflection()},
                            {"compliance", touch.patch.compliance},
                            {"contact_stiffness", touch.patch.contactStiffness},
                            {"felt_stiffness", touch.patch.feltStiffness},
                            {"sphere_radius", touch.patch.sphere.fit.radius()},
                            {"discretisation_error", error ? nlohmann::json(*error) : nlohmann::json(nullptr)},
                            {"milliseconds", touch.patch.times.total()}});
        }
    return rows;
}

/// A row of the table in the user's units, for the terminal and the page.
std::vector<std::string> cells(const nlohmann::json& row)
{
    const nlohmann::json& error = row["discretisation_error"];
    char                  percent[16];
    std::snprintf(percent, sizeof percent, "%.2g %%", error.is_null() ? 0.0 : 100 * error.get<double>());
    return {row["law"],
            row["preset"],
            formatQuantity(row["x"], "m"),
            formatQuantity(row["rigidity"], "N m"),
            formatQuantity(row["deflection"], "m"),
            formatQuantity(row["compliance"], "m/N"),
            formatQuantity(row["felt_stiffness"], "N/m"),
            error.is_null() ? "-" : percent,
            formatQuantity(row["milliseconds"].get<double>() / 1e3, "s")};
}

const std::vector<std::string> kHeadings = {"law",        "recipe",         "place x",    "rigidity", "deflection",
                                            "compliance", "felt stiffness", "grid error", "time"};

std::string textTable(const nlohmann::json& rows)
{
    std::ostringstream text;
    const auto         line = [&](const std::vector<std::string>& row) {
        for (const std::string& cell : row) text << cell << std::string(cell.size() < 15 ? 15 - cell.size() : 1, ' ');
        text << "\n";
    };
    line(kHeadings);
    for (const auto& row : rows) line(cells(row));
    return text.str();
}

std::string page(const std::vector<Series>& all, const nlohmann::json& rows, const std::string& skin)
{
    std::ostringstream html;
    html << "<!doctype html><html lang=\"en\"><meta charset=\"utf-8\"><title>Palpate: the paper's experiment</title>\n"
            "<style>body{font:16px/1.5 sans-serif;max-width:72rem;margin:2rem auto;padding:0 "
            "1rem;color:#1a1a1a;background:#fff}"
            "table{border-collapse:collapse;font-variant-numeric:tabular-nums}td,th{padding:.15rem "
            ".7rem;text-align:right;"
            "border-bottom:1px solid #ddd}td:nth-child(-n+2),th:nth-child(-n+2){text-align:left}"
            ".pair{display:grid;grid-template-columns:1fr 1fr;gap:1rem}img{width:100%;height:auto}</style>\n"
            "<h1>An ellipsoid of 40 000 points, pressed at five places</h1>\n<p>The modulus rises along x from "
         << formatQuantity(kSoftest, "Pa") << " to " << formatQuantity(kStiffest, "Pa")
         << ", linearly or hyperbolically (so that its inverse falls linearly). The same force of "
         << formatQuantity(kForce, "N")
         << " dents it less where it is more rigid. <em>paper</em> is the published recipe (Gall-Peters map, nearest "
            "point, "
            "E A/h as felt stiffness), <em>palpate</em> is ours (azimuthal equal-area map, log-mean, plate and contact "
            "in "
            "series). Under the finger Gall-Peters stretches one way by the square root of 2 and shrinks the other, so "
            "a round "
            "poke makes an oblong dent; the charts below show it round because they show the map, not the object.</p>\n"
            "<div class=\"pair\"><img src=\"summary.svg\" alt=\"deflection against rigidity\">"
            "<img src=\"product.svg\" alt=\"deflection times rigidity, over its mean\"></div>\n"
            "<p>Left: deflection falls as 1 / rigidity, and the four curves coincide. Right: that law divided out. No "
            "place is farther than 2 % from it, the linear rigidity lies above and the hyperbolic one below, because "
            "the finger feels the rigidity of its surroundings too and not that of the contact alone; the two presets "
            "differ by about 1 % at most.</p>\n<table><tr>";
    for (const std::string& heading : kHeadings) html << "<th>" << heading << "</th>";
    html << "</tr>\n";
    for (const auto& row : rows) {
        html << "<tr>";
        for (const std::string& cell : cells(row)) html << "<td>" << cell << "</td>";
        html << "</tr>\n";
    }
    html << "</table>\n<p>Deflection is that of the contact point; compliance is the mean under the fingertip, per "
            "newton, so that it is a little smaller than deflection over force. Felt stiffness: preset <em>paper</em> "
            "takes that of the contact alone, E A/h, as published, although the plate beneath gives way some eight "
            "times as "
            "easily; preset <em>palpate</em> puts plate and contact in series.</p>\n<p>Grid error: change of "
            "compliance against half as many cells, divided by 3. All numbers: "
            "<a href=\"results.json\">results.json</a>.</p>\n";
    for (const char* law : {"linear", "hyperbolic"}) {
        html << "<h2>" << law << " rigidity</h2>\n";
        for (const char* picture : {"surface", "profiles", "deflection", "rigidity"}) {
            html << "<div class=\"pair\">";
            for (const Series& series : all)
                if (series.law == law)
                    html << "<img src=\"" << series.name() << "_" << picture << ".svg\" alt=\"" << picture << ", "
                         << series.name() << "\">";
            html << "</div>\n";
        }
        for (const Series& series : all)
            if (series.law == law)
                html << "<p>Deformed cloud, " << series.preset << ": <a href=\"" << series.name() << ".ply\">"
                     << series.name() << ".ply</a></p>\n";
    }
    html << skin;
    return html.str();
}

/// The wart under the skin that samples/demo.sh presses into the folder "skin" beside the page; empty if it did not.
std::string skinSection(const std::filesystem::path& folder)
{
    if (!std::filesystem::exists(folder / "skin" / "touch.json")) return "";
    std::string html =
        "<h2>A wart under the skin</h2>\n<p><code>palpate touch sample:skin</code> with the preset "
        "<em>palpate</em>; all numbers: <a href=\"skin/touch.json\">skin/touch.json</a>, deformed cloud: "
        "<a href=\"skin/deformed.ply\">skin/deformed.ply</a>.</p>\n<div class=\"pair\">";
    for (const char* picture : {"surface", "close_up", "rigidity", "deflection"})
        html += std::string("<img src=\"skin/") + picture + ".svg\" alt=\"" + picture + " of the skin\">";
    return html + "</div>\n";
}

void run(const std::filesystem::path& folder)
{
    makeFolder(folder);
    PlateDevice device;
    if (!device.note().empty()) std::cerr << "palpate: auto takes " << device.name() << ": " << device.note() << "\n";
    std::vector<Series> all;
    Progress            progress("pressing");
    for (const auto& [law, kind] :
         {std::pair("linear", SpatialLaw::Kind::linear), std::pair("hyperbolic", SpatialLaw::Kind::hyperbolic)}) {
        const PointCloud     cloud = ellipsoid(kind);
        const NeighbourIndex index(cloud.positions());
        const Series pair[]  = {press(cloud, index, law, Preset::paper, device),
                               press(cloud, index, law, Preset::palpate, device)};
        const double deepest = std::max(pair[0].middle().deepest(), pair[1].middle().deepest());
        for (const Series& series : pair) {
            writeDeformed(folder / (series.name() + ".ply"), cloud, series);
            writePictures(folder, cloud, series, deepest);
            all.push_back(series);
            progress.at(all.size(), 4);
        }
    }
    const nlohmann::json rows = numbers(all, device);
    write(folder / "results.json", rows.dump(2) + "\n");
    write(folder / "summary.svg", summaryPlot(all));
    write(folder / "product.svg", productPlot(all));
    write(folder / "index.html", page(all, rows, skinSection(folder)));
    std::cout << textTable(rows);
}

} // namespace

int main(int argumentCount, char** arguments)
{
    const std::string_view argument = argumentCount == 2 ? arguments[1] : "";
    const bool             help     = argument == "--help" || argument == "-h";
    if (!help && (argument.empty() || argument.starts_with('-'))) {
        std::cerr << kUsage;
        return 2;
    }
    try {
        if (help)
            std::cout << kUsage;
        else
            run(argument);
        std::cout.flush();
        if (!std::cout) throw Error("standard output cannot be written");
    } catch (const Error& error) {
        std::cerr << "paper_experiment: " << error.what() << "\n";
        return 2;
    }
    return 0;
}
