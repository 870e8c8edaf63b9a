#include <string>

#include <gtest/gtest.h>

#include "engine/core/contract.h"
#include "engine/core/shown_text.h"

namespace palp {
namespace {

TEST(ShownText, HasNoControlCharacterAndNothingButUtf8)
{
    EXPECT_EQ(shownText("a\x1b[2J\n\x7f"), "a?[2J??");
    EXPECT_EQ(shownText("\xc2\x9b[2J"), "?[2J") << "C1's control sequence, in UTF-8";
    EXPECT_EQ(shownText("\xe2\x80\xae"), "?") << "turns the direction of what follows";
    EXPECT_EQ(shownText("caf\xc3\xa9 \xe6\xbf\xa1 \xf0\x9f\x96\x90"), "caf\xc3\xa9 \xe6\xbf\xa1 \xf0\x9f\x96\x90");
    EXPECT_EQ(shownText("caf\xe9"), "caf?") << "Latin-1";
    EXPECT_EQ(shownText("\xc0\xaf\xed\xa0\x80\xe2\x82"), "???????") << "too long a form, a surrogate, a cut character";
    EXPECT_EQ(shownText(""), "");
}

TEST(ShownText, IsCutBetweenCharacters)
{
    EXPECT_EQ(shownText("abcdef", 6), "abcdef");
    EXPECT_EQ(shownText("abcdefg", 6), "abcdef...");
    EXPECT_EQ(shownText("abcde\xc3\xa9", 6), "abcde...");
    EXPECT_EQ(inQuotes(std::string(61, 'a')), '"' + std::string(60, 'a') + "...\"");
}

TEST(ShownText, OfALongPathTheNameOfTheFileIsKept)
{
    const std::string name = "caf\xc3\xa9.csv";
    EXPECT_EQ(shownPath("a/" + name), "a/" + name);
    EXPECT_EQ(shownPath(std::string(300, 'a') + "/\n" + name), "..." + std::string(189, 'a') + "/?" + name);
    EXPECT_EQ(shownPath("a\xc3\xa9" + std::string(199, 'b')), "..." + std::string(199, 'b')) << "no half characters";
}

TEST(ShownText, IsWhatEveryErrorSays)
{
    EXPECT_STREQ(Error("a file \"\x1b]0;title\x07\" of\ntwo lines").what(), "a file \"?]0;title?\" of?two lines");
}

} // namespace
} // namespace palp
