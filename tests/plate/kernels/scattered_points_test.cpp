#include "engine/plate/scattered_points.h"

#include <cstring>
#include <limits>

#include "tests/plate/kernels/plate_shader_test.h"
#include "tests/plate/kernels/point_scenes.h"

namespace palp {
namespace {

constexpr PlateGrid     kGrid{17, 12, 0.002, 0.0026};
constexpr std::uint32_t kTwoLoads = 2;

PointScene sceneOf(std::size_t points)
{
    PointScene scene = scatteredScene(std::to_string(points) + " points", kGrid, points, {-0.2, -0.2}, {1.2, 1.2});
    giveRigidities(scene);
    return scene;
}

/// A plate's buffers, filled, and points over it.
class ScatteredPointsTest : public PlateShaderTest {
protected:
    PlateKernels        kernels_{context()};
    bool                doubles_ = kernels_.all().doubles;
    ScatteredPoints     points_{context(), kernels_.all(), kGrid, kTwoLoads};
    std::vector<double> answer_ = roughValues<double>(kTwoLoads * kGrid.nodes(), 98);
    std::vector<float>  rounded_{answer_.begin(), answer_.end()}, metres_{0.5F, 3};
    compute::Buffer     hostAnswer_{context(), "answer from the host", realBytes(), compute::Intent::upload};
    compute::Buffer     hostMetres_{context(), "metres", 8, compute::Intent::upload};
    compute::Buffer     rigidity_{context(), "rigidity", 4 * kGrid.nodes(), compute::Intent::device};
    compute::Buffer     hostRigidity_{context(), "rigidity to the host", 4 * kGrid.nodes(), compute::Intent::readback};
    [[nodiscard]] std::size_t realBytes() const { return (doubles_ ? 8 : 4) * answer_.size(); }

    void SetUp() override
    {
        PlateShaderTest::SetUp();
        const void* from = doubles_ ? static_cast<const void*>(answer_.data()) : rounded_.data();
        std::memcpy(hostAnswer_.mapped(), from, realBytes());
        std::memcpy(hostMetres_.mapped(), metres_.data(), 8);
    }

    using Record = void (ScatteredPoints::*)(compute::CommandList&, const compute::Buffer&) const;

    [[nodiscard]] compute::CommandList listOf(Record sampling) const
    {
        compute::CommandList list(context());
        (points_.*sampling)(list, rigidity_);
        points_.recordLift(list, hostAnswer_, hostMetres_);
        list.copy(rigidity_, hostRigidity_);
        list.end();
        return list;
    }

