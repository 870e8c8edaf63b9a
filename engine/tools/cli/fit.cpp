#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <iostream>
#include <memory>

#include <nlohmann/json.hpp>

#include "engine/core/contract.h"
#include "engine/core/counted.h"
#include "engine/core/file.h"
#include "engine/core/progress.h"
#include "engine/core/quantity.h"
#include "engine/core/shown_text.h"
#include "engine/tools/cli/cloud_report.h"
#include "engine/tools/cli/commands.h"
#include "engine/tools/cli/scene_source.h"
#include "engine/tools/cli/solver_choice.h"
#include "engine/tools/fit/fit_page.h"
#include "engine/tools/paper/section.h"

// palpate fit: from measurements to an object.

namespace palp {
namespace {

using Json = nlohmann::ordered_json;

struct FitOptions {
    SceneSource source;
    std::string out, page;
    std::size_t places = 400;
    bool        json   = false;
};

void refuseSourcesAsTargets(const FitOptions& o, const std::string& cloud)
{
    for (const std::string& source : {o.source.name, cloud}) {
        refuseSourceAsTarget("--out", source, o.out);
        refuseSourceAsTarget("--page", source, o.page);
    }
}

void writePage(const std::string& file, const std::string& html)
{
    writeFileWhole(file, [&](std::ostream& stream) { stream << html; });
}

void printWritten(const FitOptions& o)
{
    for (const std::string& file : {o.out, o.page})
        if (!file.empty()) std::printf("  written     %s\n", file.c_str());
}

void addWritten(Json& json, const FitOptions& o)
{
    json["written"] = o.out.empty() ? Json() : Json(o.out);
    json["page"]    = o.page.empty() ? Json() : Json(o.page);
}

// --- presses

Json jsonOf(const fit::Estimate& e)
{
    return {{"value", e.value}, {"low", e.low}, {"high", e.high}};
}

Json jsonOf(const fit::Probe& probe, const fit::ProbeFit& found)
{
    Json json{{"probe", found.name},
              {"rows", probe.force.size()},
              {"felt_stiffness", jsonOf(found.stiffness)},
              {"stiffening", jsonOf(found.stiffening)},
              {"residual", found.residual}};
    if (probe.place) json["at"] = {probe.place->x, probe.place->y, probe.place->z};
    Json terms = Json::array();
    for (std::size_t n = 0; n < found.shares.size(); ++n)
        terms.push_back({{"share", jsonOf(found.shares[n])}, {"time", jsonOf(found.times[n])}});
    json["relaxation"] = terms;
    for (const fit::TriedLaw& law : found.others) json["other_residuals"][law.name] = law.residual;
    return json;
}

void printProbes(const FitOptions& o, const fit::ProbesFit& all)
{
    std::printf("%s: %s, 95 %% intervals from the covariance of each fit\n\n", o.source.name.c_str(),
                counted(all.probes.size(), "press", "es").c_str());
    std::printf("%-10s %-34s %-34s %9s %9s %9s %9s  %s\n", "probe", "K", "b", "residual", "linear", "Hertz", "cubic",
                "relaxation");
    for (const fit::ProbeFit& p : all.probes)
        std::printf("%-10s %-34s %-34s %9s %9s %9s %9s  %s\n", p.name.c_str(),
                    fit::intervalText(p.stiffness, "N/m").c_str(), fit::intervalText(p.stiffening, "1/m").c_str(),
                    report::percent(p.residual).c_str(), report::percent(p.others[0].residual).c_str(),
                    report::percent(p.others[1].residual).c_str(), report::percent(p.others[2].residual).c_str(),
                    relaxationText(p.relaxation).c_str());
    std::printf("\nmedian residual %s of the range of the forces; linear %s, Hertz %s, cubic %s\n",
                report::percent(all.medianResidual()).c_str(), report::percent(all.medianResidual("linear")).c_str(),
                report::percent(all.medianResidual("Hertz")).c_str(),
                report::percent(all.medianResidual("cubic")).c_str());
    std::printf("for a scene:  \"stiffening\": %.4g, \"relaxation\": \"%s\"\n", all.stiffening,
                relaxationText(all.relaxation).c_str());
    printWritten(o);
}

/// Writes what was felt at the places of the presses, as a map that the command fits in turn.
void writeMap(const FitOptions& o, std::span<const fit::Probe> probes, const fit::ProbesFit& all)
{
    std::vector<glm::dvec3>            places;
    std::vector<double>                stiffness, stiffening, residual;
    std::array<std::vector<double>, 3> normals;
    for (std::size_t n = 0; n < probes.size(); ++n) {
        if (!probes[n].place)
            throw Error("--out: expected the places of the presses, columns x, y and z of " + o.source.name +
                        ", found none; omit --out, or add them");
        places.push_back(*probes[n].place);
        stiffness.push_back(all.probes[n].stiffness.value);
        stiffening.push_back(all.probes[n].stiffening.value);
        residual.push_back(all.probes[n].residual);
        if (probes[n].normal)
            for (int k = 0; k < 3; ++k) normals[std::size_t(k)].push_back((*probes[n].normal)[k]);
    }
    std::vector<NamedField> fields;
    if (normals[0].size() == probes.size())
        fields = {{"nx", "", normals[0]}, {"ny", "", normals[1]}, {"nz", "", normals[2]}};
    fields.push_back({"stiffening", "1/m", stiffening});
    fields.push_back({"residual", "", residual});
    writeCloud(o.out, PointCloud(places, stiffness, StiffnessKind::felt), fields);
}

void fitProbes(const FitOptions& o)
{
    if (!o.source.flags.empty())
        throw Error(flagOf(o.source.flags.begin()->first) +
                    ": presses over depth take no keys of scenes; a map of felt stiffness does");
    refuseSourcesAsTargets(o, o.source.name);
    const auto                    unused = unusedVariables();
    const std::vector<fit::Probe> probes = fit::readProbes(o.source.name);
    std::vector<fit::ProbeFit>    fits;
    Progress                      progress("fitting " + o.source.name);
    for (const fit::Probe& probe : probes) {
        progress.at(fits.size(), probes.size());
        fits.push_back(fit::fitProbe(probe));
    }
    const fit::ProbesFit all = fit::together(std::move(fits));
    if (!o.out.empty()) writeMap(o, probes, all);
    if (!o.page.empty()) writePage(o.page, fit::probesPage(probes, all, o.source.title()));
    if (!o.json) {
        printProbes(o, all);
        return warn(unused);
    }
    Json json{{"name", o.source.name},
              {"interval", 0.95},
              {"interval_from", "covariance"},
              {"stiffening", all.stiffening},
              {"relaxation", relaxationText(all.relaxation)},
              {"residual", all.medianResidual()},
              {"warnings", unused}};
    addWritten(json, o);
    for (std::size_t n = 0; n < probes.size(); ++n) json["probes"].push_back(jsonOf(probes[n], all.probes[n]));
    std::cout << jsonText(json);
}

// --- maps

double median(std::span<const double> values)
{
    std::vector<double> sorted(values.begin(), values.end());
    std::nth_element(sorted.begin(), sorted.begin() + std::ptrdiff_t(sorted.size() / 2), sorted.end());
    return sorted[sorted.size() / 2];
}

/// Refuses a map of which no object can be made.
void demandMap(const FitOptions& o, const Scene& scene, const PointCloud& cloud)
{
    constexpr std::size_t kFewest = 8;
    if (cloud.kind() != StiffnessKind::felt)
        throw Error(o.source.name +
                    ": expected a map of felt stiffness [N/m] or presses over depth, found a stiffness in " +
                    std::string(unitOf(cloud.kind())) +
                    "; if it was felt, say --stiffness-unit N/m, or call the property felt_stiffness");
    const auto tip = scene.origins.find("footprint_radius");
    if (tip == scene.origins.end() || tip->second.origin == Origin::standard)
        throw Error(o.source.name +
                    ": expected the radius over which the probe's tip pressed, found none; give "
                    "--footprint-radius, such as 3mm: for a ball of radius R pressed d deep, sqrt(R d)");
    if (cloud.size() < kFewest)
        throw Error(o.source.name + ": expected at least " + std::to_string(kFewest) + " points, found " +
                    std::to_string(cloud.size()));
    const double size = cloud.bounds().diagonal();
    if (2 * scene.patch.footprintRadius > size)
        throw Error(openingOf(scene, "footprint_radius") + ": expected a tip smaller than the map, found a radius of " +
                    formatQuantity(scene.patch.footprintRadius, "m") + " on a map of " + formatQuantity(size, "m") +
                    "; is the unit right?");
}

/// Returns what looks odd about a fit, in sentences.
std::vector<std::string> doubts(const PointCloud& measured, const fit::FeltFit& found)
{
    constexpr double         kSoftest = 1e2, kHardest = 1e9; // [Pa] jelly, hard plastic
    constexpr double         kOpen = 0.02;                   // [1] of corrections
    std::vector<std::string> said;
    const double             modulus = median(found.object.cloud().stiffness()), felt = median(measured.stiffness());
    if (!(modulus > kSoftest && modulus < kHardest))
        said.push_back("the map asks for a modulus of " + formatQuantity(modulus, "Pa") + " to feel like " +
                       formatQuantity(felt, "N/m") +
                       "; are its unit, the tip, the thickness and the foundation right?");
    if (found.unsettled > kOpen)
        said.push_back("after " + std::to_string(found.steps) + " steps " + report::percent(found.unsettled) +
                       " are still to be corrected at the median: no object of this thickness, foundation and tip "
                       "feels like the map");
    if (found.leftOut > 0)
        said.push_back(std::to_string(found.leftOut) +
                       " places could not be touched; there the modulus follows from places nearby");
    return said;
}

void printMap(const FitOptions& o, const PointCloud& measured, const fit::FeltFit& found, const std::string& solver)
{
    const auto [soft, hard] = std::ranges::minmax(found.object.cloud().stiffness());
    std::printf("%s: %zu points, felt stiffness typically %s\n", o.source.name.c_str(), measured.size(),
                formatQuantity(median(measured.stiffness()), "N/m").c_str());
    std::printf("  modulus     %s at the median, %s to %s\n",
                formatQuantity(median(found.object.cloud().stiffness()), "Pa").c_str(),
                formatQuantity(soft, "Pa").c_str(), formatQuantity(hard, "Pa").c_str());
    std::printf("  steps       %d, solved on %s\n", found.steps, solver.c_str());
    std::printf("  left over   %s at the median: noise, and contrast within %s, which no touch can tell\n",
                report::percent(found.rest).c_str(), formatQuantity(found.reach, "m").c_str());
    printWritten(o);
}

void fitMap(const FitOptions& o)
{
    const Scene       scene  = o.source.load();
    const LoadedCloud loaded = o.source.loadCloud(scene);
    demandMap(o, scene, loaded.cloud);
    refuseSourcesAsTargets(o, scene.cloud);
    PlateSolver solver = openSolver(scene.solver);
    const int   told   = solver.counts().takeovers;
    LoadedCloud guess  = loaded; // one modulus everywhere
    const auto  at     = loaded.cloud.positions();
    guess.cloud =
        PointCloud({at.begin(), at.end()}, std::vector<double>(at.size(), kDefaultModulus), StiffnessKind::modulus);
    const SoftObject     start = objectOf(std::move(guess), scene).object;
    Progress             progress("fitting " + o.source.name);
    fit::FeltFitSettings settings{scene.patch, o.places, 15,
                                  [&](std::size_t done, std::size_t total) { progress.at(done, total); }};
    const fit::FeltFit   found    = fit::fitFeltMap(start, loaded.cloud.stiffness(), settings, solver);
    const std::string    takeover = sayTakeovers(solver, told);
    if (!o.out.empty()) {
        const auto              felt = loaded.cloud.stiffness();
        const FieldsBeside      beside(loaded);
        std::vector<NamedField> fields(beside.all().begin(), beside.all().end());
        fields.push_back({"measured", "N/m", felt});
        fields.push_back({"felt", "N/m", found.felt});
        fields.push_back({"residual", "", found.residual});
        writeCloud(o.out, found.object.cloud(), fields, {CloudEncoding::binaryLittleEndian, loaded.faces});
    }
    std::vector<std::string> undrawn;
    if (!o.page.empty()) {
        FigureRenderer renderer;
        writePage(o.page, fit::mapPage(loaded.cloud, found, o.source.title(), renderer));
        undrawn = renderer.warnings();
    }
    auto odd = cloudWarnings(scene, loaded.cloud, loaded.report);
    for (std::string& doubt : doubts(loaded.cloud, found)) odd.push_back(std::move(doubt));
    odd.insert(odd.end(), undrawn.begin(), undrawn.end());
    if (!o.json) {
        printMap(o, loaded.cloud, found, solver.name());
        warn(odd);
        return;
    }
    const auto [soft, hard] = std::ranges::minmax(found.object.cloud().stiffness());
    Json json{{"name", o.source.name},
              {"points", loaded.cloud.size()},
              {"felt_stiffness_median", median(loaded.cloud.stiffness())},
              {"modulus_median", median(found.object.cloud().stiffness())},
              {"modulus_min", soft},
              {"modulus_max", hard},
              {"footprint_radius", scene.patch.footprintRadius},
              {"steps", found.steps},
              {"residual", found.rest},
              {"unsettled", found.unsettled},
              {"reach", found.reach},
              {"left_out", found.leftOut},
              {"solved_on", solver.name()},
              {"takeover", orNull(takeover)},
              {"warnings", odd}};
    addWritten(json, o);
    std::cout << jsonText(json);
}

} // namespace

void addFitCommand(CLI::App& app)
{
    CLI::App*  command = app.add_subcommand("fit", "makes materials and objects of measured presses and maps");
    const auto o       = std::make_shared<FitOptions>();
    o->source.addTo(*command, SceneKey::Group::touch);
    command->get_option("SCENE")->description(
        "presses, a table of depth and force (.csv); or a map of felt stiffness, a cloud file (" +
        extensionsFor(CloudUse::reading) + ") or a scene file with one");
    command->add_option("--out", o->out,
                        "of presses the map of felt stiffness, of a map the object: a cloud file, " +
                            extensionsFor(CloudUse::writing));
    command->add_option("--page", o->page, "HTML file with a plot for each press, or pictures of the map");
    command->add_option("--places", o->places, "approximate number of touches in a step on a map")
        ->check(CLI::Range(8, 20'000))
        ->capture_default_str();
    command->add_flag("--json", o->json, "machine-readable, SI units");
    command->footer(
        "Examples:\n"
        "  palpate fit probes.csv --page probes.html --out map.csv\n"
        "  palpate fit map.csv --footprint-radius 3mm --thickness 4mm --foundation 2MPa/m --out object.ply\n"
        "Presses are rows with the columns depth and force, and perhaps probe, time, x, y, z, nx, ny, nz;\n"
        "a unit stands in brackets, as in depth [mm], else they are m, N and s.\n"
        "A map is a cloud with the property felt_stiffness [N/m], or --stiffness-unit N/m.\n"
        "Touch the object with the thickness and foundation with which it was fitted.");
    command->callback([command, o] {
        if (!o->out.empty()) static_cast<void>(formatToWrite(o->out)); // first, refuses a name of no known format
        if (!o->page.empty() && std::filesystem::path(o->page).extension() != ".html")
            throw Error("--page: expected a file that ends in .html, found \"" + o->page + "\"");
        for (const std::string& file : {o->out, o->page})
            if (!file.empty()) expectWritable(file);
        const bool isScene = o->source.name.ends_with(".json") || o->source.name.starts_with(kSamplePrefix);
        if (!isScene && fit::holdsProbes(o->source.name)) {
            if (command->get_option("--places")->count() > 0)
                throw Error("--places has no effect on presses over depth, found " + shownPath(o->source.name) +
                            "; a map of felt stiffness has places");
            return fitProbes(*o);
        }
        fitMap(*o);
    });
}

} // namespace palp
