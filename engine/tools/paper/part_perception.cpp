// What people would notice along paths over three objects, predicted, beside the floor of the same points with one
// stiffness.
#include "engine/core/quantity.h"
#include "engine/tools/paper/parts.h"
#include "engine/tools/paper/perception_figures.h"
#include "engine/perception/scene_perception.h"

namespace palp::report {
namespace {

struct Felt {
    std::string     name, scene; ///< for people; JSON
    double          reach = 0;   ///< of the path to either side [m]
    bool            map   = false;
    ScenePerception perception{};
};

std::string withLess(const std::string& scene, bool quick)
{
    return quick ? scene.substr(0, scene.rfind('}')) + R"(, "points": 6000, "cells": 32})" : scene;
}

/// \param number, count  of the objects, for progress
void feel(Felt& felt, Section& section, const ReportRun& run, std::size_t number, std::size_t count)
{
    static constexpr std::size_t kSteps = 100; // per object: half along the path, half for the map
    const auto                   part   = [&](std::size_t first) {
        return [&run, from = number * kSteps + first, count](std::size_t done, std::size_t total) {
            run.step(from + kSteps / 2 * done / total, count * kSteps);
        };
    };
    constexpr int    kMapPlaces = 500;
    const Scene      scene      = parseScene(withLess(felt.scene, run.quick), felt.name, ".");
    const SoftObject object     = loadObject(scene).object;
    const FeltLine   line       = feltLine(scene, object, {}, felt.reach);
    felt.perception             = perceive(scene, object, line, run.quick ? 11 : 41, run.solver, part(0));
    section.figures.push_back({"A finger at rest, one that slides, and one that slides over the same points with one "
                               "stiffness: a variation there is an artefact.",
                               pathSvg(felt.perception, scene.patch.forceLaw, "Felt along the path: " + felt.name)});
    if (!felt.map) return;
    const FeltMap map = feltMap(object, scene.patch, run.quick ? 60 : kMapPlaces, run.solver, part(kSteps / 2));
    section.figures.push_back(
        {"How surely a place is told from the object's typical one if 15 % is the smallest change "
         "that is noticed: 0.5 is guessing.",
         mapSvg(object.cloud(), map, kWeberFractions[1], line.middle.outward,
                "Told from the typical place: " + felt.name, run.renderer)});
    section.numbers.push_back({felt.name + "/map/typical", "N/m", {map.typical}});
    section.numbers.push_back({felt.name + "/map/places", "1", {double(map.places.size())}});
}

void addNumbers(Section& section, const Felt& felt)
{
    for (const auto& [how, noticed] :
         {std::pair("sliding", felt.perception.sliding), std::pair("at_rest", felt.perception.atRest)}) {
        std::vector<double> whole, passing, floor, right;
        for (const NoticedSteps& n : noticed) {
            whole.push_back(n.whole);
            passing.push_back(n.passing);
            floor.push_back(n.floor);
            right.push_back(n.right);
        }
        const std::string stem = felt.name + "/" + how + "/";
        section.numbers.push_back({stem + "steps", "1", whole});
        section.numbers.push_back({stem + "steps_in_passing", "1", passing});
        section.numbers.push_back({stem + "floor", "1", floor});
        section.numbers.push_back({stem + "right_answers", "1", right});
    }
}

} // namespace

Section perceptionPart(const ReportRun& run)
{
    std::vector<Felt> all;
    all.push_back(
        {"ellipsoid, linear",
         R"({"cloud": "sample:ellipsoid", "stiffness": {"law": "linear", "from": 0.15e6, "to": 1.5e6, "axis": "x"}, "from": [0, 0, 1]})",
         30e-3, false});
    all.push_back({"skin with a wart", R"({"cloud": "sample:skin"})", 20e-3, true});
    all.push_back({"palm",
                   R"({"cloud": "sample:palm", "foundation": "2 MPa/m", "window": "78 mm", "thickness": "3.5 mm"})",
                   24e-3, true});

    Section section{'h', "What a person would notice: a prediction", {}, {}, {}, {}, {}, {}};
    section.text = {
        "Nobody was asked. J counts the steps between two stiffnesses that can just be told apart, "
        "|ln(k1/k2)| / ln(1 + W), for people whose smallest noticed change W is 7, 15 or 22 %. A step is "
        "told right in 3 of 4 trials; in general in a share Φ(0.674 J) of them. Sliding goes through all of "
        "a session at 50 mm/s: proxy, tables at 60 Hz, hand-over, energy tank, governor. The floor is J of "
        "the same hand over the same points with one stiffness, and has to stay below 0.5."};
    section.numbers.push_back({"weber_fractions", "1", {kWeberFractions.begin(), kWeberFractions.end()}});
    Table  table{"Sliding. Right answers: stiffest and softest place of the path, side by side.",
                {"object", "smallest change noticed", "J of the path", "J within 5 mm", "floor", "right answers"},
                {}};
    double floor = 0;
    for (Felt& felt : all) {
        feel(felt, section, run, std::size_t(&felt - all.data()), all.size());
        addNumbers(section, felt);
        for (const NoticedSteps& n : felt.perception.sliding) {
            table.rows.push_back({felt.name, percent(n.weber), fixed(n.whole, 2), fixed(n.passing, 2),
                                  formatNumber(n.floor), fixed(100 * n.right, 1) + " %"});
            floor = std::max(floor, n.floor);
        }
    }
    section.tables.push_back(std::move(table));
    const NoticedSteps& most = all.front().perception.sliding[1];
    section.claims.push_back(
        {"About 90 % of the users perceived the change of stiffness over the object.",
         "Predicted for the ellipsoid: J = " + fixed(most.whole, 1) + " for W = 15 %, right in " +
             fixed(100 * most.right, 0) + " % of trials; largest floor of these objects " + formatNumber(floor) + ".",
         "a hand slides 60 mm through the whole pipeline in virtual time; a prediction, no study with people",
         most.right >= 0.9 && floor < kMostFloor ? Verdict::holds : Verdict::inPart,
         most.right >= 0.9 && floor < kMostFloor
             ? "Consistent, not a test of it: between its ends so large a change should be noticed by all, and it is "
               "no artefact. How far apart the places were that the users compared is not published."
             : "The predicted score is lower, or part of what is felt is an artefact."});
    return section;
}

} // namespace palp::report
