#include "engine/compute/buffer.h"

#include <numeric>

#include "tests/support/shader_fixture.h"
#include "tests/support/temporary_folder.h"

namespace palp {
namespace {

class BufferTest : public ShaderTest {};

TEST_F(BufferTest, WhatIsUploadedComesBackThroughTheDevice)
{
    constexpr std::size_t kBytes = 4 * 1001;
    const compute::Buffer up(context(), "up", kBytes, compute::Intent::upload);
    const compute::Buffer on(context(), "on", kBytes, compute::Intent::processor);
    const compute::Buffer down(context(), "down", kBytes, compute::Intent::readback);
    std::iota(up.as<std::uint32_t>().begin(), up.as<std::uint32_t>().end(), 7u);
    compute::CommandList list(context());
    list.copy(up, on);
    list.copy(on, 4, down, 0, kBytes - 4);
    list.copy(on, 0, down, kBytes - 4, 4);
    list.end();

    context().run(list);

    down.makeVisibleToHost();
    const auto words = down.as<const std::uint32_t>();
    EXPECT_EQ(words[0], 8u);
    EXPECT_EQ(words[999], 1007u);
    EXPECT_EQ(words[1000], 7u);
}

TEST_F(BufferTest, OneThatIsTooLargeIsRefusedWithItsSize)
{
    const std::size_t most     = context().limits().buffer;
    const std::string sentence = refusalOf(
        [&] { const compute::Buffer monster(context(), "monster", (most / 4 + 1) * 4, compute::Intent::processor); });

    EXPECT_TRUE(holds(sentence, {"'monster'", "MiB", context().processor().name, "fewer cells"})) << sentence;
}

TEST_F(BufferTest, TheDevicesOwnMemoryIsNotMapped)
{
    const compute::Buffer on(context(), "on", 64, compute::Intent::processor);

    EXPECT_EQ(on.mapped(), nullptr);
    EXPECT_THROW((void)on.as<float>(), ContractViolation);
}

TEST_F(BufferTest, SizesThatAreNoWordsAreRefused)
{
    EXPECT_THROW(compute::Buffer(context(), "none", 0, compute::Intent::processor), ContractViolation);
    EXPECT_THROW(compute::Buffer(context(), "odd", 6, compute::Intent::processor), ContractViolation);
}

TEST_F(BufferTest, MoreBuffersThanAnyDeviceMapsAtOnceComeAndGo)
{
    for (int n = 0; n < 5000; ++n) // processors need not allow more than 4096 at once
        const compute::Buffer buffer(context(), "brief", 64, compute::Intent::processor);
}

} // namespace
} // namespace palp
