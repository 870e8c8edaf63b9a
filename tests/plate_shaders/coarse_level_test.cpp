#include <Eigen/Cholesky>
#include <Eigen/Core>

#include "tests/plate_shaders/plate_shader_test.h"

// The coarsest level's direct solve: coarse_assemble.comp, coarse_factor.comp and coarse_solve.comp.

namespace palp {
namespace {

/// Bands and answers where a device may fuse: the tests against Eigen say whether they are right.
constexpr Rounding kFactorRounding{1e4,
                                   "rounding grows in up to 289 steps of elimination by the condition of the matrix"};

class CoarseLevelTest : public PlateShaderTest {
protected:
    /// Up to kMostCoarseCells along a side, shorter along x, along z, and square.
    static std::vector<Plate> coarsePlates()
    {
        using enum Edge;
        std::vector<Plate> all{roughPlate(9, 12, {clamped, clamped, clamped, clamped}),
                               roughPlate(13, 7, {supported, free, clamped, supported}, 1, 1.3)};
        if (isSlow()) return all;
        all.push_back(roughPlate(16, 16, {clamped, clamped, supported, clamped}));
        all.push_back(roughPlate(4, 5, {free, clamped, free, free}));
        return all;
    }

    static std::vector<float> factorBy(const gpu::Kernel& factor, const shared::PlateLevel& g,
                                       const std::vector<float>& band)
    {
        std::vector<float> measured(band.size());
        dispatchTwice(factor, {in(band), out(measured)}, shared::LevelPush{g}, {1, 1, 1});
        return measured;
    }

    static std::vector<float> solveBy(const gpu::Kernel& solve, const shared::PlateLevel& g,
                                      const std::vector<float>& factor, const std::vector<float>& force)
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

