#include <numeric>

#include "engine/chart/nearest_map.h"
#include "engine/chart/resample.h"
#include "tests/plate/kernels/plate_shader_test.h"
#include "tests/plate/kernels/point_scenes.h"

// From points to nodes: rigidity_nearest.comp and rigidity_log_mean.comp, against the shared headers as C++ and against
// the host's own nearestPoint() and resampleRigidity(), which share no line with them.

namespace palp {
namespace {

constexpr Rounding kLogMeanRounding{
    128,
    "Vulkan allows exp(x) 3 + 2 |x| units in the last place, and C++ has another one: 5 on average in the weights, "
    "35 in the smallest, which shift ln D by so many parts of its spread of 7; 17 in exp(ln D)"};

/// Of positions that are rounded to floats: by up to 4e-6 spacings [spacings].
constexpr double kPositionError = 1e-5;

class RigiditySamplingTest : public PlateShaderTest {
protected:
    static host::Sampled sampled(const compute::Kernel& kernel, const PointBuckets& from)
    {
        host::Sampled all(from.layout);
        dispatchTwice(
            kernel,
            {in(std::vector{from.layout}), in(from.starts), in(from.points), out(all.rigidity), out(all.without)}, {},
            kernel.groupsOver(std::uint32_t(from.layout.cellsZ + 1), std::uint32_t(from.layout.cellsX + 1)));
        return all;
    }

    static Resampled reference(const PointScene& scene, Resampling sampling)
    {
        return resampleRigidity({scene.grid, scene.corner}, scene.positions, scene.rigidities, sampling, scene.spacing);
    }

    static std::size_t count(const std::vector<std::uint32_t>& flags)
    {
        return std::accumulate(flags.begin(), flags.end(), std::size_t(0));
    }
};

TEST_F(RigiditySamplingTest, NearestIsThatOfCxxToTheBit)
{
    for (const compute::Workgroup shape : tiles()) {
        const compute::Kernel nearest(context(), kernels::rigidityNearest(), shape);
        for (const PointScene& scene : pointScenes(isSlow())) {
            SCOPED_TRACE(scene.name + " by " + describe(shape));
            const host::Sampled measured = sampled(nearest, scene.buckets());
            if (!context().bitExact()) continue; // a fused product may choose the other of two equally near points
            const host::Sampled expected = host::nearestSampled(scene.buckets());
            EXPECT_EQ(measured.rigidity, expected.rigidity);
            EXPECT_EQ(measured.without, expected.without);
        }
    }
}

TEST_F(RigiditySamplingTest, NearestIsThePointThatTheHostFinds)
{
    const compute::Kernel nearest(context(), kernels::rigidityNearest(), {8, 8, 1});
    for (const PointScene& scene : pointScenes(isSlow())) {
        SCOPED_TRACE(scene.name);
        const host::Sampled measured = sampled(nearest, scene.buckets());
        const auto          expected = nearestPoint(scene.grid, scene.corner, scene.positions);
        const double allowed = scene.dyadic ? 0 : kPositionError * std::max(scene.grid.spacingX, scene.grid.spacingZ);
        std::size_t  n       = 0;
        for (int i = 0; i < scene.grid.nodesX(); ++i)
            for (int j = 0; j < scene.grid.nodesZ(); ++j, ++n) {
                const std::size_t point = scene.pointOf(measured.rigidity[n]);
                ASSERT_LT(point, scene.positions.size()) << "node " << i << ", " << j << " has no point's rigidity";
                if (scene.dyadic) {
                    EXPECT_EQ(point, expected[n]) << "of equally near points the lowest number wins";
                }
                EXPECT_LE(scene.distance(i, j, point), scene.distance(i, j, expected[n]) + allowed)
                    << "node " << i << ", " << j << ": point " << point << " for " << expected[n];
            }
        EXPECT_EQ(count(measured.without), reference(scene, Resampling::nearest).nodesWithoutPoint);
    }
}

TEST_F(RigiditySamplingTest, LogMeanIsThatOfCxxButForTheExponential)
{
    for (const compute::Workgroup shape : tiles()) {
        const compute::Kernel logMean(context(), kernels::rigidityLogMean(), shape);
        for (const PointScene& scene : pointScenes(isSlow())) {
            SCOPED_TRACE(scene.name + " by " + describe(shape));
            const host::Sampled measured = sampled(logMean, scene.buckets());
            const host::Sampled expected = host::logMeanSampled(scene.buckets());
            EXPECT_TRUE(
                isWithin(measured.rigidity, expected.rigidity, magnitudes(expected.rigidity), kLogMeanRounding));
            if (context().bitExact()) {
                EXPECT_EQ(measured.without, expected.without);
            }
        }
    }
}

TEST_F(RigiditySamplingTest, LogMeanIsThatOfTheHostInDoubles)
{
    const compute::Kernel logMean(context(), kernels::rigidityLogMean(), {8, 8, 1});
    for (const PointScene& scene : pointScenes(isSlow())) {
        SCOPED_TRACE(scene.name);
        const host::Sampled measured = sampled(logMean, scene.buckets());
        const Resampled     expected = reference(scene, Resampling::logMean);
        for (std::size_t n = 0; n < measured.rigidity.size(); ++n)
            EXPECT_NEAR(double(measured.rigidity[n]) * PointScene::kUnit / expected.rigidity.values()[n], 1, 1e-4)
                << "node " << n;
        EXPECT_EQ(count(measured.without), expected.nodesWithoutPoint);
    }
}

TEST_F(RigiditySamplingTest, ScenesHaveNodesWithAndWithoutPoints) // or else the flags are not tested
{
    std::size_t nodes = 0, without = 0;
    for (const PointScene& scene : pointScenes(isSlow())) {
        nodes += scene.grid.nodes();
        without += reference(scene, Resampling::nearest).nodesWithoutPoint;
    }
    EXPECT_GT(10 * without, nodes);
    EXPECT_LT(10 * without, 9 * nodes);
}

} // namespace
} // namespace palp
