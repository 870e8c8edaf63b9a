#include "engine/pipeline/compliance_table_solve.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include <glm/geometric.hpp>

#include "engine/cloud/samples.h"
#include "engine/core/contract.h"
#include "engine/pipeline/deform.h"
#include "engine/pipeline/patch_warnings.h"
#include "engine/plate/load.h"
#include "tests/pipeline/crossing.h"
#include "tests/support/errors.h"
#include "tests/support/published_tables.h"

namespace palp {
namespace {

constexpr double kMillimetre = 1e-3; // [m]

SoftObject homogeneous(const char* name, unsigned seed)
{
    const SpatialLaw law{.kind = SpatialLaw::Kind::constant, .from = 1e6};
    return SoftObject(makeSample(sampleNamed(name), 20'000, seed, law));
}

const PatchSettings kSkin{.foundation = 1e6, .window = 40e-3, .cells = 40, .footprintRadius = 3e-3};

/// ln c of one footprint anywhere in a window, over what a homogeneous plate has there: what a table interpolates.
double lnCompliance(const Plate& plate, const Plate& homogeneous, double x, double z)
{
    static PlateSolver solver("host");
    const double       middle = plate.grid.sizeX() / 2;
    const auto         c      = [&](const Plate& of, double atX, double atZ) {
        const NodeField load = footprintLoad(of.grid, 1, middle + atX, middle + atZ, Sheet::kRadius);
        return std::log(dot(load, solver.solve(of, load, 1e-5).deflection));
    };
    return c(plate, x, z) - c(homogeneous, x, z) + c(homogeneous, 0, 0);
}

/// Of the same geometric mean throughout.
Plate evened(Plate plate)
{
    double sum = 0;
    for (double d : plate.rigidity.values()) sum += std::log(d);
    plate.rigidity = NodeField(plate.grid, std::exp(sum / double(plate.grid.nodes())));
    return plate;
}

/// The same values with slopes from their own differences, as Catmull and Rom have it; one-sided at the rim.
ComplianceTable withSlopesOfValues(ComplianceTable table)
{
    const auto given = table.compliance;
    const int  last  = table.side - 1;
    const auto slope = [&](int n, auto value) {
        if (n == 0) return (-3 * value(0) + 4 * value(1) - value(2)) / (2 * table.spacing);
        if (n == last) return (3 * value(last) - 4 * value(last - 1) + value(last - 2)) / (2 * table.spacing);
        return (value(n + 1) - value(n - 1)) / (2 * table.spacing);
    };
    const auto at = [&](int i, int j) { return given[std::size_t(i * table.side + j)].value; };
    for (int i = 0; i <= last; ++i)
        for (int j = 0; j <= last; ++j) {
            auto& entry  = table.compliance[std::size_t(i * table.side + j)];
            entry.slopeX = slope(i, [&](int n) { return at(n, j); });
            entry.slopeZ = slope(j, [&](int n) { return at(i, n); });
        }
    return table;
}

TEST(TableSolve, InterpolationLosesLittleBetweenFootprintsAndSlopesAreWhatMakesItSo)
{
    struct Case {
        const char*   name;
        Sheet::Factor factor;
        double        allowed; ///< of c [1]
    };
    for (const Case& c : {Case{"wart of 100", wart(100), 0.003}, Case{"step of 10", step(10), 0.01},
                          Case{"step of 100", step(100), 0.03}}) {
        const Sheet sheet(c.factor);
        double      worst = 0, catmullRom = 0;
        for (double centre : {0.0, 1.3e-3, 2.7e-3}) {
            const Plate           plate = sheet.plateAt(centre), flat = evened(plate);
            const ComplianceTable table = sheet.tableAt(centre, 5), values = withSlopesOfValues(table);
            for (double x = -7e-3; x <= 7e-3; x += 2e-3)
                for (double z : {-5e-3, -2e-3, 1e-3, 6e-3}) {
                    const double truth = lnCompliance(plate, flat, x, z);
                    worst              = worse(worst, table.at({x, z}).lnCompliance - truth);
                    catmullRom         = std::max(catmullRom, std::abs(values.at({x, z}).lnCompliance - truth));
                }
        }
        RecordProperty(c.name,
                       std::to_string(100 * worst) + " %, by differences " + std::to_string(100 * catmullRom) + " %");
        EXPECT_LT(worst, c.allowed) << c.name;
        EXPECT_GT(catmullRom, 2 * worst) << c.name;
    }
}

TEST(TableSolve, SlopesAreThoseOfTheCompliance)
{
    const Sheet           sheet(wart(10));
    const double          centre = 3e-3;
    const Plate           plate = sheet.plateAt(centre), flat = Sheet::homogeneous();
    const ComplianceTable table = sheet.tableAt(centre, 3);
    const double          step  = kMillimetre / 2;
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) {
            const double x = (i - 1) * Sheet::kRadius, z = (j - 1) * Sheet::kRadius;
            const auto   entry = table.compliance[std::size_t(3 * i + j)];
            const double slopeX =
                (lnCompliance(plate, flat, x + step, z) - lnCompliance(plate, flat, x - step, z)) / (2 * step);
            const double slopeZ =
                (lnCompliance(plate, flat, x, z + step) - lnCompliance(plate, flat, x, z - step)) / (2 * step);
            EXPECT_NEAR(entry.slopeX, slopeX, 0.5) << "per metre, of up to 60: what a difference over 1 mm leaves";
            EXPECT_NEAR(entry.slopeZ, slopeZ, 0.5);
        }
}

/// One place has one stiffness: a touch that is not a session's has the mean under the fingertip too, not one node's.
TEST(TableSolve, TheContactIsThatOfATouchAlsoWhereAWartIsAsSmallAsTheFingertip)
{
    PlateSolver host("host");
    for (const double radius : {1.5e-3, 3e-3, 6e-3}) {
        const SpatialLaw law{
            .kind = SpatialLaw::Kind::disc, .from = 1e5, .to = 1e6, .centres = {{0, 0, 0}}, .width = radius};
        const SoftObject object(makeSample(sampleNamed("sheet"), 20'000, 1, law));
        const Contact    middle{{0, 0, 0}, {0, 0, 1}};
        const Patch      alone = deform(object, middle, kSkin, host);
        const auto       made  = deformWithTable(object, middle, kSkin, footprintLattice(object, kSkin, 3, host), host);
        ASSERT_TRUE(made.table);
        EXPECT_NEAR(std::exp(made.table->middle().lnContactStiffness) / alone.contactStiffness, 1, 1e-9) << radius;
        EXPECT_NEAR(made.patch.contactStiffness / alone.contactStiffness, 1, 1e-12) << radius;
        const double node = contactStiffness(object.material().modulus(rigidityAtContact(alone)), kSkin.footprintRadius,
                                             object.material().thickness);
        EXPECT_LT(alone.contactStiffness, node * (radius < 4e-3 ? 0.95 : 1.01)) << "the sheet beside it is softer";
    }
}

/// What is held far away is no firmer foundation, and the window's correction has to know.
TEST(TableSolve, TablesOfHomogeneousSheetsAreFlatBesideWhatIsHeld)
{
    PlateSolver         host("host");
    const SoftObject    sheet = homogeneous("sheet", 1);
    std::vector<double> held;
    for (const glm::dvec3& p : sheet.positions()) held.push_back(p.x > 35e-3);
    PatchSettings settings = kSkin;
    settings.window        = 46e-3;
    const Contact middle{{0, 0, 0}, {0, 0, 1}};
    const auto    flatness = [&](const SoftObject& object) {
        const auto made = deformWithTable(object, middle, settings, footprintLattice(sheet, settings, 7, host), host);
        double     most = 0;
        for (std::size_t n = 0; n < 49; ++n)
            most = worse(most, made.table->compliance[n].value - made.table->middle().lnCompliance);
        return most;
    };
    EXPECT_LT(flatness(sheet), 1e-6);
    EXPECT_LT(flatness(sheet.withHeld(held)), 1e-6) << "nothing of the window is held";
    const Patch patch = deform(sheet.withHeld(held), middle, settings, host);
    EXPECT_NEAR(patch.below, settings.foundation, 1e-6);

    settings.foundation = 1e4;
    const auto isNarrow = [&](const SoftObject& object) {
        const auto said = warnings(deform(object, middle, settings, host), settings, 1e-3, object.material());
        return std::ranges::any_of(
            said, [](const std::string& one) { return one.find("is narrower than") != std::string::npos; });
    };
    EXPECT_TRUE(isNarrow(sheet));
    EXPECT_TRUE(isNarrow(sheet.withHeld(held)));
}

/// The law before the first table, on a dome: it was that of a flat plate, six times too soft.
TEST(TableSolve, TheMiddlesOfALatticeAreThoseOfAShellAsCurvedAsTheObject)
{
    PlateSolver             host("host");
    const double            radius = 50e-3;
    std::vector<glm::dvec3> points;
    constexpr int           kCount = 12'000;
    for (int n = 0; n < kCount; ++n) { // Fibonacci's spiral
        const double z = 1 - (2 * n + 1.0) / kCount, around = n * 2.399963229728653, flat = std::sqrt(1 - z * z);
        points.push_back(radius * glm::dvec3(flat * std::cos(around), flat * std::sin(around), z));
    }
    std::vector<double> moduli(points.size(), 3e5);
    const SoftObject    sphere(PointCloud(std::move(points), std::move(moduli), StiffnessKind::modulus),
                               Material{.thickness = 2e-3, .poissonRatio = 0.45});
    for (const double foundation : {0.0, 3e4}) {
        const Edge    s = Edge::supported;
        PatchSettings settings{
            .foundation = foundation, .window = 60e-3, .cells = 48, .theory = Theory::shell, .edges = {s, s, s, s}};
        const double felt = deform(sphere, {{0, 0, radius}, {0, 0, 1}}, settings, host).compliance;
        const auto   at   = footprintLattice(sphere, settings, 1, host);
        EXPECT_NEAR(std::exp(at.lnCompliance(sphere.rigidity(0))) / felt, 1, 0.15) << foundation;
        EXPECT_NEAR(at.lnCompliance(2 * sphere.rigidity(0)) - at.lnCompliance(sphere.rigidity(0)), -std::log(2.0),
                    foundation > 0 ? 0.2 : 1e-12);
        PatchSettings whole = settings;
        whole.windowOf      = WindowOf::object;
        EXPECT_NEAR(std::exp(footprintLattice(sphere, whole, 1, host).lnCompliance(sphere.rigidity(0))) / felt, 1, 0.2);
        settings.theory = Theory::plate;
        EXPECT_GT(std::exp(footprintLattice(sphere, settings, 1, host).lnCompliance(sphere.rigidity(0))) / felt, 2);
    }
}

/// A foundation ends dents where a sheet is soft: that is no curvature, which stiff places would feel nine times.
TEST(TableSolve, TheMiddlesOfAFlatShellAreThoseOfAPlateWhateverItsStiffnesses)
{
    PlateSolver             host("host");
    std::vector<glm::dvec3> points;
    std::vector<double>     moduli;
    for (int i = -40; i <= 40; ++i)
        for (int j = -40; j <= 40; ++j) {
            points.emplace_back(1e-3 * i, 1e-3 * j, 0);
            moduli.push_back(i < 8 ? 3e4 : 3e6);
        }
    const SoftObject sheet(PointCloud(std::move(points), std::move(moduli), StiffnessKind::modulus),
                           Material{.thickness = 2e-3, .poissonRatio = 0.45});
    PatchSettings    settings{.foundation = 3e5, .window = 60e-3, .cells = 48, .theory = Theory::shell};
    const auto       shell = footprintLattice(sheet, settings, 1, host);
    settings.theory        = Theory::plate;
    const auto plate       = footprintLattice(sheet, settings, 1, host);
    for (const double rigidity : {sheet.rigidity(0), sheet.rigidity(sheet.size() - 1)})
        EXPECT_NEAR(shell.lnCompliance(rigidity), plate.lnCompliance(rigidity), 1e-6);
}

/// The floor of every measurement of perception, J = (largest - smallest stiffness within 5 mm) / 7 %, the plate part.
TEST(TableSolve, TablesOfHomogeneousPlatesAreFlatWhateverTheWindow)
{
    PlateSolver solver("host");
    for (double foundation : {0.0, 1e6})
        for (const PlateEdges& edges : {PlateEdges{}, PlateEdges{.x1 = Edge::supported, .z0 = Edge::supported}}) {
            const PlateGrid grid{40, 40, kMillimetre, kMillimetre};
            const Plate     plate{grid, edges, 0.45, foundation, NodeField(grid, 2e-3)};
            const auto      lattice = solveLattice(plate, {3e-3, 7, 1e6}, solver, 1e-4);
            const auto      table   = solveTable(plate, lattice, solver, 1e-4).table;
            double          least = 1e9, most = -1e9;
            for (double x = -9e-3; x <= 9e-3; x += 0.7e-3)
                for (double z = -9e-3; z <= 9e-3; z += 0.7e-3) {
                    const auto here = table.at({x, z});
                    ASSERT_TRUE(std::isfinite(here.lnCompliance));
                    least = std::min(least, here.lnCompliance);
                    most  = std::max(most, here.lnCompliance);
                    EXPECT_NEAR(here.lnContactStiffness, std::log(1e6 * 2e-3), 1e-9);
                }
            EXPECT_LT((most - least) / 0.07, 1e-6) << "the same bits twice, and cubics that sum to 1";
            if (foundation == 0) {
                EXPECT_LT(lattice.rungs.front()[0].value, -0.1) << "what the ratios take away: the window's edge";
            }
        }
}

/// Far from a feature an object is homogeneous, but of another rigidity than the cloud's mean.
TEST(TableSolve, TablesOfSofterAndStifferPlatesThanTheMeanAreFlatToAThousandth)
{
    PlateSolver    solver("host");
    const Plate    plate   = Sheet::homogeneous();
    constexpr auto kShape  = FootprintTable{Sheet::kRadius, 7, 1e6};
    const auto     lattice = solveLattice(plate, kShape, solver, 1e-4);
    for (double factor : {0.05, 0.4, 1.7, 10.0}) {
        Plate other      = plate;
        other.rigidity   = NodeField(plate.grid, factor * plate.rigidity(0, 0));
        const auto table = solveTable(other, lattice, solver, 1e-4).table;
        for (std::size_t n = 0; n < 49; ++n)
            EXPECT_NEAR(table.compliance[n].value, table.middle().lnCompliance, 2e-3)
                << "between two rungs; with one for all it is 0.16 at 10: factor " << factor;
    }
}

TEST(TableSolve, ATableThatDoesNotFitItsWindowIsRefused)
{
    PlateSolver     solver("reference");
    const PlateGrid grid{20, 20, kMillimetre, kMillimetre};
    const Plate     plate{grid, {}, 0.45, 0, NodeField(grid, 2e-3)};
    EXPECT_NO_THROW((void)solveLattice(plate, {3e-3, 5, 1e6}, solver, 1e-4)) << "2 (6 + 3) + 1 mm";
    EXPECT_THROW((void)solveLattice(plate, {3e-3, 7, 1e6}, solver, 1e-4), Error);
    EXPECT_THROW((void)solveLattice(plate, {3e-3, 4, 1e6}, solver, 1e-4), ContractViolation);
    EXPECT_THROW((void)solveLattice(plate, {3e-3, 9, 1e6}, solver, 1e-4), ContractViolation);
}

TEST(TableSolve, TheReferenceAgreesWithTheMultigrid)
{
    const Plate plate = Sheet(step(10)).plateAt(1e-3);
    PlateSolver reference("reference"), host("host");
    Plate       flat = plate;
    flat.rigidity    = NodeField(plate.grid, plate.rigidity(0, 0));
    const FootprintTable shape{Sheet::kRadius, 3, 1e6};
    const auto           slow = solveTable(plate, solveLattice(flat, shape, reference, 1e-4), reference, 1e-4);
    const auto           fast = solveTable(plate, solveLattice(flat, shape, host, 1e-4), host, 1e-4);
    EXPECT_EQ(slow.middle.report.solver, "reference");
    EXPECT_EQ(fast.middle.report.solver, "host");
    for (std::size_t n = 0; n < 9; ++n) {
        EXPECT_NEAR(fast.table.compliance[n].value, slow.table.compliance[n].value, 1e-4) << "the tolerance";
        EXPECT_NEAR(fast.table.compliance[n].slopeX, slow.table.compliance[n].slopeX, 0.1) << "per metre, of up to 100";
    }
}

TEST(DeformWithTable, ThePatchIsThatOfDeformAndTheTablesMiddleIsItsCompliance)
{
    const SoftObject     object(makeSample(sampleNamed("ellipsoid"), 20'000, 1));
    PlateSolver          solver("host");
    const Contact        contact = touchAt(object, {0, 0, 35e-3}, glm::dvec3(0, 0, 1), 10e-3);
    const auto           lattice = footprintLattice(object, kSkin, 3, solver);
    const PatchWithTable both    = deformWithTable(object, contact, kSkin, lattice, solver);
    const Patch          alone   = deform(object, contact, kSkin, solver);

    ASSERT_TRUE(both.table.has_value());
    EXPECT_NEAR(both.patch.compliance / alone.compliance, 1, 1e-4) << "the tolerance of tables";
    EXPECT_NEAR(std::exp(both.table->middle().lnCompliance), both.patch.compliance, 1e-12 * alone.compliance);
    for (std::size_t n = 0; n < alone.response.values().size(); ++n) // of a table it is drawn, and solved to 1e-2
        EXPECT_NEAR(both.patch.response.values()[n], alone.response.values()[n], 3e-3 * alone.compliance) << n;
    EXPECT_NEAR(std::exp(both.table->middle().lnContactStiffness) / alone.contactStiffness, 1, 0.02)
        << "over the footprint, where rigidity changes slowly";
    ASSERT_EQ(both.patch.pointResponse.size(), alone.pointResponse.size());
    EXPECT_EQ(both.table->chart.origin, alone.chart.origin);
    EXPECT_EQ(both.table->sequence, 0u) << "the caller's";
}

TEST(DeformWithTable, WhatIsNoSurfaceHasNoTable)
{
    std::vector<glm::dvec3> line;
    for (int n = 0; n < 100; ++n) line.push_back({n * 1e-4, 0, 0});
    const SoftObject wire(PointCloud(line, std::vector<double>(100, 1e6), StiffnessKind::modulus));
    PlateSolver      solver("host");
    const auto       lattice = footprintLattice(wire, kSkin, 1, solver);
    EXPECT_FALSE(deformWithTable(wire, {{5e-3, 0, 0}, {0, 0, 1}, true}, kSkin, lattice, solver).table);
}

/// All of it: random points, sphere fits, charts carried along a path, tables ahead of the hand, the servo's hand-over.
TEST(DeformWithTable, AHandThatSlidesOverAHomogeneousEllipsoidFeelsNothing)
{
    constexpr double     kSpeed = 0.2, kPeriod = 1.0 / 60, kTick = 1e-3;
    const SoftObject     object = homogeneous("ellipsoid", 3);
    PlateSolver          solver("host");
    const PatchSettings  settings = kSkin;
    std::optional<Frame> carried;
    const auto           lattice =
        footprintLattice(object, settings, tableSide(ComplianceLaw::table, kPeriod, settings.footprintRadius), solver);
    const auto onSurface = [](double x) {
        return glm::dvec3(x, 3e-3, 35e-3 * std::sqrt(1 - std::pow(x / 60e-3, 2) - std::pow(3.0 / 45, 2)));
    };

    ComplianceTracker              handOver;
    PublishedTables                places;
    RecentMotion                   motion;
    std::optional<ComplianceTable> coming, published;
    std::uint64_t                  sequence = 0;
    for (int n = -10; n < 0; ++n) motion.add(n * kTick, onSurface(-20e-3 + kSpeed * n * kTick)); // already moving
    std::vector<double> stiffness; // ln of what the hand feels, per tick
    for (int n = 0; n < 200; ++n) {
        const double     time = n * kTick;
        const glm::dvec3 hand = onSurface(-20e-3 + kSpeed * time);
        motion.add(time, hand);
        if (time >= double(sequence) * kPeriod) {
            published          = coming;
            const Contact next = {
                aheadOf(ComplianceLaw::table, hand, motion.velocity(), 1.5 * kPeriod), {0, 0, 1}, true};
            const auto both = deformWithTable(object, next, settings, lattice, solver, carried);
            ASSERT_TRUE(both.table.has_value());
            carried          = both.patch.chart.frame;
            coming           = both.table;
            coming->sequence = ++sequence;
            coming->time     = time;
        }
        const auto handed =
            handOver.tick({hand, time, kTick, published ? places.place(*published, handOver) : nullptr});
        EXPECT_FALSE(handed && handed->clamped) << time;
        if (handed)
            stiffness.push_back(
                std::log(feltStiffness(ForceLaw::series, handed->contactStiffness, handed->compliance)));
    }

    ASSERT_GT(stiffness.size(), 150u);
    double     worst  = 0; // range within 5 mm
    const auto window = std::size_t(5e-3 / (kSpeed * kTick));
    for (std::size_t n = 0; n + window <= stiffness.size(); ++n) {
        const auto [least, most] =
            std::minmax_element(stiffness.begin() + long(n), stiffness.begin() + long(n + window));
        worst = worse(worst, *most - *least);
    }
    EXPECT_LT(worst / 0.07, 1e-6) << "0.5 is what fingers allow, but nothing that sets the force comes from the points";
}

/// 10 l, or 12 l where rigidity varies by more than 10.
TEST(Warnings, AskForTheWindowThatTheFoundationNeeds)
{
    const auto warnedAt = [](const SoftObject& object, double lengths, double mean) {
        PatchSettings settings = kSkin;
        settings.foundation    = mean / std::pow(settings.window / lengths, 4);
        PlateSolver   solver("host");
        const Contact contact = touchAt(object, {0, 0, 0}, glm::dvec3(0, 0, 1), 10e-3);
        const Patch   patch   = deform(object, contact, settings, solver);
        const auto    all     = warnings(patch, settings, 0.01, object.material());
        return std::any_of(all.begin(), all.end(),
                           [](const std::string& s) { return s.find("its edges are felt") != std::string::npos; });
    };
    const SoftObject even = homogeneous("sheet", 4);
    const double     mean = even.material().rigidity(1e6);
    EXPECT_TRUE(warnedAt(even, 9.9, mean));
    EXPECT_FALSE(warnedAt(even, 10.1, mean));

    // From 0.1 to 10 MPa across the window: a contrast of 100 whose geometric mean is 1 MPa.
    std::vector<double> moduli;
    for (const glm::dvec3& p : even.positions())
        moduli.push_back(1e6 * std::pow(10, std::clamp(p.x / 20e-3, -1.0, 1.0)));
    const SoftObject varied = even.repainted(moduli);
    EXPECT_TRUE(warnedAt(varied, 11.5, mean));
    EXPECT_FALSE(warnedAt(varied, 12.5, mean));
}

TEST(ComplianceTable, SaysHowTheForceStiffensUnderEachFootprint)
{
    const SoftObject    even = homogeneous("sheet", 5);
    std::vector<double> b(even.size()); // [1/m] 280 to 520 in a table
    for (std::size_t n = 0; n < b.size(); ++n) b[n] = std::max(0.0, 400 + 2e4 * even.positions()[n].x);
    const SoftObject       object = even.withStiffening(b);
    PlateSolver            solver("host");
    const FootprintLattice lattice = footprintLattice(even, kSkin, 5, solver);
    const Contact          contact{glm::dvec3(0), {0, 0, 1}};

    const auto plain = deformWithTable(even, contact, kSkin, lattice, solver),
               soft  = deformWithTable(object, contact, kSkin, lattice, solver);
    ASSERT_TRUE(plain.table && soft.table);
    EXPECT_FALSE(plain.table->stiffens || plain.table->at({0, 0}).stiffening);
    EXPECT_EQ(soft.table->compliance[0].value, plain.table->compliance[0].value) << "the plate is the same";
    const Frame& axes = soft.patch.chart.frame;
    for (const double x : {-5e-3, -1e-3, 0.0, 2.3e-3, 6e-3}) {
        const ChartPoint place{x * axes.east.x, x * axes.north.x}; // along the world's x
        ASSERT_TRUE(soft.table->at(place).stiffening);
        EXPECT_NEAR(*soft.table->at(place).stiffening, 400 + 2e4 * x, 4) << "a percent, as the points lie by chance";
    }
    EXPECT_NEAR(soft.patch.stiffening, 400, 4);
    EXPECT_EQ(plain.patch.stiffening, 0);

    for (double& each : b) each = 250;
    EXPECT_NEAR(deform(even.withStiffening(b), contact, kSkin, solver).stiffening, 250, 1e-6);
    Material firm   = even.material();
    firm.stiffening = 250;
    EXPECT_EQ(deform(even.withMaterial(firm), contact, kSkin, solver).stiffening, 250);
}

} // namespace
} // namespace palp
