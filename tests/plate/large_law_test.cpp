#include "engine/plate/large_law.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "engine/plate/load.h"
#include "engine/plate/reference/reference_large_shell.h"
#include "engine/plate/reference/reference_shell_solver.h"
#include "tests/plate/large_shells.h"

namespace palp {
namespace {

using namespace large_shells;

struct Pressed {
    Shell     shell;
    NodeField load, linear;
    LargeLaw  law;
};

Pressed pressed(const char* name, int cells, const char* processor, double radius = 4e-3)
{
    Pressed result;
    result.shell = named(name, cells);
    PlateSolver solver(processor);
    result.load   = fingertip(result.shell.bending.grid, radius);
    result.linear = ReferenceShellSolver(result.shell).solve(result.load).deflection;
    result.law    = largeLaw(result.shell, result.load, result.linear, 2 * kThickness, solver);
    return result;
}

/// Largest error of the force up to a depth [1].
double errorOf(const Pressed& of, double until)
{
    std::vector<double> depths;
    for (double depth = 0.2e-3; depth < until + 1e-9; depth += 0.2e-3) depths.push_back(depth);
    double most = 0;
    for (const LargeState& state : pressDeep(of.shell, of.load, depths))
        most = std::max(most, std::abs(of.law.forceAt(state.depth) / state.force - 1));
    return most;
}

TEST(LargeLaw, IsThatOfAllEquationsUpToOnePointEightThicknesses)
{
    struct Of {
        const char* name;
        double      close; // [1]
    };
    // Measured on a footprint of 4 mm, in %: flat 0.05, supported dome 2.8, clamped dome 1.7, cylinder 1.5, spots of 10
    // under the finger 1.4 and beside it 3.5, saddle 0.3. What is missing are shapes: it has three.
    for (const auto& [name, close] : {Of{"flat", 0.002}, Of{"cap ss", 0.035}, Of{"cap clamped", 0.02},
                                      Of{"cylinder", 0.02}, Of{"wart", 0.02}, Of{"beside", 0.04}, Of{"saddle", 0.01}}) {
        const Pressed of = pressed(name, 32, "host");
        EXPECT_LT(errorOf(of, 1.8e-3), close) << name;
        EXPECT_LT(errorOf(of, 1.4e-3), 0.012) << name; // measured 1.1 % at most
        EXPECT_LT(errorOf(of, 0.8e-3), 0.001) << name; // and 0.05 %
    }
}

TEST(LargeLaw, IsTheSameByEverySolver)
{
    for (const char* name : {"flat", "cap ss", "saddle"}) {
        const LargeLaw host = pressed(name, 32, "host").law, reference = pressed(name, 32, "reference").law;
        for (std::size_t n = 1; n < host.force.size(); ++n)
            EXPECT_NEAR(host.force[n] / reference.force[n], 1, 2e-4) << name << n; // twice the solver's tolerance
    }
}

TEST(LargeLaw, BeginsAsTheLinearTheory)
{
    for (const char* name : {"flat", "cap ss", "cap clamped", "cylinder"}) {
        const Pressed of = pressed(name, 32, "host");
        EXPECT_EQ(of.law.force[0], 0) << name;
        EXPECT_NEAR(of.law.tangent[0] * dot(of.load, of.linear), 1, 1e-9) << name; // rounding
    }
}

TEST(LargeLaw, ItsTangentIsTheSlopeOfItsForce)
{
    for (const char* name : {"flat", "cap ss", "saddle"}) {
        const LargeLaw law = pressed(name, 32, "host").law;
        for (std::size_t n = 1; n + 1 < law.force.size(); ++n) {
            const double slope = (law.force[n + 1] - law.force[n - 1]) / (2 * law.step);
            EXPECT_NEAR(law.tangent[n] / slope, 1, 0.01) << name << n; // of the third derivative over an eighth of h
        }
    }
}

TEST(LargeLaw, ItsForceNeverFalls)
{
    Shell           shell = sheet(32, 1 / kRadius, 1 / kRadius, Edge::supported); // snaps under an even pressure
    const NodeField load  = uniformLoad(shell.bending.grid, 1 / (kSize * kSize));
    PlateSolver     host("host");
    const LargeLaw  law = largeLaw(shell, load, ReferenceShellSolver(shell).solve(load).deflection, 2e-3, host);
    EXPECT_TRUE(std::ranges::is_sorted(law.force));
    EXPECT_EQ(std::ranges::min(law.tangent), 0);
    EXPECT_LT(law.depthOf(10 * law.force.back()), INFINITY);
}

TEST(LargeLaw, DepthAndForceAreInverse)
{
    const LargeLaw law = pressed("cap ss", 32, "host").law;
    for (const double depth : {0.0, 0.3e-3, 1e-3, 1.99e-3, 3e-3})
        EXPECT_NEAR(law.depthOf(law.forceAt(depth)), depth, 1e-9) << depth; // halvings
}

} // namespace
} // namespace palp
