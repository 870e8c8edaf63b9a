#include "engine/plate/reference/reference_large_shell.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include "engine/plate/load.h"
#include "engine/plate/reference/reference_shell_solver.h"
#include "engine/plate/shell_energy.h"
#include "tests/plate/large_shells.h"
#include "tests/support/errors.h"

namespace palp {
namespace {

using namespace large_shells;

/// Force over that of the linear theory at depths in thicknesses.
std::vector<double> secants(const Shell& shell, double radius, const std::vector<double>& depths)
{
    const NodeField     load = fingertip(shell.bending.grid, radius);
    const double        c    = dot(load, ReferenceShellSolver(shell).solve(load).deflection);
    std::vector<double> metres, result;
    for (const double depth : depths) metres.push_back(depth * kThickness);
    for (const LargeState& state : pressDeep(shell, load, metres)) result.push_back(state.force * c / state.depth);
    return result;
}

/// Depth of the middle in thicknesses under a pressure of Q E t^4 / a^4.
double levysDepth(int cells, double Q)
{
    const Shell         shell  = sheet(cells, 0, 0, Edge::clamped, 0.316);
    const double        wanted = Q * kModulus * std::pow(kThickness, 4) / (kSize * kSize); // [N] of the whole plate
    NodeField           load   = uniformLoad(shell.bending.grid, 1 / (kSize * kSize));
    std::vector<double> depths; // mean ones [m]: of a clamped plate 0.3 of the middle's
    for (int n = 1; n <= 24; ++n) depths.push_back(0.05 * n * kThickness);
    double before = 0, depthBefore = 0;
    for (const LargeState& state : pressDeep(shell, load, depths)) {
        const double middle = state.deflection(cells / 2, cells / 2) / kThickness;
        if (state.force >= wanted)
            return depthBefore + (middle - depthBefore) * (wanted - before) / (state.force - before);
        before      = state.force;
        depthBefore = middle;
    }
    return NAN;
}

TEST(PressDeep, MeetsLevysClampedSquarePlate)
{
    // Levy 1942, NACA report 740: w/t in the middle of a clamped square plate held in its plane, nu = 0.316.
    // Measured 0.4 and 0.1 % at first, 1.2 and 1.9 % deeper: his series has few terms, and ours 32 cells.
    struct Of {
        double load, depth, close;
    };
    for (const auto& [Q, depth, close] :
         {Of{17.79, 0.237, 0.01}, Of{63.4, 0.695, 0.01}, Of{184.0, 1.323, 0.025}, Of{402.0, 1.902, 0.025}})
        EXPECT_NEAR(levysDepth(32, Q), depth, close * depth) << Q;
}

/// A sphere's window of supported fields under an even pressure, as double sine series of both of them: phi of each
/// wave follows from w by its own equation, and the waves of w from Newton's method on what is left of the energy.
class SineSeries {
public:
    explicit SineSeries(double curvature) : curvature_(curvature), mixed_(kWaves * kWaves * kWaves)
    {
        for (int n = 0; n < kPlaces; ++n) addPlaces(n);
    }

    /// The mean deflection under a force [m].
    double meanUnder(double force) const
    {
        std::vector<double> W(kWaves);
        for (int steps = 1; steps <= 10; ++steps) // of the force
            for (int n = 0; n < 12; ++n) improve(W, force * steps / 10);
        double mean = 0;
        for (int a = 0; a < kWaves; ++a) mean += W[a] * meanOf(a);
        return mean;
    }

private:
    static constexpr int    kOdd = 5, kWaves = kOdd * kOdd, kPlaces = 96; // 1, 3, ... 9 in each direction; per side
    static constexpr double kWave = std::numbers::pi / kSize;             // [1/m]

    static double along(int a) { return kWave * (2 * (a / kOdd) + 1); }
    static double across(int a) { return kWave * (2 * (a % kOdd) + 1); }
    static double square(int a) { return along(a) * along(a) + across(a) * across(a); }
    static double meanOf(int a) { return 4 / (along(a) * across(a) * kSize * kSize); }

