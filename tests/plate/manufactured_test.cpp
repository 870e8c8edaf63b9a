// Tests by manufactured solutions: each chooses w and D, derives the load, and solves for w.

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/plate/jet.h"
#include "tests/plate/plates.h"

namespace palp {
namespace {

using reference::makePlate;
using reference::Refinement;

constexpr double kPi = std::numbers::pi;

struct Solution {
    const char* name;
    PlateEdges  edges;
    Jet (*deflection)(const Jet& x, const Jet& z);
    Jet (*rigidity)(const Jet& x, const Jet& z);
};

constexpr PlateEdges kSupported{Edge::supported, Edge::supported, Edge::supported, Edge::supported};

const Solution kSolutions[] = {
    {"Polynomial",
     {},
     [](const Jet& x, const Jet& z) { return squared(x * (1 - x) * z * (1 - z)); },
     [](const Jet& x, const Jet& z) { return 1 + 0.5 * x + z + x * z; }},
    {"Wart",
     {},
     [](const Jet& x, const Jet& z) { return squared(sin(kPi * x) * sin(kPi * z)); },
     [](const Jet& x, const Jet& z) {
         return 1 + 9 * exp((squared(x - 0.4) + squared(z - 0.55)) * (-1 / (2 * 0.15 * 0.15)));
     }},
    {"Hyperbolic",
     {},
     [](const Jet& x, const Jet& z) { return squared(x * (1 - x) * sin(kPi * z)) * exp(x); },
     [](const Jet& x, const Jet& z) { return inverse(x + squared(z) + 0.2); }},
    {"Supported", kSupported, [](const Jet& x, const Jet& z) { return sin(kPi * x) * sin(2 * kPi * z); },
     [](const Jet& x, const Jet& z) { return exp(x - 0.5 * z); }},
};

/// The load that bends a plate of rigidity D to w [Pa]: second derivatives of the moments.
double loadOf(const Jet& w, const Jet& D, double nu)
{
    const Jet wxx = w.differentiated(2, 0), wzz = w.differentiated(0, 2), wxz = w.differentiated(1, 1);
    const Jet mx = D * (wxx + nu * wzz), mz = D * (wzz + nu * wxx), mxz = (1 - nu) * D * wxz;
    return mx.derivative(2, 0) + mz.derivative(0, 2) + 2 * mxz.derivative(1, 1);
}

using LoadFunction = double (*)(const Jet& w, const Jet& D, double nu);

/// Deflection under the load that `load` derives, on the unit square.
PlateSolution answer(const Solution& s, int cells, double nu, LoadFunction load)
{
    const Plate plate = makePlate(cells, cells, 1, 1, s.edges, nu,
                                  [&](double x, double z) { return s.rigidity(Jet::x(x), Jet::z(z)).value(); });
    NodeField   pressure(plate.grid);
    for (int i = 0; i <= cells; ++i)
        for (int j = 0; j <= cells; ++j) {
            const Jet x = Jet::x(i * plate.grid.spacingX), z = Jet::z(j * plate.grid.spacingZ);
            pressure(i, j) = load(s.deflection(x, z), s.rigidity(x, z), nu);
        }
    return ReferencePlateSolver(plate).solve(gridLoad(plate.grid, pressure));
}

constexpr int kCoarse = 24; ///< cells a side of the coarsest of three grids; every node of it is compared

Refinement refined(const Solution& s, double nu, LoadFunction load)
{
    Refinement r;
    for (int i = 0; i <= kCoarse; ++i)
        for (int j = 0; j <= kCoarse; ++j)
            r.limits.push_back(s.deflection(Jet::x(double(i) / kCoarse), Jet::z(double(j) / kCoarse)).value());
    for (int level = 0; level < 3; ++level) {
        const int       stride = 1 << level;
        const NodeField w      = answer(s, kCoarse * stride, nu, load).deflection;
        for (int i = 0; i <= kCoarse; ++i)
            for (int j = 0; j <= kCoarse; ++j) r.values[std::size_t(level)].push_back(w(i * stride, j * stride));
    }
    return r;
}

/// Largest error after extrapolation over the largest deflection [1]: measured 5e-7 to 1.5e-6 of the right operator,
/// and what each of the mistakes below makes at least.
constexpr double kBar = 5e-5, kMistake = 0.1;

class Manufactured : public testing::TestWithParam<Solution> {};

TEST_P(Manufactured, DeflectionConvergesToItWithSecondOrderAtEveryNode)
{
    for (const double nu : {0.2, 0.45}) {
        const Refinement r = refined(GetParam(), nu, loadOf);

        EXPECT_GE(r.order(0), 1.8) << "second order; the coarse grid is not yet asymptotic";
        EXPECT_GE(r.order(1), 1.9) << "second order";
        EXPECT_LE(r.richardsonError(), kBar);
    }
}

INSTANTIATE_TEST_SUITE_P(All, Manufactured, testing::ValuesIn(kSolutions),
                         [](const auto& tested) { return tested.param.name; });

TEST(ManufacturedLoads, AgreeWithTheSymbolicallyDerivedOnes)
{
    struct Value {
        int    solution;
        double nu, x, z, load;
    };
    // Derived by computer algebra from the moments and evaluated in multiple precision.
    constexpr Value kValues[] = {
        {0, 0.2, 0.375, 0.625, 8.2075805664062500e+00},  {0, 0.3, 0.9, 0.3, 1.8008192000000001e+00},
        {1, 0.2, 0.125, 0.875, 7.4946390528827521e+02},  {1, 0.3, 0.25, 0.75, -2.4920784186478459e+03},
        {2, 0.2, 0.9, 0.3, 4.6965749820595313e+01},      {2, 0.3, 0.25, 0.25, 5.8785522699016795e+01},
        {3, 0.2, 0.375, 0.625, -1.7956913496549378e+03}, {3, 0.3, 0.9, 0.3, 2.0174609273300966e+03}};
    for (const Value& v : kValues) {
        const Solution& s = kSolutions[v.solution];
        const Jet       x = Jet::x(v.x), z = Jet::z(v.z);
        EXPECT_NEAR(loadOf(s.deflection(x, z), s.rigidity(x, z), v.nu) / v.load, 1, 1e-12) << s.name << ": rounding";
    }
}

/// The expanded equation with a weight on each of its parts; all ones are the right equation:
///     D lap lap w + 2 grad D . grad lap w + lap D lap w - (1-nu)(D_xx w_zz - 2 D_xz w_xz + D_zz w_xx)
struct Weights {
    double gradient = 1, laplacian = 1, bracket = 1, mixed = 1;
    bool   swapped = false; ///< w_xx and w_zz exchanged in the bracket
    double nuSign  = 1;     ///< in (1 - nu)
};

double expandedLoad(const Jet& w, const Jet& D, double nu, const Weights& k)
{
    const auto   lap  = [](const Jet& u) { return u.differentiated(2, 0) + u.differentiated(0, 2); };
    const Jet    lapW = lap(w);
    const double wxx = w.derivative(2, 0), wzz = w.derivative(0, 2);
    const double bracket = D.derivative(2, 0) * (k.swapped ? wxx : wzz) -
                           2 * k.mixed * D.derivative(1, 1) * w.derivative(1, 1) +
                           D.derivative(0, 2) * (k.swapped ? wzz : wxx);
    return D.value() * lap(lapW).value() +
           2 * k.gradient * (D.derivative(1, 0) * lapW.derivative(1, 0) + D.derivative(0, 1) * lapW.derivative(0, 1)) +
           k.laplacian * lap(D).value() * lapW.value() - k.bracket * (1 - k.nuSign * nu) * bracket;
}

struct Mistake {
    const char*  name;
    LoadFunction load;
};

/// Classical mistakes in the operator. An operator A + M answers to the load of the chosen w with A^-1 (A - M) w up to
/// second order in M, which is what the right solver answers to the load that the mistaken equation derives.
const Mistake kMistakes[] = {
    {"BracketDropped", [](const Jet& w, const Jet& D, double nu) { return expandedLoad(w, D, nu, {.bracket = 0}); }},
    {"OnePlusNu", [](const Jet& w, const Jet& D, double nu) { return expandedLoad(w, D, nu, {.nuSign = -1}); }},
    {"MixedTermOfWrongSign",
     [](const Jet& w, const Jet& D, double nu) { return expandedLoad(w, D, nu, {.mixed = -1}); }},
    {"MixedTermWithoutItsTwo",
     [](const Jet& w, const Jet& D, double nu) { return expandedLoad(w, D, nu, {.mixed = 0.5}); }},
    {"CurvaturesSwapped",
     [](const Jet& w, const Jet& D, double nu) { return expandedLoad(w, D, nu, {.swapped = true}); }},
    {"LaplacianOfRigidityDropped",
     [](const Jet& w, const Jet& D, double nu) { return expandedLoad(w, D, nu, {.laplacian = 0}); }},
    {"GradientWithoutItsTwo",
     [](const Jet& w, const Jet& D, double nu) { return expandedLoad(w, D, nu, {.gradient = 0.5}); }},
    {"RigidityFrozen", [](const Jet& w, const Jet& D,
                          double nu) { return expandedLoad(w, D, nu, {.gradient = 0, .laplacian = 0, .bracket = 0}); }},
};

TEST(ManufacturedEquation, TheEquationWithoutAMistakeIsTheExpandedOne)
{
    const Jet x = Jet::x(0.3), z = Jet::z(0.7);
    for (const Solution& s : kSolutions) {
        const Jet    w = s.deflection(x, z), D = s.rigidity(x, z);
        const double load = loadOf(w, D, 0.3);
        EXPECT_NEAR(expandedLoad(w, D, 0.3, {}), load, 1e-12 * std::abs(load)) << "rounding";
    }
}

class ManufacturedMistakes : public testing::TestWithParam<Mistake> {};

TEST_P(ManufacturedMistakes, MovesSomeAnswerByATenth)
{
    double most = 0;
    for (const Solution& s : kSolutions) most = std::max(most, refined(s, 0.2, GetParam().load).richardsonError());

    EXPECT_TRUE(std::isfinite(most)) << "then nothing is shown";
    EXPECT_GE(most, kMistake) << "measured 0.1002 (a mixed term without its two) to 1.6";
}

INSTANTIATE_TEST_SUITE_P(All, ManufacturedMistakes, testing::ValuesIn(kMistakes),
                         [](const auto& tested) { return tested.param.name; });

} // namespace
} // namespace palp
