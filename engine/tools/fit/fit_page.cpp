#include "engine/tools/fit/fit_page.h"

#include <array>
#include <cmath>

#include "engine/core/quantity.h"
#include "engine/tools/paper/page.h"
#include "engine/tools/plot/line_plot.h"

namespace palp::fit {
namespace {

using report::Figure;
using report::percent;
using report::Section;
using report::Table;

/// Returns the measured forces and those of the laws: over time where depths do not tell the rows apart.
Figure plotOf(const Probe& probe, const ProbeFit& fit)
{
    const std::vector<double>& x = probe.time.empty() ? probe.depth : probe.time;
    std::vector<PlotSeries>    series{{"measured", x, probe.force, SeriesStyle::markers},
                                   {"fitted", x, fit.force, SeriesStyle::line}};
    for (const TriedLaw& law : fit.others)
        series.push_back({law.name, x, law.force, law.name == "linear" ? SeriesStyle::reference : SeriesStyle::line});
    LinePlotSettings settings;
    settings.title = "Probe " + probe.name;
    settings.x =
        probe.time.empty() ? PlotAxis{"depth", "m", Scale::linear, {}} : PlotAxis{"time", "s", Scale::linear, {}};
    settings.y          = {"force", "N", Scale::linear, {}};
    std::string caption = "K " + intervalText(fit.stiffness, "N/m") + ", b " + intervalText(fit.stiffening, "1/m");
    for (std::size_t n = 0; n < fit.relaxation.count; ++n)
        caption += ", g " + report::fixed(fit.shares[n].value, 2) + " in " + intervalText(fit.times[n], "s");
    return {caption + "; leaves " + percent(fit.residual) + " of the range of the forces",
            linePlotSvg(series, settings)};
}

Table tableOf(const ProbesFit& fit)
{
    Table table{"Residuals are root mean squares as shares of the range of a probe's forces.",
                {"probe", "K", "b", "relaxation", "residual"},
                {}};
    for (const TriedLaw& law : fit.probes.front().others) table.headings.push_back(law.name);
    for (const ProbeFit& p : fit.probes) {
        std::vector<std::string> row{p.name, intervalText(p.stiffness, "N/m"), intervalText(p.stiffening, "1/m"),
                                     relaxationText(p.relaxation), percent(p.residual)};
        for (const TriedLaw& law : p.others) row.push_back(percent(law.residual));
        row.resize(table.headings.size());
        table.rows.push_back(std::move(row));
    }
    return table;
}

} // namespace

std::string probesPage(std::span<const Probe> probes, const ProbesFit& fit, const std::string& name)
{
    Section all, each;
    all.letter = 'a', all.title = "All probes";
    each.letter = 'b', each.title = "Each probe";
    all.tables.push_back(tableOf(fit));
    for (std::size_t n = 0; n < probes.size(); ++n) each.figures.push_back(plotOf(probes[n], fit.probes[n]));
    const std::array<std::string, 3> words{
        "Fitted is F = K (e^(b d) - 1) / b of the depth d, and where times were measured what relaxation leaves of "
        "it: the law of a session, whose scene says stiffening = b and relaxation. K is what is felt by that probe's "
        "tip at the surface.",
        "Intervals are 95 %, from the covariance of each fit. The residuals of one curve hang together, so they are "
        "rather too narrow than too wide; how far probes differ says more.",
        "All probes: b " + formatQuantity(fit.stiffening, "1/m") + " and relaxation " + relaxationText(fit.relaxation) +
            " at the median, which leaves " + percent(fit.medianResidual()) + " where a straight line leaves " +
            percent(fit.medianResidual("linear")) + "."};
    return report::plainPage("Presses on " + name, words, std::array{std::move(all), std::move(each)});
}

std::string mapPage(const PointCloud& measured, const FeltFit& fit, const std::string& name, FigureRenderer& renderer)
{
    const auto positions = measured.positions();
    const auto figure    = [&](const std::string& title, const std::string& quantity, const std::string& unit,
                            std::span<const double> values, std::optional<ValueRange> range) {
        CloudFigure settings;
        settings.title = title, settings.quantity = quantity, settings.unit = unit, settings.range = range;
        return Figure{title, cloudFigureSvg(positions, positions, values, settings, renderer)};
    };
    std::vector<double> both(measured.stiffness().begin(), measured.stiffness().end());
    both.insert(both.end(), fit.felt.begin(), fit.felt.end());
    const auto range = rangeOf(both, Scale::linear);
    Section    section;
    section.title   = "The map and the object";
    section.figures = {
        figure("Measured", "felt stiffness", "N/m", measured.stiffness(), range),
        figure("Felt on the fitted object", "felt stiffness", "N/m", fit.felt, range),
        figure("The fitted object", "Young's modulus", "Pa", fit.object.cloud().stiffness(), {}),
        figure("What is left", "felt per measured - 1", "", fit.residual, ValueRange{-0.3, 0.3}),
    };
    const std::array<std::string, 2> words{
        "Each point of the object has the modulus with which the program's own map of felt stiffness agrees with the "
        "measured one. It took " +
            std::to_string(fit.steps) + " steps.",
        "At the median " + percent(fit.rest) + " are left between the two at a point, of which " +
            percent(fit.unsettled) + " could still be corrected. The rest is noise, or contrast within " +
            formatQuantity(fit.reach, "m") + ", which no touch of that tip can tell: it is not followed."};
    return report::plainPage("The map " + name, words, std::array{std::move(section)});
}

} // namespace palp::fit
