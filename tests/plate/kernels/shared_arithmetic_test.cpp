#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include <gtest/gtest.h>

#include "engine/plate/reference/reference_plate_solver.h"
#include "tests/plate/kernels/host_passes.h"
#include "tests/support/errors.h"

// Tests of the arithmetic that shaders and C++ share, against the reference solver, which has no stencil, and against
// theory. No processor has to be opened.

namespace palp {
namespace {

constexpr std::array kEdges{Edge::clamped, Edge::supported, Edge::free, Edge::guided};

template <class Visit>
void forAllEdges(Visit&& visit)
{
    for (const Edge x0 : kEdges)
        for (const Edge x1 : kEdges)
            for (const Edge z0 : kEdges)
                for (const Edge z1 : kEdges) visit(PlateEdges{x0, x1, z0, z1});
}

double dot(const std::vector<double>& a, const std::vector<double>& b)
{
    return std::inner_product(a.begin(), a.end(), b.begin(), 0.0);
}

constexpr double kUnitRigidity = 1024; ///< [N m] a power of two

/// A plate of which every number that the shaders are given is exact in floats.
Plate exactPlate(int cellsX, int cellsZ, const PlateEdges& edges)
{
    Plate plate        = roughPlate(cellsX, cellsZ, edges, 1, 2);
    plate.poissonRatio = 0.25;
    plate.foundation   = 0.5;
    for (double& D : plate.rigidity.values()) D = std::ceil(64 * D) / 64; // at most 1500
    return plate;
}

/// Its finest level.
struct ExactLevel {
    shared::PlateLevel g;
    std::vector<float> rigidity;
    double             stiffness; ///< [N/m]

