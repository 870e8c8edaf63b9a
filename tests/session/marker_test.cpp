#include "engine/session/marker.h"

#include <string>

#include <gtest/gtest.h>

namespace palp {
namespace {

TEST(Marker, PlainTextIsKept)
{
    EXPECT_EQ(markerText("left hand"), "left hand");
    EXPECT_EQ(markerText("Gr\xC3\xBC\xC3\x9F"
                         "e \xF0\x9F\x91\x8B"),
              "Gr\xC3\xBC\xC3\x9F"
              "e \xF0\x9F\x91\x8B");
}

TEST(Marker, ControlCharactersBecomeBlanksAndEndsAreTrimmed)
{
    EXPECT_EQ(markerText("stop\r\n"), "stop");
    EXPECT_EQ(markerText("\x1b[2Jgone"), "[2Jgone") << "nothing that a terminal obeys";
    EXPECT_EQ(markerText(std::string("a\0b\tc\x7F"
                                     "d",
                                     7)),
              "a b c d");
    EXPECT_EQ(markerText("C1:\xC2\x9B"
                         "31m"),
              "C1: 31m");
    EXPECT_EQ(markerText("abc\xE2\x80\xAE"
                         "def"),
              "abc def")
        << "the direction of a text is not turned";
    EXPECT_EQ(markerText(""), "marker");
    EXPECT_EQ(markerText(" \n "), "marker");
}

TEST(Marker, WhatIsNotUtf8IsMarkedAsUnknown)
{
    const std::string unknown = "\xEF\xBF\xBD";
    EXPECT_EQ(markerText("a\xFFz"), "a" + unknown + "z");
    EXPECT_EQ(markerText("\xC3"), unknown) << "half a character";
    EXPECT_EQ(markerText("\xC0\xAF"), unknown + unknown) << "a longer form than need be";
    EXPECT_EQ(markerText("\xE0\x80\x80"), unknown + unknown + unknown);
    EXPECT_EQ(markerText("\xED\xA0\x80"), unknown + unknown + unknown) << "half of a pair of UTF-16";
    EXPECT_EQ(markerText("\xF4\x90\x80\x80"), unknown + unknown + unknown + unknown) << "beyond Unicode";
}

TEST(Marker, ItIsCutBetweenTwoCharacters)
{
    EXPECT_EQ(markerText(std::string(100'000, 'x')), std::string(kMostOfMarker, 'x'));
    std::string text(kMostOfMarker - 1, 'x');
    EXPECT_EQ(markerText(text + "\xC3\xBC"), text);
}

} // namespace
} // namespace palp
