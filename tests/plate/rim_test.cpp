#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "compute_shaders/shared/plate_push.h"
#include "compute_shaders/shared/tile_layout.h"
#include "engine/plate/host/host_kernels.h"
#include "engine/plate/multigrid/detail/grid_hierarchy.h"
#include "engine/plate/multigrid/detail/rim.h"
#include "tests/plate/kernels/plate_fields.h"
#include "tests/support/errors.h"

// The exact correction at rims, as a map from forces to deflections, against the operator's own kernel.

namespace palp {
namespace {

using shared::LevelPush;
using shared::PlateLevel;

/// A soft plate with two stiff discs, one of which lies in its own rim.
std::vector<float> discs(const PlateLevel& g, float contrast)
{
    std::vector<float> rigidity;
    for (int i = 0; i <= g.cellsX; ++i)
        for (int j = 0; j <= g.cellsZ; ++j)
            rigidity.push_back(std::hypot(i - 18, j - 20) < 12 || std::hypot(i - 38, j - 9) < 3 ? contrast : 1);
    return rigidity;
}

/// A level with its rim, factored by the kernels of an instruction set.
struct Factored {
    PlateLevel         g;
    std::vector<float> rigidity;
    Rim                rim;
    RimView            view{};
    const HostVariant& by;
    bool               found = false, spared = false;

    Factored(const PlateEdges& edges, float contrast, bool doubles, const HostVariant& variant, double mostWork = 1e9)
        : by(variant)
    {
        const Plate plate = roughPlate(50, 41, edges);
        g                 = gridHierarchy(plate, 1).levels.front().plate;
        rigidity          = discs(g, contrast);
        std::vector<std::uint32_t> tiles{std::uint32_t(shared::tilesX(g) * shared::tilesZ(g))};
        for (std::uint32_t n = 0; n < tiles.front(); ++n) tiles.push_back(n);
        tiles.front() = std::uint32_t(tiles.size() - 1);
        found         = rim.divide(g, rigidity, tiles.data(), mostWork);
        if (!found) return;
        view               = rim.prepare(doubles);
        std::uint32_t lost = 0;
        run(by.kernels->rimFactor, {&view, rigidity.data(), &lost});
        spared = lost == 0;
    }

    void run(compute::HostKernel kernel, std::vector<void*> buffers, std::uint32_t loads = 1) const
    {
        const LevelPush push{g};
        kernel({buffers.data(), &push, nullptr, {}, {1, 1, loads}});
    }

    /// Returns the exact answer on the rim, zero elsewhere.
    [[nodiscard]] std::vector<float> solve(std::vector<float> force) const
    {
        std::vector<float> w(force.size(), 7);
        auto               rimView = view;
        run(by.kernels->rimFirst, {&rimView, force.data(), w.data()});
        return w;
    }