    explicit ExactLevel(const Plate& plate)
    {
        const GridHierarchy grids = gridHierarchy(plate, kUnitRigidity);
        g                         = grids.levels.front().plate;
        stiffness                 = grids.stiffness;
        for (const double D : plate.rigidity.values()) rigidity.push_back(float(D / kUnitRigidity));
        for (const double s : plate.foundationShape.values()) rigidity.push_back(float(s));
    }
};

TEST(SharedOperatorTest, GivesTheLoadBackThatTheReferenceSolverWasGivenWhateverTheEdges)
{
    int solved = 0;
    enum class Bed { none, even, rough };
    for (const Bed bed : {Bed::even, Bed::rough, Bed::none})
        forAllEdges([&](const PlateEdges& edges) {
            Plate plate = exactPlate(7, 6, edges);
            if (bed == Bed::none) plate.foundation = 0;
            if (bed == Bed::rough) {
                plate = onRoughBed(plate);
                for (double& s : plate.foundationShape.values()) s = std::ceil(16 * s) / 16; // exact in floats
            }
            if (whyUnsolvable(plate)) return; // edges that leave it free to move
            const ExactLevel level(plate);
            NodeField        load(plate.grid);
            load.values() = roughDeflection<double>(level.g, 1, 71); // none on held nodes

            const NodeField     w = ReferencePlateSolver(plate).solve(load).deflection;
            std::vector<double> scaled;
            for (const double value : w.values()) scaled.push_back(value * level.stiffness);
            const std::vector<double> forces = host::applied(level.g, level.rigidity, scaled);

            ++solved;
            for (std::size_t n = 0; n < forces.size(); ++n)
                ASSERT_NEAR(forces[n], load.values()[n], 1e-9)
                    << describe(plate) << ", node " << n << ": the reference solver's rounding";
        });
    EXPECT_GE(solved, 2 * 256 + 60);
}

TEST(SharedOperatorTest, GivesTheLoadBackAlsoWhereFloatsRoundTheCoefficients)
{
    forAllEdges([&](const PlateEdges& edges) {
        Plate        plate = roughPlate(9, 6, edges, 0.013, 0.017);
        const double most  = *std::max_element(plate.rigidity.values().begin(), plate.rigidity.values().end());
        plate.foundation   = 1e-3 * most / std::pow(0.013 * 0.017, 2);
        const RoughLevel level(plate);
        NodeField        load(plate.grid);
        load.values() = roughDeflection<double>(level.g, 1, 72);

        const NodeField     w = ReferencePlateSolver(plate).solve(load).deflection;
        std::vector<double> scaled;
        for (const double value : w.values()) scaled.push_back(value * gridHierarchy(plate, most).stiffness);
        const std::vector<double> forces = host::applied(level.g, level.rigidity, scaled);

        for (std::size_t n = 0; n < forces.size(); ++n)
            ASSERT_NEAR(forces[n], load.values()[n], 5e-6 * largest(load.values()))
                << describe(plate) << ", node " << n
                << ": coefficients are good to 6e-8, and moments over some ten cells are some ten times the load";
    });
}

TEST(SharedOperatorTest, IsSymmetricAndPositive)
{
    forAllEdges([](const PlateEdges& edges) {
        const Plate               plate = exactPlate(5, 8, edges);
        const ExactLevel          level(plate);
        const std::vector<double> u = roughDeflection<double>(level.g, 1, 73),
                                  v = roughDeflection<double>(level.g, 1, 74);

        const std::vector<double> Au = host::applied(level.g, level.rigidity, u);
        const std::vector<double> Av = host::applied(level.g, level.rigidity, v);

        const double size = largest(Au) * double(u.size());
        EXPECT_NEAR(dot(v, Au), dot(u, Av), 1e-14 * size) << describe(plate) << ": rounding of doubles";
        EXPECT_GT(dot(u, Au), 0) << describe(plate);
        EXPECT_GT(dot(v, Av), 0) << describe(plate);
    });
}

TEST(SharedOperatorTest, DoesNotSeeRigidMotionsOfAFreePlateWithoutFoundation)
{
    using enum Edge;
    Plate plate      = exactPlate(9, 7, {free, free, free, free});
    plate.foundation = 0;
    const ExactLevel    level(plate);
    std::vector<double> w(nodesOf(level.g));
    host::forEachNode(level.g, 1, [&](int i, int j, std::size_t n, std::size_t) { w[n] = 3 + 2 * i - 5 * j; });

    EXPECT_EQ(largest(host::applied(level.g, level.rigidity, w)), 0) << "small whole numbers are exact";
}

// --- relaxation

TEST(SharedRelaxationTest, TheDivisorIsAtLeastTheBoundOfAConvergentSplitting)
{
    forAllEdges([](const PlateEdges& edges) {
        Plate      plate  = exactPlate(5, 6, edges);
        const auto values = roughValues<double>(plate.grid.nodes(), 75);
        for (std::size_t n = 0; n < values.size(); ++n)
            plate.rigidity.values()[n] = std::pow(1000, (values[n] + 1) / 2);
        const ExactLevel         level(plate);
        const std::size_t        nodes   = nodesOf(level.g);
        const int                nodesZ  = level.g.cellsZ + 1;
        const std::vector<float> inverse = host::inverseDivisor(level.g, level.rigidity);

        // The matrix by brute force: answers to unit deflections of every node that moves.
        std::vector<double> diagonal(nodes), sameColour(nodes);
        host::forEachNode(level.g, 1, [&](int i, int j, std::size_t n, std::size_t) {
            if (holds(level.g, i, j)) return;
            std::vector<double> unit(nodes);
            unit[n]           = 1;
            const auto column = host::applied(level.g, level.rigidity, unit);
            for (std::size_t m = 0; m < nodes; ++m) {
                const int apart = int(m) / nodesZ - i + int(m) % nodesZ - j;
                if (m == n) diagonal[m] = column[m];
                if (m != n && apart % 2 == 0) sameColour[m] += std::abs(column[m]);
            }
        });

        host::forEachNode(level.g, 1, [&](int i, int j, std::size_t n, std::size_t) {
            if (holds(level.g, i, j)) {
                EXPECT_EQ(inverse[n], 0.0F);
                return;
            }
            const double divisor = 1 / double(inverse[n]);
            EXPECT_GE(divisor, (diagonal[n] + sameColour[n]) / 2) << describe(plate) << ", node " << i << ", " << j;
            const double stated = std::max(diagonal[n] / 1.1, 0.51 * (diagonal[n] + sameColour[n]));
            EXPECT_NEAR(divisor, stated, 1e-5 * stated) << "no smaller steps than stated; computed in floats";
        });
    });
}

TEST(SharedRelaxationTest, EveryHalfSweepLowersTheEnergy)
{
    forAllEdges([](const PlateEdges& edges) {
        const Plate      plate = roughPlate(6, 7, edges);
        const RoughLevel level(plate);
        host::HalfSweep  fields;
        fields.inverseDivisor = host::inverseDivisor(level.g, level.rigidity);
        fields.after          = roughDeflection<float>(level.g, 1, 76);
        fields.force          = std::vector<float>(fields.after.size());
        const auto energy     = [&] {
            const std::vector<double> w(fields.after.begin(), fields.after.end());
            return dot(w, host::applied(level.g, level.rigidity, w));
        };

        double before = energy();
        for (int n = 0; n < 10; ++n) {
            fields.same = fields.other = fields.after;
            fields.after               = host::relaxed(level, fields, unsigned(n % 2));
            const double now           = energy();
            EXPECT_LT(now, before) << describe(plate) << ", half sweep " << n;
            before = now;
        }
    });
}

// Chebyshev's iteration lives on it: beyond the largest eigenvalue that it expects it diverges.
TEST(SharedRelaxationTest, NoEigenvalueRelativeToTheDivisorIsLargerThanTwiceThatOfAColour)
{
    double most = 0;
    forAllEdges([&](const PlateEdges& edges) {
        for (const double contrast : {1.0, 10.0, 1e4}) {
            Plate      plate  = exactPlate(7, 6, edges);
            const auto values = roughValues<double>(plate.grid.nodes(), 79);
            for (std::size_t n = 0; n < values.size(); ++n)
                plate.rigidity.values()[n] = std::pow(contrast, (values[n] + 1) / 2);
            const ExactLevel         level(plate);
            const std::vector<float> inverse = host::inverseDivisor(level.g, level.rigidity);
            std::vector<double>      v       = roughDeflection<double>(level.g, 1, 80);
            double                   found   = 0;
            for (int n = 0; n < 300; ++n) { // the largest eigenvalue by powers, from below
                v           = host::applied(level.g, level.rigidity, v);
                double size = 0;
                for (std::size_t m = 0; m < v.size(); ++m) size = worse(size, v[m] *= double(inverse[m]));
                for (double& value : v) value /= size;
                found = size;
            }
            EXPECT_LE(found, 2 / 0.51 * 1.00001)
                << describe(plate) << ", contrast " << contrast << "; divisors are floats";
            most = std::max(most, found);
        }
    });
    EXPECT_GT(most, 3.2) << "the bound is not idle: 64/(20/1.1) = 3.5 for a large plate of one rigidity";
}

// --- transfers

struct Sizes {
    int fine, coarse; ///< cells
};
constexpr std::array<Sizes, 12> kSizes{
    {{6, 3}, {7, 4}, {8, 4}, {9, 5}, {10, 5}, {13, 7}, {17, 9}, {17, 17}, {33, 17}, {12, 7}, {20, 13}, {5, 3}}};

/// A table as rows of fine nodes and as rows of coarse ones.
struct Matrices {
    std::vector<std::vector<float>> byFine, byCoarse; ///< [fine][coarse] both

