#include "engine/core/json_depth.h"

#include <string>

#include <gtest/gtest.h>

#include "engine/core/json_object.h"
#include "tests/support/temporary_folder.h"

namespace palp {
namespace {

std::string lists(std::size_t levels)
{
    return std::string(levels, '[') + std::string(levels, ']');
}

TEST(JsonDepth, CountsOpenListsAndObjects)
{
    EXPECT_EQ(tooDeepAt(""), std::nullopt);
    EXPECT_EQ(tooDeepAt(lists(100)), std::nullopt);
    EXPECT_EQ(tooDeepAt(lists(101)), 100u);
    EXPECT_EQ(tooDeepAt("  " + lists(1'000'000)), 102u);
    EXPECT_EQ(tooDeepAt("{\"a\": " + lists(100) + "}"), 6u + 99u) << "an object is a level";
    std::string beside;
    for (int n = 0; n < 300; ++n) beside += lists(1) + ",";
    EXPECT_EQ(tooDeepAt(beside), std::nullopt);
}

TEST(JsonDepth, BracketsOfTextsAndCommentsAreNone)
{
    const std::string open(500, '[');
    EXPECT_EQ(tooDeepAt("\"" + open + "\""), std::nullopt);
    EXPECT_EQ(tooDeepAt(R"("\")" + open + "\""), std::nullopt) << "an escaped quote ends no text";
    EXPECT_EQ(tooDeepAt("// " + open + "\n[]"), std::nullopt);
    EXPECT_EQ(tooDeepAt("/* " + open + " */[]"), std::nullopt);
    EXPECT_EQ(tooDeepAt("/*/ " + open + " */[]"), std::nullopt) << "/*/ begins a comment, and does not end it";
    EXPECT_NE(tooDeepAt("// \r" + open), std::nullopt) << "the library ends a comment there";
    EXPECT_NE(tooDeepAt(std::string("// \0", 4) + open), std::nullopt) << "and there";
    // What only looks like the begin of a text or a comment hides nothing.
    EXPECT_NE(tooDeepAt("// \"\n" + open), std::nullopt);
    EXPECT_NE(tooDeepAt("/* // */" + open), std::nullopt);
    EXPECT_NE(tooDeepAt(R"("//")" + open), std::nullopt);
    EXPECT_NE(tooDeepAt(R"("\\")" + open), std::nullopt) << "an escaped backslash escapes nothing";
    // Ends within a text, an escape or a comment.
    for (const char* cut : {"\"", "\"\\", "\"a", "/", "//", "/*", "/* *"})
        EXPECT_EQ(tooDeepAt(cut), std::nullopt) << cut;
}

TEST(JsonDepth, AnObjectThatIsTooDeepIsRefusedByItsLine)
{
    const std::string text = "{\n\"cells\":\n" + lists(200'000) + "}";
    EXPECT_TRUE(holds(refusalOf([&] { static_cast<void>(JsonObject::parse(text, "deep.json")); }),
                      {"deep.json: line 3", "100 levels"}));
    const JsonObject bears = JsonObject::parse("{\"cells\": " + lists(99) + "}", "scene");
    EXPECT_TRUE(holds(refusalOf([&] { static_cast<void>(bears.number("cells")); }), {"cells", "number"}));
}

} // namespace
} // namespace palp
