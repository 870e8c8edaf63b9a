#include "engine/plate/large_law.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "engine/plate/load.h"
#include "engine/plate/reference/reference_large_shell.h"
#include "engine/plate/reference/reference_shell_solver.h"
#include "tests/plate/large_shells.h"
#include "tests/plate/strips.h"
#include "tests/support/errors.h"

namespace palp {
namespace {

using namespace large_shells;

struct Pressed {
    Shell     shell;
    NodeField load, linear;
    LargeLaw  law;
};

Pressed pressed(const Shell& shell, const char* processor, double radius = 4e-3)
{
    Pressed result;
    result.shell = shell;
    PlateSolver solver(processor);
    result.load   = fingertip(result.shell.bending.grid, radius);
    result.linear = ReferenceShellSolver(result.shell).solve(result.load).deflection;
    result.law    = largeLaw(result.shell, result.load, result.linear, 2 * kThickness, solver);
    return result;
}

Pressed pressed(const char* name, int cells, const char* processor)
{
    return pressed(named(name, cells), processor);
}

/// Largest errors of the force up to 0.8, 1.4 and 1.8 thicknesses [1].
std::array<double, 3> errorsOf(const Pressed& of)
{
    std::vector<double> depths;
    for (int n = 1; n <= 9; ++n) depths.push_back(0.2 * n * kThickness);
    std::array<double, 3> most{};
    for (const LargeState& state : pressDeep(of.shell, of.load, depths)) {
        const double error = of.law.forceAt(state.depth) / state.force - 1;
        for (std::size_t k = 0; k < 3; ++k)
            if (state.depth < std::array{0.81, 1.41, 1.81}[k] * kThickness) most[k] = worse(most[k], error);
    }
    return most;
}

TEST(LargeLaw, IsThatOfAllEquationsUpToOnePointEightThicknesses)
{
    struct Of {
        const char* name;
        double      close; // [1]
    };
    // Measured on a footprint of 4 mm, in %: flat 0.05, supported dome 0.2, clamped dome 0.4, cylinder 0.15, spots of
    // 10 under the finger 1.0 and beside it 1.2, saddle 0.01. What is missing are shapes: it has three.
    for (const auto& [name, close] :
         {Of{"flat", 0.001}, Of{"cap ss", 0.003}, Of{"cap clamped", 0.006}, Of{"cylinder", 0.003}, Of{"wart", 0.012},
          Of{"beside", 0.015}, Of{"saddle", 0.001}}) {
        const auto [little, more, most] = errorsOf(pressed(name, 32, "host"));
        EXPECT_LT(most, close) << name;
        EXPECT_LT(more, 0.007) << name;    // measured 0.5 % at most
        EXPECT_LT(little, 0.0015) << name; // and 0.11 %
    }
}

TEST(LargeLaw, IsThatOfOtherSheetsToo)
{
    struct Of {
        const char* name;
        double      kx, kz; // [1/m]
        Edge        edge;
        double      times, beside; // a spot [1], [m]
        double      radius;        // of the fingertip [m]
        double      nu;            // [1]
        double      close;         // [1] up to 1.8 thicknesses
    };
    constexpr Edge kOn = Edge::supported, kIn = Edge::clamped;
    for (const Of& of : {// Seen while it was found which shapes are good.
                         Of{"deep, clamped", 28, 28, kIn, 1, 0, 4e-3, 0.3, 0.01},
                         Of{"ellipsoid, clamped", 30, 5, kIn, 1, 0, 4e-3, 0.3, 0.003},
                         Of{"cylinder of 30 mm", 0, 33, kOn, 1, 0, 5e-3, 0.3, 0.008},
                         Of{"wide fingertip", 20, 20, kOn, 1, 0, 7e-3, 0.3, 0.002},
                         Of{"beside a soft spot", 20, 20, kIn, 0.1, 8e-3, 4e-3, 0.3, 0.005},
                         Of{"beside a spot of 30", 20, 20, kOn, 30, 5e-3, 4e-3, 0.3, 0.035},
                         Of{"from within", -25, -10, kIn, 1, 0, 4e-3, 0.3, 0.003},
                         // Tried once, when the shapes were fixed: the bounds are what was found then.
                         Of{"shallow", 12, 12, kIn, 1, 0, 6e-3, 0.3, 0.003},
                         Of{"narrow fingertip", 40, 10, kOn, 1, 0, 3e-3, 0.3, 0.005},
                         Of{"beside a spot of 50", 20, 20, kIn, 50, 6e-3, 4e-3, 0.3, 0.055},
                         Of{"soft spot", 20, 20, kOn, 0.05, 0, 4e-3, 0.3, 0.003},
                         Of{"cylinder of 20 mm", 0, 50, kIn, 1, 0, 4e-3, 0.3, 0.004},
                         Of{"saddle", 30, -10, kIn, 1, 0, 4e-3, 0.3, 0.002},
                         Of{"beside a spot of 10", 20, 20, kIn, 10, 5e-3, 4e-3, 0.2, 0.025},
                         Of{"flat, beside a spot of 30", 0, 0, kIn, 30, 4e-3, 4e-3, 0.3, 0.013},
                         Of{"tube, beside a spot of 8", 35, 3, kOn, 8, -5e-3, 5e-3, 0.4, 0.013}}) {
        Shell shell = sheet(32, of.kx, of.kz, of.edge, of.nu);
        if (of.times != 1) addSpot(shell, of.times, of.beside);
        const auto [little, more, most] = errorsOf(pressed(shell, "host", of.radius));
        EXPECT_LT(most, of.close) << of.name;
        EXPECT_LT(more, std::max(of.close / 2, 0.003)) << of.name;
        EXPECT_LT(little, 0.0035) << of.name; // measured 0.3 % at most
    }
}

/// Beyond a border within its window a bed holds the stresses, also where no side of the window does: three corners
/// that were held besides made an error of 0.9. Of three shapes none moves a free border well: 1.4 % where the other
/// sides are held in the plane, 4.2 % where they are supported.
TEST(LargeLaw, IsThatOfASheetThatEndsWithinItsWindow)
{
    for (const auto& [k, edge, close] : {std::tuple{0.0, Edge::clamped, 0.02}, std::tuple{20.0, Edge::clamped, 0.02},
                                         std::tuple{20.0, Edge::supported, 0.05}}) {
        Shell            shell = sheet(32, k, k, edge);
        const PlateGrid& grid  = shell.bending.grid;
        const double     area  = grid.spacingX * grid.spacingZ;
        shell.stressBed        = NodeField(grid);
        for (int i = 27; i <= grid.cellsX; ++i)
            for (int j = 0; j <= grid.cellsZ; ++j) {
                shell.bending.rigidity(i, j) *= 3e-3;
                shell.stressBed(i, j) = 270 * shell.membraneCompliance(i, j) / (area * area);
            }
        const auto [little, more, most] = errorsOf(pressed(shell, "host"));
        EXPECT_LT(most, close) << k << " 1/m";
        EXPECT_LT(more, close / 3) << k << " 1/m";
        EXPECT_LT(little, 0.003) << k << " 1/m";
    }
}

/// Between two supports a strip hardens by the forces that it carries between them, three times at 1.8 thicknesses, and
/// an arch gives way. Three shapes do not follow well how one of 2 thicknesses or more snaps through.
TEST(LargeLaw, IsThatOfAStripBetweenSupports)
{
    for (const auto& [k, close] : {std::pair{0.0, 0.01}, std::pair{2.0, 0.003}, std::pair{5.0, 0.003},
                                   std::pair{-10.0, 0.003}, std::pair{10.0, 0.15}}) {
        Shell strip                     = sheet(32, k, 0, Edge::clamped);
        strip.bending.edges.z0          = Edge::free;
        strip.bending.edges.z1          = Edge::free;
        strip                           = stripOf(strip);
        const Pressed of                = pressed(strip, "host");
        const auto [little, more, most] = errorsOf(of);
        EXPECT_LT(most, close) << k << " 1/m";
        EXPECT_LT(more, close / 3) << k << " 1/m";
        EXPECT_LT(little, 0.004) << k << " 1/m";
        const double linear = of.law.tangent.front() * 1.8 * kThickness, force = of.law.forceAt(1.8 * kThickness);
        if (k == 0) {
            EXPECT_GT(force, 2.5 * linear);
        }
        if (k == 10) {
            EXPECT_LT(force, 0.35 * linear);
        }
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
