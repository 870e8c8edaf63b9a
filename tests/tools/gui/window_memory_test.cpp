#include "engine/tools/gui/window_memory.h"

#include <cstdlib>
#include <filesystem>
#include <fstream>

#include <gtest/gtest.h>

#include "tests/support/temporary_folder.h"

namespace palp {
namespace {

class WindowMemory : public ::testing::Test {
protected:
    WindowMemory() { setenv("XDG_CONFIG_HOME", folder_.path().c_str(), 1); }
    ~WindowMemory() override { unsetenv("XDG_CONFIG_HOME"); }
    [[nodiscard]] std::filesystem::path file() const { return folder_.path() / "palpate" / "window.json"; }

    TemporaryFolder folder_;
};

TEST_F(WindowMemory, KeepsASize)
{
    EXPECT_EQ(rememberedSize(), glm::ivec2(1280, 720)) << "nothing yet";
    rememberSize({900, 650});
    EXPECT_EQ(rememberedSize(), glm::ivec2(900, 650));
}

TEST_F(WindowMemory, WhatMakesNoSenseIsNotBelieved)
{
    rememberSize({900, 650});
    for (const char* text :
         {"", "{", "[]", R"({"width": -5, "height": 700})", R"({"width": 1e9, "height": 700})",
          R"({"width": 99999999999999999999, "height": 700})", R"({"width": "900", "height": 700})"}) {
        std::ofstream(file()) << text;
        EXPECT_EQ(rememberedSize(), glm::ivec2(1280, 720)) << text;
    }
}

TEST_F(WindowMemory, KeepsTheLastFilesThatAreStillThere)
{
    EXPECT_TRUE(isFirstWindow());
    EXPECT_TRUE(rememberedFiles().empty());
    std::vector<std::string> made;
    for (int n = 0; n < 9; ++n) {
        made.push_back((folder_.path() / ("cloud " + std::to_string(n) + ".ply")).string());
        std::ofstream(made.back()) << "ply";
        rememberFile(made.back());
    }
    rememberSize({900, 650});
    rememberFile(made[3]);
    EXPECT_FALSE(isFirstWindow());
    EXPECT_EQ(rememberedFiles(),
              (std::vector<std::string>{made[3], made[8], made[7], made[6], made[5], made[4], made[2], made[1]}))
        << "newest first, each once, eight of them";
    EXPECT_EQ(rememberedSize(), glm::ivec2(900, 650)) << "neither forgets the other";
    std::filesystem::remove(made[8]);
    EXPECT_EQ(rememberedFiles().size(), 7U);
    std::ofstream(file()) << R"({"width": 900, "height": 650, "files": [1, "/no/such/file"]})";
    EXPECT_TRUE(rememberedFiles().empty());
}

TEST_F(WindowMemory, AFolderThatCannotBeWrittenIsNoError)
{
    std::ofstream(folder_.path() / "palpate") << "a file in its place";
    rememberSize({900, 650});
    EXPECT_EQ(rememberedSize(), glm::ivec2(1280, 720));
}

} // namespace
} // namespace palp
