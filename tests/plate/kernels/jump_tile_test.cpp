#include <algorithm>

#include "compute_shaders/shared/tile_layout.h"
#include "tests/plate/kernels/plate_shader_test.h"

// Tests of tiles in which the rigidity jumps: jump_mark.comp, jump_list.comp, plate_relax_tile.comp,
// plate_copy_tile.comp.

namespace palp {
namespace {

using shared::kTile;

constexpr std::uint32_t kUntouched = 0xFFFFFFFFu;

std::size_t tilesOf(const shared::PlateLevel& g)
{
    return std::size_t(shared::tilesX(g)) * std::size_t(shared::tilesZ(g));
}

int tileOf(const shared::PlateLevel& g, int i, int j)
{
    return i / kTile * shared::tilesZ(g) + j / kTile;
}

/// From the nodes to the tiles, where the shader goes from the tiles to the nodes.
std::vector<std::uint32_t> expectedMarks(const RoughLevel& level)
{
    const shared::PlateLevel&  g  = level.g;
    const auto                 at = [&](int i, int j) { return level.rigidity[std::size_t(i * (g.cellsZ + 1) + j)]; };
    std::vector<std::uint32_t> marks(tilesOf(g), 0);
    for (int i = 0; i <= g.cellsX; ++i)
        for (int j = 0; j <= g.cellsZ; ++j) {
            bool jumps = false; // against any two of the nodes around
            for (int a = std::max(0, i - 1); a <= std::min(g.cellsX, i + 1); ++a)
                for (int b = std::max(0, j - 1); b <= std::min(g.cellsZ, j + 1); ++b)
                    for (int c = std::max(0, i - 1); c <= std::min(g.cellsX, i + 1); ++c)
                        for (int d = std::max(0, j - 1); d <= std::min(g.cellsZ, j + 1); ++d)
                            jumps = jumps || at(a, b) > 3 * at(c, d);
            if (!jumps) continue;
            for (int a = std::max(0, i - 1); a <= std::min(g.cellsX, i + 1); ++a)
                for (int b = std::max(0, j - 1); b <= std::min(g.cellsZ, j + 1); ++b)
                    marks[std::size_t(tileOf(g, a, b))] = 1;
        }
    return marks;
}

class JumpTileTest : public PlateShaderTest {
protected:
    /// Larger than the other tests' plates, so that there are tiles without a jump; the block of 1000 reaches a side.
    static std::vector<RoughLevel> levels()
    {
        using enum Edge;
        std::vector<RoughLevel> all{RoughLevel(onRoughBed(roughPlate(33, 26, {clamped, free, supported, clamped})))};
        if (!isSlow()) {
            all.emplace_back(roughPlate(61, 40, {clamped, clamped, clamped, clamped}));
            all.emplace_back(roughPlate(4, 5, {supported, supported, supported, supported}));
        }
        return all;
    }

    /// Every third tile, the last ones included, which are cut off by the sides.
    static std::vector<std::uint32_t> someTiles(const shared::PlateLevel& g)
    {
        std::vector<std::uint32_t> list{0};
        for (std::size_t n = 0; n < tilesOf(g); ++n)
            if (n % 3 == 0 || n + 1 == tilesOf(g)) list.push_back(std::uint32_t(n));
        list[0] = std::uint32_t(list.size() - 1);
        return list;
    }

