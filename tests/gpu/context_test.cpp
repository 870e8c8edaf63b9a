#include <chrono>
#include <optional>
#include <thread>

#include "tests/gpu/planes.h"
#include "tests/support/shader_fixture.h"
#include "tests/support/temporary_folder.h"

namespace palp {
namespace {

class ContextTest : public ShaderTest {};

TEST_F(ContextTest, TheOpenedDeviceIsOneOfTheList)
{
    const std::vector<gpu::DeviceDescription> list = gpu::listDevices();

    ASSERT_LT(std::size_t(context().device().index), list.size());
    EXPECT_EQ(list[std::size_t(context().device().index)].name, context().device().name);
    EXPECT_TRUE(context().device().refusals.empty());
    EXPECT_GT(context().device().memory, 0u);
    EXPECT_GT(context().limits().buffer, std::size_t(1) << 26);
    EXPECT_GE(context().limits().invocations, 128u);
}

TEST_F(ContextTest, ShadersAreTestedInSoftwareUnlessAnotherDeviceIsNamed)
{
    EXPECT_TRUE(!gpu::isDeviceWord(deviceOfTests(), gpu::kLavapipeDevice) || context().device().kind == "software");
    EXPECT_FALSE(gpu::isDeviceWord(deviceOfTests(), gpu::kAutoDevice)) << "which may be the host";
    EXPECT_EQ(onHost(), gpu::isDeviceWord(deviceOfTests(), gpu::kHostDevice));
}

TEST_F(ContextTest, ADeviceThatIsNotThereIsRefusedAndEachDeviceNamed)
{
    gpu::ContextSettings settings;
    settings.device = "no such device";

    EXPECT_THROW(gpu::Context{settings}, gpu::UnknownDevice);
    const std::string sentence = refusalOf([&] { gpu::Context{settings}; });
    EXPECT_TRUE(holds(sentence, {"'no such device'"})) << sentence;
    for (const gpu::DeviceDescription& device : gpu::listDevices())
        EXPECT_TRUE(holds(sentence, {device.name})) << sentence;
}

TEST_F(ContextTest, AMovedContextStillServesWhatWasMadeFromIt)
{
    gpu::ContextSettings settings;
    settings.device = std::to_string(context().device().index);
    std::optional<gpu::Context> second; // goes last
    gpu::Context                first(settings);
    gpu::Buffer                 buffer(first, "moved", 64, gpu::Intent::readback);
    gpu::CommandList            list(first);
    list.fill(buffer, 42);
    list.end();

    second.emplace(std::move(first));
    second->run(list);

    buffer.makeVisibleToHost();
    EXPECT_EQ(buffer.as<std::uint32_t>()[15], 42u);
}

TEST_F(ContextTest, ASubmissionThatOutlastsThePatienceIsALostDevice)
{
    if (context().device().kind != "software") GTEST_SKIP() << "a device in software is slow enough";
    gpu::ContextSettings settings;
    settings.device   = std::to_string(context().device().index);
    settings.patience = 1e-9;
    gpu::Context            hasty(settings);
    const gpu::Kernel       smooth(hasty, kSmooth, {64, 1, 1});
    constexpr std::uint32_t kSide = 512;
    const gpu::Buffer       from(hasty, "from", kSide * kSide * 4, gpu::Intent::device);
    const gpu::Buffer       to(hasty, "to", kSide * kSide * 4, gpu::Intent::device);
    gpu::CommandList        list(hasty);
    list.dispatch(smooth, {from, to}, shared::PlanePush{kSide, kSide, 1}, smooth.groupsOver(kSide, kSide));
    list.end();

    bool lost = false;
    for (int n = 0; n < 100 && !lost; ++n) // on a busy machine it may be done before the wait begins
        lost = !refusalOf([&] { hasty.run(list); }).empty();

    EXPECT_TRUE(lost);
    EXPECT_THROW(hasty.run(list), gpu::DeviceLost) << "once lost, always lost";
    std::this_thread::sleep_for(std::chrono::milliseconds(300)); // it finishes, so that nothing is leaked here
}

TEST_F(ContextTest, ValidationReportsAKernelThatContradictsItsCode)
{
    if (validation() == gpu::Validation::off) GTEST_SKIP() << "validation is off";
    gpu::KernelCode without = kSmooth;
    without.pushBytes       = 0; // the shader reads 12

    const gpu::Kernel kernel(context(), without, {8, 8, 1});

    EXPECT_FALSE(context().takeMessages().empty());
    EXPECT_TRUE(context().takeMessages().empty()) << "each is told once";
}

TEST_F(ContextTest, GpuAssistedValidationReportsAWriteBeyondTheBuffer)
{
    if (validation() != gpu::Validation::gpuAssisted) GTEST_SKIP() << "GPU-assisted validation is off";
    const gpu::Kernel broken(context(), kSmoothPastEnd, {8, 8, 1});
    const gpu::Buffer from(context(), "from", 7 * 7 * 4, gpu::Intent::device);
    const gpu::Buffer to(context(), "to", 7 * 7 * 4, gpu::Intent::device);
    gpu::CommandList  list(context());
    list.fill(from, 0);
    list.dispatch(broken, {from, to}, shared::PlanePush{7, 7, 1}, broken.groupsOver(7, 7));
    list.end();

    context().run(list);

    EXPECT_FALSE(context().takeMessages().empty());
}

TEST_F(ContextTest, AnUnfinishedListIsNotRun)
{
    gpu::CommandList list(context());

    EXPECT_THROW(context().run(list), ContractViolation);
    list.end();
    context().run(list);
}

} // namespace
} // namespace palp
