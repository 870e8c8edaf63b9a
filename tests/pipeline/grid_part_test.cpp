#include "engine/pipeline/detail/grid_part.h"

#include <algorithm>
#include <utility>

#include <gtest/gtest.h>

namespace palp {
namespace {

/// A sheet that covers the middle of a grid, of which all is solved for.
struct Covered {
    PlateGrid grid{64, 64, 1e-3, 1e-3};
    Patch     patch;
    Shell     shell;

    Covered()
    {
        const NodeField none(grid);
        patch.plate   = {grid, {}, 0.3, 0, NodeField(grid, 1e-4)};
        patch.covered = none;
        for (int i = 10; i <= 54; ++i)
            for (int j = 10; j <= 54; ++j) patch.covered(i, j) = 1;
        shell = {patch.plate, NodeField(grid, 1e-3), {}, none, none, none, none, {}, {}};
    }
    /// Returns the sum of the bed that is left of a bed of 1 at some nodes, and the edges that go with it.
    template <class Where>
    std::pair<double, PlateEdges> bedOf(const Where& where)
    {
        for (int i = 0; i <= 64; ++i)
            for (int j = 0; j <= 64; ++j) shell.stressBed(i, j) = where(i, j) ? 1 : 0;
        const Shell part = GridPart(patch).of(shell);
        double      sum  = 0;
        for (const double bed : part.stressBed.values()) sum += bed;
        return {sum, part.stressEdges};
    }
};

/// Such a bed holds no linear stress function, and the shell was refused with advice about sides.
TEST(GridPart, OfABedInACornerAloneNothingIsLeft)
{
    Covered sheet;
    const auto [corner, free] = sheet.bedOf([](int i, int j) { return i == 64 && j == 64; });
    EXPECT_EQ(corner, 0);
    EXPECT_EQ(free, (PlateEdges{Edge::free, Edge::free, Edge::free, Edge::free}));
    const auto [corners, three] = sheet.bedOf([](int i, int j) { return i + j == 0 || (i + j == 64 && i * j == 0); });
    EXPECT_GT(corners, 0) << "three hold it";
    EXPECT_EQ(three, free);
    const auto [border, clamped] = sheet.bedOf([](int i, int j) { return std::min({i, j, 64 - i, 64 - j}) < 8; });
    EXPECT_GT(border, 1000);
    EXPECT_EQ(clamped, PlateEdges{});
}

} // namespace
} // namespace palp
