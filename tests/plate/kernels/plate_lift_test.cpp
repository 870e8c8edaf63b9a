#include "tests/plate/kernels/plate_shader_test.h"
#include "tests/plate/kernels/point_scenes.h"

// From nodes to points: plate_lift.comp.

namespace palp {
namespace {

class PlateLiftTest : public PlateShaderTest {
protected:
    static std::vector<float> metresOf(std::size_t loads)
    {
        std::vector<float> metres;
        for (std::size_t load = 0; load < loads; ++load) metres.push_back(2.5e-3F * float(1 + load));
        return metres;
    }

    template <class Real>
    static std::vector<float> lifted(const compute::Kernel& lift, const PointBuckets& from,
                                     const std::vector<Real>& answer, const std::vector<float>& metres)
    {
        constexpr std::uint32_t kMoreRoom = 300; // than there are points
        std::vector<float>      w(metres.size() * from.points.size());
        dispatchTwice(lift, {in(std::vector{from.layout}), in(from.points), in(answer), in(metres), out(w)}, {},
                      lift.groupsOver(from.layout.points + kMoreRoom, 1, std::uint32_t(metres.size())));
        return w;
    }

    /// In doubles, from the positions as they were before they were rounded.
    static double bilinear(const PointScene& scene, const double* w, const ChartPoint& p)
    {
        const PlateGrid& grid = scene.grid;
        const double     x = (p.x - scene.corner.x) / grid.spacingX, z = (p.z - scene.corner.z) / grid.spacingZ;
        constexpr double kOnSide = 1e-9; // a position on a side may have been rounded across it [spacings]
        if (std::min(x, z) < -kOnSide || x > grid.cellsX + kOnSide || z > grid.cellsZ + kOnSide) return 0;
        double sum = 0;
        for (int i = 0; i < grid.nodesX(); ++i)
            for (int j = 0; j < grid.nodesZ(); ++j)
                sum +=
                    std::max(0.0, 1 - std::abs(x - i)) * std::max(0.0, 1 - std::abs(z - j)) * w[i * grid.nodesZ() + j];
        return sum;
    }
};

TEST_F(PlateLiftTest, IsThatOfCxx)
{
    inEachPrecision([](auto number) {
        using Real = decltype(number);
        for (const compute::Workgroup shape : lines()) {
            const compute::Kernel lift(context(), kernels::lift<Real>(), shape);
            for (const PointScene& scene : pointScenes(isSlow()))
                for (const std::size_t loads : {1, 2, 9}) {
                    SCOPED_TRACE(scene.name + " by " + describe(shape));
                    const auto metres   = metresOf(loads);
                    const auto answer   = roughValues<Real>(loads * scene.grid.nodes(), 95);
                    const auto measured = lifted(lift, scene.buckets(), answer, metres);
                    EXPECT_TRUE(agree(measured, host::lifted(scene.buckets(), answer, metres),
                                      std::vector<double>(measured.size(), double(metres.back())),
                                      {12, "three nested means and a product, which a driver may fuse"}));
                }
        }
    });
}

TEST_F(PlateLiftTest, IsBilinearAndZeroOutsideTheGrid)
{
    inEachPrecision([](auto number) {
        using Real = decltype(number);
        const compute::Kernel lift(context(), kernels::lift<Real>(), {64, 1, 1});
        std::size_t           outside = 0, inside = 0;
        for (const PointScene& scene : pointScenes(isSlow())) {
            SCOPED_TRACE(scene.name);
            const auto                metres = metresOf(2);
            const auto                answer = roughValues<Real>(2 * scene.grid.nodes(), 96);
            const std::vector<double> w(answer.begin(), answer.end());
            const auto                measured = lifted(lift, scene.buckets(), answer, metres);
            for (std::size_t n = 0; n < measured.size(); ++n) {
                const std::size_t load = n / scene.positions.size();
                const double      expected =
                    bilinear(scene, w.data() + load * scene.grid.nodes(), scene.positions[n % scene.positions.size()]);
                EXPECT_NEAR(double(measured[n]), expected * double(metres[load]), 2e-5 * double(metres[load]))
                    << "positions are good to 4e-6 spacings, slopes are at most 2";
                (expected == 0 ? outside : inside) += 1;
                if (expected == 0) {
                    EXPECT_EQ(measured[n], 0.0F);
                }
            }
        }
        EXPECT_GT(outside, 100U);
        EXPECT_GT(inside, 100U);
    });
}

TEST_F(PlateLiftTest, PointsOnNodesHaveTheirDeflectionUpToTheLastOne)
{
    const compute::Kernel    lift(context(), kernels::lift<float>(), {64, 1, 1});
    PointScene               scene{"on nodes", {7, 5, 0.5, 0.25}, {1, -1}, {}};
    const std::vector<float> answer = roughValues<float>(scene.grid.nodes(), 97), metres{1};
    for (int i = 0; i <= 7; ++i)
        for (int j = 0; j <= 5; ++j) scene.positions.push_back({1 + 0.5 * i, -1 + 0.25 * j});
    giveRigidities(scene);
    EXPECT_EQ(lifted(lift, scene.buckets(), answer, metres), answer);
}

} // namespace
} // namespace palp