    double& mixed(int p, int a, int b) { return mixed_[(p * kWaves + a) * kWaves + b]; }
    double  mixed(int p, int a, int b) const { return mixed_[(p * kWaves + a) * kWaves + b]; }

    /// Adds a row of places to int (phi_zz w_x w_x + phi_xx w_z w_z - 2 phi_xz w_x w_z) of three waves, by the midpoint
    /// rule, which is exact for the cosines into which products of slopes and forces that vanish at the rim fall apart.
    void addPlaces(int row)
    {
        const double area = kSize * kSize / (kPlaces * kPlaces), x = (row + 0.5) * kSize / kPlaces;
        for (int n = 0; n < kPlaces; ++n) {
            const double               z = (n + 0.5) * kSize / kPlaces;
            std::array<double, kWaves> value{}, slopeX{}, slopeZ{}, twist{};
            for (int a = 0; a < kWaves; ++a) {
                const double sx = std::sin(along(a) * x), cx = std::cos(along(a) * x);
                const double sz = std::sin(across(a) * z), cz = std::cos(across(a) * z);
                value[a]  = sx * sz;
                slopeX[a] = along(a) * cx * sz;
                slopeZ[a] = across(a) * sx * cz;
                twist[a]  = along(a) * across(a) * cx * cz;
            }
            for (int p = 0; p < kWaves; ++p) {
                const double zz = -across(p) * across(p) * value[p], xx = -along(p) * along(p) * value[p];
                for (int a = 0; a < kWaves; ++a)
                    for (int b = 0; b < kWaves; ++b)
                        mixed(p, a, b) += area * (zz * slopeX[a] * slopeX[b] + xx * slopeZ[a] * slopeZ[b] -
                                                  twist[p] * (slopeX[a] * slopeZ[b] + slopeZ[a] * slopeX[b]));
            }
        }
    }

    /// Makes a step of Newton's method.
    void improve(std::vector<double>& W, double force) const
    {
        constexpr double kNorm    = kSize * kSize / 4; // int of a wave's square
        const double     rigidity = kModulus * std::pow(kThickness, 3) / 12 / (1 - kPoisson * kPoisson);
        std::vector<std::array<double, kWaves + 1>> rows(kWaves); // second derivative, and what is missing
        for (int a = 0; a < kWaves; ++a) {
            rows[a]         = {};
            rows[a][a]      = rigidity * square(a) * square(a) * kNorm;
            rows[a][kWaves] = force * meanOf(a) - rows[a][a] * W[a];
        }
        for (int p = 0; p < kWaves; ++p) {
            const double               soft = kNorm * square(p) * square(p) / (kModulus * kThickness);
            std::array<double, kWaves> slope{};
            double                     load = curvature_ * square(p) * kNorm * W[p];
            slope[p]                        = curvature_ * square(p) * kNorm;
            for (int a = 0; a < kWaves; ++a)
                for (int b = 0; b < kWaves; ++b) {
                    load += mixed(p, a, b) * W[a] * W[b] / 2;
                    slope[a] += mixed(p, a, b) * W[b];
                }
            for (int a = 0; a < kWaves; ++a) {
                rows[a][kWaves] -= slope[a] * load / soft;
                for (int b = 0; b < kWaves; ++b)
                    rows[a][b] += slope[a] * slope[b] / soft + mixed(p, a, b) * load / soft;
            }
        }
        solveInto(rows, W);
    }

    static void solveInto(std::vector<std::array<double, kWaves + 1>>& rows, std::vector<double>& W)
    {
        for (int k = 0; k < kWaves; ++k)
            for (int r = k + 1; r < kWaves; ++r) {
                const double times = rows[r][k] / rows[k][k];
                for (int c = k; c <= kWaves; ++c) rows[r][c] -= times * rows[k][c];
            }
        for (int k = kWaves - 1; k >= 0; --k) {
            for (int c = k + 1; c < kWaves; ++c) rows[k][kWaves] -= rows[k][c] * rows[c][kWaves];
            rows[k][kWaves] /= rows[k][k];
            W[k] += rows[k][kWaves];
        }
    }

