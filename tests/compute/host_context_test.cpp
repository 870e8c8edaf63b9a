#include <array>
#include <cstdint>

#include <gtest/gtest.h>

#include "engine/compute/command_list.h"
#include "engine/compute/context.h"
#include "engine/core/contract.h"

// The host as a processor: what lists do with kernels that are functions.

namespace palp::compute {
namespace {

struct AddPush {
    std::uint32_t summand;
};

/// Adds to each of as many words as there are groups along x.
void addTo(const HostDispatch& d)
{
    auto* const words = static_cast<std::uint32_t*>(d.buffers[0]);
    for (std::uint32_t n = 0; n < d.groups.x; ++n)
        words[n] += static_cast<const AddPush*>(d.push)->summand * d.constants[0];
}

constexpr std::array<std::uint32_t, 1> kNoShader{0};

class HostDeviceTest : public ::testing::Test {
protected:
    Context       context{{.processor = std::string(kHostProcessor)}};
    std::uint32_t factor = 10;
    Kernel        add{context, {"add", kNoShader, 1, int(sizeof(AddPush)), &addTo}, {1, 1, 1}, {&factor, 1}};
    Buffer        words{context, "words", 32, Intent::readback};
};

TEST_F(HostDeviceTest, ListsRunInOrderAsOftenAsTheyAreRun)
{
    const Buffer other(context, "other", 32, Intent::processor);
    CommandList  start(context), step(context);
    start.fill(other, 5);
    start.copy(other, 0, words, 4, 28);
    start.copy(other, words);
    start.end();
    step.timestamp();
    step.dispatch(add, {words}, AddPush{2}, {3, 1, 1});
    step.dispatch(add, {{words, 16}}, AddPush{1}, {1, 1, 1});
    step.timestamp();
    step.end();
    context.run(start);
    CommandList* const twice[] = {&step, &step};
    context.run(twice);
    const std::array<std::uint32_t, 8> expected{45, 45, 45, 5, 25, 5, 5, 5};
    for (std::size_t n = 0; n < expected.size(); ++n) EXPECT_EQ(words.as<std::uint32_t>()[n], expected[n]) << n;
    ASSERT_EQ(step.timestampsMilliseconds().size(), 2u);
    EXPECT_EQ(step.timestampsMilliseconds()[0], 0);
    EXPECT_GE(step.timestampsMilliseconds()[1], 0);
    EXPECT_EQ(step.dispatches(), 2);
}

TEST_F(HostDeviceTest, GroupsFromABufferAreReadWhenTheListRuns)
{
    const Buffer groups(context, "groups", 12, Intent::upload);
    CommandList  list(context);
    list.dispatchIndirect(add, {words}, AddPush{1}, groups);
    list.end();
    for (std::uint32_t& word : words.as<std::uint32_t>()) word = 0;
    for (const std::uint32_t along : {0U, 2U}) {
        groups.as<std::uint32_t>()[0] = along;
        groups.as<std::uint32_t>()[1] = groups.as<std::uint32_t>()[2] = 1;
        context.run(list);
        EXPECT_EQ(words.as<std::uint32_t>()[0], along ? 10u : 0u) << "no group, no call";
        EXPECT_EQ(words.as<std::uint32_t>()[2], 0u);
    }
}

TEST_F(HostDeviceTest, AKernelWithoutAFunctionIsRefused)
{
    EXPECT_THROW(Kernel(context, {"shader only", kNoShader, 1, 0}, {1, 1, 1}), ContractViolation);
    EXPECT_TRUE(context.bitExact());
    EXPECT_TRUE(context.takeMessages().empty());
}

} // namespace
} // namespace palp::compute
