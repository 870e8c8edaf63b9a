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

    [[nodiscard]] std::string name() const { return law + "_" + preset; }
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

Series press(const PointCloud& cloud, const NeighbourIndex& index, const std::string& law, Preset preset)
{
    const glm::dvec3 axes = boundsOf(sampleNamed("ellipsoid")).high;
    Series           series{law, palp::name(preset), settingsFor(preset), {}};
    for (double x : kPlaces) {
        const glm::dvec3 place{x, 0, axes.z * std::sqrt(1 - x * x / (axes.x * axes.x))};
        const Contact    contact = touchAt(cloud, index, place, glm::dvec3(0, 0, 1), 5e-3);
        series.touches.push_back({x, deform(cloud, index, contact, series.settings)});
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

void writePictures(const std::filesystem::path& folder, const PointCloud& cloud, const Series& series)
{
    std::vector<PressedPatch> pressed;
    double                    deepest = 0;
    for (const Touch& touch : series.touches) {
        pressed.push_back({&touch.patch, kForce, ""});
        deepest = std::max(deepest, touch.deflection());
    }
    const std::string what = series.law + " rigidity, " + (series.preset == "paper" ? "the paper's recipe" : "ours");
    write(folder / (series.name() + "_surface.svg"),
          surfaceSvg(cloud, pressed,
                     {what + ": " + formatQuantity(kForce, "N") + " at five places, displacement x 2",
                      kExaggeration,
                      {0.15, 0.75, -0.65},
                      false}));
    for (std::size_t n = 0; n < pressed.size(); ++n) pressed[n].label = placeName(series.touches[n].x);
    write(folder / (series.name() + "_profiles.svg"), profilesSvg(pressed, what));

    const Touch& middle = series.touches[series.touches.size() / 2];
    write(folder / (series.name() + "_rigidity.svg"),
          rigidityChartSvg(middle.patch, series.settings, what + ", " + placeName(middle.x)));
    write(folder / (series.name() + "_deflection.svg"),
          deflectionChartSvg(middle.patch, series.settings, kForce, what + ", " + placeName(middle.x)));
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

nlohmann::json numbers(const std::vector<Series>& all)
{
    nlohmann::json rows = nlohmann::json::array();
    for (const Series& series : all)
        for (const Touch& touch : series.touches) {
            const auto error = discretisationError(touch.patch, series.settings);
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
    std::snprintf(percent, sizeof percent, "%.2f %%", error.is_null() ? 0.0 : 100 * error.get<double>());
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

std::string page(const std::vector<Series>& all, const nlohmann::json& rows)
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
            "<p><img style=\"max-width:44rem\" src=\"summary.svg\" alt=\"deflection against "
            "rigidity\"></p>\n<table><tr>";
    for (const std::string& heading : kHeadings) html << "<th>" << heading << "</th>";
    html << "</tr>\n";
    for (const auto& row : rows) {
        html << "<tr>";
        for (const std::string& cell : cells(row)) html << "<td>" << cell << "</td>";
        html << "</tr>\n";
    }
    html << "</table>\n<p>Grid error: change of compliance against half as many cells, divided by 3. All numbers: "
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
    return html.str();
}

void run(const std::filesystem::path& folder)
{
    makeFolder(folder);
    std::vector<Series> all;
    Progress            progress("pressing");
    for (const auto& [law, kind] :
         {std::pair("linear", SpatialLaw::Kind::linear), std::pair("hyperbolic", SpatialLaw::Kind::hyperbolic)}) {
        const PointCloud     cloud = ellipsoid(kind);
        const NeighbourIndex index(cloud.positions());
        for (Preset preset : {Preset::paper, Preset::palpate}) {
            all.push_back(press(cloud, index, law, preset));
            writeDeformed(folder / (all.back().name() + ".ply"), cloud, all.back());
            writePictures(folder, cloud, all.back());
            progress.at(all.size(), 4);
        }
    }
    const nlohmann::json rows = numbers(all);
    write(folder / "results.json", rows.dump(2) + "\n");
    write(folder / "summary.svg", summaryPlot(all));
    write(folder / "index.html", page(all, rows));
    std::cout << textTable(rows);
}

} // namespace

int main(int argumentCount, char** arguments)
{
    if (argumentCount != 2 || arguments[1][0] == '-') {
        std::cerr << "usage: paper_experiment FOLDER\n";
        return 2;
    }
    try {
        run(arguments[1]);
    } catch (const Error& error) {
        std::cerr << "paper_experiment: " << error.what() << "\n";
        return 2;
    }
    return 0;
}
