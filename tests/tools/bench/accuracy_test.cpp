#include "engine/tools/bench/accuracy.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "engine/plate/reference/reference_plate_solver.h"
#include "engine/tools/bench/bench_plates.h"

namespace palp::bench {
namespace {

Direct directOf(const Plate& plate)
{
    Direct direct{PlateMatrix(plate), {}};
    direct.solver = eigenSolver(direct.matrix);
    return direct;
}

TEST(Accuracy, RefinedTruthIsTheReferencesAnswer)
{
    for (const Map& map : maps()) {
        const Plate     plate  = plateOf(map, 33);
        const NodeField force  = fingertip(plate.grid);
        Direct          direct = directOf(plate);

        const Truth truth = refinedTruth(direct, plate, force);

        EXPECT_LT(truth.correction, 1e-10) << map.name;
        EXPECT_LT(errorOf(ReferencePlateSolver(plate).solve(force).deflection, truth.w), 1e-10) << map.name;
    }
}

// A solver that is a little wrong everywhere: factors of a plate that is 1 % stiffer.
TEST(Accuracy, RefinedTruthDoesNotDependOnWhoseFactorsItUses)
{
    const Plate     plate = plateOf(mapNamed("wart"), 33);
    const NodeField force = fingertip(plate.grid);
    struct Stiffer  final : DirectSolver {
        std::unique_ptr<DirectSolver> solver;
        [[nodiscard]] std::string     name() const override { return "stiffer"; }
        void                          factorise(const PlateMatrix& m) override { solver->factorise(m); }
        void                          solve(std::span<const double> right, std::span<double> answer) override
        {
            solver->solve(right, answer);
            for (double& w : answer) w /= 1.01;
        }
        [[nodiscard]] std::optional<std::size_t> peakBytes() const override { return {}; }
    };
    Direct mistaken = directOf(plate), right = directOf(plate);
    auto   stiffer  = std::make_unique<Stiffer>();
    stiffer->solver = std::move(mistaken.solver);
    mistaken.solver = std::move(stiffer);

    const Truth truth = refinedTruth(mistaken, plate, force);

    EXPECT_LT(errorOf(truth.w, refinedTruth(right, plate, force).w), 1e-10);
}

TEST(Accuracy, ABrokenSolutionHasABigError)
{
    const Plate     plate  = plateOf(mapNamed("linear"), 33);
    const NodeField force  = fingertip(plate.grid);
    Direct          direct = directOf(plate);
    const NodeField truth  = refinedTruth(direct, plate, force).w;
    NodeField       broken = truth;

    broken(16, 16) *= 1.01; // the middle, where it is deepest
    EXPECT_NEAR(errorOf(broken, truth), 0.01, 1e-3);
    EXPECT_GT(residualOf(plate, force, broken), 1);
    broken(3, 4) = std::numeric_limits<double>::quiet_NaN();
    EXPECT_EQ(errorOf(broken, truth), std::numeric_limits<double>::infinity());
    EXPECT_EQ(errorOf(NodeField(plate.grid), truth), 1);
    EXPECT_EQ(errorOf(truth, truth), 0);
    EXPECT_LT(residualOf(plate, force, truth), 1e-7);
    EXPECT_EQ(residualOf(plate, force, NodeField(plate.grid)), 1);
}

TEST(Accuracy, TheGridsErrorFallsBySecondOrder)
{
    const Map& map = mapNamed("wart");
    NodeField  w[4];
    for (int n = 0; n < 4; ++n) {
        const Plate plate  = plateOf(map, 16 * (1 << n) + 1);
        Direct      direct = directOf(plate);
        w[n]               = refinedTruth(direct, plate, fingertip(plate.grid)).w;
    }

    const double at65 = discretisationError(w[2], w[1]), at129 = discretisationError(w[3], w[2]);

    EXPECT_NEAR(std::log2(at65 / at129), 2, 0.3);
}

} // namespace
} // namespace palp::bench
