#include "engine/chart/coverage.h"

#include <cmath>
#include <functional>
#include <numbers>
#include <random>

#include <gtest/gtest.h>

namespace palp {
namespace {

constexpr double kSpacing = 1e-3; // [m] of random points: one for each square of it

NodeField shareOf(int cells, const std::vector<ChartPoint>& points, double spacing)
{
    const PatchWindow window = PatchWindow::square(100e-3, cells);
    return coveredShare(window.grid, depthWithin(window, points, spacing, 2 * 100e-3 / cells));
}

NodeField sharesOf(const std::function<bool(double, double)>& inside, unsigned seed, int cells = 128)
{
    std::mt19937_64                        bits(seed);
    std::uniform_real_distribution<double> along(-40e-3, 40e-3);
    std::vector<ChartPoint>                points;
    for (int n = 0; n < 6400; ++n) {
        const double x = along(bits), z = along(bits);
        if (inside(x, z)) points.push_back({x, z});
    }
    return shareOf(cells, points, kSpacing);
}

double areaOf(const NodeField& share)
{
    double sum = 0;
    for (const double value : share.values()) sum += value;
    const double cell = 100e-3 / (share.nodesX() - 1);
    return sum * cell * cell;
}

TEST(CoveredShare, HasTheAreaOfTheSheetHoweverThePointsAreDrawn)
{
    const double radius = 30e-3;
    for (const unsigned seed : {1U, 2U, 3U, 4U}) {
        const NodeField disc = sharesOf([&](double x, double z) { return std::hypot(x, z) < radius; }, seed);
        const NodeField bar =
            sharesOf([](double x, double z) { return std::abs(x + z) < 30e-3 && std::abs(x - z) < 20e-3; }, seed);
        // A tenth of a spacing all along the border: 0.7 % of the disc, 1.2 % of the bar, whose corners
        // are lost by as much again.
        EXPECT_NEAR(areaOf(disc) / (std::numbers::pi * radius * radius), 1, 0.01) << seed;
        EXPECT_NEAR(areaOf(bar) / (30e-3 * 20e-3 * 2), 1, 0.02) << seed << ", a bar across the grid";
    }
}

TEST(CoveredShare, GoesFromOneToNothingOverACell)
{
    const NodeField share = sharesOf([](double x, double) { return x < 10e-3; }, 5);
    const double    cell  = 100e-3 / 128;
    for (int j = 40; j <= 88; ++j) // away from the corners
        for (int i = 20; i <= 128; ++i) {
            const double x = -50e-3 + i * cell;
            if (x < 10e-3 - kSpacing - cell) {
                EXPECT_EQ(share(i, j), 1) << x;
            }
            if (x > 10e-3 + kSpacing + cell) {
                EXPECT_EQ(share(i, j), 0) << x;
            }
            EXPECT_LE(share(i + (i < 128), j), share(i, j)) << "it falls across the border";
        }
}

TEST(CoveredShare, ClosesNarrowHolesAndLeavesWideOnes)
{
    const auto withHole = [](double radius) {
        return sharesOf([=](double x, double z) { return std::hypot(x, z) > radius; }, 6)(64, 64);
    };
    EXPECT_EQ(withHole(1e-3), 1) << "gaps between random points are as wide";
    EXPECT_EQ(withHole(6e-3), 0);
}

TEST(CoveredShare, OfPointsMuchCloserThanNodesIsTheirs)
{
    std::vector<ChartPoint> points;
    for (int i = 0; i < 200; ++i)
        for (int k = 0; k < 200; ++k) points.push_back({-25e-3 + (i + 0.5) * 0.25e-3, -25e-3 + (k + 0.5) * 0.25e-3});
    const NodeField share = shareOf(64, points, 0.25e-3);
    EXPECT_NEAR(areaOf(share) / (50e-3 * 50e-3), 1, 0.01);
}

} // namespace
} // namespace palp