    Matrices(Sizes sizes, Edge first, Edge last)
        : byFine(std::size_t(sizes.fine) + 1, std::vector<float>(std::size_t(sizes.coarse) + 1)), byCoarse(byFine)
    {
        using namespace shared;
        const std::vector<float> table = transferTable(sizes.fine, sizes.coarse, first, last);
        for (int i = 0; i <= sizes.fine; ++i)
            for (int m = 0; m < kFineWeights; ++m) {
                const float* row = table.data() + i * kFineStride;
                byFine[std::size_t(i)].at(std::size_t(int(row[0]) + m)) += row[1 + m];
            }
        for (int I = 0; I <= sizes.coarse; ++I)
            for (int m = 0; m < kCoarseWeights; ++m) {
                const float* row = table.data() + (sizes.fine + 1) * kFineStride + I * kCoarseStride;
                if (row[1 + m] != 0) byCoarse.at(std::size_t(int(row[0]) + m))[std::size_t(I)] += row[1 + m];
            }
    }
};

TEST(SharedTransferTest, RestrictionIsExactlyTheTransposeOfProlongation)
{
    for (const Sizes sizes : kSizes)
        for (const Edge first : kEdges)
            for (const Edge last : kEdges) {
                const Matrices matrices(sizes, first, last);
                EXPECT_EQ(matrices.byFine, matrices.byCoarse)
                    << sizes.fine << " to " << sizes.coarse << ", " << name(first) << ", " << name(last);
            }
}

TEST(SharedTransferTest, ForcesDoTheSameWorkOnBothGrids)
{
    forAllEdges([](const PlateEdges& edges) {
        const LevelPair           pair(roughPlate(13, 10, edges), 7, 6);
        const std::vector<float>  force  = roughValues<float>(nodesOf(pair.fine), 77);
        const std::vector<double> coarse = roughDeflection<double>(pair.coarse, 1, 78);

        const std::vector<float>  gathered = host::restricted(pair, force);
        const std::vector<double> fine     = host::interpolated(pair, coarse);

        EXPECT_NEAR(dot(fine, std::vector<double>(force.begin(), force.end())),
                    dot(coarse, std::vector<double>(gathered.begin(), gathered.end())), 1e-5)
            << "some 40 sums of floats of order 1";
    });
}

/// Largest error of the interpolation of a function of the distance from the first side [coarse cells], from places
/// `from` to `to` in fine cells.
template <class Function>
double interpolationError(Sizes sizes, Edge first, Edge last, int from, int to, const Function& function)
{
    const Matrices matrices(sizes, first, last);
    double         most = 0, size = 0;
    for (int I = 0; I <= sizes.coarse; ++I) size = std::max(size, std::abs(function(I)));
    for (int i = from; i <= to; ++i) {
        double sum = 0;
        for (int I = 0; I <= sizes.coarse; ++I)
            sum += double(matrices.byFine[std::size_t(i)][std::size_t(I)]) * function(I);
        most = worse(most, sum - function(double(i) * sizes.coarse / sizes.fine));
    }
    return most / size;
}

constexpr double kWeightRounding = 3e-7; ///< weights are floats

TEST(SharedTransferTest, CubicsAreReproducedInside)
{
    for (const Sizes sizes : kSizes)
        for (const Edge edge : kEdges) {
            const int  margin = (2 * sizes.fine + sizes.coarse - 1) / sizes.coarse; // held nodes are out of reach
            const auto cubic  = [&](double x) { return 1 + x * (2 - x * (0.7 - 0.1 * x)); };
            EXPECT_LT(interpolationError(sizes, edge, edge, margin, sizes.fine - margin, cubic), kWeightRounding)
                << sizes.fine << " to " << sizes.coarse << ", " << name(edge);
        }
}

// What each side makes of the node beyond it is exact for these functions, which obey its conditions: no deflection and
// slope; no deflection and curvature; no curvature.
TEST(SharedTransferTest, SidesKeepTheirConditions)
{
    for (const Sizes sizes : kSizes)
        for (const Edge other : kEdges) {
            const double length = sizes.coarse;
            const int    middle = sizes.fine / 2;
            const auto   square = [](double x) { return x * x; };
            const auto   cube   = [](double x) { return x * x * x; };
            const auto   line   = [](double x) { return x; };
            const auto   one    = [](double) { return 1.0; };
            const auto   fits   = [&](Edge edge, const auto& function) {
                const auto fromLast = [&](double x) { return function(length - x); };
                // up to the middle: on small grids the other side reaches no further
                EXPECT_LT(interpolationError(sizes, edge, other, 0, middle - 1, function), kWeightRounding)
                    << name(edge) << ", first side, " << sizes.fine << " to " << sizes.coarse;
                EXPECT_LT(interpolationError(sizes, other, edge, sizes.fine - middle + 1, sizes.fine, fromLast),
                              kWeightRounding)
                    << name(edge) << ", last side, " << sizes.fine << " to " << sizes.coarse;
            };
            if (sizes.coarse < 5) continue; // the other side is too near
            fits(Edge::clamped, square);
            fits(Edge::clamped, cube);
            fits(Edge::supported, line);
            fits(Edge::supported, cube);
            fits(Edge::free, one);
            fits(Edge::free, line);
            fits(Edge::guided, one);
            fits(Edge::guided, square);
        }
}

TEST(SharedTransferTest, EqualGridsAreLeftAsTheyAre)
{
    for (const Edge first : kEdges)
        for (const Edge last : kEdges) {
            const Matrices matrices({17, 17}, first, last);
            for (std::size_t i = 0; i <= 17; ++i)
                for (std::size_t I = 0; I <= 17; ++I) {
                    const bool held = (i == 0 && holdsNodes(first)) || (i == 17 && holdsNodes(last));
                    EXPECT_EQ(matrices.byFine[i][I], i == I && !held ? 1.0F : 0.0F);
                }
        }
}

TEST(SharedTransferTest, AConstantRigidityStaysAsItIs)
{
    for (const float constant : {1.0F, 0.3F, 0.7F, 123.456F, 1e-15F, 9.9e14F})
        for (const auto& [x, z] : {std::array{7, 5}, {7, 10}, {13, 5}, {9, 7}}) {
            const LevelPair          pair(roughPlate(13, 10, {}), x, z);
            const std::vector<float> rigidity(nodesOf(pair.fine), constant);

            EXPECT_EQ(host::coarsened(pair, rigidity), std::vector<float>(nodesOf(pair.coarse), constant));
        }
}

TEST(CoarseBandTest, TheInverseRootHasAllDigitsOfADouble)
{
    double most = 0;
    for (double x = 1e-300; x < 1e300; x *= 1.0137) {
        const double exact = double(1 / std::sqrt(static_cast<long double>(x)));
        most               = worse(most, shared::inverseRoot(x) / exact - 1);
    }
    EXPECT_LE(most, std::ldexp(1, -51)) << "two units: of the last sum and product, and of the quotient here";
    EXPECT_EQ(shared::inverseRoot(4.0), 0.5);
}

TEST(SharedTransferTest, ACoarsenedShapeOfTheFoundationIsAWeightedMean)
{
    for (const auto& [cellsX, cellsZ] : {std::pair(6, 5), std::pair(12, 5), std::pair(6, 10)}) {
        const LevelPair wide(roughPlate(12, 10, {}), cellsX, cellsZ);
        LevelPair       pair     = wide;
        pair.fine.shapeAt        = int(nodesOf(pair.fine));
        pair.coarse.shapeAt      = int(nodesOf(pair.coarse));
        const auto         shape = [](double i, double j) { return 1 + 0.1 * i * i - 0.03 * j * j + 0.02 * i * j; };
        std::vector<float> field(2 * nodesOf(pair.fine), 1.0F);
        host::forEachNode(pair.fine, 1, [&](int i, int j, std::size_t n, std::size_t) {
            field[nodesOf(pair.fine) + n] = float(shape(i, j));
        });

        const std::vector<float> coarse = host::coarsened(pair, field);

        const int    stepX = 12 / cellsX, stepZ = 10 / cellsZ;
        const double bent = (stepX == 2 ? 0.05 : 0) - (stepZ == 2 ? 0.015 : 0); // a quarter of the second differences
        host::forEachNode(
            pair.coarse, 1, [&, cellsX = cellsX, cellsZ = cellsZ](int i, int j, std::size_t n, std::size_t) {
                if (i == 0 || j == 0 || i == cellsX || j == cellsZ) return; // mirrored there
                EXPECT_NEAR(double(coarse[nodesOf(pair.coarse) + n]), shape(stepX * i, stepZ * j) + bent, 2e-6)
                    << i << ", " << j << "; floats of about 10 round";
            });
    }
}

TEST(SharedTransferTest, CoarsenedRigidityIsAGeometricMean)
{
    const LevelPair    pair(roughPlate(12, 10, {}), 6, 5); // every coarse node lies on a fine one
    std::vector<float> rigidity(nodesOf(pair.fine));
    host::forEachNode(pair.fine, 1, [&](int i, int j, std::size_t n, std::size_t) {
        rigidity[n] = float(std::exp(0.2 * i - 0.3 * j));
    });

    const std::vector<float> coarse = host::coarsened(pair, rigidity);

    host::forEachNode(pair.coarse, 1, [&](int i, int j, std::size_t n, std::size_t) {
        if (i == 0 || j == 0 || i == 6 || j == 5) return; // mirrored there
        const double expected = std::exp(0.4 * i - 0.6 * j);
        EXPECT_NEAR(double(coarse[n]), expected, 1e-6 * expected) << "exponentials stay what they are; floats round";
    });
}

} // namespace
} // namespace palp
