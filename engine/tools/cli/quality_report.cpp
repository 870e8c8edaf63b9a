#include "engine/tools/cli/quality_report.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <iostream>
#include <span>
#include <vector>

#include <nlohmann/json.hpp>

#include "engine/chart/coverage.h"
#include "engine/cloud/touch_scale.h"
#include "engine/core/contract.h"
#include "engine/core/counted.h"
#include "engine/core/file.h"
#include "engine/core/quantity.h"
#include "engine/pipeline/curvature_doubt.h"
#include "engine/tools/plot/svg.h"
#include "engine/tools/render/cloud_figure.h"

// What palpate info says about the quality of a scan, and what follows from it for a touch.

namespace palp {
namespace {

constexpr double kUneven = 3;   ///< ratio of the spacings of sparse and dense parts that is worth a word [1]
constexpr double kStep   = 0.1; ///< rounding that is worth a word [spacings]

std::string metres(double length)
{
    return formatQuantity(length, "m");
}

std::string spacings(double ratio)
{
    char text[32];
    std::snprintf(text, sizeof text, "%.2f spacings", ratio);
    return text;
}

/// Returns a number of points with two digits: "0.9", "12", "1300".
std::string roughly(double count)
{
    char text[32];
    if (count >= 10) {
        const double step = std::pow(10.0, std::floor(std::log10(count)) - 1);
        std::snprintf(text, sizeof text, "%.0f", std::round(count / step) * step);
    } else
        std::snprintf(text, sizeof text, "%.1f", count);
    return text;
}

std::string onFingertip(const QualityReport& r)
{
    constexpr double  kWanted = 2; // spacings in a radius: the touch warns below
    const Spread&     s       = r.quality.spacing;
    const std::string tip     = "the fingertip's radius is " + metres(r.fingertip);
    if (r.fingertip < kWanted * s.typical)
        return tip + " and covers only " + roughly(r.quality.pointsUnder(r.fingertip)) +
               " points: stiffness between the points is interpolated, finer detail is not in the data";
    const std::string good =
        tip + " and covers some " + roughly(r.quality.pointsUnder(r.fingertip)) + " points: dense enough";
    if (r.fingertip >= kWanted * s.high) return good;
    return good + ", but not where they are " + metres(s.high) + " apart";
}

/// The same for points in lines, whose density along a line says nothing.
std::string linesOnFingertip(const QualityReport& r)
{
    constexpr double kWanted = 3; // lines under a fingertip: fewer are felt one by one
    const double     lines   = 2 * r.fingertip / r.quality.betweenLines;
    return "the fingertip's radius is " + metres(r.fingertip) + " and covers " + (lines < kWanted ? "only " : "some ") +
           roughly(lines) + " of the lines in which the points lie, " + metres(r.quality.alongLine) +
           " apart along a line and " + metres(r.quality.betweenLines) +
           " from line to line: the touch is as coarse as the lines are apart";
}

std::string onNoise(const CloudQuality& q)
{
    const bool   everywhere = q.noisy > kNoisySpacings;
    const double sigma      = everywhere ? q.noise : q.noise95;
    const double share      = everywhere ? q.noisy : q.noisy95;
    return "the points scatter by " + spacings(share) +
           (everywhere ? "" : " or more in places, where you should expect a blurred touch") +
           ": the touch averages over points " + metres(touchScale(sigma, sigma / share)) +
           " apart, and finer shapes are lost";
}

/// Returns how many borders there are, and how wide the widest of them.
std::string bordersText(const std::vector<double>& widths)
{
    constexpr std::size_t kTold = 4;
    if (widths.empty()) return "";
    std::string text = widths.size() == 1 ? ", as one border " : ", as " + std::to_string(widths.size()) + " borders ";
    for (std::size_t n = 0; n < std::min(kTold, widths.size()); ++n) text += (n > 0 ? ", " : "") + metres(widths[n]);
    return text + (widths.size() > kTold ? ", ... wide" : " wide");
}

std::string onSides(const QualityReport& r)
{
    return std::string(r.quality.sided == 0 ? "" : "elsewhere ") +
           "the outward side is the one from which the hand comes, and is carried along the surface from there: it is "
           "open, or its sides are far apart";
}

std::string onDents(const QualityReport& r)
{
    char widths[32];
    std::snprintf(widths, sizeof widths, "%.1f", r.window / r.dents->typical);
    const std::string dents = "dents of this shell die away over " + metres(r.dents->typical) + " (" +
                              metres(r.dents->least) + " to " + metres(r.dents->most) + "); ";
    if (r.closed > 0) return dents + "the object, all of which bends, is some " + widths + " of these wide";
    return dents + "the patch window of " + metres(r.window) + " is " + widths + " of these wide" +
           (r.window >= 0.95 * r.dents->window ? ""
            : r.whyWindow.empty()              ? ", so that its edges are felt: set window to auto"
                                               : ", so that its edges are felt: the object is no wider");
}

/// Says on how much of the surface a touch warns of its theory; empty where that is hardly any.
std::string onBeyond(const BeyondShell& beyond)
{
    constexpr double  kSome = 0.02; // of the surface [1]
    const std::string deep  = "the patch window sags by more than a fourth of its width",
                      thick = "the sheet is thicker than a tenth of its radius of curvature";
    const auto        on    = [](double share) { return "on " + percentText(share) + " of the surface "; };
    const std::string end   = ": there touch says what that may do to its answer";
    if (beyond.deep > kSome && beyond.thick > kSome)
        return on(beyond.deep) + deep + ", " + on(beyond.thick) + thick + end;
    return beyond.deep > kSome    ? on(beyond.deep) + deep + end
           : beyond.thick > kSome ? on(beyond.thick) + thick + end
                                  : "";
}

std::vector<double> noiseInSpacings(const SurfaceSurvey& survey, std::size_t points)
{
    std::vector<double> values(points);
    for (std::size_t i = 0; i < points; ++i) values[i] = survey.noise(i) / survey.spacing(i);
    return values;
}

} // namespace

std::string percentText(double share)
{
    if (share == 0) return "0 %";
    if (share < 1e-3) return "<0.1 %";
    char text[32];
    std::snprintf(text, sizeof text, share < 0.0995 ? "%.1f %%" : "%.0f %%", 100 * share);
    return share < 1 && text == std::string("100 %") ? "almost 100 %" : text;
}

/// Returns the shares of points whose side is known, by what tells it.
SideSources sideSources(const SoftObject& object, bool byNormals)
{
    std::size_t given = 0, sided = 0;
    for (std::size_t i = 0; i < object.size(); ++i) {
        sided += object.survey().sided(i);
        given += object.survey().given(i);
    }
    const double all = double(object.size()), share = double(given) / all;
    return {byNormals ? share : 0, byNormals ? 0 : share, double(sided - given) / all};
}

QualityReport qualityReport(const SoftObject& object, const LoadedCloud& loaded, const Scene& scene)
{
    const bool          isShell = scene.patch.theory == Theory::shell;
    const bool          whole   = scene.patch.windowOf == WindowOf::object;
    const PatchSettings settled = settledFor(object, scene.patch);
    const double        window  = bentSize(object, settled);
    const bool          isCut   = settled.outside == Outside::body;
    return {cloudQuality(object),
            sideSources(object, !loaded.normals.empty()),
            loaded.report.coordinateRounding,
            scene.patch.footprintRadius,
            window,
            object.cloud().bounds().diagonal(),
            whole ? closedGap(object.spacing(), settled.window / settled.cells) : 0,
            {},
            isShell && !isCut ? dentLengths(object, scene.patch) : std::nullopt,
            whyDentWindow(object, scene.patch),
            isShell && !whole ? beyondShell(object, scene.patch, window) : BeyondShell{},
            isShell ? sparseForCurvature(object) : "",
            isCut};
}

std::vector<std::string> meaningForTouch(const QualityReport& r)
{
    constexpr double         kBeyondReach  = 5; // [m]
    constexpr double         kFewestAcross = 3; // points across a patch window: 9 in all are asked for
    const CloudQuality&      q             = r.quality;
    std::vector<std::string> said;
    if (!r.refusal.empty()) return {"refused: " + r.refusal};
    if (!(q.spacing.typical > 0)) return {"there is no surface to touch: too few points in different places"};
    if (r.size > kBeyondReach)
        said.push_back("the object is " + metres(r.size) +
                       " across, more than a hand reaches: if its numbers are millimetres, say --length-unit mm");
    said.push_back(q.areLines() && q.betweenLines > 0 ? linesOnFingertip(r) : onFingertip(r));
    if (r.window < kFewestAcross * q.spacing.high)
        said.push_back(
            "the patch window of " + metres(r.window) +
            " holds fewer than 9 points where the points are sparse: nothing can be felt there; set --window to " +
            metres(2 * kFewestAcross * q.spacing.high) + " or more");
    if (r.dents)
        said.push_back(onDents(r));
    else if (!r.whyWindow.empty())
        said.push_back("the patch window is " + r.whyWindow);
    if (const std::string beyond = onBeyond(r.beyond); !beyond.empty()) said.push_back(beyond);
    if (!r.sparse.empty()) said.push_back(r.sparse);
    if (q.noisy95 > kNoisySpacings) said.push_back(onNoise(q));
    if (q.noise > r.fingertip / 4)
        said.push_back(
            "the noise of " + metres(q.noise) +
            " is more than a quarter of the fingertip: forces are no better than the depth of a press, which is "
            "uncertain by as much");
    if (q.unevenness() > kUneven)
        said.push_back("the spacing varies by a factor of " + roughly(q.unevenness()) +
                       ": the sparse parts are felt as coarsely as their own points lie");
    else if (q.spacing.typical > kUneven * q.byPoints)
        said.push_back(
            "half of the points lie " + metres(q.byPoints) +
            " apart or less, on a small part of the area: the touch is fine there, and elsewhere as coarse as "
            "the points");
    if (q.strays > 0)
        said.push_back(counted(q.strays, "point", "lies", "lie") +
                       std::string(" far from all others: strays count in the extent, and little is felt there"));
    if (r.closed > 0)
        said.push_back("the sheet ends at borders and holes; gaps up to " + metres(r.closed) +
                       " wide are taken for sheet: five spacings, of the points or of half a cell");
    else if (q.border > 0 && !r.cut)
        said.push_back("at borders and holes the sheet goes on with the stiffness of the nearest points");
    if (q.sided < 0.995) said.push_back(onSides(r));
    if (r.rounding > kStep * q.spacing.typical)
        said.push_back("the coordinates are rounded to steps of " + metres(r.rounding) + ", " +
                       spacings(r.rounding / q.spacing.typical) + ": the surface is felt as stairs");
    if (q.depthStep > 0)
        said.push_back("the depth takes few values, " + metres(q.depthStep) + " apart (" +
                       spacings(q.depthStep / q.spacing.typical) +
                       "): layers of equal depth count as faces without noise of their own, and are felt as stairs");
    return said;
}

nlohmann::json jsonOf(const QualityReport& r)
{
    const CloudQuality& q = r.quality;
    return {{"spacing",
             {{"min", q.spacing.least},
              {"p5", q.spacing.low},
              {"median", q.spacing.typical},
              {"median_by_points", q.byPoints},
              {"p95", q.spacing.high},
              {"max", q.spacing.most}}},
            {"area", q.areLines() ? nlohmann::json(nullptr) : nlohmann::json(q.area)},
            {"noise", {{"median", q.noise}, {"p95", q.noise95}}},
            {"noise_in_spacings", {{"median", q.noisy}, {"p95", q.noisy95}}},
            {"sides_known",
             {{"all", q.sided}, {"file", r.sides.file}, {"faces", r.sides.faces}, {"layers", r.sides.layers}}},
            {"border_points", q.border},
            {"strays", q.strays},
            {"border_widths", q.borderWidths},
            {"points_in_lines", q.inLines},
            {"spacing_between_lines", q.areLines() ? nlohmann::json(q.betweenLines) : nlohmann::json(nullptr)},
            {"spacing_along_lines", q.areLines() ? nlohmann::json(q.alongLine) : nlohmann::json(nullptr)},
            {"coordinate_rounding", r.rounding},
            {"depth_step", q.depthStep},
            {"footprint_radius", r.fingertip},
            {"points_under_footprint", q.pointsUnder(r.fingertip)},
            {"window", r.window},
            {"closed_gap", r.closed > 0 ? nlohmann::json(r.closed) : nlohmann::json(nullptr)},
            {"dent_lengths",
             r.dents ? nlohmann::json{{"min", r.dents->least}, {"median", r.dents->typical}, {"max", r.dents->most}}
                     : nlohmann::json(nullptr)},
            {"beyond_shell_theory", {{"deep", r.beyond.deep}, {"thick", r.beyond.thick}}},
            {"for_touch", meaningForTouch(r)}};
}

void printText(const QualityReport& r, std::size_t duplicates)
{
    const CloudQuality& q      = r.quality;
    const std::string   merged = std::to_string(duplicates) + " exact duplicates merged\n";
    if (!(q.spacing.typical > 0)) {
        std::cout << "  spacing     unknown (fewer than seven different places), " << merged;
        return;
    }
    std::cout << "  spacing     " << metres(q.spacing.typical) << " between points; 90 % of the area "
              << metres(q.spacing.low) << " to " << metres(q.spacing.high) << ", all " << metres(q.spacing.least)
              << " to " << metres(q.spacing.most) << "; " << merged << "  noise       " << metres(q.noise) << " ("
              << spacings(q.noisy) << "); 95 % of the points below " << metres(q.noise95) << " (" << spacings(q.noisy95)
              << ")\n";
    std::cout << "  sides       known for " << percentText(q.sided) << " of the points";
    const char* joint = ": ";
    for (const auto& [share, source] : {std::pair{r.sides.file, "normals in the file"},
                                        {r.sides.faces, "faces"},
                                        {r.sides.layers, "another side that is near"}}) {
        if (share == 0) continue;
        std::cout << joint << percentText(share) << " by " << source;
        joint = ", ";
    }
    std::cout << "\n  borders     " << percentText(q.border) << " of the points are at a border or beside a hole"
              << bordersText(q.borderWidths) << "\n";
}

void demandPictureName(const std::string& option, const std::string& file)
{
    const auto ending = std::filesystem::path(file).extension();
    if (ending != ".png" && ending != ".svg")
        throw Error(option + ": expected a file that ends in .png or .svg, found \"" + file + "\"");
    expectWritable(file);
}

/// Returns what colours span [m]: what 90 % of the area have, and 90 % of the points, as a dense part may be small and
/// hold most of them.
ValueRange shownSpacings(const Spread& area, std::span<const double> ofPoints)
{
    constexpr double    kEven = 1.5; // to either side of the median at least: even clouds look even [1]
    std::vector<double> sorted(ofPoints.begin(), ofPoints.end());
    std::sort(sorted.begin(), sorted.end());
    const auto at = [&](double share) { return sorted[std::size_t(share * double(sorted.size() - 1))]; };
    return {std::min({area.low, at(0.05), area.typical / kEven}),
            std::max({area.high, at(0.95), area.typical * kEven})};
}

void writeQualityPicture(const std::filesystem::path& file, const std::string& title, const SoftObject& object,
                         const CloudQuality& quality)
{
    const Spread&             s        = quality.spacing;
    const std::vector<double> noise    = noiseInSpacings(object.survey(), object.size());
    const ValueRange          range    = shownSpacings(s, object.survey().spacings());
    const bool                steep    = range.low > 0 && range.high > 10 * range.low; // coinciding points: low is 0
    const Scale               scale    = steep ? Scale::logarithmic : Scale::linear;
    const CloudPanel          panels[] = {
                 {object.survey().spacings(),
                  {ColourMap::viridis, scale, range, "spacing", "m"},
                  title,
                  metres(s.typical) + " between points; 90 % of the area " + metres(s.low) + " to " + metres(s.high)},
                 {noise,
                  {ColourMap::cividis,
                   Scale::linear,
                   {0, std::max(2 * kNoisySpacings, quality.noisy95)},
                   "noise [spacings]",
                   "1"},
                  "noise",
                  metres(quality.noise) + ", " + spacings(quality.noisy) + "; the touch smooths more above " +
                      spacings(kNoisySpacings)}};
    FigureRenderer renderer;
    const Image    image = cloudPanels(object, panels, renderer);
    std::string    bytes;
    if (file.extension() == ".svg") {
        SvgDrawing       svg;
        const glm::dvec2 size(image.width, image.height);
        svg.image({0, 0}, size, image);
        bytes = svg.finish(size, title + ": spacing and noise");
    } else
        bytes = encodePng(image);
    writeFileWhole(file, [&](std::ostream& stream) { stream << bytes; });
}

} // namespace palp