    double              curvature_; // [1/m]
    std::vector<double> mixed_;
};

TEST(PressDeep, MeetsTheSineSeriesOfSupportedPlatesAndDomesWithSecondOrder)
{
    struct Of {
        double curvature, depth; // [1/m], [m]: outwards beyond a thickness, inwards before the dome snaps
    };
    for (const auto& [curvature, depth] : {Of{0, 1e-3}, Of{0.3 / kRadius, -1e-3}, Of{0.3 / kRadius, 0.3e-3},
                                           Of{1 / kRadius, -1e-3}, Of{1 / kRadius, 0.2e-3}}) {
        const SineSeries series(curvature);
        const auto       errorOf = [&, curvature = curvature, depth = depth](int cells) {
            const Shell shell = sheet(cells, curvature, curvature, Edge::supported);
            const auto  state =
                pressDeep(shell, uniformLoad(shell.bending.grid, 1 / (kSize * kSize)), std::array{depth / 2, depth})
                    .back();
            return series.meanUnder(state.force) / state.depth - 1;
        };
        const double coarse = errorOf(16), fine = errorOf(32);
        EXPECT_LT(std::abs(fine), 6e-3) << curvature << ", " << depth;
        EXPECT_GT(coarse / fine, 3) << curvature << ", " << depth; // h^4, and waves beyond the ninth: 3.9 to 8.2
    }
}

TEST(PressDeep, IsOfSecondOrder)
{
    for (const char* name : {"flat", "cap ss", "cylinder", "saddle"}) {
        std::array<double, 3> force{};
        for (std::size_t level = 0; level < 3; ++level) {
            const Shell shell = named(name, 16 << level);
            force[level]      = pressDeep(shell, fingertip(shell.bending.grid, 6e-3), std::array{1e-3}).back().force;
        }
        // A ratio of 4, but for h^4 of a footprint that is 2.4 spacings of the coarsest grid.
        EXPECT_NEAR((force[0] - force[1]) / (force[1] - force[2]), 4, 1.2) << name;
    }
}

TEST(PressDeep, IsTheLinearTheoryAtFirst)
{
    for (const char* name : {"flat", "cap ss", "cap clamped", "saddle"}) {
        // The first term beyond is one of depth over thickness, of about 0.6 of a dome.
        EXPECT_NEAR(secants(named(name, 32), 4e-3, {1e-4}).back(), 1, 1e-4) << name;
    }
}

TEST(PressDeep, ADomeGivesWayInwardsAndHardensOutwards)
{
    const auto inward  = secants(named("cap clamped", 32), 4e-3, {0.5, 1});
    const auto outward = secants(named("cap clamped", 32), 4e-3, {-0.5, -1});
    EXPECT_LT(inward[1], 0.6);
    EXPECT_GT(outward[1], 1.4);
    // Bowls are domes from the other side.
    Shell bowl = named("cap clamped", 32);
    for (NodeField* k : {&bowl.curvatureX, &bowl.curvatureZ})
        for (double& value : k->values()) value = -value;
    EXPECT_NEAR(secants(bowl, 4e-3, {0.5, 1})[1] / outward[1], 1, 1e-8); // rounding
}

TEST(PressDeep, ASnappingDomeIsFollowedBeyondItsPeak)
{
    // A deep dome whose load falls: 12 times its thickness high, pressed evenly.
    Shell               shell = sheet(24, 6 / kRadius, 6 / kRadius, Edge::supported);
    const double        all   = kSize * kSize;
    std::vector<double> depths;
    for (int n = 1; n <= 40; ++n) depths.push_back(0.1e-3 * n);
    const auto states = pressDeep(shell, uniformLoad(shell.bending.grid, 1 / all), depths);
    double     most = 0, leastAfter = 1e9;
    for (const LargeState& state : states) {
        if (state.force > most) leastAfter = most = state.force;
        leastAfter = std::min(leastAfter, state.force);
    }
    EXPECT_LT(leastAfter, 0.9 * most);
}

TEST(StretchEnergy, IsExactForLinearSlopesAndEvenForces)
{
    // phi of the second degree has the same forces everywhere; on a free edge of the membrane the difference across it
    // is no term, so w is linear within and 0 near the rim.
    Plate membrane    = membraneOf(sheet(12, 0, 0, Edge::clamped));
    membrane.grid     = {12, 10, 1e-3, 1.5e-3};
    membrane.rigidity = NodeField(membrane.grid, 1);
    const Shell      everywhere;
    constexpr double Nx = 2, Nz = -3, Nxz = 0.7; // [N/m]
    NodeField        phi(membrane.grid), w(membrane.grid);
    for (int i = 0; i <= 12; ++i)
        for (int j = 0; j <= 10; ++j) {
            const double x = i * 1e-3, z = j * 1.5e-3;
            phi(i, j) = Nx * z * z / 2 + Nz * x * x / 2 - Nxz * x * z;
            w(i, j)   = std::pow(std::sin(std::numbers::pi * i / 12) * std::sin(std::numbers::pi * j / 10), 2);
        }
    double direct = 0; // the same integral by sums that share nothing with the terms
    for (int i = 0; i < 12; ++i)
        for (int j = 0; j <= 10; ++j) direct += Nx / 2 * std::pow((w(i + 1, j) - w(i, j)) / 1e-3, 2);
    for (int i = 0; i <= 12; ++i)
        for (int j = 0; j < 10; ++j) direct += Nz / 2 * std::pow((w(i, j + 1) - w(i, j)) / 1.5e-3, 2);
    for (int i = 0; i < 12; ++i)
        for (int j = 0; j < 10; ++j) {
            const double slopeX = (w(i + 1, j) - w(i, j) + w(i + 1, j + 1) - w(i, j + 1)) / 2e-3;
            const double slopeZ = (w(i, j + 1) - w(i, j) + w(i + 1, j + 1) - w(i + 1, j)) / 3e-3;
            direct += Nxz * slopeX * slopeZ;
        }
    direct *= 1e-3 * 1.5e-3;
    EXPECT_NEAR(dot(w, stretchForces(everywhere, membrane, phi, w)) / 2, direct, 1e-12 * std::abs(direct)); // rounding
    EXPECT_NEAR(dot(phi, stretchOf(everywhere, membrane, w, w)) / 2, direct, 1e-12 * std::abs(direct));
}

/// At the ground of what is held the deflection is whatever a solver leaves there.
TEST(StretchEnergy, EndsWhereNothingIsStretched)
{
    Shell shell;
    shell.bending   = {{24, 12, 1e-3, 1e-3}, {}, 0.3, 0, NodeField(25, 13, 1.0)};
    Plate membrane  = shell.bending;
    shell.stretched = NodeField(shell.bending.grid, 1);
    NodeField w(shell.bending.grid), phi(shell.bending.grid);
    for (int i = 0; i <= 24; ++i)
        for (int j = 0; j <= 12; ++j) {
            if (i > 15) shell.stretched(i, j) = 0;
            if (i > 16) w(i, j) = 1e-3 * ((7 * i + 5 * j) % 11);
            phi(i, j) = std::sin(0.4 * i) * std::sin(0.7 * j);
        }
    EXPECT_EQ(largest(stretchOf(shell, membrane, w, w)), 0);
    EXPECT_EQ(largest(stretchForces(shell, membrane, phi, w)), 0);
    shell.stretched = NodeField();
    EXPECT_GT(largest(stretchOf(shell, membrane, w, w)), 1);
    EXPECT_GT(largest(stretchForces(shell, membrane, phi, w)), 1);
}

} // namespace
} // namespace palp
