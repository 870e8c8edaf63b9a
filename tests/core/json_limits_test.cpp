#include "engine/core/json_limits.h"

#include <algorithm>
#include <iterator>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "engine/core/json_object.h"
#include "tests/support/memory_use.h"
#include "tests/support/sanitized.h"
#include "tests/support/temporary_folder.h"

namespace palp {
namespace {

std::string lists(std::size_t levels)
{
    return std::string(levels, '[') + std::string(levels, ']');
}

std::optional<std::size_t> excessAt(std::string_view json)
{
    const auto excess = excessOf(json);
    return excess ? std::optional(excess->at) : std::nullopt;
}

TEST(JsonLimits, CountsOpenListsAndObjects)
{
    EXPECT_EQ(excessAt(""), std::nullopt);
    EXPECT_EQ(excessAt(lists(100)), std::nullopt);
    EXPECT_EQ(excessAt(lists(101)), 100u);
    EXPECT_EQ(excessAt("  " + lists(1'000'000)), 102u);
    EXPECT_EQ(excessAt("{\"a\": " + lists(100) + "}"), 6u + 99u) << "an object is a level";
    std::string beside;
    for (int n = 0; n < 300; ++n) beside += lists(1) + ",";
    EXPECT_EQ(excessAt(beside), std::nullopt);
}

TEST(JsonLimits, BracketsOfTextsAndCommentsAreNone)
{
    const std::string open(500, '[');
    EXPECT_EQ(excessAt("\"" + open + "\""), std::nullopt);
    EXPECT_EQ(excessAt(R"("\")" + open + "\""), std::nullopt) << "an escaped quote ends no text";
    EXPECT_EQ(excessAt("// " + open + "\n[]"), std::nullopt);
    EXPECT_EQ(excessAt("/* " + open + " */[]"), std::nullopt);
    EXPECT_EQ(excessAt("/*/ " + open + " */[]"), std::nullopt) << "/*/ begins a comment, and does not end it";
    EXPECT_NE(excessAt("// \r" + open), std::nullopt) << "the library ends a comment there";
    EXPECT_NE(excessAt(std::string("// \0", 4) + open), std::nullopt) << "and there";
    // What only looks like the begin of a text or a comment hides nothing.
    EXPECT_NE(excessAt("// \"\n" + open), std::nullopt);
    EXPECT_NE(excessAt("/* // */" + open), std::nullopt);
    EXPECT_NE(excessAt(R"("//")" + open), std::nullopt);
    EXPECT_NE(excessAt(R"("\\")" + open), std::nullopt) << "an escaped backslash escapes nothing";
    // Ends within a text, an escape or a comment.
    for (const char* cut : {"\"", "\"\\", "\"a", "/", "//", "/*", "/* *"})
        EXPECT_EQ(excessAt(cut), std::nullopt) << cut;
}

/// Returns the most memory that reading a text and freeing it takes, beside the text [bytes].
std::size_t memoryOf(const std::string& json)
{
    const std::size_t before = memoryNow();
    forgetMostMemory();
    EXPECT_FALSE(nlohmann::json::parse(json, nullptr, false, true).is_discarded());
    return mostMemory() - before;
}

std::string repeated(const std::string& first, const std::string& one, std::size_t count, const std::string& last)
{
    std::string text = first;
    for (std::size_t n = 0; n < count; ++n) text += one;
    return text + last;
}

/// Returns the least count of a piece with which a text is refused for its memory; 0 if 600 000 are not.
std::size_t leastRefused(const std::string& first, const std::string& one, const std::string& last)
{
    std::size_t good = 0, bad = 600'000;
    if (!excessOf(repeated(first, one, bad, last))) return 0;
    while (bad - good > 1) (excessOf(repeated(first, one, (good + bad) / 2, last)) ? bad : good) = (good + bad) / 2;
    return bad;
}

struct Shape {
    const char *name, *first, *one, *last;
    bool        isRefused;
};
const Shape kShapes[] = {
    {"objects", "[", "{},", "{}]", true},
    {"lists", "[", "[],", "[]]", true},
    {"texts", "[", "\"\",", "\"\"]", true},
    {"digits", "[", "1,", "1]", true},
    {"pairs", "[", "{\"a\":1},", "{}]", true},
    {"places", "[", "[1,2,3],", "[]]", true},
    {"words", "[", "\"abcdefghijklmnop\",", "1]", false},
    {"long words", "[", "\"abcdefghijklmnopqrstuvwxyzabcdefghijklmnopqrstuvwxyz\",", "1]", false},
    {"measured places", "[", "[0.01234, -0.0234, 1.25e-3],\n", "[]]", false},
    {"comments", "[", "/* {},{},{},{} */", "1]", false},
    {"short places", "[", "[1,2],", "[]]", true},
    {"literals", "[", "true,", "null]", true},
    {"blanks", "[", "          ", "1]", false},
    {"a long number", "[0.", "1234567890", "]", false},
    {"a long text", "[\"", "abcdefghij", "\"]", false},
};

TEST(JsonLimits, MemoryIsWhatTheLibraryTakesAtMost)
{
    for (const Shape& shape :
         std::span(kShapes).first(kSanitized ? 2 : std::size(kShapes))) { // each takes seconds there
        SCOPED_TRACE(shape.name);
        const std::size_t least = leastRefused(shape.first, shape.one, shape.last);
        EXPECT_EQ(least > 0, shape.isRefused) << least;
        const std::string text = repeated(shape.first, shape.one, least > 0 ? least - 1 : 600'000, shape.last);
        EXPECT_LE(memoryOf(text), kMostPerByteOfJson * text.size() + kMostBesideJson) << "of what is read";
        if (least == 0) continue;
        // What is refused takes more, or is within a fifth of it: the count is no guess. A list doubles at once.
        const std::string refused = repeated(shape.first, shape.one, least + least / 5, shape.last);
        EXPECT_GT(memoryOf(refused), kMostPerByteOfJson * text.size() + kMostBesideJson) << "of what is refused";
    }
}

TEST(JsonLimits, MemoryOfManyNamesIsWhatTheLibraryTakesAtMost)
{
    for (const char* name : {"", "a name of more than fifteen bytes "}) {
        SCOPED_TRACE(name);
        std::string text = "{", read;
        for (int n = 0; n < 400'000 && !excessOf(text + "}"); n += 10'000) {
            read = text + "}";
            for (int k = n; k < n + 10'000; ++k)
                text += (k > 0 ? ",\"" : "\"") + std::string(name) + std::to_string(k) + "\":1";
        }
        EXPECT_EQ(excessOf(text + "}").has_value(), *name == '\0') << "short names take most";
        EXPECT_LE(memoryOf(read), kMostPerByteOfJson * read.size() + kMostBesideJson);
    }
}

TEST(JsonLimits, ComplaintsTakeWhatIsCounted)
{
    for (const char* piece : {"\n", "\t \n", " ", "/*\n*/", "true "}) {
        SCOPED_TRACE(piece);
        for (std::size_t count : {10'000, 100'000, 1'000'000}) {
            const std::string text = "{\"a\": " + repeated("", piece, count, "x");
            if (excessOf(text)) continue;
            const std::size_t before = memoryNow();
            forgetMostMemory();
            EXPECT_TRUE(
                holds(refusalOf([&] { static_cast<void>(JsonObject::parse(text, "scene")); }), {"not valid JSON"}));
            EXPECT_LE(mostMemory() - before, kMostPerByteOfJson * text.size() + kMostBesideJson) << count;
        }
    }
    EXPECT_TRUE(excessOf("{\"a\": " + repeated("", "\n", 1'000'000, "x")));
}

TEST(JsonLimits, WhatIsNoJsonIsScannedToItsEnd)
{
    using At = std::optional<std::size_t>;
    for (const auto& [piece, at] : {std::pair<const char*, At>{"{", 100},
                                    {"[", 100},
                                    {"{:", 200},
                                    {"{{:}", 397},
                                    {"}", {}},
                                    {"]", {}},
                                    {":", {}},
                                    {",", {}},
                                    {"}:", {}},
                                    {":}", {}},
                                    {"{]", {}},
                                    {"[}", {}},
                                    {":]]", {}},
                                    {"-e+", {}}})
        EXPECT_EQ(excessAt(repeated("", piece, 50'000, "")), at) << piece;
    EXPECT_EQ(excessAt(repeated("", ":}", 1000, "{{{:")), std::nullopt);
}

TEST(JsonLimits, WhatATextIsAPartOfCounts)
{
    const std::string text = repeated("[", "{},", 1'000'000, "{}]");
    EXPECT_TRUE(excessOf(text, 2 * text.size()));
    EXPECT_FALSE(excessOf(text, 10 * text.size()));
}

TEST(JsonLimits, AnObjectThatTakesTooMuchMemoryIsRefusedByItsLine)
{
    const std::string text = repeated("{\"cells\":\n[", "{},\n", 20'000, "{}]}");
    EXPECT_EQ(JsonObject::parse(text, "small.json").kind("cells"), JsonObject::Kind::list);
    const std::string more = repeated("{\"cells\":\n[", "{},\n", 1'000'000, "{}]}");
    const auto line = std::to_string(1 + std::count(more.begin(), more.begin() + long(excessAt(more).value()), '\n'));
    EXPECT_GT(line.size(), 5u) << "where it gets too much, not where it begins";
    EXPECT_TRUE(holds(refusalOf([&] { static_cast<void>(JsonObject::parse(more, "wide.json")); }),
                      {"wide.json: line " + line + ": expected", "8 times the file's size in memory"}));
}

TEST(JsonLimits, AnObjectThatIsTooDeepIsRefusedByItsLine)
{
    const std::string text = "{\n\"cells\":\n" + lists(200'000) + "}";
    EXPECT_TRUE(holds(refusalOf([&] { static_cast<void>(JsonObject::parse(text, "deep.json")); }),
                      {"deep.json: line 3", "100 levels"}));
    const JsonObject bears = JsonObject::parse("{\"cells\": " + lists(99) + "}", "scene");
    EXPECT_TRUE(holds(refusalOf([&] { static_cast<void>(bears.number("cells")); }), {"cells", "number"}));
}

} // namespace
} // namespace palp
