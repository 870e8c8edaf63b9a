#include <cstdlib>
#include <string>

#include <gtest/gtest.h>

#include "engine/compute/context.h"
#include "tests/support/temporary_folder.h"

// What "auto" does with a driver that does not work, broken_driver.cpp; and that nobody else's wish is changed by it.

namespace palp::compute {
namespace {

class BrokenVulkan : public ::testing::Test {
protected:
    /// \param where   see broken_driver.cpp
    /// \param others  manifests of drivers that work
    static void fail(const char* where, const std::string& others = "")
    {
        const std::string manifests = PALPATE_BROKEN_MANIFEST + (others.empty() ? "" : ":" + others);
        setenv("PALPATE_BROKEN", where, 1);
        setenv("VK_DRIVER_FILES", manifests.c_str(), 1);
        setenv("VK_ICD_FILENAMES", manifests.c_str(), 1);
    }

    static std::string refusal(const char* processor)
    {
        return refusalOf([&] { const Context context({.processor = processor}); });
    }
};

TEST_F(BrokenVulkan, AutoTakesTheHostWhereVulkanDoesNotStart)
{
    fail("start");
    const Context context;
    EXPECT_EQ(context.processor().kind, ProcessorKind::host);
    EXPECT_TRUE(holds(context.note(), {"Vulkan does not start", "vulkaninfo"})) << context.note();
    EXPECT_TRUE(holds(refusal("lavapipe"), {"Vulkan does not start"}));
    EXPECT_THROW((void)listProcessors(), ProcessorError);
}

TEST_F(BrokenVulkan, AutoTakesTheHostWhereADriverCannotListItsDevices)
{
    fail("list");
    const Context context;
    EXPECT_EQ(context.processor().kind, ProcessorKind::host);
    EXPECT_TRUE(holds(context.note(), {"cannot list", "vulkaninfo"})) << context.note();
    EXPECT_TRUE(holds(refusal("0"), {"cannot list"}));
}

TEST_F(BrokenVulkan, AutoPassesOverAGpuThatDoesNotOpen)
{
    fail("open");
    const std::vector<Processor> list = listProcessors();
    const auto                   best = chooseProcessor(list, "auto");
    ASSERT_TRUE(best && list[*best].name == "Broken Large") << "it looks like a good one";
    const Context context;
    EXPECT_EQ(context.processor().kind, ProcessorKind::host);
    EXPECT_TRUE(holds(context.note(), {"Broken Large cannot be opened", "; the GPU Broken Small cannot"}))
        << "the next best one is tried: " << context.note();
    EXPECT_TRUE(holds(refusal("large"), {"Broken Large", "cannot be opened"})) << "who names it is told";
    EXPECT_FALSE(holds(refusal("large"), {"Broken Small"})) << "and gets no other one";
}

TEST_F(BrokenVulkan, TheHostIsTakenWithoutLookingAtVulkan)
{
    for (const char* where : {"start", "list", "open"}) {
        fail(where);
        const Context context({.processor = "host"});
        EXPECT_EQ(context.processor().kind, ProcessorKind::host);
        EXPECT_EQ(context.note(), "") << where;
    }
}

TEST_F(BrokenVulkan, AMachineWithoutADriverIsNotBroken)
{
    setenv("VK_DRIVER_FILES", "/nowhere.json", 1);
    setenv("VK_ICD_FILENAMES", "/nowhere.json", 1);
    const Context context;
    EXPECT_EQ(context.processor().kind, ProcessorKind::host);
    EXPECT_EQ(context.note(), "");
}

TEST_F(BrokenVulkan, ValidationIsNotGivenUpForTheHost)
{
    fail("start");
    const auto open = [](const char* processor) { const Context context({processor, Validation::core}); };
    EXPECT_THROW(open("auto"), ProcessorError);
    EXPECT_THROW(open("host"), ProcessorError);
}

#ifdef PALPATE_LAVAPIPE_MANIFEST
TEST_F(BrokenVulkan, AutoDoesNotTakeSoftwareInPlaceOfABrokenGpu)
{
    fail("open", PALPATE_LAVAPIPE_MANIFEST);
    ASSERT_EQ(listProcessors().size(), 3u);
    const Context context;
    EXPECT_EQ(context.processor().kind, ProcessorKind::host);
    EXPECT_TRUE(holds(context.note(), {"Broken Large"})) << context.note();
    EXPECT_EQ(Context({.processor = "lavapipe"}).processor().kind, ProcessorKind::software)
        << "but where it is asked for";
}
#endif

} // namespace
} // namespace palp::compute
