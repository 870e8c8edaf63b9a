#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <random>
#include <string>

#include <gtest/gtest.h>

#include "engine/core/contract.h"
#include "engine/pipeline/deform.h"
#include "engine/pipeline/detail/node_pieces.h"
#include "engine/pipeline/homogeneous_sites.h"
#include "engine/pipeline/patch_warnings.h"
#include "engine/plate/load.h"
#include "tests/support/sanitized.h"
#include "tests/support/temporary_folder.h"

// Windows that span the object: its borders are free, and what is held holds it.

namespace palp {
namespace {

constexpr Material kSheet{.thickness = 1.5e-3, .poissonRatio = 0.45};
constexpr double   kModulus = 300e3, kSpacing = 1e-3; // [Pa], [m]

using Where = std::function<bool(double, double)>;

/// An object of points of one modulus, with the share of each that is held.
SoftObject objectOf(std::vector<glm::dvec3> points, std::vector<double> held, const Material& material,
                    double modulus = 1e6)
{
    std::vector<double> moduli(points.size(), modulus);
    return SoftObject(PointCloud(std::move(points), std::move(moduli), StiffnessKind::modulus), material)
        .withHeld(std::move(held));
}

/// A flat sheet of random points.
SoftObject sheetOf(const Where& inside, const Where& held, unsigned seed, double spacing = kSpacing)
{
    std::mt19937_64                        bits(seed);
    std::uniform_real_distribution<double> along(-70e-3, 70e-3);
    std::vector<glm::dvec3>                points;
    std::vector<double>                    shares;
    const auto                             count = std::size_t(std::pow(140e-3 / spacing, 2));
    for (std::size_t n = 0; n < count; ++n) {
        const double x = along(bits), y = along(bits);
        if (!inside(x, y)) continue;
        points.emplace_back(x, y, 0);
        shares.push_back(held(x, y));
    }
    return objectOf(std::move(points), std::move(shares), kSheet, kModulus);
}

bool isInDrum(double x, double y)
{
    return std::abs(x) < 65e-3 && std::abs(y) < 65e-3;
}
bool isDrumsFrame(double x, double y)
{
    return std::abs(x) > 60e-3 || std::abs(y) > 60e-3;
}
bool isInStrip(double x, double y)
{
    return x > -20e-3 && x < 60e-3 && std::abs(y) < 30e-3;
}
bool isStripsRoot(double x, double)
{
    return x < 0;
}

const PatchSettings kWhole{.windowOf = WindowOf::object};

Patch touched(const SoftObject& object, double x, double y, const PatchSettings& settings = kWhole)
{
    PlateSolver host("host");
    return deform(object, {{x, y, 0}, {0, 0, 1}}, settings, host);
}

/// c of a plate whose grid ends where the object does, by the reference solver.
double complianceOf(const PlateGrid& grid, const PlateEdges& edges, double x, double z)
{
    const Plate     plate{grid, edges, kSheet.poissonRatio, 0, NodeField(grid, kSheet.rigidity(kModulus))};
    const Footprint finger(footprintLoad(grid, 1, x, z, kWhole.footprintRadius));
    PlateSolver     reference("reference");
    return reference.solveFootprints(plate, {&finger, 1}, 0, 1e-6, 1e-6).responses.front().work;
}

TEST(WholeObject, ASheetHeldFarAwayIsFeltAsSoftAsItIs)
{
    const double truth = complianceOf({160, 160, 120e-3 / 160, 120e-3 / 160}, {}, 60e-3, 60e-3);
    EXPECT_NEAR(truth * kSheet.rigidity(kModulus) / (0.0056 * 120e-3 * 120e-3), 1, 0.02)
        << "Timoshenko, clamped square under a point load; a fingertip of 4 mm makes it 1.1 % stiffer";
    const SoftObject drum = sheetOf(isInDrum, isDrumsFrame, 1);
    const double     felt = touched(drum, 0, 0).compliance;
    EXPECT_NEAR(felt / truth, 1, 0.02) << "measured 1.4 %";
    EXPECT_GT(felt / touched(drum, 0, 0, {}).compliance, 9) << "through a clamped window of 40 mm";
}

TEST(WholeObject, AStripBendsAboutItsRootHoweverItsPointsAreDrawn)
{
    const Edge   c = Edge::clamped, f = Edge::free;
    const double truth = complianceOf({120, 120, 0.5e-3, 0.5e-3}, {c, f, f, f}, 45e-3, 30e-3);
    double       least = 1e9, most = 0;
    for (const unsigned seed : {1U, 2U, 3U, 4U}) {
        const Patch  patch = touched(sheetOf(isInStrip, isStripsRoot, seed), 45e-3, 0);
        const double felt  = patch.compliance;
        EXPECT_TRUE(patch.report.converged);
        EXPECT_EQ(patch.report.solver, "host") << "nobody had to take over";
        EXPECT_NEAR(felt / truth, 1, 0.03) << seed << ": its length to a fifth of a spacing, thrice";
        least = std::min(least, felt);
        most  = std::max(most, felt);
    }
    EXPECT_LT(most / least, 1.02);
}

TEST(WholeObject, AnglesOfTheObjectInItsWindowMakeNoDifference)
{
    const auto turned = [](const Where& of, double angle) -> Where {
        return [=](double x, double y) {
            return of(x * std::cos(angle) + y * std::sin(angle), y * std::cos(angle) - x * std::sin(angle));
        };
    };
    const double straight = touched(sheetOf(isInStrip, isStripsRoot, 1), 45e-3, 0).compliance;
    for (const double angle : {0.3, 0.7}) {
        const SoftObject strip = sheetOf(turned(isInStrip, angle), turned(isStripsRoot, angle), 2);
        const double     felt  = touched(strip, 45e-3 * std::cos(angle), 45e-3 * std::sin(angle)).compliance;
        EXPECT_NEAR(felt / straight, 1, 0.03) << angle << ": borders across the grid";
    }
}

TEST(WholeObject, ATableIsWhatItsPlacesFeel)
{
    const SoftObject       strip = sheetOf(isInStrip, isStripsRoot, 1);
    PlateSolver            host("host");
    const FootprintLattice lattice = footprintLattice(strip, kWhole, 3, host);
    const auto             made    = deformWithTable(strip, {{30e-3, 0, 0}, {0, 0, 1}}, kWhole, lattice, host);
    ASSERT_TRUE(made.table);
    for (int n = 0; n < 9; ++n) {
        const double     x = (n / 3 - 1) * 4e-3, z = (n % 3 - 1) * 4e-3;
        const auto&      frame = made.patch.chart.frame;
        const glm::dvec3 place = made.patch.chart.origin + x * frame.east + z * frame.north;
        const double     alone = touched(strip, place.x, place.y).compliance;
        EXPECT_NEAR(std::exp(made.table->compliance[std::size_t(n)].value) / alone, 1, 0.01) << n;
        EXPECT_NEAR(std::exp(made.table->contactStiffness[std::size_t(n)].value) / made.patch.contactStiffness, 1,
                    1e-6);
    }
}

TEST(WholeObject, AFingerOverTheBorderPressesTheSheetAlone)
{
    const SoftObject strip = sheetOf(isInStrip, isStripsRoot, 1);
    const Patch      tip = touched(strip, 60e-3, 0), inner = touched(strip, 55e-3, 0);
    EXPECT_GT(tip.compliance, inner.compliance);
    EXPECT_LT(tip.compliance, 1.5 * inner.compliance) << "(60 / 55)^3 = 1.3; the void beside it would give without end";
    EXPECT_NEAR(tip.contactStiffness / inner.contactStiffness, 1, 1e-9) << "the contact is with the sheet";
}

TEST(WholeObject, WhatNothingHoldsIsRefused)
{
    const SoftObject loose = sheetOf(
                                 isInStrip, [](double x, double) { return x < -19.9e-3; }, 1)
                                 .withHeld({});
    try {
        touched(loose, 45e-3, 0);
        FAIL() << "it would move off";
    } catch (const Error& error) {
        EXPECT_TRUE(holds(error.what(), {"held", "expected at least 3", "foundation"}));
    }
    PatchSettings bedded = kWhole;
    bedded.foundation    = 1e6;
    EXPECT_GT(touched(loose, 45e-3, 0, bedded).compliance, 0) << "a foundation holds it";
}

/// Two sheets of one plane hang together by nothing: what holds the one does not hold the other.
TEST(WholeObject, WhatHoldsAnotherPieceDoesNotHoldTheTouchedOne)
{
    const Where two     = [](double x, double y) { return std::abs(y) < 20e-3 && (x < -10e-3 || x > 10e-3); };
    const Where farther = [](double x, double) { return x > 50e-3; };
    try {
        touched(sheetOf(two, farther, 1), -35e-3, 0);
        FAIL() << "it would move off";
    } catch (const Error& error) {
        EXPECT_TRUE(holds(error.what(), {"reaches 0 nodes that are held", "expected at least 3"})) << error.what();
    }
    const Patch other = touched(sheetOf(two, farther, 1), 35e-3, 0);
    EXPECT_GT(other.heldNodes, 100u);
    const Where both = [](double x, double) { return std::abs(x) > 50e-3; };
    EXPECT_NEAR(double(touched(sheetOf(two, both, 1), 35e-3, 0).heldNodes), double(other.heldNodes),
                0.2 * double(other.heldNodes))
        << "those of its own piece alone";
}

/// A fingertip on the border of a piece that is held reaches another one across a slit, which nothing holds. What it
/// presses on there would go through: that was felt 1.5 times too soft, or more, and without a word.
TEST(WholeObject, AFingerOnTheBorderIsFeltAlikeWithALoosePieceAcrossASlit)
{
    PlateSolver host("host");
    const Where held = [](double x, double) { return x < -30e-3; };
    const auto  felt = [&](double beyond, double x) {
        const Where is = [&](double at, double y) {
            return std::abs(y) < 15e-3 && at > -40e-3 && (at < 0 || (at > beyond && at < 25e-3));
        };
        const SoftObject sheet = sheetOf(is, held, 1, 0.4e-3); // of 1 mm gaps of 4 mm are closed
        return deformWithTable(sheet, {{x, 0, 0}, {0, 0, 1}}, kWhole, footprintLattice(sheet, kWhole, 3, host), host);
    };
    const auto alone = felt(1, -0.5e-3);
    const auto both  = felt(3e-3, -0.5e-3);
    EXPECT_NEAR(both.patch.compliance / alone.patch.compliance, 1, 0.01) << "points are others";
    EXPECT_NEAR(both.table->middle().lnCompliance, alone.table->middle().lnCompliance, 0.01);
    EXPECT_GT(both.patch.apart, 0.2) << "it is said to be in pieces";
    EXPECT_THROW((void)felt(3e-3, 4e-3), Error) << "most of it lies on what nothing holds";
}

TEST(WholeObject, TheSheetsRigidityIsTheSameAtItsBorder)
{
    const Patch patch        = touched(sheetOf(isInStrip, isStripsRoot, 1), 45e-3, 0);
    const auto [least, most] = rigiditiesOfSheet(patch);
    const double whole       = kSheet.rigidity(kModulus);
    EXPECT_NEAR(least / whole, 1, 1e-9);
    EXPECT_NEAR(most / whole, 1, 1e-9);
    EXPECT_NEAR(rigidityAtContact(patch) / whole, 1, 1e-9);
}

TEST(WholeObject, AFoundationIsFeltAsInAnyWindow)
{
    PatchSettings fixed{.foundation = 1e6}, whole = kWhole;
    whole.foundation      = 1e6;
    const SoftObject drum = sheetOf(
                                isInDrum, [](double, double) { return false; }, 3)
                                .withHeld({});
    EXPECT_NEAR(touched(drum, 0, 0, whole).compliance / touched(drum, 0, 0, fixed).compliance, 1, 0.02)
        << "a dent of 3 mm, cells of 0.7 and of 1 mm";
}

/// What answers until the first table knows that a foundation hardly minds the sheet: half a sheet that is thirty times
/// as stiff as the other was guessed in proportion, 2.4 times too stiff on the soft half.
TEST(WholeObject, TheFirstAnswerOnAFoundationIsNearThatOfTheTable)
{
    PatchSettings settings = kWhole;
    settings.foundation    = 1e6;
    std::vector<glm::dvec3> points;
    std::vector<double>     moduli;
    for (int i = -40; i <= 40; ++i)
        for (int j = -20; j <= 20; ++j) {
            points.emplace_back(1e-3 * i, 1e-3 * j, 0);
            moduli.push_back(i > 0 ? 30 * kModulus : kModulus);
        }
    const SoftObject sheet(PointCloud(std::move(points), std::move(moduli), StiffnessKind::modulus), kSheet);
    PlateSolver      host("host");
    const auto       lattice = footprintLattice(sheet, settings, 3, host);
    const auto       first   = homogeneousLaw(sheet, lattice, settings);
    for (const double x : {-20e-3, 20e-3}) {
        const auto guess = first.at({x, 0, 0});
        ASSERT_TRUE(guess) << x;
        const double table = std::log(touched(sheet, x, 0, settings).compliance);
        EXPECT_NEAR(guess->lnCompliance, table, 0.15) << x << ": one cell of the sites is wider than the dent";
    }
}

/// A dish: a cap of a sphere of 60 mm, 50 mm wide, held at its stem of 12 mm, pressed between stem and rim.
SoftObject dishOf(unsigned seed)
{
    std::mt19937_64                        bits(seed);
    std::uniform_real_distribution<double> along(-25e-3, 25e-3);
    std::vector<glm::dvec3>                points;
    std::vector<double>                    shares;
    while (points.size() < 7800) { // half a millimetre apart
        const double x = along(bits), y = along(bits), r = std::hypot(x, y);
        if (r > 25e-3) continue;
        points.emplace_back(x, y, std::sqrt(60e-3 * 60e-3 - r * r));
        shares.push_back(r < 6e-3);
    }
    return objectOf(std::move(points), std::move(shares), kSheet, kModulus);
}

TEST(WholeObject, ADishBendsAboutItsStemHoweverItsPointsAreDrawn)
{
    PatchSettings shell = kWhole;
    shell.theory        = Theory::shell;
    PlateSolver         host("host");
    std::vector<double> found;
    for (unsigned seed = 1; seed <= 8; ++seed) {
        const SoftObject dish  = dishOf(seed);
        const Patch      patch = deform(dish, {{15e-3, 0, 58.1e-3}, {0, 0, 1}}, shell, host);
        EXPECT_TRUE(patch.curvature) << patch.flatBecause;
        EXPECT_TRUE(patch.report.converged);
        found.push_back(patch.compliance);
        const double flat = deform(dish, {{15e-3, 0, 58.1e-3}, {0, 0, 1}}, kWhole, host).compliance;
        std::printf("  %u: c %.4g m/N, %d steps, as a plate %.4g\n", seed, patch.compliance,
                    patch.report.iterations.value_or(0), flat);
        EXPECT_GT(flat, 1.3 * patch.compliance);
    }
    double mean = 0, square = 0;
    for (const double c : found) mean += c / double(found.size());
    for (const double c : found) square += (c - mean) * (c - mean) / double(found.size() - 1);
    // A stem of 6 mm is found to 0.06 mm by random points half a millimetre apart, and c goes as its radius by -1.6.
    EXPECT_LT(std::sqrt(square) / mean, 0.02) << "points drawn anew: the standard deviation";
}

/// A lobe of two faces that meet at a sharp rim, held at one end, and the same sheet by the points of its middle.
SoftObject lobeOf(double halfThickness, unsigned seed)
{
    constexpr double                       kLong = 18e-3, kWide = 14e-3;
    std::mt19937_64                        bits(seed);
    std::uniform_real_distribution<double> along(-1, 1);
    std::vector<glm::dvec3>                points;
    std::vector<double>                    shares;
    while (points.size() < (halfThickness > 0 ? 20000 : 10000)) {
        const double x = along(bits), y = along(bits), rest = 1 - x * x - y * y;
        if (rest < 0) continue;
        const double side = points.size() % 2 == 0 ? 1 : -1;
        points.emplace_back(kWide * x, kLong * y, side * halfThickness * std::sqrt(rest));
        shares.push_back(kWide * x < -6e-3);
    }
    return objectOf(std::move(points), std::move(shares), {.thickness = 3e-3, .poissonRatio = 0.45}, kModulus);
}

TEST(WholeObject, OfATwoFacedLobeOnlyTheTouchedFaceBends)
{
    PlateSolver host("host");
    for (const Theory theory : {Theory::plate, Theory::shell})
        for (const double x : {0.0, 9e-3}) {
            PatchSettings settings   = kWhole;
            settings.theory          = theory;
            settings.footprintRadius = 2.5e-3;
            const double     high    = 1.5e-3 * std::sqrt(1 - std::pow(x / 14e-3, 2));
            const Patch      lobe    = deform(lobeOf(1.5e-3, 1), {{x, 0, high}, {0, 0, 1}}, settings, host);
            const Patch      sheet   = deform(lobeOf(0, 2), {{x, 0, 0}, {0, 0, 1}}, settings, host);
            const PlateGrid& grid    = lobe.plate.grid;
            EXPECT_TRUE(lobe.report.converged);
            EXPECT_EQ(lobe.report.solver, "host");
            std::size_t frayed = 0; // nodes more than two cells on the wrong side of the border
            for (int i = 0; i < grid.nodesX(); ++i)
                for (int j = 0; j < grid.nodesZ(); ++j) {
                    const ChartPoint at{lobe.window.corner.x + i * grid.spacingX,
                                        lobe.window.corner.z + j * grid.spacingZ};
                    const glm::dvec3 place =
                        lobe.chart.origin + at.x * lobe.chart.frame.east + at.z * lobe.chart.frame.north;
                    const double out     = std::hypot(place.x / 14e-3, place.y / 18e-3) - 1;
                    const bool   covered = lobe.covered(i, j) > 0.5;
                    frayed += covered ? out * 14e-3 > 2 * grid.spacingX : out * 18e-3 < -2 * grid.spacingX;
                }
            EXPECT_EQ(frayed, 0U) << name(theory) << " at " << x;
            // The faces slope and the way over them is longer, and a border is found to half a cell.
            EXPECT_NEAR(lobe.compliance / sheet.compliance, 1, 0.06) << name(theory) << " at " << x;

            std::printf("  %s at %g: c %.4g, of a sheet %.4g, %.0f ms\n", name(theory), x, lobe.compliance,
                        sheet.compliance, lobe.times.total());
        }
}

TEST(WholeObject, SettingsSettleOnce)
{
    const SoftObject strip    = sheetOf(isInStrip, isStripsRoot, 1);
    const auto       isTip    = [](double x, double y) { return isInStrip(x, y) && std::abs(y) < 0.2 * (60e-3 - x); };
    const SoftObject triangle = sheetOf(isTip, isStripsRoot, 1); // it spreads less than a strip of its length
    for (const int cells : {16, 64, 300, 1024}) {
        PatchSettings settings   = kWhole;
        settings.cells           = cells;
        const PatchSettings tip  = settledFor(triangle, settings);
        const PatchSettings once = settledFor(strip, settings), twice = settledFor(strip, once);
        EXPECT_EQ(settledFor(triangle, tip).cells, tip.cells) << cells;
        EXPECT_EQ(once.cells, twice.cells) << cells;
        EXPECT_EQ(once.window, twice.window) << cells;
        EXPECT_GE(once.window, 2 * strip.extent().across);
        EXPECT_TRUE(once.cells >= 256 && once.cells <= 512 && once.cells % 16 == 0) << once.cells;
    }
    PatchSettings fine = kWhole;
    fine.cells         = 384;
    EXPECT_EQ(settledFor(strip, fine).cells, 384) << "finer than the fingertip asks for, because somebody did";
    EXPECT_EQ(settledFor(strip, {}).window, PatchSettings{}.window);
}

/// By the box along the axes a square that is turned by 45 degrees had cells 1.4 times as wide.
TEST(WholeObject, TheWindowIsTheSameHoweverTheObjectIsTurned)
{
    const auto settledAt = [](double turn) {
        std::vector<glm::dvec3> points;
        for (double x = -40e-3; x < 40e-3; x += 1e-3)
            for (double y = -40e-3; y < 40e-3; y += 1e-3)
                points.emplace_back(x * std::cos(turn) - y * std::sin(turn), x * std::sin(turn) + y * std::cos(turn),
                                    0);
        std::vector<double> shares(points.size(), 0.0);
        return settledFor(objectOf(std::move(points), std::move(shares), kSheet), kWhole);
    };
    const PatchSettings along = settledAt(0), turned = settledAt(std::numbers::pi / 4);
    EXPECT_EQ(turned.cells, along.cells);
    EXPECT_NEAR(turned.window / along.window, 1, 1e-3);
}

TEST(WholeObject, AFlatStripOfAShellIsFlatWithoutAWordHoweverNarrow)
{
    PatchSettings settings = kWhole;
    settings.theory        = Theory::shell;
    const auto  narrow     = [](double x, double y) { return std::abs(x) < 30e-3 && std::abs(y) < 8e-3; };
    const Patch strip      = touched(sheetOf(
                                         narrow, [](double x, double) { return x < -22e-3; }, 1, 0.7e-3),
                                     20e-3, 0, settings);
    EXPECT_FALSE(strip.curvature);
    EXPECT_EQ(strip.flatBecause, "");
}

/// A strip of 100 x 40 mm, 1 mm thick, curved across, held over 10 mm at one end: random points, or a raster.
SoftObject gutterOf(double radius, unsigned seed)
{
    std::mt19937_64                        bits(seed);
    std::uniform_real_distribution<double> along(-50e-3, 50e-3), across(-20e-3, 20e-3);
    std::vector<glm::dvec3>                points;
    std::vector<double>                    shares;
    const auto                             add = [&](double x, double y) {
        points.emplace_back(x, y, -y * y / (2 * radius));
        shares.push_back(x < -40e-3);
    };
    for (int n = 0; seed != 0 && n < 4000; ++n) {
        const double y = across(bits), x = along(bits); // in this order, whichever the compiler's is for arguments
        add(x, y);
    }
    for (int i = 0; seed == 0 && i < 125; ++i) // each in the middle of its share
        for (int j = 0; j < 50; ++j) add(-49.6e-3 + 0.8e-3 * i, -19.6e-3 + 0.8e-3 * j);
    return objectOf(std::move(points), std::move(shares), {.thickness = 1e-3, .poissonRatio = 0.3});
}

/// Truth: CalculiX, bricks of 20 nodes and 1.2 mm, all of the held end fixed; beams of the same sections are 3 %
/// stiffer. It goes with the width to the fifth power. A curvature that ended at the border made these gutters 2.7
/// times too stiff, and those of a raster 5.5 times; a membrane beyond it that gave way a thousand times as much, 1.24
/// and 1.46 times; a bed that begins at the border, 0.93 to 1.1 times, as the cells are. Lengths as they are on the
/// nearest sphere took 12 % off.
TEST(WholeObject, AGutterHeldAtOneEndBendsAsABeam)
{
    PatchSettings settings   = kWhole;
    settings.theory          = Theory::shell;
    settings.footprintRadius = 3e-3;
    for (const auto& [radius, truth] : {std::pair(0.05, 0.515), std::pair(0.1, 0.150), std::pair(0.2, 0.0603)})
        for (const int cells : {256, 512}) {
            if (kSanitized && cells == 512) continue; // the same code again
            std::vector<double> felt;
            settings.cells = cells;
            for (const unsigned seed : {0U, 1U, 2U})
                felt.push_back(touched(gutterOf(radius, seed), 30e-3, 0, settings).feltStiffness / truth);
            const auto [least, most] = std::ranges::minmax(felt);
            std::printf("  radius %g m, %d cells: %+.1f to %+.1f %%\n", radius, cells, 100 * least - 100,
                        100 * most - 100);
            EXPECT_GT(least, 0.95) << radius << " m, " << cells << " cells: measured";
            EXPECT_LT(most, 1.01) << radius << " m, " << cells << " cells";
        }
}

/// By whatever solver: what the void moves by beyond a border stretches no sheet. By the reference this curved disc
/// with a hole resisted up to twice as much as by the factor, and another one thirteen times.
TEST(WholeObject, TheLawOfLargeDeflectionsIsTheSameByTheReference)
{
    constexpr double        kRadius = 40e-3, kHalfX = 21e-3, kHalfY = 37e-3, kHeld = 16.1e-3; // [m]
    std::vector<glm::dvec3> points;
    std::vector<double>     shares;
    for (int i = -21; i <= 21; ++i)
        for (int j = -37; j <= 37; ++j) {
            const double x = 1e-3 * i, y = 1e-3 * j;
            if (std::hypot(x / kHalfX, y / kHalfY) > 1 || std::hypot((x - 11.55e-3) / 6.3e-3, y / 14.8e-3) < 1)
                continue;
            points.emplace_back(x, y, -x * x / (2 * kRadius));
            shares.push_back(std::abs(x) > kHeld);
        }
    const Material   material{.thickness = 1e-3, .poissonRatio = 0.45};
    const SoftObject disc     = objectOf(std::move(points), std::move(shares), material, kModulus);
    PatchSettings    settings = kWhole;
    settings.theory           = Theory::shell;
    settings.large            = Large::on;
    settings.cells            = 256;
    const auto forces         = [&](const char* solver) {
        PlateSolver by(solver);
        const Patch patch = deform(disc, {{0, 0, 0}, {0, 0, 1}}, settings, by);
        return patch.large ? patch.large->force : LargeLaw::Values{};
    };
    const auto factor = forces("host"), reference = forces("reference");
    ASSERT_GT(factor.back(), 0);
    for (std::size_t n = 1; n < factor.size(); ++n)
        EXPECT_NEAR(reference[n] / factor[n], 1, 0.01) << n << ": nodes with hardly any sheet go on otherwise";
}

/// A dome of radius 120 mm over a square of 70 mm, 1.5 mm thick, on strips of 7 mm that are held.
SoftObject domeOnSides(const Where& inside, const Where& held)
{
    std::mt19937_64                        bits(1);
    std::uniform_real_distribution<double> jitter(-0.3e-3, 0.3e-3);
    std::vector<glm::dvec3>                points;
    std::vector<double>                    shares;
    for (int i = -42; i <= 42; ++i)
        for (int j = -42; j <= 42; ++j) {
            const double x = 1e-3 * i + jitter(bits), y = 1e-3 * j + jitter(bits);
            if (!inside(x, y)) continue;
            points.emplace_back(x, y, std::sqrt(0.12 * 0.12 - x * x - y * y) - 0.12);
            shares.push_back(held(x, y));
        }
    return objectOf(std::move(points), std::move(shares), kSheet);
}

/// Truth: CalculiX, bricks of 20 nodes, three meshes, within 2 %; shells S8R agree within 1.5 %. With Airy's function
/// held at 0 behind what is held as well, the last two were felt at 45.1 and 37.7 N/m.
TEST(WholeObject, WhatIsHeldCarriesTheForcesInADome)
{
    constexpr double kHalf = 35e-3;
    PatchSettings    settings{.theory = Theory::shell};
    settings.windowOf   = WindowOf::object;
    const auto allRound = [](double x, double y) { return std::max(std::abs(x), std::abs(y)) > kHalf; };
    const auto isHole   = [](double x, double y) { return x > 11e-3 && x < 25e-3 && std::abs(y) < 7e-3; };
    struct Case {
        Where  inside, held;
        double truth, tolerance;
    };
    for (const auto& [inside, held, truth, tolerance] :
         {Case{[](double, double) { return true; }, allRound, 61.9, 0.03},
          Case{[](double, double y) { return y < kHalf; },
               [](double x, double y) { return std::abs(x) > kHalf || y < -kHalf; }, 57.3, 0.03},
          Case{[&](double x, double y) { return !isHole(x, y); }, allRound, 54.5, 0.06}}) {
        const Patch dome = touched(domeOnSides(inside, held), 0, 0, settings);
        EXPECT_NEAR(dome.feltStiffness / truth, 1, tolerance) << truth << " N/m: borders are found to half a spacing";
        EXPECT_TRUE(dome.thrusts.empty());
    }
}

/// Truth: CalculiX, bricks of 1 mm and 20 nodes, all that is held fixed. Without thrust the first was 40 % too soft.
TEST(WholeObject, WhatIsHeldAtSeveralPlacesThrusts)
{
    PatchSettings settings{.theory = Theory::shell};
    settings.windowOf = WindowOf::object;
    const auto isHole = [](double x, double y) { return x > 11e-3 && x < 25e-3 && std::abs(y) < 7e-3; };
    const auto within = [](double x, double y, double most) { return std::max(std::abs(x), std::abs(y)) < most; };
    struct Case {
        Where       inside, held;
        std::size_t thrusts;
        double      truth, tolerance;
    };
    const auto ends = [](double x, double) { return std::abs(x) > 35e-3; };
    for (const auto& [inside, held, thrusts, truth, tolerance] :
         {Case{[](double, double y) { return std::abs(y) < 35e-3; }, ends, 3, 54.2, 0.03},
          Case{[&](double x, double y) { return std::abs(y) < 35e-3 && !isHole(x, y); }, ends, 6, 46.0, 0.07},
          Case{[&](double x, double y) { return within(x, y, 35e-3); },
               [](double x, double y) { return std::abs(x) > 27e-3 && std::abs(y) > 27e-3; }, 9, 51.7, 0.03}}) {
        const Patch dome = touched(domeOnSides(inside, held), 0, 0, settings);
        EXPECT_EQ(dome.thrusts.size(), thrusts);
        EXPECT_NEAR(dome.feltStiffness / truth, 1, tolerance) << truth << " N/m: borders are found to half a spacing";
    }
}

TEST(WholeObject, ATableOfAnArchIsThatOfTheReference)
{
    PatchSettings settings{.theory = Theory::shell};
    settings.windowOf     = WindowOf::object;
    const SoftObject dome = domeOnSides([](double, double y) { return std::abs(y) < 35e-3; },
                                        [](double x, double) { return std::abs(x) > 35e-3; });
    PlateSolver      host("host"), reference("reference");
    const auto       lattice = footprintLattice(dome, settings, 3, host);
    const auto       found   = deformWithTable(dome, {{0, 0, 0}, {0, 0, 1}}, settings, lattice, host).table.value();
    const auto       exact = deformWithTable(dome, {{0, 0, 0}, {0, 0, 1}}, settings, lattice, reference).table.value();
    for (std::size_t n = 0; n < 9; ++n) {
        EXPECT_NEAR(found.compliance[n].value, exact.compliance[n].value, 6e-4)
            << "works of eight loads miss the tolerance of 1e-4 by up to five times";
        EXPECT_NEAR(found.compliance[n].slopeX, exact.compliance[n].slopeX, 0.3) << "1/m, of slopes up to 10";
    }
}

/// A panel of a tube of radius 40 mm, 1 mm thick, held along a straight side, of points some millimetres apart with
/// noise.
SoftObject panelOf(double spacing, double noise, unsigned seed)
{
    std::mt19937_64                        bits(seed);
    std::uniform_real_distribution<double> jitter(-0.3, 0.3);
    std::normal_distribution<double>       away(0, std::max(noise, 1e-12));
    std::vector<glm::dvec3>                points;
    std::vector<double>                    shares;
    const int                              around = int(80e-3 / spacing), along = int(60e-3 / spacing);
    for (int i = 0; i < around; ++i)
        for (int j = 0; j < along; ++j) {
            const double angle = (i + 0.5 + jitter(bits)) * 2 / around - 1, r = 40e-3 + away(bits);
            points.emplace_back(r * std::sin(angle), (j + 0.5 + jitter(bits)) * spacing - 30e-3,
                                r * std::cos(angle) - 40e-3);
            shares.push_back(angle < -0.8);
        }
    return objectOf(std::move(points), std::move(shares), {.thickness = 1e-3, .poissonRatio = 0.45});
}

/// It bends without stretching. Curvatures that noise made were felt as 1.5 to 5 times the stiffness.
TEST(WholeObject, APanelIsAsSoftWhereItsPointsAreNoisy)
{
    PatchSettings settings = kWhole;
    settings.theory        = Theory::shell;
    std::vector<double> felt;
    for (const double spacing : {1e-3, 2e-3, 3e-3}) {
        const double clean = touched(panelOf(spacing, 0, 1), 0, 0, settings).feltStiffness;
        for (const unsigned seed : {1U, 2U, 3U})
            felt.push_back(touched(panelOf(spacing, 0.3 * spacing, seed), 0, 0, settings).feltStiffness / clean);
    }
    std::ranges::sort(felt);
    EXPECT_GT(felt.front(), 0.93) << "the touched place moves by noise too";
    EXPECT_LT(felt[7], 1.1);
    EXPECT_LT(felt.back(), 1.25) << "of one in thirty a curvature that noise made is left: 22 % here";
}

/// A dome of radius 100 mm with a lump 6 mm wide, held all around, and the same turned about its axis. The window is
/// wider then, and with places of curvature a sixteenth of it apart the lump was felt 40 % stiffer.
TEST(WholeObject, ALumpIsFeltAlikeHoweverTheObjectIsTurned)
{
    PatchSettings settings = kWhole;
    settings.theory        = Theory::shell;
    std::vector<double> felt;
    for (const double turn : {0.0, std::numbers::pi / 4}) {
        std::vector<glm::dvec3> points;
        std::vector<double>     shares;
        for (double x = -35e-3; x < 35e-3; x += 0.6e-3)
            for (double y = -30e-3; y < 30e-3; y += 0.6e-3) {
                const double r2 = x * x + y * y, z = 1e-3 * std::exp(-r2 / (2 * 6e-3 * 6e-3)) - 5 * r2;
                points.emplace_back(x * std::cos(turn) - y * std::sin(turn), x * std::sin(turn) + y * std::cos(turn),
                                    z);
                shares.push_back(std::abs(x) > 30e-3 || std::abs(y) > 25e-3);
            }
        const auto  dome = objectOf(std::move(points), std::move(shares), kSheet);
        PlateSolver host("host");
        felt.push_back(deform(dome, {{0, 0, 1e-3}, {0, 0, 1}}, settings, host).feltStiffness);
    }
    EXPECT_NEAR(felt[1] / felt[0], 1, 0.03);
}

TEST(WholeObject, ALongArchIsOneHoweverNarrow)
{
    PatchSettings settings = kWhole;
    settings.theory        = Theory::shell;
    std::vector<glm::dvec3> points;
    std::vector<double>     shares;
    for (int i = -137; i <= 137; ++i)
        for (int j = -20; j <= 20; ++j) {
            const double x = 1e-3 * i;
            points.emplace_back(x, 1e-3 * j, -0.8 * x * x);
            shares.push_back(std::abs(i) > 130);
        }
    const auto  arch  = objectOf(std::move(points), std::move(shares), {.thickness = 2e-3, .poissonRatio = 0.45});
    const Patch patch = touched(arch, 0, 0, settings);
    EXPECT_EQ(patch.flatBecause, "");
    EXPECT_NEAR(patch.feltStiffness / 3.873, 1, 0.05) << "CalculiX, bricks of 1.2 mm and 20 nodes";
}

bool says(const Patch& patch, const PatchSettings& settings, std::string_view what)
{
    const auto all = warnings(patch, settings, 1e-6, kSheet);
    return std::ranges::any_of(all, [&](const std::string& line) { return line.find(what) != std::string::npos; });
}

/// A strip that is held at one end, of points far closer than the nodes, without Poisson's ratio: a beam.
TEST(WholeObject, WhatIsHeldBeginsWhereItsPointsHaveItWhereverThatLiesBetweenTheNodes)
{
    constexpr double    kPoints = 0.25e-3, kFinger = 55e-3; // [m]
    std::vector<double> lengths;                            // of the beam, less what it should be [cells]
    double              cell = 0;
    for (int slide = 0; slide < 8; ++slide) {
        const double            root = 15e-3 + slide * kPoints / 2;
        std::vector<glm::dvec3> points;
        std::vector<double>     shares;
        for (int i = 0; i < 280; ++i)
            for (int j = -40; j < 40; ++j) {
                points.emplace_back((i + 0.5) * kPoints, (j + 0.5) * kPoints, 0);
                const double from = i * kPoints; // the share of the point's square
                shares.push_back(std::clamp((root - from) / kPoints, 0.0, 1.0));
            }
        const Material material{.thickness = 1e-3, .poissonRatio = 0};
        const Patch    strip = touched(objectOf(std::move(points), std::move(shares), material), kFinger, 0);
        cell                 = strip.window.grid.spacingX;
        const double c       = strip.compliance * 3 * 1e6 * 20e-3 * 1e-9 / 12; // times 3 E I [m^3]
        lengths.push_back((std::cbrt(c) - (kFinger - root)) / cell);
    }
    const auto [least, most] = std::ranges::minmax(lengths);
    EXPECT_GT(least, -0.1) << "cells of " << cell << " m";
    EXPECT_LT(most, 0.1);
}

/// Nodes in the void behind a support are held as its points are. Where they were not, as far out, the support was taken
/// for one within the sheet, and the bowl was felt 28 % too soft, by chance.
TEST(WholeObject, ASupportAtTheRimIsNoneThatTheSheetSurrounds)
{
    constexpr double kStep = 0.6e-3, kRim = 30e-3; // [m]
    for (const unsigned seed : {1U, 2U, 3U, 4U, 5U, 6U}) {
        std::mt19937_64                        bits(seed);
        std::uniform_real_distribution<double> within(0, kStep);
        std::vector<glm::dvec3>                points;
        std::vector<double>                    shares;
        for (double i = -kRim; i < kRim; i += kStep)
            for (double j = -kRim; j < kRim; j += kStep) {
                const double x = i + within(bits), y = j + within(bits), r = std::hypot(x, y);
                if (r > kRim) continue;
                bool held = false;
                for (int k = 0; k < 3; ++k) {
                    const double angle = 2 * std::numbers::pi * k / 3 + seed;
                    held = held || std::hypot(x - 27e-3 * std::cos(angle), y - 27e-3 * std::sin(angle)) < 4e-3;
                }
                points.emplace_back(x, y, 8 * r * r);
                shares.push_back(held);
            }
        PatchSettings settings = kWhole;
        settings.theory        = Theory::shell;
        const Patch patch      = touched(objectOf(std::move(points), std::move(shares), kSheet), 0, 0, settings);
        EXPECT_EQ(patch.thrustsLeftOut, 0) << seed;
        EXPECT_EQ(patch.thrusts.size(), 6U) << seed << ": free borders in three pieces";
    }
}

TEST(WholeObject, ATouchOfWhatIsHeldIsSaidToBeOne)
{
    const SoftObject strip = sheetOf(isInStrip, isStripsRoot, 1);
    EXPECT_TRUE(says(touched(strip, -10e-3, 0), kWhole, "held at this place"));
    EXPECT_FALSE(says(touched(strip, 10e-3, 0), kWhole, "held at this place"));
}

TEST(WholeObject, PiecesThatAreNotTouchedAreSaidNotToBeFelt)
{
    const auto inBoth = [](double x, double y) { return isInStrip(x, y) || (x < -35e-3 && std::abs(y) < 30e-3); };
    EXPECT_TRUE(says(touched(sheetOf(inBoth, isStripsRoot, 1), 10e-3, 0), kWhole, "% of the object are other pieces"));
    EXPECT_FALSE(says(touched(sheetOf(isInStrip, isStripsRoot, 1), 10e-3, 0), kWhole, "other pieces"));

    PatchSettings onFoundation = kWhole;
    onFoundation.foundation    = 1e5;
    const auto nowhere         = [](double, double) { return false; };
    EXPECT_TRUE(says(touched(sheetOf(inBoth, nowhere, 1), 10e-3, 0, onFoundation), onFoundation, "other pieces"));
}

TEST(WholeObject, ForcesTowardsASupportThatTheSheetSurroundsAreSaidToBeLeftOut)
{
    PatchSettings settings{.theory = Theory::shell};
    settings.windowOf = WindowOf::object;
    const auto said   = [&](const Where& held) {
        const SoftObject dome = domeOnSides([](double, double y) { return std::abs(y) < 35e-3; }, held);
        return says(touched(dome, 0, 0, settings), settings, "left out");
    };
    const auto post = [](double x, double y) { return std::hypot(x - 20e-3, y) < 5e-3; };
    EXPECT_TRUE(said([&](double x, double y) { return x < -35e-3 || post(x, y); }));
    EXPECT_FALSE(said([](double x, double) { return std::abs(x) > 35e-3; }));
    EXPECT_FALSE(said(post)) << "alone it carries none";
    const auto bolt = [&](double x, double y) { return post(x, y) && std::hypot(x - 20e-3, y) > 3e-3; };
    const auto has  = [](double x, double y) { return std::abs(y) < 35e-3 && std::hypot(x - 20e-3, y) > 3e-3; };
    const auto held = [&](double x, double y) { return x < -35e-3 || bolt(x, y); };
    EXPECT_EQ(touched(domeOnSides(has, held), 0, 0, settings).thrustsLeftOut, 1) << "a bolt holds around its hole";
}

/// An arch of R 40 mm, 72 x 40 mm and 1 mm, between a support and a pin that ends 2.5 mm before the border, by CalculiX
/// (calculix_outlines.py with this outline, elements of 2.2 and 1.5 mm carried on): 0.0498 m/N in its middle, where it
/// was felt 14 times as soft. 20 % are those of a pin as wide as seven cells, 9 by another cloud.
TEST(WholeObject, APinNearABorderCarriesAnArch)
{
    const double                           radius = 40e-3;
    std::mt19937_64                        bits(3);
    std::uniform_real_distribution<double> within(0, kSpacing);
    std::vector<glm::dvec3>                points;
    std::vector<double>                    held;
    for (double i = -36e-3; i < 36e-3; i += kSpacing)
        for (double j = -20e-3; j < 20e-3; j += kSpacing) {
            const double x = i + within(bits), y = j + within(bits);
            points.emplace_back(x, y, std::sqrt(radius * radius - x * x) - radius);
            held.push_back(x < -32e-3 || (x > 31e-3 && x < 33.5e-3 && y > -2e-3 && y < 0.5e-3));
        }
    PatchSettings settings{.theory = Theory::shell};
    settings.windowOf      = WindowOf::object;
    const SoftObject arch  = objectOf(std::move(points), std::move(held), {.thickness = 1e-3, .poissonRatio = 0.45});
    const Patch      patch = touched(arch, 0, 0, settings);
    EXPECT_EQ(patch.tied, 1);
    EXPECT_EQ(patch.thrustsLeftOut, 0);
    EXPECT_NEAR(patch.compliance / 0.0498, 1.1, 0.15);
    EXPECT_TRUE(says(patch, settings, "at 1 place that does not reach its border"));
}

/// The nearest border of a pin on one arm of a U faces the other arm, which is narrow and which no tie holds.
TEST(WholeObject, ATieOfAPinCrossesNoOtherArm)
{
    const auto has = [](double x, double y) {
        return std::abs(y) < 30e-3 && x < 11e-3 && (std::abs(x) > 8e-3 || y < -20e-3);
    };
    const auto    held = [](double x, double y) { return y < -26e-3 || std::hypot(x + 12e-3, y - 10e-3) < 2e-3; };
    PatchSettings settings{.theory = Theory::shell};
    settings.windowOf = WindowOf::object;
    const Patch patch = touched(domeOnSides(has, held), -20e-3, 0, settings);
    ASSERT_EQ(patch.tied, 1) << "obliquely, through the mouth of the U";
    const auto strips = connected(patch.plate.grid, [&](std::size_t n) {
        return patch.covered.values()[n] > 0.5 && patch.heldInPlane.values()[n] > patch.held.values()[n] + 0.5;
    });
    EXPECT_EQ(strips.size(), 1U) << "straight to the right the other arm would have one too";
}

/// A saddle of 100 x 60 mm and radii of 80 and -60 mm, by points anywhere in squares of their spacing, that a row of
/// balls holds along either end; turned about the normal in its middle and then about x.
struct SaddleInBalls {
    double   spacing = 1e-3, middle = 47e-3; ///< of the points; of the balls, from the saddle's [m]
    double   apart    = 4e-3;                ///< the balls, whose radius is 3 mm [m]
    double   turn     = 0;                   ///< [rad]
    unsigned seed     = 1;
    bool     hasOther = false; ///< a strip beside it, that nothing holds

