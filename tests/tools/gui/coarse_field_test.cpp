#include "engine/tools/gui/coarse_field.h"

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

TEST(CoarseField, ASmallFieldStaysAsItIs)
{
    const NodeField   field  = linear(33, 21);
    const CoarseField coarse = coarseField(field, 2);

    ASSERT_EQ(coarse.nodesX, 33);
    ASSERT_EQ(coarse.nodesZ, 21);
    for (int i = 0; i < 33; ++i)
        for (int j = 0; j < 21; ++j) ASSERT_EQ(coarse.at(i, j), 2 * field(i, j));
}

TEST(CoarseField, ALargeOneIsAveragedWhereItIs)
{
    for (const int nodes : {51, 97, 257, 1025}) {
        const CoarseField coarse = coarseField(linear(nodes, 21), 1);

        ASSERT_EQ(coarse.nodesX, 49);
        for (int i = 0; i < 49; ++i)
            for (int j = 0; j < 21; ++j)
                // Half a cell of the small picture: at its ends it averages over one side only.
                ASSERT_NEAR(coarse.at(i, j), 3.0 * i / 48 - 2.0 * j / 20, 3.0 / 48 / 2) << nodes << " nodes";
    }
}

} // namespace
} // namespace palp