    static std::vector<double> sizesOf(const std::vector<float>& values)
    {
        const auto all = magnitudes(values);
        return std::vector<double>(values.size(), *std::max_element(all.begin(), all.end()));
    }
};

TEST_F(CoarseLevelTest, TheBandIsThatOfCxx)
{
    for (const gpu::Workgroup shape : tiles()) {
        const gpu::Kernel assemble(context(), kernels::assemble(), shape);
        for (const Plate& plate : coarsePlates()) {
            SCOPED_TRACE(describe(plate) + " by " + describe(shape));
            const RoughLevel         level(plate);
            const std::vector<float> expected = host::assembled(level.g, level.rigidity);
            std::vector<float>       band(expected.size());

            dispatchTwice(
                assemble, {in(level.rigidity), out(band)}, shared::LevelPush{level.g},
                assemble.groupsOver(std::uint32_t(shared::halfBand(level.g) + 1), std::uint32_t(nodesOf(level.g))));

            EXPECT_TRUE(agree(band, expected, sizesOf(expected), kOperatorRounding));
        }
    }
}

TEST_F(CoarseLevelTest, TheBandHoldsTheWholeMatrix)
{
    for (const Plate& plate : coarsePlates()) {
        const RoughLevel          level(plate);
        const shared::PlateLevel& g    = level.g;
        const Eigen::MatrixXd     A    = denseMatrix(level);
        const std::vector<float>  band = host::assembled(g, level.rigidity);
        Eigen::MatrixXd           B    = Eigen::MatrixXd::Zero(A.rows(), A.cols());

        const int  slots = shared::halfBand(g) + 1, unknowns = int(nodesOf(g));
        const auto nodeOf = [&](int n) { return shared::columnOf(g, n) * (g.cellsZ + 1) + shared::rowOf(g, n); };
        for (int n = 0; n < unknowns; ++n)
            for (int d = 0; d < slots && n + d < unknowns; ++d)
                B(nodeOf(n), nodeOf(n + d)) = B(nodeOf(n + d), nodeOf(n)) = double(band[std::size_t(n * slots + d)]);

        EXPECT_LT((A - B).cwiseAbs().maxCoeff(), 1e-6 * A.cwiseAbs().maxCoeff())
            << describe(plate) << ": entries are sums in floats";
    }
}

TEST_F(CoarseLevelTest, FactorAndAnswerAreThoseOfCxx)
{
    for (const gpu::Workgroup shape : lines()) {
        const gpu::Kernel factor(context(), kernels::factor(), shape), solve(context(), kernels::coarseSolve(), shape);
        for (const Plate& plate : coarsePlates()) {
            SCOPED_TRACE(describe(plate) + " by " + describe(shape));
            const RoughLevel         level(plate);
            const std::vector<float> band     = host::assembled(level.g, level.rigidity);
            const std::vector<float> expected = host::factored(level.g, band);
            const std::vector<float> force    = roughValues<float>(kLoads * nodesOf(level.g), 31); // held nodes too

            const std::vector<float> L = factorBy(factor, level.g, band);
            const std::vector<float> w = solveBy(solve, level.g, expected, force);

            const std::vector<float> wExpected = host::coarseSolved(level.g, expected, force);
            EXPECT_TRUE(agree(L, expected, sizesOf(expected), kFactorRounding));
            EXPECT_TRUE(agree(w, wExpected, sizesOf(wExpected), kFactorRounding));
        }
    }
}

// In floats a direct solve of condition 1e5 .. 1e8 keeps few digits of the smoothest deflections, but leaves little
// force unbalanced, and that is what a cycle needs of it. Energies weigh errors as the cycle does.
TEST_F(CoarseLevelTest, TheAnswerIsThatOfADenseCholeskyInDoubles)
{
    const gpu::Kernel factor(context(), kernels::factor(), {64, 1, 1}),
        solve(context(), kernels::coarseSolve(), {64, 1, 1});
    for (const Plate& plate : coarsePlates()) {
        SCOPED_TRACE(describe(plate));
        const RoughLevel          level(plate);
        const shared::PlateLevel& g     = level.g;
        const Eigen::MatrixXd     A     = denseMatrix(level);
        std::vector<float>        force = roughValues<float>(nodesOf(g), 32);
        host::forEachNode(g, 1, [&](int i, int j, std::size_t n, std::size_t) {
            if (holds(g, i, j)) force[n] = 0;
        });

        const std::vector<float> w = solveBy(solve, g, factorBy(factor, g, host::assembled(g, level.rigidity)), force);

        const Eigen::VectorXd f        = Eigen::Map<const Eigen::VectorXf>(force.data(), A.rows()).cast<double>();
        const Eigen::VectorXd exact    = A.llt().solve(f);
        const Eigen::VectorXd error    = Eigen::Map<const Eigen::VectorXf>(w.data(), A.rows()).cast<double>() - exact;
        const double          relative = std::sqrt(error.dot(A * error) / exact.dot(A * exact));
        EXPECT_LT(relative, 5e-3) << "largest measured 1.2e-3, where three sides are free; a cycle leaves some 0.1";
    }
}

TEST_F(CoarseLevelTest, AFactorIsFiniteWhateverRoundingLeavesOfThePivots)
{
    using enum Edge;
    const gpu::Kernel factor(context(), kernels::factor(), {64, 1, 1}),
        solve(context(), kernels::coarseSolve(), {64, 1, 1});
    for (const Edge edge : {supported, free}) {
        Plate plate      = roughPlate(16, 16, {supported, supported, edge, edge});
        plate.foundation = 0;
        for (double& D : plate.rigidity.values()) D = D > 100 ? 1e9 : 1;
        const RoughLevel         level(plate);
        const std::vector<float> band  = host::assembled(level.g, level.rigidity);
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
        EXPECT_TRUE(holdsSome) << "else this test shows nothing";
        EXPECT_GT(work, 0) << "conjugate gradients need a positive preconditioner";
    }
}

TEST_F(CoarseLevelTest, RepeatsAreEqualToTheBit)
{
    const gpu::Kernel factor(context(), kernels::factor(), {64, 1, 1}),
        solve(context(), kernels::coarseSolve(), {64, 1, 1});
    const RoughLevel         level(coarsePlates()[1]);
    const std::vector<float> band  = host::assembled(level.g, level.rigidity);
    const std::vector<float> force = roughValues<float>(kLoads * nodesOf(level.g), 33);

    const std::vector<float> L = factorBy(factor, level.g, band), w = solveBy(solve, level.g, L, force);
    for (int n = 0; n < 5; ++n) {
        EXPECT_EQ(L, factorBy(factor, level.g, band));
        EXPECT_EQ(w, solveBy(solve, level.g, L, force));
    }
}

} // namespace
} // namespace palp
