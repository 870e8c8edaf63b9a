#include "engine/compute/command_list.h"

#include <algorithm>

#include "tests/compute/planes.h"
#include "tests/support/shader_fixture.h"
#include "tests/support/temporary_folder.h"

namespace palp {
namespace {

constexpr std::uint32_t kSide  = 13;
constexpr std::size_t   kBytes = kSide * kSide * sizeof(float);

/// Two planes on the processor, and what the second holds after a run.
class CommandListTest : public ShaderTest {
protected:
    void SetUp() override
    {
        ShaderTest::SetUp();
        const std::vector<float> rough = roughPlane(kSide, kSide);
        std::ranges::copy(rough, up_.as<float>().begin());
    }

    std::vector<float> result() const
    {
        down_.makeVisibleToHost();
        const auto values = down_.as<const float>();
        return {values.begin(), values.end()};
    }

    compute::Buffer         up_{context(), "up", kBytes, compute::Intent::upload};
    compute::Buffer         source_{context(), "source", kBytes, compute::Intent::processor};
    compute::Buffer         sum_{context(), "sum", kBytes, compute::Intent::processor};
    compute::Buffer         down_{context(), "down", kBytes, compute::Intent::readback};
    compute::Kernel         accumulate_{context(), kAccumulate, {8, 8, 1}};
    const compute::Groups   groups_ = accumulate_.groupsOver(kSide, kSide);
    const shared::PlanePush push_{kSide, kSide, 0.25f};
};

TEST_F(CommandListTest, EachCommandSeesWhatThoseBeforeItWrote)
{
    compute::CommandList list(context());
    list.copy(up_, source_);
    list.fill(sum_, 0);
    for (int n = 0; n < 4; ++n) list.dispatch(accumulate_, {source_, sum_}, push_, groups_);
    list.copy(sum_, down_);
    list.end();

    context().run(list);

    EXPECT_EQ(list.dispatches(), 4);
    EXPECT_EQ(result(), roughPlane(kSide, kSide)) << "four quarters, exact in binary";
}

TEST_F(CommandListTest, ARecordedListGivesTheSameAnswerEachTime)
{
    compute::CommandList list(context());
    list.copy(up_, source_);
    list.fill(sum_, 0);
    list.dispatch(accumulate_, {source_, sum_}, push_, groups_);
    list.copy(sum_, down_);
    list.end();

    context().run(list);
    const std::vector<float> first = result();
    for (int n = 0; n < 10; ++n) context().run(list);
    EXPECT_EQ(result(), first);
    std::ranges::fill(up_.as<float>(), 8.0f);
    context().run(list);
    EXPECT_EQ(result(), std::vector<float>(kSide * kSide, 2.0f)) << "and sees what the host wrote meanwhile";
}

TEST_F(CommandListTest, ResultsOfOneRunAreThereForTheNext)
{
    compute::CommandList start(context()), step(context()), fetch(context());
    start.copy(up_, source_);
    start.fill(sum_, 0);
    start.end();
    step.dispatch(accumulate_, {source_, sum_}, push_, groups_);
    step.end();
    fetch.copy(sum_, down_);
    fetch.end();

    context().run(start);
    for (int n = 0; n < 4; ++n) context().run(step);
    context().run(fetch);

    EXPECT_EQ(result(), roughPlane(kSide, kSide));
}

TEST_F(CommandListTest, MoreDispatchesThanOnePoolOfDescriptorsHolds)
{
    constexpr int        kMany = 1000;
    compute::CommandList list(context());
    std::ranges::fill(up_.as<float>(), 4.0f);
    list.copy(up_, source_);
    list.fill(sum_, 0);
    for (int n = 0; n < kMany; ++n) list.dispatch(accumulate_, {source_, sum_}, push_, groups_);
    list.copy(sum_, down_);
    list.end();

    context().run(list);

    EXPECT_EQ(result(), std::vector<float>(kSide * kSide, float(kMany)));
}

TEST_F(CommandListTest, AnIndirectDispatchTakesItsGroupsFromABuffer)
{
    const compute::Buffer arguments(context(), "arguments", 32, compute::Intent::upload);
    const auto            words = arguments.as<std::uint32_t>();
    compute::CommandList  list(context());
    list.copy(up_, source_);
    list.fill(sum_, 0);
    list.dispatchIndirect(accumulate_, {source_, sum_}, push_, arguments, 16);
    list.copy(sum_, down_);
    list.end();

    std::ranges::copy(std::initializer_list<std::uint32_t>{groups_.x, groups_.y, 1}, words.begin() + 4);
    context().run(list);
    EXPECT_EQ(result()[kSide + 1], 0.25f * roughPlane(kSide, kSide)[kSide + 1]);
    std::ranges::fill(words, 0u);
    context().run(list);
    EXPECT_EQ(result(), std::vector<float>(kSide * kSide, 0.0f)) << "no groups, no writes";
}

TEST_F(CommandListTest, AnIndirectDispatchSeesGroupsThatChangeWithinTheList)
{
    const compute::Buffer some(context(), "some", 12, compute::Intent::upload),
        none(context(), "none", 12, compute::Intent::upload),
        arguments(context(), "arguments", 12, compute::Intent::processor);
    std::ranges::copy(std::initializer_list<std::uint32_t>{groups_.x, groups_.y, 1}, some.as<std::uint32_t>().begin());
    std::ranges::fill(none.as<std::uint32_t>(), 0U);
    compute::CommandList list(context());
    list.copy(up_, source_);
    list.fill(sum_, 0);
    const auto dispatchTwice = [&] {
        for (int n = 0; n < 2; ++n) list.dispatchIndirect(accumulate_, {source_, sum_}, push_, arguments, 0);
    };
    list.copy(some, arguments);
    dispatchTwice();
    list.copy(none, arguments);
    dispatchTwice();
    list.copy(some, arguments);
    dispatchTwice();
    list.fill(arguments, 0);
    dispatchTwice();
    list.copy(sum_, down_);
    list.end();

    context().run(list);
    EXPECT_EQ(result(), roughPlane(kSide, kSide)) << "four quarters";
}

TEST_F(CommandListTest, PartOfABufferCanBeBound)
{
    const compute::Buffer wide(context(), "wide", 256 + kBytes, compute::Intent::processor);
    compute::CommandList  list(context());
    list.fill(wide, 0);
    list.copy(up_, 0, wide, 256, kBytes);
    list.fill(sum_, 0);
    list.dispatch(accumulate_, {{wide, 256, kBytes}, sum_}, shared::PlanePush{kSide, kSide, 1.0f}, groups_);
    list.copy(sum_, down_);
    list.end();

    context().run(list);

    EXPECT_EQ(result(), roughPlane(kSide, kSide));
}

TEST_F(CommandListTest, TimestampsRiseAndStartAtZero)
{
    compute::CommandList list(context());
    list.copy(up_, source_);
    list.fill(sum_, 0);
    for (int n = 0; n < 70; ++n) { // more than one pool of queries
        list.timestamp();
        list.dispatch(accumulate_, {source_, sum_}, push_, groups_);
    }
    list.timestamp();
    list.end();

    for (int repeat = 0; repeat < 2; ++repeat) {
        context().run(list);
        const std::vector<double> times = list.timestampsMilliseconds();
        if (times.empty()) GTEST_SKIP() << "this processor has no clock";
        ASSERT_EQ(times.size(), 71u);
        EXPECT_EQ(times.front(), 0);
        EXPECT_TRUE(std::ranges::is_sorted(times));
        EXPECT_GT(times.back(), 0);
        EXPECT_LT(times.back(), 60e3);
    }
}

TEST_F(CommandListTest, MistakesAreRefusedWhileRecording)
{
    compute::CommandList list(context());
    const auto           record = [&](const compute::Bindings& bindings, const compute::Push& push) {
        list.dispatch(accumulate_, bindings, push, groups_);
    };

    EXPECT_THROW(record({source_}, push_), ContractViolation) << "a buffer is missing";
    EXPECT_THROW(record({source_, sum_}, {}), ContractViolation) << "no push constants";
    EXPECT_THROW(record({source_, {sum_, 256, kBytes}}, push_), ContractViolation) << "beyond the end";
    EXPECT_THROW(record({source_, {sum_, 3}}, push_), ContractViolation) << "not aligned";
    EXPECT_THROW(list.copy(up_, 4, sum_, 0, kBytes), ContractViolation);
    EXPECT_THROW(list.dispatchIndirect(accumulate_, {source_, sum_}, push_, sum_, kBytes - 8), ContractViolation);
    EXPECT_THROW((void)list.timestampsMilliseconds(), ContractViolation);
    list.end();
    EXPECT_THROW(list.end(), ContractViolation);
    EXPECT_THROW(record({source_, sum_}, push_), ContractViolation);
}

} // namespace
} // namespace palp
