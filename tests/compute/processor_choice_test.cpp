#include <gtest/gtest.h>

#include "engine/compute/processor_list.h"
#include "tests/support/temporary_folder.h"

namespace palp::compute {
namespace {

using Processors = std::vector<Processor>;

constexpr std::optional<std::size_t> kHost{};

Processor processor(int index, std::string name, ProcessorKind kind, std::vector<std::string> refusals = {})
{
    Processor description;
    description.index    = index;
    description.name     = std::move(name);
    description.kind     = kind;
    description.refusals = std::move(refusals);
    return description;
}

Processors desk()
{
    return {processor(0, "llvmpipe (LLVM 15)", ProcessorKind::software),
            processor(1, "Intel UHD 770", ProcessorKind::integrated),
            processor(2, "Intel Arc A770", ProcessorKind::discrete, {"it speaks Vulkan 1.1.0, and 1.2 is needed"}),
            processor(3, "GeForce RTX 4090", ProcessorKind::discrete),
            processor(4, "Virtio", ProcessorKind::virtualGpu)};
}

std::string refusal(const Processors& processors, std::string_view wanted)
{
    return refusalOf([&] { (void)chooseProcessor(processors, wanted); });
}

TEST(ProcessorChoice, AutoTakesTheFirstUsableGpuOfTheBestKind)
{
    Processors processors = desk();
    EXPECT_EQ(chooseProcessor(processors, "auto"), 3u);
    processors.erase(processors.begin() + 3);
    EXPECT_EQ(chooseProcessor(processors, "auto"), 1u);
    processors.erase(processors.begin() + 1);
    EXPECT_EQ(chooseProcessor(processors, "auto"), 2u) << "virtual is left";
    processors.pop_back();
    EXPECT_EQ(chooseProcessor(processors, "auto"), kHost) << "what is left is in software, or cannot be used";
}

TEST(ProcessorChoice, AutoTakesTheHostWhereThereIsNoGpu)
{
    const Processor software = processor(0, "llvmpipe", ProcessorKind::software);
    EXPECT_EQ(chooseProcessor({}, "auto"), kHost);
    EXPECT_EQ(chooseProcessor({software}, "auto"), kHost);
    EXPECT_EQ(chooseProcessor({processor(0, "Venus", ProcessorKind::other)}, "auto"), kHost) << "only when asked for";
    EXPECT_EQ(chooseProcessor({software, processor(1, "Old", ProcessorKind::discrete, {"it is too old"})}, "auto"),
              kHost);
    EXPECT_EQ(chooseProcessor({software, processor(1, "Intel UHD 770", ProcessorKind::integrated)}, "auto"), 1u);
}

TEST(ProcessorChoice, TheHostAndSoftwareAreThereWhenAskedFor)
{
    EXPECT_EQ(chooseProcessor(desk(), "host"), kHost);
    EXPECT_EQ(chooseProcessor({}, "host"), kHost);
    for (const char* wanted : {"lavapipe", "0", "llvmpipe"}) EXPECT_EQ(chooseProcessor(desk(), wanted), 0u) << wanted;
}

TEST(ProcessorChoice, LavapipeIsTheDeviceInSoftware)
{
    EXPECT_EQ(chooseProcessor(desk(), "lavapipe"), 0u);
    EXPECT_TRUE(holds(refusal({processor(0, "GeForce", ProcessorKind::discrete)}, "lavapipe"),
                      {"mesa-vulkan-drivers", "GeForce"}));
}

TEST(ProcessorChoice, WordsAreKnownInAnyCase)
{
    EXPECT_EQ(chooseProcessor(desk(), "Lavapipe"), 0u);
    EXPECT_EQ(chooseProcessor(desk(), "AUTO"), 3u);
    EXPECT_EQ(chooseProcessor(desk(), "Host"), kHost);
}

TEST(ProcessorChoice, AWrongWordIsBadUsageUnlessNoOtherWouldDo)
{
    const Processors useless{
        processor(0, "Old", ProcessorKind::discrete, {"it speaks Vulkan 1.1.0, and 1.2 is needed"})};

    for (const char* wrong : {"voodoo", "99", "", "e"}) { // the last one is part of several names
        EXPECT_THROW((void)chooseProcessor(desk(), wrong), UnknownProcessor) << wrong;
        EXPECT_THROW((void)chooseProcessor({}, wrong), ProcessorError) << wrong;
    }
    EXPECT_THROW((void)chooseProcessor(useless, "voodoo"), ProcessorError);
    EXPECT_THROW((void)chooseProcessor(desk(), "Arc"), ProcessorError) << "it is there and cannot be used";
    EXPECT_THROW((void)chooseProcessor(desk(), "2"), ProcessorError) << "it is there and cannot be used";
}

TEST(ProcessorChoice, AnIndexIsThatOfTheListNotThePlaceInIt)
{
    Processors processors = desk();
    EXPECT_EQ(chooseProcessor(processors, "1"), 1u);
    processors.erase(processors.begin());
    EXPECT_EQ(chooseProcessor(processors, "1"), 0u);
}

TEST(ProcessorChoice, PartOfANameFitsWhateverItsCase)
{
    EXPECT_EQ(chooseProcessor(desk(), "geforce"), 3u);
    EXPECT_EQ(chooseProcessor(desk(), "LLVM"), 0u);
    EXPECT_EQ(chooseProcessor(desk(), "4090"), 3u) << "no index of the list, so a name";
    EXPECT_EQ(chooseProcessor(desk(), "intel"), 1u) << "the other one cannot be used anyway";
}

TEST(ProcessorChoice, SeveralFittingNamesAreRefused)
{
    const Processors two{processor(0, "RTX 4090", ProcessorKind::discrete),
                         processor(1, "RTX 4090", ProcessorKind::discrete)};
    EXPECT_TRUE(holds(refusal(two, "rtx"), {"several", "'rtx'", "index", "; 0 is RTX", "; 1 is RTX"}));
}

TEST(ProcessorChoice, ARefusedDeviceIsRefusedWithItsReason)
{
    EXPECT_TRUE(holds(refusal(desk(), "2"), {"GPU 2", "Vulkan 1.1.0"}));
    EXPECT_TRUE(holds(refusal(desk(), "Arc"), {"'Arc'", "Vulkan 1.1.0"}));
}

TEST(ProcessorChoice, AnUnknownNameNamesEveryDevice)
{
    const std::string sentence = refusal(desk(), "voodoo");
    EXPECT_TRUE(holds(sentence, {"'voodoo'", "auto, host, lavapipe", "an index or part of a name", "; host is"}))
        << sentence;
    for (const Processor& one : desk()) EXPECT_TRUE(holds(sentence, {one.name, palp::name(one.kind)})) << sentence;
    EXPECT_NE(refusal(desk(), ""), "");
    EXPECT_NE(refusal(desk(), "99"), "");
    EXPECT_NE(refusal(desk(), "-1"), "");
}

TEST(ProcessorChoice, WithoutAnyGpuThePackageIsNamed)
{
    for (const char* wanted : {"lavapipe", "0", "geforce"})
        EXPECT_TRUE(holds(refusal({}, wanted), {"mesa-vulkan-drivers", "; host is"})) << wanted;
}

} // namespace
} // namespace palp::compute
