#include "engine/cloud/detail/byte_reader.h"

#include <sstream>

#include <gtest/gtest.h>

#include "engine/core/contract.h"

namespace palp {
namespace {

TEST(ByteReader, GivesLinesAndBytesInTurnAndCountsBoth)
{
    std::istringstream stream("one\r\n\n  \nthree\nxyz\nlast");
    ByteReader         reader(stream, 23, "test");

    EXPECT_EQ(reader.line(), "one");
    EXPECT_EQ(reader.offset(), 5u);
    EXPECT_EQ(reader.lineWithText(), "three");
    EXPECT_EQ(reader.lineNumber(), 4u);
    EXPECT_EQ(reader.take(4)[2], std::byte('z'));
    EXPECT_EQ(reader.offset(), 19u);
    EXPECT_EQ(reader.remaining(), 4u);
    EXPECT_EQ(reader.line(), "last");
    EXPECT_FALSE(reader.line());
}

TEST(ByteReader, BytesBeyondTheEndAreRefusedBeforeRoomIsMade)
{
    std::istringstream stream("12345678");
    ByteReader         reader(stream, 8, "test");
    static_cast<void>(reader.take(3));

    for (const std::uint64_t count : {std::uint64_t(6), std::uint64_t(1) << 50}) {
        try {
            static_cast<void>(reader.take(count));
            FAIL() << "took " << count << " of 5 bytes";
        } catch (const Error& error) {
            EXPECT_NE(std::string(error.what()).find("test: byte 3: "), std::string::npos) << error.what();
            EXPECT_NE(std::string(error.what()).find("found 5"), std::string::npos) << error.what();
        }
        EXPECT_THROW(reader.skip(count), Error);
    }
    EXPECT_EQ(reader.take(5)[4], std::byte('8')) << "a refused request takes nothing";
}

TEST(ByteReader, NothingBeyondTheStatedSizeIsRead)
{
    std::istringstream stream("abcdef");
    ByteReader         reader(stream, 4, "test");

    EXPECT_EQ(reader.line(), "abcd");
    EXPECT_FALSE(reader.line());
}

TEST(ByteReader, LargeTakesAndSkipsCrossItsBlocks)
{
    constexpr std::size_t kSize = 5'000'000; // several blocks
    std::string           bytes(kSize, 'a');
    bytes[3'999'999] = 'b';
    bytes[4'500'000] = 'c';
    std::istringstream stream(bytes);
    ByteReader         reader(stream, kSize, "test");

    EXPECT_EQ(reader.take(4'000'000)[3'999'999], std::byte('b'));
    reader.skip(500'000);
    EXPECT_EQ(reader.take(1)[0], std::byte('c'));
    reader.skip(reader.remaining());
    EXPECT_TRUE(reader.onlyBlanksLeft());
}

} // namespace
} // namespace palp
