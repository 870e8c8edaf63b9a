#include <Eigen/Cholesky>
#include <Eigen/Core>

#include "tests/plate/kernels/plate_shader_test.h"

// Tests of the coarsest level's direct solve: coarse_assemble.comp, coarse_factor.comp and coarse_solve.comp.

namespace palp {
namespace {

/// Bands and answers where a processor may fuse: the tests against Eigen say whether they are right.
constexpr Rounding kFactorRounding{1e4,
                                   "rounding grows in up to 289 steps of elimination by the condition of the matrix"};

class CoarseLevelTest : public PlateShaderTest {
protected:
    /// Up to kMostCoarseCells along a side, shorter along x, along z, and square.
    static std::vector<Plate> coarsePlates()
    {
        using enum Edge;
        std::vector<Plate> all{roughPlate(9, 12, {clamped, clamped, clamped, clamped}),
                               onRoughBed(roughPlate(13, 7, {supported, free, clamped, supported}, 1, 1.3))};
        if (isSlow()) return all;
        all.push_back(roughPlate(16, 16, {clamped, clamped, supported, clamped}));
        all.push_back(onRoughBed(roughPlate(4, 5, {free, clamped, free, free})));
        return all;
    }

    template <class Real>
    static std::vector<Real> factorBy(const compute::Kernel& factor, const shared::PlateLevel& g,
                                      const std::vector<Real>& band)
    {
        std::vector<Real>          measured(band.size());
        std::vector<std::uint32_t> lost(1);
        dispatchTwice(factor, {in(band), out(measured), out(lost)}, shared::LevelPush{g}, {1, 1, 1});
        const double doubtfulShare =
            sizeof(Real) == sizeof(double) ? shared::kLeastPivotDouble : shared::kDoubtfulPivot;
        std::uint32_t doubtful = 0;
        for (std::size_t n = 0; n < measured.size(); n += std::size_t(shared::halfBand(g) + 1))
            doubtful +=
                !(double(measured[n]) * double(measured[n]) * doubtfulShare * double(band[n]) < 1) || measured[n] == 0;
        EXPECT_EQ(lost[0], doubtful) << "every pivot that was lost, or is next to nothing, is counted";
        return measured;
    }

    template <class Real>
    static std::vector<float> solveBy(const compute::Kernel& solve, const shared::PlateLevel& g,
                                      const std::vector<Real>& factor, const std::vector<float>& force)
    {
        std::vector<float> w(force.size());
        dispatchTwice(solve, {in(factor), in(force), out(w)}, shared::LevelPush{g},
                      {1, 1, std::uint32_t(force.size() / nodesOf(g))});
        return w;
    }

    /// The matrix by nodes, in doubles, from the operator's answers to unit deflections; the identity on held nodes.
    static Eigen::MatrixXd denseMatrix(const RoughLevel& level)
    {
        const int           nodes = int(nodesOf(level.g));
        Eigen::MatrixXd     A     = Eigen::MatrixXd::Identity(nodes, nodes);
        std::vector<double> unit(static_cast<std::size_t>(nodes));
        host::forEachNode(level.g, 1, [&](int i, int j, std::size_t n, std::size_t) {
            if (holds(level.g, i, j)) return;
            unit[n]                = 1;
            const auto column      = host::applied(level.g, level.rigidity, unit);
            A.col(Eigen::Index(n)) = Eigen::Map<const Eigen::VectorXd>(column.data(), nodes);
            unit[n]                = 0;
        });
        return A;
    }