    void expectAnswers(compute::CommandList& list, const PointScene& scene, const host::Sampled& expected) const
    {
        SCOPED_TRACE(scene.name);
        context().run(list);
        hostRigidity_.makeVisibleToHost();
        const auto               from = hostRigidity_.as<const float>();
        const std::vector<float> rigidity(from.begin(), from.end());
        EXPECT_TRUE(isWithin(rigidity, expected.rigidity, magnitudes(expected.rigidity), {128, "see the sampling's"}));
        EXPECT_EQ(points_.nodesWithoutPoint(), std::size_t(std::ranges::count(expected.without, 1U)));

        std::vector<float> lifted;
        for (std::uint32_t load = 0; load < kTwoLoads; ++load)
            lifted.insert(lifted.end(), points_.deflection(load).begin(), points_.deflection(load).end());
        const auto w = doubles_ ? host::lifted(scene.buckets(), answer_, metres_)
                                : host::lifted(scene.buckets(), rounded_, metres_);
        EXPECT_TRUE(agree(lifted, w, std::vector<double>(w.size(), 3), {12, "see the lift's"}));
    }
};

TEST_F(ScatteredPointsTest, AListServesAnyNumberOfPointsUntilMemoryGrows)
{
    const PointScene first = sceneOf(300), fewer = sceneOf(7), more = sceneOf(points_.capacity()),
                     most = sceneOf(points_.capacity() + 1);
    ASSERT_FALSE(points_.set(first.points()));
    compute::CommandList list = listOf(&ScatteredPoints::recordNearest);
    for (const PointScene* scene : {&first, &fewer, &more, &first}) {
        EXPECT_FALSE(points_.set(scene->points()));
        EXPECT_EQ(points_.count(), scene->positions.size());
        expectAnswers(list, *scene, host::nearestSampled(scene->buckets()));
    }
    const std::size_t before = points_.capacity();
    EXPECT_TRUE(points_.set(most.points())) << "a point more than there was room for";
    EXPECT_EQ(points_.capacity(), 2 * before);
    list = listOf(&ScatteredPoints::recordNearest);
    expectAnswers(list, most, host::nearestSampled(most.buckets()));
    EXPECT_FALSE(points_.set(fewer.points())) << "memory does not shrink";
    expectAnswers(list, fewer, host::nearestSampled(fewer.buckets()));
}

TEST_F(ScatteredPointsTest, TheLogMeanIsSampledLikewise)
{
    const PointScene first = sceneOf(3), second = sceneOf(400);
    ASSERT_FALSE(points_.set(first.points()));
    compute::CommandList list = listOf(&ScatteredPoints::recordLogMean);
    expectAnswers(list, first, host::logMeanSampled(first.buckets()));
    EXPECT_FALSE(points_.set(second.points()));
    expectAnswers(list, second, host::logMeanSampled(second.buckets()));
}

TEST_F(ScatteredPointsTest, BadPointsAreRefusedInASentenceAndTheOldOnesStay)
{
    const PointScene good = sceneOf(50);
    ASSERT_FALSE(points_.set(good.points()));
    compute::CommandList list = listOf(&ScatteredPoints::recordNearest);

    const auto refused = [&](auto spoil) -> std::string {
        PointScene bad = sceneOf(60);
        spoil(bad);
        try {
            (void)points_.set(bad.points());
        } catch (const Error& error) {
            return error.what();
        }
        return "accepted";
    };
    constexpr double kNan      = std::numeric_limits<double>::quiet_NaN(),
                     kInfinite = std::numeric_limits<double>::infinity();
    const auto startsWith      = [](const std::string& text, const std::string& start) {
        return text.compare(0, start.size(), start) == 0 ? ::testing::AssertionSuccess()
                                                              : ::testing::AssertionFailure() << text;
    };
    EXPECT_TRUE(startsWith(refused([](PointScene& s) { s.positions.clear(), s.rigidities.clear(); }),
                           "plate: expected points to take the rigidity from, found none"));
    for (const double x : {kNan, kInfinite, -kInfinite}) {
        EXPECT_TRUE(startsWith(refused([=](PointScene& s) { s.positions[9].x = x; }),
                               "plate: expected finite positions, found point 9 at "));
        EXPECT_TRUE(startsWith(refused([=](PointScene& s) { s.positions[59].z = x; }),
                               "plate: expected finite positions, found point 59 at "));
    }
    for (const double D : {0.0, -1.0, kNan, kInfinite})
        EXPECT_TRUE(startsWith(refused([=](PointScene& s) { s.rigidities[9] = D; }),
                               "plate: expected finite rigidities above 0, found "));
    for (const double D : {1e-16, 1e16})
        EXPECT_TRUE(startsWith(refused([=](PointScene& s) { s.rigidities[9] = D; }),
                               "plate: the rigidity spans too many orders of magnitude"));
    for (const double x : {2e7, -1e300})
        EXPECT_TRUE(
            startsWith(refused([=](PointScene& s) { s.positions[9].x = x; }), "plate: expected points within "));
    expectAnswers(list, good, host::nearestSampled(good.buckets()));
}

TEST_F(ScatteredPointsTest, MorePointsThanTheDeviceCanHoldAreRefused)
{
    const ScatteredPoints many(context(), kernels_.all(), kGrid, 1000); // loads, so that it takes no gigabytes
    ScatteredPoints       all(context(), kernels_.all(), kGrid, 1000);
    PointScene            scene{"", kGrid, {}, std::vector<ChartPoint>(many.most() + 1)};
    scene.rigidities.resize(scene.positions.size(), 1);
    EXPECT_THROW((void)all.set(scene.points()), Error);
    EXPECT_EQ(all.capacity(), many.capacity());
}

} // namespace
} // namespace palp
