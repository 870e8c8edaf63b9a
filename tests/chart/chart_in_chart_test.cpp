#include "engine/chart/chart_in_chart.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <span>
#include <vector>

#include <gtest/gtest.h>

namespace palp {
namespace {

ChartPoint bent(const ChartPoint& p)
{
    return {2e-3 + 0.8 * p.x - 0.6 * p.z + 3 * p.x * p.z, -1e-3 + 0.6 * p.x + 0.8 * p.z - 5 * p.z * p.z};
}

std::vector<PlaceInBoth> placesOf(const std::function<ChartPoint(const ChartPoint&)>& other, int along = 4)
{
    std::vector<PlaceInBoth> places;
    for (int i = -4; i <= 4; ++i)
        for (int j = -along; j <= along; ++j) {
            const ChartPoint own{2e-3 * i, 2e-3 * j};
            places.push_back({own, other(own), 1.0 / (1 + i * i)});
        }
    return places;
}

TEST(ChartInChart, IsExactToTheSecondOrder)
{
    const auto lies = ChartInChart::fitted(placesOf(bent), 12e-3);
    ASSERT_TRUE(lies);
    const ChartPoint at = lies->at({3e-3, -5e-3}), truth = bent({3e-3, -5e-3});
    EXPECT_NEAR(at.x, truth.x, 1e-15);
    EXPECT_NEAR(at.z, truth.z, 1e-15);
    EXPECT_NEAR(lies->stretchAt({}), 0, 1e-12) << "it is turned only";
    const ChartPoint there{4e-3, 6e-3}; // the Jacobian by differences, its singular values by its invariants
    const double     d = 1e-7, xx = (bent({there.x + d, there.z}).x - bent(there).x) / d,
                 xz      = (bent({there.x, there.z + d}).x - bent(there).x) / d,
                 zx      = (bent({there.x + d, there.z}).z - bent(there).z) / d,
                 zz      = (bent({there.x, there.z + d}).z - bent(there).z) / d;
    const double squares = xx * xx + xz * xz + zx * zx + zz * zz, det = xx * zz - xz * zx;
    const double larger = std::sqrt((squares + std::sqrt(squares * squares - 4 * det * det)) / 2);
    EXPECT_NEAR(lies->stretchAt(there), std::max(larger - 1, std::abs(det / larger - 1)), 1e-5);
    EXPECT_LT(lies->misfit(), 1e-15);
}

TEST(ChartInChart, TellsHowLengthsAreOff)
{
    const auto lies = ChartInChart::fitted(placesOf([](const ChartPoint& p) {
                                               return ChartPoint{1.04 * p.x, p.z / 1.04};
                                           }),
                                           12e-3);
    EXPECT_NEAR(lies->stretchAt({}), 0.04, 1e-12);
    const auto mirrored = ChartInChart::fitted(placesOf([](const ChartPoint& p) {
                                                   return ChartPoint{-p.x, p.z};
                                               }),
                                               12e-3);
    EXPECT_TRUE(std::isinf(mirrored->stretchAt({})));
    const auto torn = ChartInChart::fitted(placesOf([](const ChartPoint& p) {
                                               return ChartPoint{p.x + (p.x > 1e-3 ? 2e-3 : 0), p.z};
                                           }),
                                           12e-3);
    EXPECT_GT(torn->misfit(), 2e-4);
}

TEST(ChartInChart, IsNoneOfPlacesAlongALineOrOfFew)
{
    EXPECT_FALSE(ChartInChart::fitted(placesOf(bent, 0), 12e-3));
    const auto many = placesOf(bent);
    EXPECT_FALSE(ChartInChart::fitted(std::span(many).first(11), 12e-3));
}

} // namespace
} // namespace palp
