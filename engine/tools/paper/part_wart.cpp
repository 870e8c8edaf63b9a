// Felt stiffness along a line over a wart, under the published force law and under ours.
#include <algorithm>
#include <cmath>

#include "engine/core/quantity.h"
#include "engine/perception/felt_path.h"
#include "engine/tools/paper/parts.h"
#include "engine/perception/perception.h"
#include "engine/tools/plot/line_plot.h"

namespace palp::report {
namespace {

/// Skin with a wart ten times as stiff; a finger pauses at places across it.
struct Walk {
    Scene                  scene;
    std::vector<FeltPlace> places;

    [[nodiscard]] std::vector<double> felt(ForceLaw law) const
    {
        std::vector<double> values;
        for (const FeltPlace& place : places) values.push_back(place.felt(law));
        return values;
    }
};

Walk walk(const ReportRun& run)
{
    constexpr double kReach = 20e-3; // to either side [m]: there the wart is not felt
    Walk             result{parseScene(run.quick ? R"({"cloud": "sample:skin", "points": 8000, "cells": 32})"
                                                 : R"({"cloud": "sample:skin"})",
                           "the wart", "."),
                {}};
    const SoftObject object = loadObject(result.scene).object;
    const FeltLine   line   = feltLine(result.scene, object, {}, kReach);
    result.places           = windowsAlong(object, result.scene.patch, line, run.quick ? 17 : 81, run.solver);
    return result;
}

std::string figureOf(const Walk& walk, double cap)
{
    PlotSeries ours{"plate and contact in series", {}, {}, SeriesStyle::line}, paper = ours, plate = ours, limit = ours;
    paper.name  = "paper: E A / h";
    plate.name  = "plate alone: 1 / c";
    limit.name  = "most that a loop of 1 kHz renders";
    limit.style = SeriesStyle::reference;
    for (const FeltPlace& place : walk.places) {
        for (PlotSeries* series : {&ours, &paper, &plate, &limit}) series->x.push_back(place.along);
        ours.y.push_back(place.felt(ForceLaw::series));
        paper.y.push_back(place.felt(ForceLaw::paper));
        plate.y.push_back(1 / place.compliance);
        limit.y.push_back(cap);
    }
    LinePlotSettings settings;
    settings.title = "Felt stiffness over a wart";
    settings.x     = {"from the middle of the wart", "m", Scale::linear, {}};
    settings.y     = {"stiffness", "N/m", Scale::logarithmic, {}};
    return linePlotSvg(std::vector{ours, paper, plate, limit}, settings);
}

} // namespace

Section wartPart(const ReportRun& run)
{
    const Walk   walked = walk(run);
    const double cap    = walked.scene.stiffnessCap;
    const auto   series = walked.felt(ForceLaw::series), paper = walked.felt(ForceLaw::paper);
    const auto [seriesLow, seriesHigh] = std::minmax_element(series.begin(), series.end());
    const auto [paperLow, paperHigh]   = std::minmax_element(paper.begin(), paper.end());

    Section section{'g', "Felt stiffness along a line over a wart", {}, {}, {}, {}, {}, {}};
    section.text = {"Skin on soft tissue with a wart ten times as stiff, 3 mm wide (standard deviation), touched along "
                    "a line across it. The paper's force law F = (E A / h) depth feels the contact alone; the plate "
                    "bends on the screen and is not felt. In series, plate and contact give way one after the other, "
                    "as springs do, and the softer one decides.",
                    "A servo of 1 kHz renders about " + formatQuantity(cap, "N/m") +
                        " without swinging. The paper's law asks for more than that everywhere, so that on a device "
                        "the wart would be cut off."};
    Table table{"J counts steps that a finger with that smallest noticed change can just tell apart.",
                {"force law", "softest", "stiffest", "J at 7 %", "J at 15 %", "J at 22 %", "of it left below the cap"},
                {}};
    for (const auto& [law, low, high] :
         {std::tuple(ForceLaw::series, *seriesLow, *seriesHigh), std::tuple(ForceLaw::paper, *paperLow, *paperHigh)}) {
        const double left = noticeableSteps(std::min(high, cap), std::min(low, cap), kWeberFractions[0]) /
                            noticeableSteps(high, low, kWeberFractions[0]);
        const std::string        stem = std::string(palp::name(law)) + "/";
        std::vector<std::string> row{palp::name(law), formatQuantity(low, "N/m"), formatQuantity(high, "N/m")};
        for (const double weber : kWeberFractions) row.push_back(fixed(noticeableSteps(high, low, weber), 1));
        row.push_back(percent(left));
        table.rows.push_back(row);
        section.numbers.push_back({stem + "stiffness", "N/m", walked.felt(law)});
        section.numbers.push_back({stem + "steps_weber_0.07", "1", {noticeableSteps(high, low, kWeberFractions[0])}});
        section.numbers.push_back({stem + "share_below_cap", "1", {left}});
    }
    std::vector<double> along, compliance;
    for (const FeltPlace& place : walked.places) {
        along.push_back(place.along);
        compliance.push_back(place.compliance);
    }
    section.numbers.push_back({"along", "m", along});
    section.numbers.push_back({"compliance", "m/N", compliance});
    section.numbers.push_back({"stiffness_cap", "N/m", {cap}});
    section.figures.push_back({"What a finger feels that presses straight down at each place.", figureOf(walked, cap)});
    section.tables.push_back(std::move(table));
    section.claims.push_back(
        {"The force F = (E A / h) depth lets the hand feel stiffness that varies.",
         "Over the wart E A / h goes from " + formatQuantity(*paperLow, "N/m") + " to " +
             formatQuantity(*paperHigh, "N/m") + "; in series with the plate, " + formatQuantity(*seriesLow, "N/m") +
             " to " + formatQuantity(*seriesHigh, "N/m") + ".",
         std::to_string(walked.places.size()) + " touches along 40 mm, both laws on the same plates", Verdict::inPart,
         "It varies, but it is the contact's, not the object's: the plate beneath is several times "
         "softer and is not felt, and all of it lies beyond what a device renders."});
    return section;
}

} // namespace palp::report