    [[nodiscard]] static double height(double x, double y) { return x * x / 160e-3 - y * y / 120e-3; }

    [[nodiscard]] bool isHeld(double x, double y) const
    {
        double nearest = 1; // [m]
        for (double at = apart * std::round(-28e-3 / apart); at < 29e-3; at += apart)
            nearest = std::min(nearest, std::hypot(std::abs(x) - middle, y - at, height(x, y) - height(middle, at)));
        return nearest <= 3e-3;
    }

    [[nodiscard]] glm::dvec3 turned(const glm::dvec3& p) const
    {
        const double     c = std::cos(turn), s = std::sin(turn);
        const glm::dvec3 q{c * p.x - s * p.y, s * p.x + c * p.y, p.z};
        return {q.x, c * q.y - s * q.z, s * q.y + c * q.z};
    }

    [[nodiscard]] SoftObject object() const
    {
        std::mt19937_64                        bits(seed);
        std::uniform_real_distribution<double> within(0, spacing);
        std::vector<glm::dvec3>                points;
        std::vector<double>                    held;
        const double                           end = hasOther ? 60e-3 : 30e-3; // [m]
        for (double i = -50e-3; i < 50e-3; i += spacing)
            for (double j = -30e-3; j < end; j += spacing) {
                const double x = i + within(bits), y = j + within(bits);
                if (j >= 30e-3 && (j < 50e-3 || std::abs(i) > 15e-3)) continue;
                points.push_back(turned({x, y, height(x, y)}));
                held.push_back(j < 30e-3 && isHeld(x, y));
            }
        return objectOf(std::move(points), std::move(held), {.thickness = 1e-3, .poissonRatio = 0.3});
    }

