#include "engine/compute/kernel.h"

#include <array>

#include "tests/compute/planes.h"
#include "tests/shaders/echo_layout.h"
#include "tests/shaders/layout_echo.spv.h"
#include "tests/support/shader_fixture.h"
#include "tests/support/temporary_folder.h"

namespace palp {
namespace {

constexpr UlpTolerance kSmoothTolerance{2, "two sums and two products, of which a driver may fuse one"};

class KernelTest : public ShaderTest {};

TEST_F(KernelTest, EveryFieldOfThePushConstantsArrivesInItsPlace)
{
    constexpr compute::KernelCode kEcho{"layout_echo", layout_echo_spv, 1, sizeof(shared::EchoPush)};
    const compute::Kernel         echo(context(), kEcho, {8, 8, 1});
    const shared::EchoPush        push{17, 0.25f, 19, -3.5f, -4};
    std::vector<std::uint32_t>    words(5);

    dispatchOnce(echo, {out(words)}, push, {1, 1, 1});

    EXPECT_EQ(words[0], push.columns);
    EXPECT_EQ(words[1], std::bit_cast<std::uint32_t>(push.spacing));
    EXPECT_EQ(words[2], push.rows);
    EXPECT_EQ(words[3], std::bit_cast<std::uint32_t>(push.offset));
    EXPECT_EQ(words[4], std::uint32_t(push.shift));
}

TEST_F(KernelTest, EveryShapeOfWorkgroupComputesWhatCxxDoes)
{
    for (const compute::Workgroup shape : {compute::Workgroup{8, 8, 1}, {64, 1, 1}, {16, 4, 1}}) {
        const compute::Kernel smooth(context(), kSmooth, shape);
        for (const std::uint32_t nx : sides())
            for (const std::uint32_t ny : {std::uint32_t(1), std::uint32_t(5), nx + 2}) {
                const shared::PlanePush  push{nx, ny, 1.7f};
                const std::vector<float> source = roughPlane(nx, ny);
                std::vector<float>       target(source.size());

                dispatchOnce(smooth, {in(source), out(target)}, push, smooth.groupsOver(nx, ny));

                EXPECT_TRUE(agree(target, smoothed(source, push, 0), kSmoothTolerance))
                    << nx << "x" << ny << " by workgroups of " << shape.x << "x" << shape.y;
            }
    }
}

TEST_F(KernelTest, RepeatsAreEqualToTheBit)
{
    const compute::Kernel    smooth(context(), kSmooth, {64, 1, 1});
    const shared::PlanePush  push{13, 9, 0.3f};
    const std::vector<float> source = roughPlane(13, 9);
    std::vector<float>       first(source.size()), again(source.size());

    dispatchOnce(smooth, {in(source), out(first)}, push, smooth.groupsOver(13, 9));
    for (int n = 0; n < 20; ++n) {
        dispatchOnce(smooth, {in(source), out(again)}, push, smooth.groupsOver(13, 9));
        EXPECT_EQ(first, again);
    }
}

TEST_F(KernelTest, FurtherConstantsStartAtThree)
{
    const std::array<std::uint32_t, 1> bias{5};
    const compute::Kernel              smooth(context(), kSmooth, {8, 8, 1}, bias);
    const shared::PlanePush            push{7, 7, 1.0f};
    const std::vector<float>           source = roughPlane(7, 7);
    std::vector<float>                 target(source.size());

    dispatchOnce(smooth, {in(source), out(target)}, push, smooth.groupsOver(7, 7));

    EXPECT_TRUE(agree(target, smoothed(source, push, 5), kSmoothTolerance));
}

TEST_F(KernelTest, GroupsCoverTheGridRoundedUp)
{
    const compute::Kernel smooth(context(), kSmooth, {16, 4, 1});

    EXPECT_EQ(smooth.groupsOver(16, 4).x, 1u);
    EXPECT_EQ(smooth.groupsOver(17, 5).x, 2u);
    EXPECT_EQ(smooth.groupsOver(17, 5).y, 2u);
    EXPECT_EQ(smooth.groupsOver(1).z, 1u);
}

TEST_F(KernelTest, WhatTheDeviceDoesNotAllowIsRefusedBeforeTheDriverSeesIt)
{
    const auto refusal = [&](const compute::KernelCode& code, compute::Workgroup shape) {
        return refusalOf([&] { const compute::Kernel kernel(context(), code, shape); });
    };
    compute::KernelCode greedy = kSmooth;
    greedy.pushBytes           = 1 << 20;

    EXPECT_TRUE(holds(refusal(greedy, {8, 8, 1}), {"plane_smooth", "push constants", context().processor().name}));
    EXPECT_TRUE(holds(refusal(kSmooth, {1 << 20, 1, 1}), {"plane_smooth", "workgroup of 1048576x1x1"}));
    greedy         = kSmooth;
    greedy.buffers = 1 << 30;
    EXPECT_TRUE(holds(refusal(greedy, {8, 8, 1}), {"plane_smooth", "buffers"}));
    compute::ContextSettings settings;
    settings.processor    = processorOfTests();
    settings.most.buffers = std::uint32_t(kSmooth.buffers) - 1;
    compute::Context small(settings);
    EXPECT_TRUE(holds(refusalOf([&] {
                          const compute::Kernel kernel(small, kSmooth, {8, 8, 1});
                      }),
                      {"plane_smooth", "buffers"}))
        << "a processor that is used as if it were a smaller one";
}

// The fixture itself: a test that cannot fail is worth nothing.
TEST_F(KernelTest, AWriteBeyondTheEndIsFoundInTheGuardBand)
{
    const compute::Kernel    broken(context(), kSmoothPastEnd, {8, 8, 1});
    const std::vector<float> source = roughPlane(13, 5);
    std::vector<float>       target(source.size());

    const std::vector<std::string> faults = dispatchGuarded(context(), broken, {in(source), out(target)},
                                                            shared::PlanePush{13, 5, 1.0f}, broken.groupsOver(13, 5));

    ASSERT_EQ(faults.size(), 1u);
    EXPECT_EQ(faults.front(), "array 1: word 0 after its end was written");
}

TEST_F(KernelTest, AColumnThatIsNotWrittenIsFound)
{
    const compute::Kernel    broken(context(), kSmoothShort, {8, 8, 1});
    const shared::PlanePush  push{13, 5, 1.0f};
    const std::vector<float> source = roughPlane(13, 5);
    std::vector<float>       target(source.size());

    const std::vector<std::string> faults =
        dispatchGuarded(context(), broken, {in(source), out(target)}, push, broken.groupsOver(13, 5));

    ASSERT_EQ(faults.size(), 1u);
    EXPECT_EQ(faults.front(), "array 1: 5 of 65 words were never written");
    EXPECT_FALSE(agree(target, smoothed(source, push, 0), kSmoothTolerance));
}

TEST_F(KernelTest, AnInputThatChangesIsFound)
{
    const compute::Kernel    accumulate(context(), kAccumulate, {8, 8, 1});
    const std::vector<float> source = roughPlane(7, 5);
    const std::vector<float> sum    = roughPlane(7, 5);

    const std::vector<std::string> faults = dispatchGuarded(context(), accumulate, {in(source), in(sum)},
                                                            shared::PlanePush{7, 5, 1.0f}, accumulate.groupsOver(7, 5));

    ASSERT_EQ(faults.size(), 1u);
    EXPECT_EQ(faults.front(), "array 1: an input changed");
}

} // namespace
} // namespace palp
