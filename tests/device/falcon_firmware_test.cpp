#include "device/falcon/falcon_firmware.h"

#include <string>

#include <gtest/gtest.h>
#include <stdlib.h>
#include <sys/stat.h>

#include "tests/support/temporary_folder.h"

namespace palp {
namespace {

std::string refusalOfFile(const std::filesystem::path& path)
{
    return refusalOf([&] { static_cast<void>(readFirmware(path)); });
}

TEST(FalconFirmware, IsReadByteForByte)
{
    const TemporaryFolder folder;
    for (std::size_t size : {kLeastFalconFirmware, std::size_t(8492), kMostFalconFirmware}) {
        std::string bytes(size, '\0');
        for (std::size_t n = 0; n < size; ++n) bytes[n] = char(n * 7 + n / 256); // zeros and line ends among them

        const auto image = readFirmware(folder.write("image.bin", bytes));

        EXPECT_EQ(std::string(image.begin(), image.end()), bytes);
    }
}

TEST(FalconFirmware, AFileOfAnotherSizeIsRefusedWithWhatToDo)
{
    const TemporaryFolder folder;
    for (std::size_t size : {std::size_t(0), kLeastFalconFirmware - 1, kMostFalconFirmware + 1}) {
        const std::string refusal = refusalOfFile(folder.write("image.bin", std::string(size, 'x')));
        EXPECT_TRUE(
            holds(refusal, {"image.bin", std::to_string(size) + " bytes", "4096 to 16384", "--falcon-firmware"}))
            << refusal;
    }
    const auto huge = folder.write("huge.bin", "");
    std::filesystem::resize_file(huge, 1ull << 40); // a hole: takes no room on the disk, and would fill the memory
    EXPECT_TRUE(holds(refusalOfFile(huge), {"1099511627776"})) << refusalOfFile(huge);
}

TEST(FalconFirmware, WhatIsNoFileIsRefusedAtOnce)
{
    const TemporaryFolder folder;
    const auto            pipe = folder / "pipe";
    ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);

    EXPECT_TRUE(holds(refusalOfFile(pipe), {"pipe", "not a plain file"})) << refusalOfFile(pipe);
    EXPECT_TRUE(holds(refusalOfFile("/dev/zero"), {"/dev/zero", "not a plain file"}));
    EXPECT_TRUE(holds(refusalOfFile(folder.path()), {"not a plain file"}));
    EXPECT_TRUE(holds(refusalOfFile(folder / "missing"), {"missing", "No such file"}));
    EXPECT_TRUE(holds(refusalOfFile(""), {"no firmware", "FALCON_FIRMWARE"}));
}

TEST(FalconFirmware, TheOptionWinsOverTheEnvironment)
{
    ASSERT_EQ(::unsetenv("FALCON_FIRMWARE"), 0);
    EXPECT_EQ(falconFirmwarePath(""), "");
    ASSERT_EQ(::setenv("FALCON_FIRMWARE", "/of/the/environment", 1), 0);
    EXPECT_EQ(falconFirmwarePath(""), "/of/the/environment");
    EXPECT_EQ(falconFirmwarePath("/of/the/option"), "/of/the/option");
    ASSERT_EQ(::unsetenv("FALCON_FIRMWARE"), 0);
}

} // namespace
} // namespace palp
