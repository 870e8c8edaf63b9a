#include "engine/tools/bench/damped_jacobi.h"

#include <cmath>

#include <gtest/gtest.h>

#include "engine/plate/reference/reference_plate_solver.h"
#include "engine/tools/bench/accuracy.h"
#include "engine/tools/bench/bench_plates.h"

namespace palp::bench {
namespace {

TEST(DampedJacobi, ConvergesToTheReferencesAnswer)
{
    const Plate     plate = plateOf(mapNamed("linear"), 17);
    const NodeField force = fingertip(plate.grid), truth = ReferencePlateSolver(plate).solve(force).deflection;
    DampedJacobi    jacobi(plate, force);

    jacobi.sweep(40'000);

    EXPECT_LT(errorOf(jacobi.answer(), truth), 1e-9);
}

TEST(DampedJacobi, ConvergesAt33Nodes)
{
    const Plate     plate = plateOf(mapNamed("linear"), 33);
    const NodeField force = fingertip(plate.grid), truth = ReferencePlateSolver(plate).solve(force).deflection;
    DampedJacobi    jacobi(plate, force);
    double          last = 1;
    for (int n = 0; n < 5; ++n) {
        jacobi.sweep(5000);
        const double error = errorOf(jacobi.answer(), truth);
        EXPECT_LT(error, 0.98 * last) << "after " << 5000 * (n + 1) << " sweeps";
        last = error;
    }
}

TEST(DampedJacobi, DivergesUndampedAt33Nodes)
{
    const Plate     plate = plateOf(mapNamed("linear"), 33);
    const NodeField force = fingertip(plate.grid), truth = ReferencePlateSolver(plate).solve(force).deflection;
    DampedJacobi    paper(plate, force, 1);

    paper.sweep(200);

    EXPECT_GT(errorOf(paper.answer(), truth), 1e20); // the fastest mode grows by 2.2 a sweep
}

// A sweep is w + omega (f - A w) / diagonal; held nodes stay. The energy's residual shares no line with it.
TEST(DampedJacobi, SweepsByTheEnergysResidual)
{
    Plate plate             = plateOf(mapNamed("wart"), 17);
    plate.edges             = {Edge::supported, Edge::free, Edge::clamped, Edge::free};
    const NodeField   force = fingertip(plate.grid, 0.6, 0.5);
    const PlateMatrix matrix(plate);
    DampedJacobi      jacobi(plate, force, 0.6);
    jacobi.sweep(3);
    const NodeField before = jacobi.answer(), rest = energyResidual(plate, force, before);

    jacobi.sweep(1);

    const NodeField after = jacobi.answer();
    double          most  = 0;
    for (const double w : after.values()) most = std::max(most, std::abs(w));
    NodeField expected = before;
    for (int c = 0; c < matrix.unknowns(); ++c) {
        const auto node = std::size_t(matrix.nodeOf()[std::size_t(c)]);
        expected.values()[node] +=
            0.6 * rest.values()[node] / matrix.value()[std::size_t(matrix.columnStart()[std::size_t(c)])];
    }
    for (std::size_t n = 0; n < after.values().size(); ++n)
        EXPECT_NEAR(after.values()[n], expected.values()[n], 1e-12 * most) << n;
}

} // namespace
} // namespace palp::bench
