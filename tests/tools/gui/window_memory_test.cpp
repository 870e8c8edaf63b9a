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

TEST_F(WindowMemory, AFolderThatCannotBeWrittenIsNoError)
{
    std::ofstream(folder_.path() / "palpate") << "a file in its place";
    rememberSize({900, 650});
    EXPECT_EQ(rememberedSize(), glm::ivec2(1280, 720));
}

} // namespace
} // namespace palp
