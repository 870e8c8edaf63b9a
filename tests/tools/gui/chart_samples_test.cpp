#include "engine/tools/gui/chart_samples.h"

#include <gtest/gtest.h>

namespace palp {
namespace {

NodeField linear(int nodesX, int nodesZ)
{
    NodeField field(nodesX, nodesZ);
    for (int i = 0; i < nodesX; ++i)
        for (int j = 0; j < nodesZ; ++j) field(i, j) = 3.0 * i / (nodesX - 1) - 2.0 * j / (nodesZ - 1);
    return field;
}

TEST(ChartSamples, ASmallFieldStaysAsItIs)
{
    const NodeField    field   = linear(33, 21);
    const ChartSamples samples = chartSamples(field, 2);

    ASSERT_EQ(samples.nodesX, 33);
    ASSERT_EQ(samples.nodesZ, 21);
    for (int i = 0; i < 33; ++i)
        for (int j = 0; j < 21; ++j) ASSERT_EQ(samples.at(i, j), 2 * field(i, j));
}

TEST(ChartSamples, ALargeOneIsAveragedWhereItIs)
{
    for (const int nodes : {51, 97, 257, 1025}) {
        const ChartSamples samples = chartSamples(linear(nodes, 21), 1);

        ASSERT_EQ(samples.nodesX, 49);
        for (int i = 0; i < 49; ++i)
            for (int j = 0; j < 21; ++j)
                // Half a cell of the small picture: at its ends it averages over one side only.
                ASSERT_NEAR(samples.at(i, j), 3.0 * i / 48 - 2.0 * j / 20, 3.0 / 48 / 2) << nodes << " nodes";
    }
}

} // namespace
} // namespace palp
