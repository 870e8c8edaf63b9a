#include "tests/pipeline/calculix_outlines.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "engine/pipeline/deform.h"
#include "engine/pipeline/detail/patch_response.h"
#include "engine/pipeline/patch_warnings.h"
#include "engine/plate/load.h"
#include "tests/pipeline/force_at.h"
#include "tests/support/errors.h"
#include "tests/support/sanitized.h"

// Curved sheets of any outline, in windows that span them: by CalculiX and by a touch of their points.
// calculix_outlines.py has the same outlines.

namespace palp {
namespace {

using Where  = std::function<bool(double, double)>;   // [m]
using Height = std::function<double(double, double)>; // [m] of [m]

Where box(double x0, double z0, double x1, double z1)
{
    return [=](double x, double z) { return x >= x0 && x <= x1 && z >= z0 && z <= z1; };
}

Where disc(double x0, double z0, double radius)
{
    return [=](double x, double z) { return std::hypot(x - x0, z - z0) <= radius; };
}

bool isInOne(const std::vector<Where>& of, double x, double z)
{
    return std::ranges::any_of(of, [&](const Where& one) { return one(x, z); });
}

struct Outline {
    std::vector<Where> pieces, held, holes{};
    Height             height = [](double x, double z) { return -5 * (x * x + z * z); };
};

Height lump(double height, double width, double x0 = 0)
{
    return [=](double x, double z) { return height * std::exp(-((x - x0) * (x - x0) + z * z) / (2 * width * width)); };
}

Outline outlineOf(std::string_view name)
{
    if (name.starts_with("u"))
        return {{box(-24e-3, -7e-3, 24e-3, 7e-3), box(-24e-3, -7e-3, -10e-3, 50e-3), box(10e-3, -7e-3, 24e-3, 50e-3)},
                {box(-30e-3, 42e-3, 30e-3, 60e-3)},
                {},
                name == "u vault" ? Height([](double x, double) { return -5 * x * x; }) : Outline{}.height};
    if (name.ends_with("lump"))
        return {{box(-40e-3, -30e-3, 40e-3, 30e-3)},
                {box(-50e-3, -40e-3, -34e-3, 40e-3), box(34e-3, -40e-3, 50e-3, 40e-3)},
                {},
                name == "gentle lump"  ? lump(2e-3, 10e-3)
                : name == "steep lump" ? lump(2e-3, 5e-3)
                : name == "small lump" ? lump(1e-3, 4e-3)
                                       : lump(2e-3, 8e-3, 12e-3)};
    if (name.find("arch") != std::string_view::npos) {
        const bool   deep   = name.starts_with("deep");
        const double radius = deep ? 40e-3 : 50e-3, held = deep ? 34e-3 : 32e-3;
        const double x0 = deep ? 15e-3 : name == "arch" ? 10e-3 : 0, z0 = deep ? 5e-3 : name == "arch" ? 0 : 15e-3;
        return {{box(-36e-3 - x0, -20e-3 - z0, 36e-3 - x0, 20e-3 - z0)},
                {[=](double x, double) { return std::abs(x + x0) >= held; }},
                {},
                [=](double x, double) {
                    return std::sqrt(radius * radius - (x + x0) * (x + x0)) - std::sqrt(radius * radius - x0 * x0);
                }};
    }
    if (name == "curled strip")
        return {{box(-56e-3, -20e-3, 16e-3, 20e-3)},
                {[](double x, double) { return x <= -52e-3; }},
                {},
                [](double x, double) {
                    return std::sqrt(50e-3 * 50e-3 - (x + 20e-3) * (x + 20e-3)) -
                           std::sqrt(50e-3 * 50e-3 - 20e-3 * 20e-3);
                }};
    if (name.starts_with("gutter")) {
        const double x0 = name == "gutter" ? 0 : 45e-3;
        return {{box(-50e-3 - x0, -20e-3, 50e-3 - x0, 20e-3)},
                {[=](double x, double) { return x + x0 <= -45e-3; }},
                {},
                [](double, double z) { return std::sqrt(40e-3 * 40e-3 - z * z) - 40e-3; }};
    }
    if (name.starts_with("corrugated")) {
        const bool   flank = name == "corrugated flank";
        const double x0    = flank ? 6e-3 : 0;
        return {{box(-36e-3 - x0, -12e-3, 36e-3 - x0, 12e-3)},
                {[=](double x, double) { return x + x0 <= -32e-3 || (flank && x + x0 >= 32e-3); }},
                {},
                [=](double x, double) {
                    const auto wave = [](double at) { return std::cos(2 * std::numbers::pi * at / 24e-3); };
                    return 2e-3 * (wave(x + x0) - wave(x0));
                }};
    }
    if (name == "j at its tip")
        return {{box(-61e-3, -12e-3, 11e-3, 12e-3)},
                {[](double x, double) { return x <= -57e-3; }},
                {},
                [](double x, double) {
                    const double round = std::max(x + 25e-3, 0.0);
                    return std::sqrt(40e-3 * 40e-3 - round * round) - std::sqrt(40e-3 * 40e-3 - 25e-3 * 25e-3);
                }};
    if (name == "s in its middle")
        return {{box(-36e-3, -12e-3, 36e-3, 12e-3)},
                {[](double x, double) { return std::abs(x) >= 32e-3; }},
                {},
                [](double x, double) {
                    const double middle = std::sqrt(30e-3 * 30e-3 - 18e-3 * 18e-3), away = std::abs(x) - 18e-3;
                    const double bulge = std::sqrt(30e-3 * 30e-3 - away * away) - middle;
                    return x < 0 ? bulge : -bulge;
                }};
    if (name == "trough at its side")
        return {{box(-40e-3, -55e-3, 40e-3, 3e-3)},
                {[](double, double z) { return z <= -53.5e-3; }},
                {},
                [](double, double z) {
                    return std::sqrt(30e-3 * 30e-3 - (z + 26e-3) * (z + 26e-3)) -
                           std::sqrt(30e-3 * 30e-3 - 26e-3 * 26e-3);
                }};
    if (name == "cap on a segment")
        return {{disc(0, -20e-3, 41e-3)}, {[](double x, double) { return x <= -30e-3; }}, {}, [](double x, double z) {
                    const double away = z + 20e-3;
                    return std::sqrt(0.04 - x * x - away * away) - std::sqrt(0.04 - 20e-3 * 20e-3);
                }};
    if (name == "l dome")
        return {{box(-7e-3, -7e-3, 40e-3, 7e-3), box(-7e-3, -7e-3, 7e-3, 40e-3)},
                {box(32e-3, -10e-3, 50e-3, 10e-3), box(-10e-3, 32e-3, 10e-3, 50e-3)}};
    if (name == "strip dome")
        return {{box(-40e-3, -7e-3, 40e-3, 7e-3)},
                {box(-50e-3, -10e-3, -32e-3, 10e-3), box(32e-3, -10e-3, 50e-3, 10e-3)}};
    if (name == "ring dome")
        return {{disc(0, 26e-3, 32e-3)},
                {box(-40e-3, 18e-3, -20e-3, 34e-3), box(20e-3, 18e-3, 40e-3, 34e-3)},
                {disc(0, 26e-3, 20e-3)}};
    Outline holes{{disc(0, 0, 40e-3)}, {[](double x, double z) { return std::hypot(x, z) >= 32e-3; }}};
    for (int n = 0; n < 12; ++n) {
        const double angle = n * std::numbers::pi / 6;
        holes.holes.push_back(disc(18e-3 * std::cos(angle), 18e-3 * std::sin(angle), 3e-3));
    }
    return holes;
}

/// Returns where and from where an outline is pressed.
Contact contactOf(const Outline& outline)
{
    constexpr double kStep = 1e-6; // [m]
    const double     here  = outline.height(0, 0);
    return {{0, 0, here},
            glm::normalize(
                glm::dvec3((here - outline.height(kStep, 0)) / kStep, (here - outline.height(0, kStep)) / kStep, 1))};
}

/// Points half a millimetre apart, each anywhere in its square.
SoftObject objectOf(const Outline& outline, unsigned seed)
{
    constexpr double                       kSpacing = 0.5e-3, kReach = 100e-3; // [m]
    std::mt19937_64                        bits(seed);
    std::uniform_real_distribution<double> within(0, kSpacing);
    std::vector<glm::dvec3>                points;
    std::vector<double>                    held;
    for (double i = -kReach; i < kReach; i += kSpacing)
        for (double j = -kReach; j < kReach; j += kSpacing) {
            const double x = i + within(bits), z = j + within(bits);
            if (!isInOne(outline.pieces, x, z) || isInOne(outline.holes, x, z)) continue;
            points.emplace_back(x, z, outline.height(x, z));
            held.push_back(isInOne(outline.held, x, z));
        }
    std::vector<double> moduli(points.size(), 1e6);
    return SoftObject(PointCloud(std::move(points), std::move(moduli), StiffnessKind::modulus),
                      {.thickness = 1.5e-3, .poissonRatio = 0.45})
        .withHeld(std::move(held));
}

/// With a bed of Airy's function that begins at the border, and with a hold that begins where the first share is held,
/// they were felt 5 to 18 % too stiff at 256 cells, and less so the finer the cells. With a free side of the window the
/// U was felt 30 % too stiff. By fits as wide as suit the panel the lumps were felt 40, 29, 11 and 7 % too soft. By the
/// shallow theory alone arches were felt 3 to 11 % too stiff, a curled strip a quarter too soft, and a cap that is held
/// on a segment 10 % too soft while what lay behind that kept no shape. By a mean curvature an S and a corrugation were
/// felt up to a third too soft, a trough that is held along a side a quarter.
TEST(CalculixOutlines, AreFeltAsStiffAsTheyAreAtAnyCells)
{
    PlateSolver host("host");
    for (const CalculixOutline& of : kCalculixOutlines)
        for (const int cells : {256, 512}) {
            if (kSanitized && cells == 512) continue; // the same code again
            PatchSettings settings{.theory = Theory::shell};
            settings.windowOf     = WindowOf::object;
            settings.cells        = cells;
            const Outline outline = outlineOf(of.name);
            const Patch   patch   = deform(objectOf(outline, 1), contactOf(outline), settings, host);
            EXPECT_TRUE(patch.report.converged);
            const double felt = 1 / (patch.compliance * of.stiffness) - 1;
            std::printf("  %s, %d cells: %+.1f %%, %s\n", std::string(of.name).c_str(), cells, 100 * felt,
                        patch.report.solver.c_str());
            const auto said  = warnings(patch, settings, 1e-3, {.thickness = 1.5e-3, .poissonRatio = 0.45});
            const bool isFar = std::ranges::any_of(
                said, [](const std::string& one) { return one.find("move far along") != std::string::npos; });
            EXPECT_EQ(isFar, of.name == "trough at its side") << of.name << patch.curvedBending;
            if (of.name == "curled strip" && cells == 256) { // the reference has what curvature bends too
                const Patch other = deform(objectOf(outline, 1), contactOf(outline), settings);
                EXPECT_NEAR(other.curvedBending / patch.curvedBending, 1, 0.01) << "it bends the void as well";
            }
            // With sizes of 1 and 0.7 mm in the script what is left of the worst, deep arch and cap, changes by 0.3 %.
            EXPECT_LT(of.meshError, 0.023) << of.name;
            // Fits of a few millimetres round off where the curvature of an S jumps, and take a sixth off short waves.
            const bool isRounded = of.name == "s in its middle" || of.name == "corrugated flank";
            EXPECT_NEAR(felt, 0, isRounded ? 0.08 : 0.05) << of.name << ", " << cells << " cells";
        }
}

/// The void's deflection stands for nothing; counted as a sheet that is stretched, it stiffened the arches up to four
/// times, by how the nodes lay.
TEST(CalculixOutlines, GiveWayAsFarWhenTheyArePressedDeep)
{
    PlateSolver host("host");
    for (const CalculixDeepOutline& of : kCalculixDeepOutlines) {
        PatchSettings settings{.theory = Theory::shell, .large = Large::on};
        settings.windowOf     = WindowOf::object;
        const Outline outline = outlineOf(of.name);
        const Patch   patch   = deform(objectOf(outline, 1), contactOf(outline), settings, host);
        ASSERT_TRUE(patch.large) << of.name << patch.linearBecause;
        std::printf("  %s:", std::string(of.name).c_str());
        double worst = 0;
        for (std::size_t n = 0; n < of.depths.size() && of.depths[n] < 1.55 * 1.5e-3; ++n) {
            const double force = of.force * double(n + 1) / double(of.depths.size());
            const double felt  = forceAt(patch, of.depths[n]) / force - 1;
            std::printf(" %+.1f", 100 * felt);
            worst = worse(worst, felt);
        }
        std::printf(" %%\n");
        EXPECT_LT(worst, 0.07) << of.name;
        // The law begins with what is drawn, to the tolerance of its shapes; contact, shear and twist lie in series.
        const double drawn = dot(unitLoad(patch, settings), patch.response);
        EXPECT_NEAR(drawn * patch.large->tangent.front(), 1, 2e-3) << of.name;
        EXPECT_LT(drawn, patch.compliance) << of.name;
        const auto error = discretisationError(patch, settings, host);
        ASSERT_TRUE(error);
        // Cells twice as wide feel the cap 6 % else, the others 2.4.
        EXPECT_LT(*error, of.name.starts_with("cap") ? 0.022 : 0.012) << of.name;
    }
}

/// A hairpin of two arms 8 mm apart, one held at its end, the other touched near its own: what lies between them must
/// not bridge the gap. With 3e-3 of the sheet's rigidity there it was felt 17 times too stiff.
TEST(CalculixOutlines, AGapIsNotBridged)
{
    const Outline hairpin{
        {box(-10e-3, -10e-3, 10e-3, -2e-3), box(-10e-3, -10e-3, -4e-3, 40e-3), box(4e-3, -10e-3, 10e-3, 40e-3)},
        {box(-12e-3, 32e-3, -2e-3, 42e-3)},
        {},
        [](double, double) { return 0; }};
    constexpr double kHairpin = 0.0411; // [N/m] CalculiX, bricks of 1 mm: right to 0.5 %
    for (const Theory theory : {Theory::plate, Theory::shell}) {
        PatchSettings settings{.theory = theory};
        settings.windowOf = WindowOf::object;
        PlateSolver host("host");
        const Patch patch = deform(objectOf(hairpin, 1), {{7e-3, 30e-3, 0}, {0, 0, 1}}, settings, host);
        std::printf("  hairpin: %+.1f %%\n", 100 / (patch.compliance * kHairpin) - 100);
        EXPECT_NEAR(1 / (patch.compliance * kHairpin), 1, 0.2);
    }
}

} // namespace
} // namespace palp
