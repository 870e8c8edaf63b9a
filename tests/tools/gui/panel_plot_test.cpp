#include "engine/tools/gui/panel_plot.h"

#include <limits>

#include <gtest/gtest.h>

namespace palp {
namespace {

TEST(PanelPlot, AxesEndAtRoundNumbers)
{
    EXPECT_DOUBLE_EQ(roundEnd(0.7, 0.05), 1);
    EXPECT_DOUBLE_EQ(roundEnd(1, 0.05), 1);
    EXPECT_DOUBLE_EQ(roundEnd(1.01, 0.05), 2);
    EXPECT_DOUBLE_EQ(roundEnd(2.6, 0.05), 3);
    EXPECT_DOUBLE_EQ(roundEnd(31, 0.05), 50);
    EXPECT_DOUBLE_EQ(roundEnd(7e-4, 1e-9), 1e-3);
}

TEST(PanelPlot, AxesNeverEndBelowTheLeast)
{
    EXPECT_DOUBLE_EQ(roundEnd(0, 0.05), 0.05);
    EXPECT_DOUBLE_EQ(roundEnd(-3, 0.05), 0.05);
    EXPECT_DOUBLE_EQ(roundEnd(std::numeric_limits<double>::infinity(), 0.05), 0.05);
    EXPECT_DOUBLE_EQ(roundEnd(std::numeric_limits<double>::quiet_NaN(), 0.05), 0.05);
}

} // namespace
} // namespace palp