    [[nodiscard]] std::vector<double> apply(const std::vector<float>& w) const
    {
        std::vector<double> of(w.size() + 1), result(w.size()); // the number before a field may be read
        auto                D = rigidity;
        std::ranges::copy(w, of.begin() + 1);
        run(by.kernels->apply_f64, {D.data(), of.data() + 1, result.data()});
        return result;
    }
};

double dot(const std::vector<float>& a, const std::vector<float>& b)
{
    double sum = 0;
    for (std::size_t n = 0; n < a.size(); ++n) sum += double(a[n]) * double(b[n]);
    return sum;
}

const HostVariant& best()
{
    return hostVariants().back();
}

const std::array<PlateEdges, 2> kEdges{PlateEdges{},
                                       PlateEdges{Edge::free, Edge::clamped, Edge::supported, Edge::free}};

/// The answer is that of the operator with all other nodes held. Forces are given in floats: an island a thousand or
/// ten thousand times as stiff as what holds it feels how they are rounded.
TEST(Rim, IsSolvedExactly)
{
    for (const PlateEdges& edges : kEdges)
        for (const bool doubles : {false, true}) {
            const Factored rim(edges, doubles ? 1e4F : 1e3F, doubles, best());
            ASSERT_TRUE(rim.found && rim.spared);
            // A deflection on the rim, the forces that make it, and what the factor makes of these.
            std::vector<float> wanted(rim.rigidity.size(), 0);
            const auto         values = roughValues<float>(wanted.size(), 3);
            for (int n = 0; n < rim.view.unknowns; ++n)
                wanted[std::size_t(rim.view.nodes[n])] = values[std::size_t(rim.view.nodes[n])];
            const std::vector<double> forces = rim.apply(wanted);
            const std::vector<float>  found  = rim.solve({forces.begin(), forces.end()});
            double                    most   = 0;
            for (std::size_t n = 0; n < found.size(); ++n) most = worse(most, double(found[n] - wanted[n]));
            EXPECT_LT(most, 0.02); // measured 5e-3 and 6e-3
        }
}

/// The cycle's preconditioner is symmetric and positive only if its parts are.
TEST(Rim, IsSymmetricAndPositive)
{
    for (const PlateEdges& edges : kEdges)
        for (const bool doubles : {false, true}) {
            const Factored           rim(edges, doubles ? 1e4F : 1e3F, doubles, best());
            const auto               f  = roughValues<float>(rim.rigidity.size(), 1);
            const auto               g  = roughValues<float>(rim.rigidity.size(), 2);
            const std::vector<float> Mf = rim.solve(f), Mg = rim.solve(g);
            EXPECT_GT(dot(f, Mf), 0);
            EXPECT_GT(dot(g, Mg), 0);
            const double size = std::sqrt(dot(f, Mf) * dot(g, Mg));
            EXPECT_NEAR(dot(g, Mf) / size, dot(f, Mg) / size, 1e-5);
        }
}

/// Nor does it touch any other node.
TEST(Rim, TheLastCorrectionLeavesNoResidualThere)
{
    const Factored     rim({}, 1e3F, false, best());
    const std::size_t  nodes = rim.rigidity.size();
    std::vector<float> force = roughValues<float>(nodes, 4), w = roughValues<float>(nodes, 5), left(nodes);
    for (std::size_t n = 0; n < nodes; ++n) // held nodes
        if (int(n) % 42 == 0 || int(n) % 42 == 41 || n < 42 || n >= nodes - 42) w[n] = 0;
    const auto residual = [&] {
        const std::vector<double> a    = rim.apply(w);
        double                    most = 0;
        for (int n = 0; n < rim.view.unknowns; ++n) {
            const auto node = std::size_t(rim.view.nodes[n]);
            most            = worse(most, double(force[node]) - a[node]);
        }
        return most;
    };
    const double       before  = residual();
    auto               view    = rim.view;
    auto               D       = rim.rigidity;
    const auto         outside = w;
    std::vector<float> room(nodes + 1); // a row of nodes is read from the one before its first
    std::ranges::copy(w, room.begin() + 1);
    rim.run(rim.by.kernels->rimLast, {&view, D.data(), force.data(), room.data() + 1, left.data()});
    std::copy(room.begin() + 1, room.end(), w.begin());
    EXPECT_LT(residual(), 3e-3 * before); // measured 7e-4, of which floats leave most
    for (std::size_t n = 0; n < nodes; ++n)
        if (rim.view.numbers[n] < 0) {
            EXPECT_EQ(w[n], outside[n]);
        }
}

TEST(Rim, GivesTheSameBitsOnEveryInstructionSet)
{
    for (const bool doubles : {false, true}) {
        const auto force    = roughValues<float>(Factored({}, 1e3F, doubles, best()).rigidity.size(), 6);
        const auto expected = Factored({}, 1e3F, doubles, hostVariants().front()).solve(force);
        for (const HostVariant& variant : hostVariants())
            EXPECT_EQ(Factored({}, 1e3F, doubles, variant).solve(force), expected) << variant.isa;
    }
}

TEST(Rim, LoadsSideBySideHaveTheBitsOfEachAlone)
{
    for (const bool doubles : {false, true}) {
        const Factored     rim({}, 1e3F, doubles, best());
        const std::size_t  nodes = rim.rigidity.size();
        auto               force = roughValues<float>(kLoadsTogether * nodes, 7);
        std::vector<float> w(force.size());
        auto               view = rim.view;
        rim.run(best().together->rimFirst, {&view, force.data(), w.data()}, kLoadsTogether);
        for (std::size_t load = 0; load < kLoadsTogether; ++load) {
            std::vector<float> one, found;
            for (std::size_t n = 0; n < nodes; ++n) {
                one.push_back(force[n * kLoadsTogether + load]);
                found.push_back(w[n * kLoadsTogether + load]);
            }
            EXPECT_EQ(found, rim.solve(one)) << "load " << load;
        }
    }
}

/// An island in the rim that is 1e7 times as stiff is held by less than floats can tell from nothing.
TEST(Rim, PivotsThatRoundingTakesAreReported)
{
    EXPECT_FALSE(Factored({}, 1e7F, false, best()).spared);
    EXPECT_TRUE(Factored({}, 1e7F, true, best()).spared);
}

TEST(Rim, IsRefusedWhereItTakesTooMuchWork)
{
    const Factored whole({}, 1e3F, false, best());
    ASSERT_TRUE(whole.found);
    EXPECT_FALSE(Factored({}, 1e3F, false, best(), 0.9 * whole.rim.work()).found);
    EXPECT_FALSE(Factored({}, 1e3F, false, best(), 1000).found);
}

} // namespace
} // namespace palp
