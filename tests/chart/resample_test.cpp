#include "engine/chart/resample.h"

#include "engine/chart/detail/log_mean.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include <gtest/gtest.h>

#include "tests/support/errors.h"

namespace palp {
namespace {

struct Scatter {
    std::vector<ChartPoint> positions;
    std::vector<double>     rigidities;
    double                  spacing; ///< [m]
};

/// Random points over a square somewhat larger than the window.
template <class Rigidity>
Scatter scatter(double size, std::size_t points, unsigned seed, Rigidity rigidity)
{
    std::mt19937_64                        bits(seed);
    std::uniform_real_distribution<double> place(-0.6 * size, 0.6 * size);
    Scatter                                s{{}, {}, 1.2 * size / std::sqrt(double(points))};
    for (std::size_t n = 0; n < points; ++n) {
        s.positions.push_back({place(bits), place(bits)});
        s.rigidities.push_back(rigidity(s.positions.back()));
    }
    return s;
}

ChartPoint nodeOf(const PatchWindow& window, int i, int j)
{
    return {window.corner.x + i * window.grid.spacingX, window.corner.z + j * window.grid.spacingZ};
}

TEST(Resample, ContactIsTheMiddleNode)
{
    const PatchWindow window = PatchWindow::square(0.03, 48);
    const ChartPoint  middle = nodeOf(window, 24, 24);
    EXPECT_NEAR(middle.x, 0, 1e-17) << "rounding of 0.03 / 48 * 24";
    EXPECT_NEAR(middle.z, 0, 1e-17);
    EXPECT_THROW((void)PatchWindow::square(0.03, 47), ContractViolation);
}

TEST(Resample, RefusesWindowsAndPointsThatAreNone)
{
    EXPECT_NO_THROW(static_cast<void>(PatchWindow::square(0.02, 2)));
    EXPECT_THROW(static_cast<void>(PatchWindow::square(0.02, 1)), ContractViolation);
    EXPECT_THROW(static_cast<void>(PatchWindow::square(0.02, 3)), ContractViolation);
    EXPECT_THROW(static_cast<void>(PatchWindow::square(0, 2)), ContractViolation);
    const PatchWindow             window = PatchWindow::square(0.02, 4);
    const std::vector<ChartPoint> two{{0, 0}, {1e-3, 0}};
    const std::vector<double>     one{1.0};
    for (const auto rule : {Resampling::logMean, Resampling::nearest}) {
        EXPECT_THROW(static_cast<void>(resampleRigidity(window, two, one, rule, 1e-3, 1e-3)), ContractViolation);
        EXPECT_THROW(static_cast<void>(resampleRigidity(window, {}, {}, rule, 1e-3, 1e-3)), ContractViolation);
    }
}

TEST(Resample, TheNearestPlaceOfAWindowIsHeldByIt)
{
    const PatchWindow window{{24, 30, 1.0 / 24, 0.9 / 30}, {-0.5, -0.45}};
    EXPECT_EQ(window.nearest({0.2, -0.3}).x, 0.2);
    EXPECT_EQ(window.nearest({0.2, -0.3}).z, -0.3);
    for (const double x : {-0.7, 0.1, 0.9})
        for (const double z : {-2.0, 0.0, 0.5}) {
            const ChartPoint inside = window.nearest({x, z});
            EXPECT_TRUE(window.holds(inside)) << x << ", " << z;
            EXPECT_NEAR(inside.x, std::clamp(x, -0.5, 0.5), 1e-15) << "rounding of the side";
            EXPECT_NEAR(inside.z, std::clamp(z, -0.45, 0.45), 1e-15);
        }
}

TEST(Resample, AWindowHoldsItsSidesAndNothingBeyond)
{
    const PatchWindow window{{4, 8, 1, 0.25}, {-1, 2}}; // x from -1 to 3, z from 2 to 4
    EXPECT_TRUE(window.holds({1, 3}));
    for (const double x : {-1.0, 3.0})
        for (const double z : {2.0, 4.0}) EXPECT_TRUE(window.holds({x, z})) << x << ", " << z << " is a corner";
    for (const ChartPoint& outside : {ChartPoint{-1.01, 3}, {3.01, 3}, {1, 1.99}, {1, 4.01}})
        EXPECT_FALSE(window.holds(outside)) << outside.x << ", " << outside.z;
}

/// Among many others too, where no node has to look for its nearest point.
TEST(Resample, RefusesAPointThatIsNotFinite)
{
    const PatchWindow window = PatchWindow::square(0.02, 4);
    for (const std::size_t count : {3U, 2000U})
        for (const auto rule : {Resampling::logMean, Resampling::nearest})
            for (const double bad : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()})
                for (const ChartPoint& point : {ChartPoint{bad, 0}, {0, bad}}) {
                    Scatter s = scatter(0.02, count, 7, [](const ChartPoint&) { return 1.0; });
                    EXPECT_NO_THROW(static_cast<void>(resampleRigidity(window, s.positions, s.rigidities, rule, 1e-3)));
                    s.positions[1] = point;
                    EXPECT_THROW(static_cast<void>(resampleRigidity(window, s.positions, s.rigidities, rule, 1e-3)),
                                 ContractViolation);
                }
}

TEST(Resample, HomogeneousCloudGivesTheSameRigidityEverywhereUnderBothRules)
{
    const PatchWindow window = PatchWindow::square(0.03, 48);
    const Scatter     s      = scatter(0.03, 900, 1, [](const ChartPoint&) { return 2.7e-3; });
    for (Resampling rule : {Resampling::logMean, Resampling::nearest}) {
        const Resampled r = resampleRigidity(window, s.positions, s.rigidities, rule, s.spacing);
        for (double d : r.rigidity.values()) EXPECT_NEAR(d / 2.7e-3, 1, 1e-13) << "exp and log of one number, ln D ~ 6";
    }
}

TEST(Resample, NearestTakesTheValueOfTheNearestPoint)
{
    const PatchWindow window = PatchWindow::square(1, 10);
    const Scatter     s      = scatter(1, 57, 2, [](const ChartPoint& p) { return 2 + p.x + p.z * p.z; });
    const Resampled   r      = resampleRigidity(window, s.positions, s.rigidities, Resampling::nearest, s.spacing);
    for (int i = 0; i <= 10; ++i)
        for (int j = 0; j <= 10; ++j) {
            const ChartPoint node = nodeOf(window, i, j);
            std::size_t      best = 0;
            for (std::size_t n = 1; n < s.positions.size(); ++n)
                if (std::hypot(s.positions[n].x - node.x, s.positions[n].z - node.z) <
                    std::hypot(s.positions[best].x - node.x, s.positions[best].z - node.z))
                    best = n;
            EXPECT_EQ(r.rigidity(i, j), s.rigidities[best]);
        }
}

/// The formula of the docstring, summed node by node instead of point by point: where a point reaches many nodes, where
/// it reaches 4 x 4, and with rigidities far from 1.
TEST(Resample, LogMeanIsTheGaussianMeanOfTheLogarithm)
{
    for (const std::size_t points : {400, 6000})
        for (const double unit : {1.0, 1e-290}) {
            const PatchWindow window = PatchWindow::square(1, 12);
            const auto        law    = [&](const ChartPoint& p) { return (p.x > 0.1 ? 50.0 : 0.5) * unit; };
            const Scatter     s      = scatter(1, points, 3, law);
            const Resampled   r = resampleRigidity(window, s.positions, s.rigidities, Resampling::logMean, s.spacing);
            const double      width = std::max(s.spacing, 0.5 / 12);
            for (int i = 0; i <= 12; ++i)
                for (int j = 0; j <= 12; ++j) {
                    const ChartPoint node    = nodeOf(window, i, j);
                    double           weights = 0, logs = 0;
                    for (std::size_t n = 0; n < s.positions.size(); ++n) {
                        const double dx = s.positions[n].x - node.x, dz = s.positions[n].z - node.z;
                        if (std::max(std::abs(dx), std::abs(dz)) > 4 * width) continue;
                        const double w = std::exp(-(dx * dx + dz * dz) / (2 * width * width));
                        weights += w;
                        logs += w * std::log(s.rigidities[n]);
                    }
                    EXPECT_NEAR(std::log(r.rigidity(i, j)) - logs / weights, 0, 1e-12)
                        << "another order of the same sum";
                }
        }
}

/// Close together on one side, five times farther apart in the middle and none beyond: each node has the mean over the
/// smallest of the squares, doubled and doubled up to that of the sparsest, in which there is a point; beyond it is the
/// nearest one.
TEST(Resample, WherePointsAreFarApartTheMeanIsOverTheNextLargerSquare)
{
    const PatchWindow window{{24, 30, 1.0 / 24, 0.9 / 30}, {-0.5, -0.45}};
    const double      close = 0.02, sparsest = 5.5 * close, cell = window.grid.spacingX;
    Scatter           s   = scatter(1, 2500, 6, [](const ChartPoint& p) { return std::exp(3 * p.x + 5 * p.z * p.z); });
    std::size_t       far = 0;
    std::erase_if(s.positions, [&](const ChartPoint& p) { return p.x > 0 || (p.x > -0.25 && ++far % 25 != 0); });
    s.rigidities.clear();
    for (const ChartPoint& p : s.positions) s.rigidities.push_back(std::exp(3 * p.x + 5 * p.z * p.z));

    const Resampled r = resampleRigidity(window, s.positions, s.rigidities, Resampling::logMean, close, sparsest);

    const double first = std::max(close, cell / 2);
    std::size_t  filled[5]{}; // by the square that had a point, the last by the nearest one
    for (int i = 0; i <= 24; ++i)
        for (int j = 0; j <= 30; ++j) {
            const ChartPoint node    = nodeOf(window, i, j);
            double           weights = 0, logs = 0, nearest = 1e9, expected = 0;
            std::size_t      square = 0;
            for (const double width : {first, 2 * first, 4 * first, sparsest}) {
                for (std::size_t n = 0; n < s.positions.size(); ++n) {
                    const double dx = s.positions[n].x - node.x, dz = s.positions[n].z - node.z;
                    if (const double d = std::hypot(dx, dz); d < nearest) {
                        nearest  = d;
                        expected = s.rigidities[n];
                    }
                    if (std::max(std::abs(dx), std::abs(dz)) > 4 * width) continue;
                    const double w = std::exp(-(dx * dx + dz * dz) / (2 * width * width));
                    weights += w;
                    logs += w * std::log(s.rigidities[n]);
                }
                if (weights > 0) break;
                ++square;
            }
            if (weights > 0) expected = std::exp(logs / weights);
            EXPECT_NEAR(r.rigidity(i, j) / expected, 1, 1e-11) << i << ", " << j << ": another order of the same sum";
            ++filled[square];
        }
    for (std::size_t square = 0; square < 5; ++square) EXPECT_GT(filled[square], 0u) << square;
}

/// Dense points, whose squares hold 4 x 4 nodes, sparse ones, whose squares hold more, and points with a hole; one, two
/// and three quantities.
TEST(Resample, SeveralQuantitiesAreEachWhatTheyWouldBeAlone)
{
    const PatchWindow window = PatchWindow::square(0.03, 32);
    for (const std::size_t points : {40'000, 900, 60})
        for (const Resampling rule : {Resampling::logMean, Resampling::nearest})
            for (const std::size_t quantities : {1, 2, 3}) {
                Scatter s = scatter(0.03, points, 4, [](const ChartPoint& p) { return 1 + 9 * (p.x > 0.004); });
                if (points == 900) std::erase_if(s.positions, [](const ChartPoint& p) { return p.x * p.x < 1e-5; });
                std::vector<std::vector<double>> own(quantities, std::vector<double>(s.positions.size()));
                for (std::size_t v = 0; v < quantities; ++v)
                    for (std::size_t n = 0; n < own[v].size(); ++n)
                        own[v][n] =
                            std::exp(double(v + 1) * std::sin(400 * (s.positions[n].x + double(v) * s.positions[n].z)));
                const std::vector<PointValues> values(own.begin(), own.end());
                const auto together = resampleAll(window, s.positions, values, rule, s.spacing, 2 * s.spacing);
                ASSERT_EQ(together.size(), quantities);
                for (std::size_t v = 0; v < quantities; ++v) {
                    const Resampled alone =
                        resampleRigidity(window, s.positions, own[v], rule, s.spacing, 2 * s.spacing);
                    EXPECT_EQ(together[v].rigidity.values(), alone.rigidity.values()) << points << " points, " << v;
                    EXPECT_EQ(together[v].nodesWithoutPoint, alone.nodesWithoutPoint);
                }
            }
}

/// Registers of two, four and eight numbers: squares of 4 x 4 nodes, of some 12 that begin anywhere in a register, and
/// of so many that a point's factors do not stay in registers.
TEST(Resample, EveryInstructionSetGivesTheSameBits)
{
    for (const int cells : {18, 64, 200})
        for (const std::size_t quantities : {1, 2}) {
            const PatchWindow window = PatchWindow::square(0.03, cells);
            const Scatter     s = scatter(0.03, 4000, 5, [](const ChartPoint& p) { return 2 + std::sin(300 * p.x); });
            const std::vector<PointValues> values(quantities, PointValues(s.rigidities));
            const double        width = std::max(cells == 200 ? 3 * s.spacing : s.spacing, 0.5 * window.grid.spacingX);
            const LogMeanSums   portable(window, s.positions, values, width, Instructions::portable);
            std::vector<double> expected(std::size_t(cells + 1)), found(expected);
            for (const Instructions with : logMeanInstructions()) {
                const LogMeanSums sums(window, s.positions, values, width, with);
                for (int i = 0; i <= cells; ++i) {
                    portable.means(i, quantities - 1, expected);
                    sums.means(i, quantities - 1, found);
                    ASSERT_EQ(found, expected) << cells << " cells, row " << i << ", set " << int(with);
                }
            }
        }
}

/// Why the kernel is the default: move the window over the same points and watch one place of the object.
TEST(Resample, LogMeanJittersLessThanNearestWhileTheGridSlides)
{
    const Scatter s      = scatter(1, 2000, 4, [](const ChartPoint& p) { return std::exp(2.3 * std::tanh(8 * p.x)); });
    const auto    jitter = [&](Resampling rule) {
        double most = 0, last = 0;
        for (int step = 0; step <= 40; ++step) {
            PatchWindow window = PatchWindow::square(0.8, 24);
            window.corner.z += 1e-3 * step; // along the level lines of D: the object itself stays the same
            const double d = resampleRigidity(window, s.positions, s.rigidities, rule, s.spacing).rigidity(14, 12);
            if (step) most = worse(most, std::log(d / last));
            last = d;
        }
        return most;
    };
    EXPECT_LT(jitter(Resampling::logMean), 0.02) << "a kernel of one spacing is smooth: 1 mm of 27 changes little";
    EXPECT_GT(jitter(Resampling::nearest), 0.05) << "else the fixture has no step to feel";
}

TEST(Resample, PointsMatterAsFarAsTheKernelReaches)
{
    const PatchWindow window = PatchWindow::square(1, 20);
    Scatter           s      = scatter(1, 3000, 5, [](const ChartPoint&) { return 1.0; });
    const double      reach  = kernelReach(s.spacing, window.grid.spacingX);
    const auto        edge   = [&](double beyond) {
        s.positions.back()  = {0.5 + beyond, 0};
        s.rigidities.back() = 100;
        return resampleRigidity(window, s.positions, s.rigidities, Resampling::logMean, s.spacing).rigidity(20, 10);
    };
    EXPECT_GT(edge(0.99 * reach), 1 + 1e-6) << "a weight of 4e-4 among some ten";
    EXPECT_NEAR(edge(1.01 * reach), 1, 1e-12) << "rounding";
}

/// Means over cells, on a grid of cells a little larger than the nodes', smooth a step as their points do: the log-mean
/// of those with its own Gaussian, of which each mean has done a part. Of a cosine of six nodes, which the Gaussian
/// alone would leave exp(-2 (pi s / 6 h)^2) of.
TEST(Resample, MeansSmoothAsThePointsThatTheyStandFor)
{
    constexpr int     kCells = 48, kInEach = 12;
    const PatchWindow window = PatchWindow::square(1, kCells);
    const double      h      = window.grid.spacingX;
    const auto law = [&](const ChartPoint& p) { return std::exp(std::cos(2 * std::numbers::pi * p.x / (6 * h))); };
    for (const double spacing : {0.7, 0.85, 1.0}) { // [h] of the means
        const int  many  = int(std::ceil(1.4 / (spacing * h)));
        const auto place = [&](int k, int parts) { return (k + 0.37) * spacing * h / parts - 0.7; };
        Scatter    all{{}, {}, spacing * h / kInEach}, means{{}, {}, spacing * h};
        for (int i = 0; i < many; ++i)
            for (int j = 0; j < many; ++j) {
                double sum = 0;
                for (int k = 0; k < kInEach; ++k) sum += std::log(law({place(kInEach * i + k, kInEach), 0})) / kInEach;
                const double middle = (kInEach - 1) / 2.0;
                means.positions.push_back({place(kInEach * i, kInEach) + middle * all.spacing, place(j, 1)});
                means.rigidities.push_back(std::exp(sum));
                for (int k = 0; k < kInEach; ++k)
                    for (int l = 0; l < 3; ++l) {
                        all.positions.push_back({place(kInEach * i + k, kInEach), place(3 * j + l, 3)});
                        all.rigidities.push_back(law(all.positions.back()));
                    }
            }
        const auto of = [&](const Scatter& s, Sampling sampling) {
            return resampleRigidity(window, s.positions, s.rigidities, Resampling::logMean, s.spacing, 0, sampling);
        };
        const Resampled whole = of(all, Sampling::places), right = of(means, Sampling::means),
                        wide = of(means, Sampling::places);
        double off = 0, offWide = 0; // [1] of the logarithm
        for (int i = 8; i < kCells - 8; ++i) {
            const double truth = std::log(whole.rigidity(i, 24));
            off                = worse(off, std::log(right.rigidity(i, 24)) - truth);
            offWide            = std::max(offWide, std::abs(std::log(wide.rigidity(i, 24)) - truth));
        }
        EXPECT_LT(off, 0.04) << spacing
                             << ": of an amplitude of 1, of which the Gaussian leaves 0.87; 0.034 where the "
                                "means' distance keeps theirs wide";
        EXPECT_GT(offWide, 3 * off) << spacing;
        EXPECT_EQ(right.nodesWithoutPoint, 0u);
    }
}

TEST(Resample, HolesAndBordersAreCountedAndFilledFromTheNearestPoint)
{
    const PatchWindow window = PatchWindow::square(1, 20);
    const auto        law    = [](const ChartPoint& p) { return p.x < 0 ? 1.0 : 2.0; };
    Scatter           s      = scatter(1, 3000, 5, law);
    const auto        count  = [&] {
        return resampleRigidity(window, s.positions, s.rigidities, Resampling::logMean, s.spacing).nodesWithoutPoint;
    };
    EXPECT_EQ(count(), 0u) << "the cloud covers the window";

    const auto removeWhere = [&](auto inside) {
        Scatter kept{{}, {}, s.spacing};
        for (std::size_t n = 0; n < s.positions.size(); ++n)
            if (!inside(s.positions[n])) {
                kept.positions.push_back(s.positions[n]);
                kept.rigidities.push_back(s.rigidities[n]);
            }
        s = kept;
    };
    removeWhere([](const ChartPoint& p) { return std::hypot(p.x + 0.2, p.z) < 0.15; });
    const std::size_t hole = count();
    EXPECT_GT(hole, 5u);
    EXPECT_LT(hole, 29u) << "29 nodes lie within 0.15 of the hole's middle";

    removeWhere([](const ChartPoint& p) { return p.x > 0.2; });
    const Resampled r = resampleRigidity(window, s.positions, s.rigidities, Resampling::logMean, s.spacing);
    EXPECT_GT(r.nodesWithoutPoint, hole + 20 * 4) << "at least four rows of 21 nodes lie beyond the border";
    EXPECT_NEAR(r.rigidity(20, 10), 2, 1e-12) << "filled from the border, where D is 2";
}

/// What is covered at a glance and what only distances tell, node by node: coarse and fine grids over clouds that leave
/// anything from nothing to most of the nodes bare.
TEST(Resample, NodesWithoutPointAreThoseThatTheDistancesTell)
{
    std::size_t bare = 0, covered = 0;
    for (const int cells : {4, 12, 31, 60})
        for (const std::size_t points : {2, 9, 40, 150, 1500}) {
            const PatchWindow window{{cells, cells + 3, 1.0 / cells, 1.1 / cells}, {-0.5, -0.5}};
            const Scatter     s = scatter(1, points, unsigned(points), [](const ChartPoint&) { return 1.0; });
            for (const double spacing : {0.6 * s.spacing, s.spacing}) {
                const double nearby   = 2.5 * std::max(spacing, window.grid.spacingZ / 2);
                std::size_t  expected = 0;
                for (int i = 0; i < window.grid.nodesX(); ++i)
                    for (int j = 0; j < window.grid.nodesZ(); ++j) {
                        const ChartPoint node = nodeOf(window, i, j);
                        expected += std::none_of(s.positions.begin(), s.positions.end(), [&](const ChartPoint& p) {
                            return std::hypot(p.x - node.x, p.z - node.z) <= nearby;
                        });
                    }
                const Resampled r = resampleRigidity(window, s.positions, s.rigidities, Resampling::logMean, spacing);
                EXPECT_EQ(r.nodesWithoutPoint, expected) << cells << " cells, " << points << " points";
                ++(expected > 0 ? bare : covered);
            }
        }
    EXPECT_GT(bare, 5u);
    EXPECT_GT(covered, 5u);
}

} // namespace
} // namespace palp