    static bool isListed(const std::vector<std::uint32_t>& list, const shared::PlateLevel& g, int i, int j)
    {
        return std::find(list.begin() + 1, list.end(), std::uint32_t(tileOf(g, i, j))) != list.end();
    }
};

TEST_F(JumpTileTest, TilesAreMarkedWhereTheRigidityJumpsInThemOrBesideThem)
{
    for (const compute::Workgroup shape : tiles()) {
        const compute::Kernel mark(context(), kernels::jumpMark(), shape);
        for (const RoughLevel& level : levels()) {
            std::vector<std::uint32_t> marks(tilesOf(level.g));
            dispatchOnce(
                mark, {in(level.rigidity), out(marks)}, shared::LevelPush{level.g},
                mark.groupsOver(std::uint32_t(shared::tilesZ(level.g)), std::uint32_t(shared::tilesX(level.g))));
            EXPECT_EQ(marks, expectedMarks(level)) << describe(shape);
            EXPECT_NE(std::count(marks.begin(), marks.end(), 1U), 0);
        }
    }
}

TEST_F(JumpTileTest, TheListHoldsTheMarkedTilesInTheirOrder)
{
    for (const compute::Workgroup shape : lines()) {
        const compute::Kernel listing(context(), kernels::jumpList(), shape);
        for (const RoughLevel& level : levels())
            for (const bool none : {false, true}) {
                std::vector<std::uint32_t> marks = expectedMarks(level), expected(1 + tilesOf(level.g), kUntouched);
                if (none) std::fill(marks.begin(), marks.end(), 0);
                std::vector<std::uint32_t> list = expected;
                expected[0]                     = 0;
                for (std::size_t n = 0; n < marks.size(); ++n)
                    if (marks[n] == 1) expected[++expected[0]] = std::uint32_t(n);
                dispatchOnce(listing, {in(marks), inOut(list)}, shared::LevelPush{level.g}, {1, 1, 1});
                EXPECT_EQ(list, expected) << describe(shape);
            }
    }
}

TEST_F(JumpTileTest, ListedTilesAreRelaxedAsideAndTheRestStaysAsItWas)
{
    const compute::Kernel relax(context(), kernels::relaxTile(), {kTile, kTile, 1});
    for (const RoughLevel& level : levels())
        for (const unsigned colour : {0U, 1U}) {
            const std::vector<std::uint32_t> list = someTiles(level.g);
            host::HalfSweep                  fields;
            fields.inverseDivisor       = host::inverseDivisor(level.g, level.rigidity);
            fields.same                 = roughDeflection<float>(level.g, kLoads, 21);
            fields.other                = fields.same;
            fields.force                = roughValues<float>(fields.same.size(), 22);
            fields.after                = roughValues<float>(fields.same.size(), 23);
            std::vector<float> expected = host::relaxed(level, fields, colour), aside = fields.after;
            const std::size_t  nodes = nodesOf(level.g);
            for (std::size_t n = 0; n < expected.size(); ++n) {
                const int i = int(n % nodes) / (level.g.cellsZ + 1), j = int(n % nodes) % (level.g.cellsZ + 1);
                if (!isListed(list, level.g, i, j)) expected[n] = fields.after[n];
            }
            dispatchOnce(relax,
                         {in(level.rigidity), in(fields.inverseDivisor), in(fields.force), in(fields.same), in(list),
                          inOut(aside)},
                         shared::RelaxPush{level.g, colour}, {list[0], 1, kLoads});
            EXPECT_TRUE(agree(aside, expected, {4096, "cancellation in sums of 60 terms that a driver may reorder"}));
        }
}

TEST_F(JumpTileTest, WhatWasRelaxedAsideIsTakenOverNodeByNode)
{
    const compute::Kernel copy(context(), kernels::copyTile(), {kTile, kTile, 1});
    for (const RoughLevel& level : levels())
        for (const unsigned colour : {0U, 1U}) {
            const std::vector<std::uint32_t> list  = someTiles(level.g);
            const std::vector<float>         aside = roughValues<float>(kLoads * nodesOf(level.g), 24);
            std::vector<float>               w = roughValues<float>(aside.size(), 25), expected = w;
            const std::size_t                nodes = nodesOf(level.g);
            for (std::size_t n = 0; n < expected.size(); ++n) {
                const int i = int(n % nodes) / (level.g.cellsZ + 1), j = int(n % nodes) % (level.g.cellsZ + 1);
                if (isListed(list, level.g, i, j) && (unsigned(i + j) & 1U) == colour) expected[n] = aside[n];
            }
            dispatchOnce(copy, {in(list), in(aside), inOut(w)}, shared::RelaxPush{level.g, colour},
                         {list[0], 1, kLoads});
            EXPECT_EQ(w, expected);
        }
}

} // namespace
} // namespace palp