    template <class Real>
    static std::vector<double> sizesOf(const std::vector<Real>& values)
    {
        const auto all = magnitudes(values);
        return std::vector<double>(values.size(), *std::max_element(all.begin(), all.end()));
    }
};

TEST_F(CoarseLevelTest, TheBandIsThatOfCxx)
{
    inEachPrecision([](auto real) {
        using Real = decltype(real);
        for (const compute::Workgroup shape : tiles()) {
            const compute::Kernel assemble(context(), kernels::assemble<Real>(), shape);
            for (const Plate& plate : coarsePlates()) {
                SCOPED_TRACE(describe(plate) + " by " + describe(shape));
                const RoughLevel        level(plate);
                const std::vector<Real> expected = host::assembled<Real>(level.g, level.rigidity);
                std::vector<Real>       band(expected.size());

                dispatchTwice(
                    assemble, {in(level.rigidity), out(band)}, shared::LevelPush{level.g},
                    assemble.groupsOver(std::uint32_t(shared::halfBand(level.g) + 1), std::uint32_t(nodesOf(level.g))));

                EXPECT_TRUE(agree(band, expected, sizesOf(expected), kOperatorRounding));
            }
        }
    });
}

TEST_F(CoarseLevelTest, TheBandHoldsTheWholeMatrix)
{
    for (const Plate& plate : coarsePlates()) {
        const RoughLevel          level(plate);
        const shared::PlateLevel& g    = level.g;
        const Eigen::MatrixXd     A    = denseMatrix(level);
        const std::vector<double> band = host::assembled<double>(g, level.rigidity);
        Eigen::MatrixXd           B    = Eigen::MatrixXd::Zero(A.rows(), A.cols());

        const int  slots = shared::halfBand(g) + 1, unknowns = int(nodesOf(g));
        const auto nodeOf = [&](int n) { return shared::columnOf(g, n) * (g.cellsZ + 1) + shared::rowOf(g, n); };
        for (int n = 0; n < unknowns; ++n)
            for (int d = 0; d < slots && n + d < unknowns; ++d)
                B(nodeOf(n), nodeOf(n + d)) = B(nodeOf(n + d), nodeOf(n)) = band[std::size_t(n * slots + d)];

        EXPECT_LT((A - B).cwiseAbs().maxCoeff(), 1e-14 * A.cwiseAbs().maxCoeff())
            << describe(plate) << ": the same sums, of the same or of scattered unit deflections";
    }
}

TEST_F(CoarseLevelTest, FactorAndAnswerAreThoseOfCxx)
{
    inEachPrecision([](auto real) {
        using Real = decltype(real);
        for (const compute::Workgroup shape : lines()) {
            const compute::Kernel factor(context(), kernels::factor<Real>(), shape),
                solve(context(), kernels::coarseSolve<Real>(), shape);
            for (const Plate& plate : coarsePlates()) {
                SCOPED_TRACE(describe(plate) + " by " + describe(shape));
                const RoughLevel         level(plate);
                const std::vector<Real>  band     = host::assembled<Real>(level.g, level.rigidity);
                const std::vector<Real>  expected = host::factored(level.g, band);
                const std::vector<float> force    = roughValues<float>(kLoads * nodesOf(level.g), 31); // held ones too

                const std::vector<Real>  L = factorBy(factor, level.g, band);
                const std::vector<float> w = solveBy(solve, level.g, expected, force);

                const std::vector<float> wExpected = host::coarseSolved(level.g, expected, force);
                EXPECT_TRUE(agree(L, expected, sizesOf(expected), kFactorRounding));
                EXPECT_TRUE(agree(w, wExpected, sizesOf(wExpected), kFactorRounding));
            }
        }
    });
}

// In floats a direct solve of condition 1e5 .. 1e8 keeps few digits of the smoothest deflections, but leaves little
// force unbalanced, and that is what a cycle needs of it. Energies weigh errors as the cycle does.
TEST_F(CoarseLevelTest, TheAnswerIsThatOfADenseCholeskyInDoubles)
{
    inEachPrecision([](auto real) {
        using Real = decltype(real);
        const compute::Kernel factor(context(), kernels::factor<Real>(), {64, 1, 1}),
            solve(context(), kernels::coarseSolve<Real>(), {64, 1, 1});
        for (const Plate& plate : coarsePlates()) {
            SCOPED_TRACE(describe(plate));
            const RoughLevel          level(plate);
            const shared::PlateLevel& g     = level.g;
            const Eigen::MatrixXd     A     = denseMatrix(level);
            std::vector<float>        force = roughValues<float>(nodesOf(g), 32);
            host::forEachNode(g, 1, [&](int i, int j, std::size_t n, std::size_t) {
                if (holds(g, i, j)) force[n] = 0;
            });

            const auto w = solveBy(solve, g, factorBy(factor, g, host::assembled<Real>(g, level.rigidity)), force);

            const Eigen::VectorXd f     = Eigen::Map<const Eigen::VectorXf>(force.data(), A.rows()).cast<double>();
            const Eigen::VectorXd exact = A.llt().solve(f);
            const Eigen::VectorXd error = Eigen::Map<const Eigen::VectorXf>(w.data(), A.rows()).cast<double>() - exact;
            const double          relative = std::sqrt(error.dot(A * error) / exact.dot(A * exact));
            // Floats: largest measured 1.2e-3, where three sides are free, and a cycle leaves some 0.1. Doubles: only
            // the answer is rounded to floats, whose 6e-8 the stiff block's energy enlarges.
            EXPECT_LT(relative, sizeof(Real) == sizeof(double) ? 1e-4 : 5e-3);
        }
    });
}

TEST_F(CoarseLevelTest, TheInverseIsTheAnswersToUnitForcesWithAllDigits)
{
    if (onHost()) GTEST_SKIP() << "the host has no such kernel";
    inEachPrecision([](auto real) {
        using Real = decltype(real);
        for (const compute::Workgroup shape : lines()) {
            const compute::Kernel invert(context(), kernels::coarseInvert<Real>(), shape);
            for (const Plate& plate : coarsePlates()) {
                SCOPED_TRACE(describe(plate) + " by " + describe(shape));
                const RoughLevel        level(plate);
                const std::size_t       nodes = nodesOf(level.g);
                const std::vector<Real> factor =
                    host::factored(level.g, host::assembled<Real>(level.g, level.rigidity));
                std::vector<Real> inverse(nodes * nodes);
                dispatchTwice(invert, {in(factor), out(inverse)}, shared::LevelPush{level.g},
                              {1, 1, std::uint32_t(nodes)});

                std::vector<float> units(nodes * nodes, 0.0F);
                for (std::size_t n = 0; n < nodes; ++n) units[n * nodes + n] = 1;
                const std::vector<float> rounded(inverse.begin(), inverse.end());
                const auto               expected = host::coarseSolved(level.g, factor, units);
                EXPECT_TRUE(agree(rounded, expected, sizesOf(expected), kFactorRounding));
                if (sizeof(Real) == sizeof(float)) continue;
                // A unit of force is balanced by the whole numbers as by doubles; by their upper parts as by floats.
                const Eigen::MatrixXd A     = denseMatrix(level);
                double                whole = 0, upper = 0;
                for (std::size_t n = 0; n < nodes; n += 7) {
                    if (holds(level.g, int(n) / (level.g.cellsZ + 1), int(n) % (level.g.cellsZ + 1))) continue;
                    Eigen::VectorXd both(A.rows()), above(A.rows()),
                        unit = Eigen::VectorXd::Unit(A.rows(), Eigen::Index(n));
                    for (std::size_t m = 0; m < nodes; ++m) {
                        above[Eigen::Index(m)] = double(rounded[n * nodes + m]);
                        both[Eigen::Index(m)]  = double(inverse[n * nodes + m]);
                    }
                    whole = std::max(whole, (A * both - unit).cwiseAbs().maxCoeff());
                    upper = std::max(upper, (A * above - unit).cwiseAbs().maxCoeff());
                }
                EXPECT_LT(whole, 1e-4 * upper) << "2^-24 of it, and the rounding of doubles";
            }
        }
    });
}

/// A plate of which a stiff part hangs on soft ones, more loosely than floats can tell.
Plate loosePlate(Edge edge)
{
    Plate plate      = roughPlate(16, 16, {Edge::supported, Edge::supported, edge, edge});
    plate.foundation = 0;
    for (double& D : plate.rigidity.values()) D = D > 100 ? 1e9 : 1;
    return plate;
}

TEST_F(CoarseLevelTest, AFactorIsFiniteWhateverRoundingLeavesOfThePivots)
{
    const compute::Kernel factor(context(), kernels::factor<float>(), {64, 1, 1}),
        solve(context(), kernels::coarseSolve<float>(), {64, 1, 1});
    for (const Edge edge : {Edge::supported, Edge::free}) {
        const Plate              plate = loosePlate(edge);
        const RoughLevel         level(plate);
        const std::vector<float> band  = host::assembled<float>(level.g, level.rigidity);
        const std::vector<float> force = roughDeflection<float>(level.g, 1, 34);

        const std::vector<float> L = factorBy(factor, level.g, band), w = solveBy(solve, level.g, L, force);

        const auto isFinite = [](float value) { return std::isfinite(value); };
        EXPECT_TRUE(std::ranges::all_of(L, isFinite)) << describe(plate);
        EXPECT_TRUE(std::ranges::all_of(w, isFinite)) << describe(plate);
        bool   holdsSome = false;
        double work      = 0;
        for (std::size_t n = 0; n < w.size(); ++n) {
            holdsSome = holdsSome || L[n * std::size_t(shared::halfBand(level.g) + 1)] == 0;
            work += double(w[n]) * double(force[n]);
        }
        EXPECT_TRUE(holdsSome || !context().bitExact()) << "else this test shows nothing";
        EXPECT_GT(work, 0) << "conjugate gradients need a positive preconditioner";
    }
}

TEST_F(CoarseLevelTest, DoublesKeepThePivotsThatFloatsLose)
{
    if (!context().processor().float64) GTEST_SKIP() << "no doubles";
    const compute::Kernel factor(context(), kernels::factor<double>(), {64, 1, 1});
    for (const Edge edge : {Edge::supported, Edge::free}) {
        const RoughLevel level(loosePlate(edge));
        const auto       L = factorBy(factor, level.g, host::assembled<double>(level.g, level.rigidity));
        for (std::size_t n = 0; n < L.size(); n += std::size_t(shared::halfBand(level.g) + 1)) EXPECT_GT(L[n], 0);
    }
}

/// A free plate on ever softer ground: long before the pivot of its sinking is lost, rounding decides it.
TEST_F(CoarseLevelTest, APivotThatRoundingDecidesIsCountedInFloatsAlone)
{
    inEachPrecision([](auto real) {
        using Real = decltype(real);
        const compute::Kernel factor(context(), kernels::factor<Real>(), {64, 1, 1});
        for (const double foundation : {1e3, 1e2, 1e-2, 1e-4, 1e-6}) {
            Plate plate;
            plate.grid                   = {16, 16, 1.0 / 16, 1.0 / 16}; // [m]
            plate.edges                  = {Edge::free, Edge::free, Edge::free, Edge::free};
            plate.foundation             = foundation;
            plate.rigidity               = NodeField(plate.grid, 1);
            const shared::PlateLevel   g = gridHierarchy(plate, 1).levels.back().plate;
            const std::vector<float>   ones(nodesOf(g), 1.0F);
            const std::vector<Real>    band = host::assembled<Real>(g, ones);
            std::vector<Real>          L(band.size());
            std::vector<std::uint32_t> lost(1);
            dispatchTwice(factor, {in(band), out(L), out(lost)}, shared::LevelPush{g}, {1, 1, 1});
            if (sizeof(Real) == sizeof(double) || foundation >= 1) {
                EXPECT_EQ(lost[0], 0U) << foundation << " Pa/m";
            } else {
                EXPECT_GT(lost[0], 0U) << foundation << " Pa/m";
            }
        }
    });
}

TEST_F(CoarseLevelTest, RepeatsAreEqualToTheBit)
{
    inEachPrecision([](auto real) {
        using Real = decltype(real);
        const compute::Kernel factor(context(), kernels::factor<Real>(), {64, 1, 1}),
            solve(context(), kernels::coarseSolve<Real>(), {64, 1, 1});
        const RoughLevel         level(coarsePlates()[1]);
        const std::vector<Real>  band  = host::assembled<Real>(level.g, level.rigidity);
        const std::vector<float> force = roughValues<float>(kLoads * nodesOf(level.g), 33);

        const std::vector<Real>  L = factorBy(factor, level.g, band);
        const std::vector<float> w = solveBy(solve, level.g, L, force);
        for (int n = 0; n < 5; ++n) {
            EXPECT_EQ(L, factorBy(factor, level.g, band));
            EXPECT_EQ(w, solveBy(solve, level.g, L, force));
        }
    });
}

} // namespace
} // namespace palp