    [[nodiscard]] Patch touched() const
    {
        PatchSettings settings{.theory = Theory::shell};
        settings.windowOf = WindowOf::object;
        PlateSolver host("host");
        return deform(object(), {turned({0, 0, 0}), turned({0, 0, 1})}, settings, host);
    }
};

/// Behind the balls a rim is left, as wide as nothing up to two cells. Each of its remnants parted the ground behind
/// it, and the saddle was felt 1 to 2.1 times too soft, by how its points lay, or solved with an error of 88 %. Boxes
/// in place of the balls hold it with 21.4 N/m.
TEST(WholeObject, ARowOfBallsHoldsItHoweverThePointsLie)
{
    const SaddleInBalls cases[] = {{},
                                   {.seed = 2},
                                   {.seed = 3},
                                   {.spacing = 0.7e-3},
                                   {.spacing = 0.5e-3, .seed = 2},
                                   {.spacing = 1.4e-3},
                                   {.turn = 0.3},
                                   {.turn = 0.58, .seed = 2},
                                   {.spacing = 0.7e-3, .turn = 1},
                                   {.apart = 5e-3},
                                   {.middle = 46e-3},
                                   {.spacing = 0.5e-3, .middle = 46e-3},
                                   {.spacing = 0.6e-3, .middle = 45.7e-3, .seed = 4},
                                   {.hasOther = true}};
    for (const SaddleInBalls& saddle : cases) {
        const Patch  patch  = saddle.touched();
        const auto   which  = testing::Message() << &saddle - cases;
        const double nearer = 47e-3 - saddle.middle; // [m] by which the span is shorter: 1.5 % a millimetre
        EXPECT_NEAR(1 / patch.compliance, 21.2 * (1 + 15 * nearer), 0.2) << which;
        EXPECT_TRUE(patch.report.converged) << which;
        EXPECT_EQ(patch.report.iterations, 0) << which << ": by the factor";
        EXPECT_EQ(patch.tied, 0) << which;
        EXPECT_EQ(patch.thrusts.size(), 3U) << which << ": for two free borders";
    }
}

/// Two strips of 2 mm hold a saddle, 5 mm before its borders. What is beyond them is felt only where it is touched
/// itself; it took 4.5 times from what is between them.
TEST(WholeObject, AnOverhangBehindASupportIsFeltWhereItIsTouchedAlone)
{
    const auto touchedAt = [](double x, double heldUpTo) {
        std::mt19937_64                        bits(4);
        std::uniform_real_distribution<double> within(0, kSpacing);
        std::vector<glm::dvec3>                points;
        std::vector<double>                    held;
        for (double i = -50e-3; i < 50e-3; i += kSpacing)
            for (double j = -30e-3; j < 30e-3; j += kSpacing) {
                const double at = i + within(bits), y = j + within(bits);
                points.emplace_back(at, y, SaddleInBalls::height(at, y));
                held.push_back(std::abs(at) > 43e-3 && std::abs(at) < heldUpTo);
            }
        PatchSettings settings{.theory = Theory::shell};
        settings.windowOf = WindowOf::object;
        PlateSolver      host("host");
        const SoftObject saddle =
            objectOf(std::move(points), std::move(held), {.thickness = 1e-3, .poissonRatio = 0.3});
        return deform(saddle, {{x, 0, SaddleInBalls::height(x, 0)}, {0, 0, 1}}, settings, host);
    };
    for (const double x : {0.0, 25e-3, 38e-3})
        EXPECT_NEAR(touchedAt(x, 45e-3).compliance / touchedAt(x, 1).compliance, 1, 0.02) << x;
    const Patch      overhang = touchedAt(48e-3, 45e-3);
    const PlateGrid& grid     = overhang.plate.grid;
    EXPECT_LT(overhang.heldInPlane(grid.cellsX / 2, grid.cellsZ / 2), 0.5);
}

/// Nothing but what is held holds their stresses, and the factor was singular.
TEST(WholeObject, ARoundObjectThatIsHeldAllAroundIsSolvedWhateverItsSize)
{
    PatchSettings settings{.theory = Theory::shell};
    settings.windowOf = WindowOf::object;
    double before     = 90; // [N/m]
    for (int n = 0; n < 5; ++n) {
        const double radius = 25e-3 + 2.3e-3 * n;
        const auto   in     = [&](double x, double y) { return std::hypot(x, y) < radius; };
        const auto   held   = [&](double x, double y) { return std::hypot(x, y) > radius - 4e-3; };
        const Patch  dome   = touched(domeOnSides(in, held), -5e-3, 2e-3, settings);
        EXPECT_TRUE(dome.report.converged) << radius;
        EXPECT_EQ(dome.report.iterations, 0) << radius << ": by the factor";
        EXPECT_LT(dome.feltStiffness, 1.03 * before)
            << radius << ": it is softer the wider it is, but for 3 % of borders";
        EXPECT_GT(dome.feltStiffness, 0.8 * before) << radius;
        before = dome.feltStiffness;
    }
}

/// Felt with its rim fixed, and in brackets where the rim may slide in its plane: 14.54 (9.89) and 6.63 (4.25) N/m, by
/// finite differences of Reissner's equations along the radius, in a program that is within 0.02 % of his point load
/// where the rim is far away.
TEST(WholeObject, ADomeThatIsHeldAtItsRimIsHeldInItsPlaneToo)
{
    const Material material{.thickness = 1e-3, .poissonRatio = 0.3};
    PatchSettings  settings{.theory = Theory::shell};
    settings.windowOf        = WindowOf::object;
    settings.footprintRadius = 3e-3;
    for (const auto& [radius, truth] : {std::pair(0.2, 14.54), std::pair(0.5, 6.63)}) {
        constexpr int           kCount = 10000;
        std::vector<glm::dvec3> points;
        std::vector<double>     shares;
        for (int n = 0; n < kCount; ++n) { // a spiral of even density
            const double r = 45e-3 * std::sqrt((n + 0.5) / kCount), turn = n * 2.399963;
            points.emplace_back(r * std::cos(turn), r * std::sin(turn), std::sqrt(radius * radius - r * r) - radius);
            shares.push_back(r > 40e-3 ? 1 : 0);
        }
        const auto dome =
            SoftObject(PointCloud(std::move(points), std::vector<double>(kCount, 1e6), StiffnessKind::modulus),
                       material)
                .withHeld(std::move(shares));
        EXPECT_NEAR(touched(dome, 0, 0, settings).feltStiffness / truth, 1, 0.02) << radius << " m";
    }
}

/// On the flank of a ridge the sphere of the chart leans, and points of the one face lie behind each other along its
/// normal. They were taken for a second face, and the panel bent flat there: four times too soft, between neighbours
/// that were not.
TEST(WholeObject, TheFlankOfARidgeIsNoSecondFace)
{
    const auto                             ridge = [](double x) { return 6e-3 * std::exp(-x * x / (2 * 4e-3 * 4e-3)); };
    std::mt19937_64                        bits(3);
    std::vector<glm::dvec3>                points;
    std::vector<double>                    held;
    std::uniform_real_distribution<double> jitter(-0.4e-3, 0.4e-3);
    for (int i = -40; i <= 40; ++i)
        for (int j = -30; j <= 30; ++j) {
            const double x = 1e-3 * i + jitter(bits), y = 1e-3 * j + jitter(bits);
            points.emplace_back(x, y, ridge(x));
            held.push_back(std::abs(x) > 36e-3);
        }
    const SoftObject panel = objectOf(std::move(points), std::move(held), {.thickness = 1e-3, .poissonRatio = 0.45});
    PatchSettings    settings{.theory = Theory::shell};
    settings.windowOf = WindowOf::object;
    PlateSolver host("host");
    for (const double x : {3e-3, 3.5e-3, 4e-3, 4.5e-3, 5e-3, -4e-3}) {
        const double     slope = x / (4e-3 * 4e-3) * ridge(x);
        const glm::dvec3 up    = glm::normalize(glm::dvec3(slope, 0, 1));
        const Patch      patch = deform(panel, {{x, 0, ridge(x)}, up, true, true}, settings, host);
        EXPECT_EQ(patch.flatBecause, "") << x;
        EXPECT_TRUE(patch.curvature) << x;
    }
}

/// A strip of a flat and a curved half that is held at one end bends without being stretched, as CalculiX has it two
/// thicknesses deep. A side of its window that was free, because the ground of what is held reaches it, let it fall by
/// a tenth.
TEST(WholeObject, WhatHasAFreeEndStaysLinear)
{
    std::mt19937_64                        bits(3);
    std::vector<glm::dvec3>                points;
    std::vector<double>                    held;
    std::uniform_real_distribution<double> jitter(-0.4e-3, 0.4e-3);
    const auto height = [](double x) { return x < 0 ? 0.0 : std::sqrt(0.04 * 0.04 - x * x) - 0.04; };
    for (int i = -36; i <= 36; ++i)
        for (int j = -12; j <= 12; ++j) {
            const double x = 1e-3 * i + jitter(bits), y = 1e-3 * j + jitter(bits);
            points.emplace_back(x, y, height(x));
            held.push_back(x < -32e-3);
        }
    const SoftObject strip = objectOf(std::move(points), std::move(held), {.thickness = 1e-3, .poissonRatio = 0.45});
    PatchSettings    settings{.theory = Theory::shell, .large = Large::on};
    settings.windowOf = WindowOf::object;
    PlateSolver host("host");
    for (const double x : {-15e-3, 0.0}) {
        const Patch patch = deform(strip, {{x, 0, 0}, {0, 0, 1}, true, true}, settings, host);
        ASSERT_TRUE(patch.large) << patch.linearBecause;
        const double secant = patch.large->force.back() / patch.large->reach();
        EXPECT_NEAR(secant / patch.large->tangent.front(), 1, 0.03) << x << ": it is stretched across a little";
    }
}

} // namespace
} // namespace palp
