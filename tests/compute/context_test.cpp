#include <chrono>
#include <optional>
#include <thread>

#include "tests/compute/planes.h"
#include "tests/support/shader_fixture.h"
#include "tests/support/temporary_folder.h"

namespace palp {
namespace {

class ContextTest : public ShaderTest {};

TEST_F(ContextTest, TheOpenedDeviceIsOneOfTheList)
{
    const std::vector<compute::Processor> list = compute::listProcessors();

    ASSERT_LT(std::size_t(context().processor().index), list.size());
    EXPECT_EQ(list[std::size_t(context().processor().index)].name, context().processor().name);
    EXPECT_TRUE(context().processor().refusals.empty());
    EXPECT_GT(context().processor().memory, 0u);
    EXPECT_GT(context().limits().buffer, std::size_t(1) << 26);
    EXPECT_GE(context().limits().invocations, 128u);
}

TEST_F(ContextTest, ShadersAreTestedInSoftwareUnlessAnotherDeviceIsNamed)
{
    EXPECT_TRUE(!compute::isProcessorWord(processorOfTests(), compute::kLavapipeProcessor) ||
                context().processor().kind == compute::ProcessorKind::software);
    EXPECT_FALSE(compute::isProcessorWord(processorOfTests(), compute::kAutoProcessor)) << "which may be the host";
    EXPECT_EQ(onHost(), compute::isProcessorWord(processorOfTests(), compute::kHostProcessor));
}

TEST_F(ContextTest, ADeviceThatIsNotThereIsRefusedAndEachDeviceNamed)
{
    compute::ContextSettings settings;
    settings.processor = "no such processor";

    EXPECT_THROW(compute::Context{settings}, compute::UnknownProcessor);
    const std::string sentence = refusalOf([&] { compute::Context{settings}; });
    EXPECT_TRUE(holds(sentence, {"'no such processor'"})) << sentence;
    for (const compute::Processor& one : compute::listProcessors())
        EXPECT_TRUE(holds(sentence, {one.name})) << sentence;
}

TEST_F(ContextTest, AProcessorCanBeUsedAsIfItWereASmallerOne)
{
    compute::ContextSettings settings;
    settings.processor = processorOfTests();
    settings.most      = {.buffer = 4096, .invocations = 64, .sharedMemory = 1024};
    settings.float64   = false;
    compute::Context small(settings);
    EXPECT_EQ(small.limits().buffer, 4096U);
    EXPECT_EQ(small.limits().invocations, 64U);
    EXPECT_EQ(small.limits().sharedMemory, 1024U);
    EXPECT_FALSE(small.processor().float64);
    EXPECT_THROW(compute::Buffer(small, "too large", 4100, compute::Intent::processor), compute::ProcessorOutOfMemory);
    const compute::Buffer fits(small, "fits", 4096, compute::Intent::processor); // the processor goes on
    settings.most.buffer = ~std::size_t(0);
    EXPECT_EQ(compute::Context(settings).limits().buffer, context().limits().buffer) << "never a larger one";
}

TEST_F(ContextTest, AMovedContextStillServesWhatWasMadeFromIt)
{
    compute::ContextSettings settings;
    settings.processor = std::to_string(context().processor().index);
    std::optional<compute::Context> second; // goes last
    compute::Context                first(settings);
    compute::Buffer                 buffer(first, "moved", 64, compute::Intent::readback);
    compute::CommandList            list(first);
    list.fill(buffer, 42);
    list.end();

    second.emplace(std::move(first));
    second->run(list);

    buffer.makeVisibleToHost();
    EXPECT_EQ(buffer.as<std::uint32_t>()[15], 42u);
}

TEST_F(ContextTest, ASubmissionThatOutlastsThePatienceIsALostDevice)
{
    if (context().processor().kind != compute::ProcessorKind::software)
        GTEST_SKIP() << "Vulkan in software is slow enough";
    compute::ContextSettings settings;
    settings.processor = std::to_string(context().processor().index);
    settings.patience  = 1e-9;
    compute::Context        hasty(settings);
    const compute::Kernel   smooth(hasty, kSmooth, {64, 1, 1});
    constexpr std::uint32_t kSide = 512;
    const compute::Buffer   from(hasty, "from", kSide * kSide * 4, compute::Intent::processor);
    const compute::Buffer   to(hasty, "to", kSide * kSide * 4, compute::Intent::processor);
    compute::CommandList    list(hasty);
    list.dispatch(smooth, {from, to}, shared::PlanePush{kSide, kSide, 1}, smooth.groupsOver(kSide, kSide));
    list.end();

    bool lost = false;
    for (int n = 0; n < 100 && !lost; ++n) // on a busy machine it may be done before the wait begins
        lost = !refusalOf([&] { hasty.run(list); }).empty();

    EXPECT_TRUE(lost);
    EXPECT_THROW(hasty.run(list), compute::ProcessorLost) << "once lost, always lost";
    std::this_thread::sleep_for(std::chrono::milliseconds(300)); // it finishes, so that nothing is leaked here
}

TEST_F(ContextTest, ValidationReportsAKernelThatContradictsItsCode)
{
    if (validation() == compute::Validation::off) GTEST_SKIP() << "validation is off";
    compute::KernelCode without = kSmooth;
    without.pushBytes           = 0; // the shader reads 12

    const compute::Kernel kernel(context(), without, {8, 8, 1});

    EXPECT_FALSE(context().takeMessages().empty());
    EXPECT_TRUE(context().takeMessages().empty()) << "each is told once";
}

TEST_F(ContextTest, GpuAssistedValidationReportsAWriteBeyondTheBuffer)
{
    if (validation() != compute::Validation::gpuAssisted) GTEST_SKIP() << "GPU-assisted validation is off";
    const compute::Kernel broken(context(), kSmoothPastEnd, {8, 8, 1});
    const compute::Buffer from(context(), "from", 7 * 7 * 4, compute::Intent::processor);
    const compute::Buffer to(context(), "to", 7 * 7 * 4, compute::Intent::processor);
    compute::CommandList  list(context());
    list.fill(from, 0);
    list.dispatch(broken, {from, to}, shared::PlanePush{7, 7, 1}, broken.groupsOver(7, 7));
    list.end();

    context().run(list);

    EXPECT_FALSE(context().takeMessages().empty());
}

TEST_F(ContextTest, AnUnfinishedListIsNotRun)
{
    compute::CommandList list(context());

    EXPECT_THROW(context().run(list), ContractViolation);
    list.end();
    context().run(list);
}

} // namespace
} // namespace palp
