// The parts of the report, in their quick form, against what is known of them otherwise.
#include "engine/tools/paper/parts.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "engine/core/contract.h"
#include "engine/tools/paper/cantilever.h"
#include "engine/tools/paper/page.h"
#include "engine/tools/paper/random_maps.h"
#include "tests/pipeline/calculix_shells.h"

namespace palp::report {
namespace {

PlateSolver& host()
{
    static PlateSolver solver("host");
    return solver;
}

/// A small run with a renderer of its own.
struct Quick {
    FigureRenderer renderer;
    ReportRun      run{.solver = host(), .renderer = renderer, .quick = true};
};

TEST(PlacesPart, DeflectionFallsAsOneOverRigidityByBothRecipes)
{
    const Section section = placesPart(Quick().run);
    for (const std::string law : {"linear", "hyperbolic"})
        for (const std::string preset : {"paper", "palpate"}) {
            const auto& rigidity   = section.number(law + "/" + preset + "/rigidity");
            const auto& deflection = section.number(law + "/" + preset + "/deflection");
            ASSERT_EQ(rigidity.size(), 5u);
            for (std::size_t n = 1; n < 5; ++n) {
                EXPECT_GT(rigidity[n], 1.2 * rigidity[n - 1]) << "a quarter of the way along the law";
                EXPECT_LT(deflection[n], 0.85 * deflection[n - 1]);
                EXPECT_NEAR(deflection[n] * rigidity[n] / (deflection[0] * rigidity[0]), 1, 0.08)
                    << "1 / D holds for one D throughout; it varies by a fifth within a window";
            }
        }
    EXPECT_EQ(section.claims.front().verdict, Verdict::holds);
}

/// \source an independent prototype in double precision: a point load on the cap of 10 degrees, the same in three maps
TEST(MapsPart, TheSameCapIsOblongAndShallowInGallPetersAndRoundInTheAzimuthalMap)
{
    const Section section = mapsPart(Quick().run);
    const auto    number  = [&](const std::string& name) { return section.number(name).front(); };

    // The poke has a tenth of the cap's radius, which rounds the dent off a little, and the grid 64 cells.
    EXPECT_NEAR(number("cap/gall-peters/elongation"), 1.504, 0.03);
    EXPECT_NEAR(number("cap/gall-peters/depth_over_azimuthal"), 0.44046 / 0.68207, 0.01);
    EXPECT_NEAR(number("cap/lambert-cylindrical/elongation"), 1.0023, 0.002);
    EXPECT_NEAR(number("cap/lambert-cylindrical/depth_over_azimuthal"), 0.68032 / 0.68207, 0.002);
    EXPECT_NEAR(number("cap/lambert-azimuthal/elongation"), 1, 1e-6) << "symmetric but for rounding";

    EXPECT_NEAR(number("window/gall-peters/elongation"), 2, 0.02) << "root 2 one way, 1/root 2 the other";
    EXPECT_NEAR(number("window/gall-peters/depth_over_azimuthal"), 1, 1e-6) << "the same plate in the chart";
}

TEST(LobePart, AFreeLobeBendsLikeACantileverAndAClampedOneDoesNotMoveItsTip)
{
    const Section section = lobePart(Quick().run);
    EXPECT_EQ(section.number("clamped/deflection_along").front(), 0) << "held";
    EXPECT_NEAR(section.number("free/tip_over_contact").front(), 2.5, 0.05)
        << "(3 L - a) / (2 a) of a beam loaded in the middle; the dent under the finger is 1 %";
    const double overBeam = section.number("free/tip_over_beam").front();
    EXPECT_LT(overBeam, 1) << "near its root a wide plate cannot curl up";
    EXPECT_GT(overBeam, 1 - 0.45 * 0.45) << "and if it could nowhere, it would be stiffer by 1 / (1 - nu^2)";
    EXPECT_GT(section.number("free/compliance").front(), 5 * section.number("clamped/compliance").front());
}

TEST(Cantilever, IsTheTextbooksForOneRigidity)
{
    const PlateGrid           grid{10, 200, 2e-3, 0.1e-3};
    const Plate               plate{grid, {}, 0.3, 0, NodeField(grid, 2e-3)};
    const std::vector<double> w      = cantilever(plate, 0.5);
    const double              length = 20e-3, a = 10e-3, stiffness = 2e-3 * (1 - 0.09) * 20e-3;
    // The trapezoidal rule with 100 steps to the load: 1/(2 100^2) of the curvature's part.
    EXPECT_NEAR(w.front() / (0.5 * a * a * (3 * length - a) / (6 * stiffness)), 1, 2e-4);
    EXPECT_NEAR(w[100] / (0.5 * a * a * a / (3 * stiffness)), 1, 2e-4);
    EXPECT_EQ(w.back(), 0);
}

TEST(StabilityPart, NothingDivergesAndEveryAnswerIsRight)
{
    const Section section = stabilityPart(Quick().run);
    EXPECT_EQ(section.number("plates").front(), 81) << "every combination of clamped, supported and free sides once";
    EXPECT_EQ(section.number("not_finite").front(), 0);
    EXPECT_EQ(section.number("not_converged").front(), 0);
    EXPECT_LT(section.number("largest_error").front(), 1e-3)
        << "asked for: 1e-4 in the energy; the largest error was up to 4.3e-4 over 1000 plates";
    const auto& contrast = section.number("contrast");
    EXPECT_LT(*std::min_element(contrast.begin(), contrast.end()), 2);
    EXPECT_GT(*std::max_element(contrast.begin(), contrast.end()), 500);
}

TEST(RandomMaps, EveryKindReachesItsContrastAndIsAnotherEachTime)
{
    const PlateGrid grid{17, 23, 1, 1};
    Uniform         uniform(3);
    for (const MapKind kind : kMapKinds) {
        const NodeField one = randomMap(kind, grid, 300, uniform), two = randomMap(kind, grid, 300, uniform);
        const auto [least, most] = std::minmax_element(one.values().begin(), one.values().end());
        EXPECT_EQ(*least, 1) << name(kind);
        EXPECT_NEAR(*most, 300, 1e-9) << name(kind) << ": a power, rounded";
        EXPECT_NE(one.values(), two.values()) << name(kind);
    }
}

TEST(JacobiPart, GrowsUndampedAndStopsTooEarlyDamped)
{
    const Section section = jacobiPart(Quick().run);
    EXPECT_NEAR(section.number("undamped/growth_per_sweep").front(), 2.14, 0.05)
        << "a clamped plate of 16 cells, by our own prototype; of large ones 2.2";
    const auto& error = section.number("damped/17/error");
    EXPECT_LT(error.back(), 1e-4) << "damped it does converge: 2e-5 after 20 000 sweeps, and falling";
    EXPECT_GT(section.number("damped/33/stop_1.0e-04/error").front(), 0.1) << "a thousand times the change";
}

TEST(WartPart, ThePapersLawIsStifferThanADeviceAndOursIsNot)
{
    const Section section = wartPart(Quick().run);
    EXPECT_EQ(section.number("paper/share_below_cap").front(), 0);
    EXPECT_EQ(section.number("series/share_below_cap").front(), 1);
    const auto &paper = section.number("paper/stiffness"), &series = section.number("series/stiffness");
    for (std::size_t n = 0; n < paper.size(); ++n) EXPECT_GT(paper[n], series[n]) << "a spring more in series";
    // E A / h of the skin, and of the wart ten times as much, evened out by points 1.3 mm apart and under the finger.
    const double skin        = 0.3e6 * std::numbers::pi * 3.6e-3 * 3.6e-3 / 4e-3; // [N/m]
    const auto [least, most] = std::minmax_element(paper.begin(), paper.end());
    EXPECT_NEAR(*least / skin, 1, 0.01) << "3.1 kN/m on the page: 20 mm beside it there is no wart";
    EXPECT_GT(*most, 17e3) << "25 kN/m on the page, whose points are twice as close";
    EXPECT_LT(*most, 10 * skin);
    EXPECT_NEAR(section.number("series/steps_weber_0.07").front(), 9.6, 1) << "of the sample scene, on a finer grid";
}

TEST(FlatnessPart, AThinEllipsoidIsAShellAndAPlateIsTooSoftTheMoreTheLargerItsWindow)
{
    const Section section = flatnessPart(Quick().run);
    for (const CalculixShell& whole : kCalculixShells) {
        if (whole.name != "ellipsoid") continue;
        const std::string stem = "ellipsoid/" + fixed(1e3 * whole.thickness, 0) + "_mm/";
        EXPECT_EQ(section.number(stem + "whole").front(), whole.stiffness) << "the table of the tests";
        const auto &plate = section.number(stem + "plate"), &shell = section.number(stem + "shell");
        ASSERT_EQ(plate.size(), 2u) << "40 and 60 mm";
        EXPECT_LT(plate[1], 0.55 * plate[0]) << "a clamped plate softens with the square of its width";
        EXPECT_LT(plate[1], 0.6 * whole.stiffness);
        for (const double felt : shell)
            EXPECT_NEAR(felt / whole.stiffness, 1, 0.12) << "8 % on 64 cells, and a coarse grid's 3 %";
    }
    EXPECT_DOUBLE_EQ(section.number("lobe/shell_over_plate").front(), 1)
        << "a lens with a flat middle is bent as a plate";
}

/// A page that tells no lies about being whole, and numbers without a clock.
TEST(Page, NumbersAreTheSameTwiceAndNothingIsFetched)
{
    const Origins        origins{"1", "abc", "libraries", "a <machine>", "host", "palpate paper --out 'x'", true};
    std::vector<Section> one, two;
    for (std::vector<Section>* sections : {&one, &two})
        for (const auto part : {placesPart, timePart, mapsPart}) sections->push_back(part(Quick().run));

    EXPECT_EQ(numbersJson(one, origins), numbersJson(two, origins));
    EXPECT_NE(timingsJson(one, origins), timingsJson(two, origins)) << "clocks never agree to the last digit";
    EXPECT_EQ(numbersJson(one, origins).find("stages"), std::string::npos) << "times are no numbers";
    const std::string page = reportPage(one, origins);
    EXPECT_NE(page.find("a &lt;machine&gt;"), std::string::npos);
    for (const char* fetched : {"<script", "<link", "src=\"http", "<img", "@import", "url("})
        EXPECT_EQ(page.find(fetched), std::string::npos) << fetched;
    EXPECT_NE(page.find("data:image/png;base64,"), std::string::npos) << "pictures are inside";
}

TEST(Page, WhatIsNoNumberIsNullAndAMissingOneIsNamed)
{
    Section section{'x', "a", {}, {}, {}, {}, {}, {}};
    section.numbers.push_back({"odd", "1", {std::nan(""), HUGE_VAL, 2}});
    EXPECT_NE(numbersJson(std::span(&section, 1), {}).find("null"), std::string::npos);
    EXPECT_EQ(section.number("odd")[2], 2);
    EXPECT_THROW((void)section.number("even"), Error);
}

} // namespace
} // namespace palp::report
