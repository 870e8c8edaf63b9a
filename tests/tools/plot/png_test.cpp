#include "engine/tools/plot/png.h"

#include <random>

#include <gtest/gtest.h>

#include "engine/core/contract.h"
#include "tests/tools/plot/svg_reader.h"

namespace palp {
namespace {

TEST(Png, DecodesToTheSamePixels)
{
    std::mt19937 random(7);
    for (auto [width, height] : {std::pair(1, 1), std::pair(37, 23), std::pair(300, 2)}) {
        Image image(width, height);
        for (Rgb8& p : image.pixels) p = {std::uint8_t(random()), std::uint8_t(random()), std::uint8_t(random())};

        const std::string bytes = encodePng(image);

        EXPECT_EQ(bytes.substr(0, 8), "\x89PNG\r\n\x1a\n");
        const Image decoded = test::decodePng(bytes);
        EXPECT_EQ(decoded.width, width);
        EXPECT_EQ(decoded.height, height);
        EXPECT_EQ(decoded.pixels, image.pixels);
        EXPECT_EQ(encodePng(image), bytes);
    }
}

TEST(Png, RefusesPicturesWithoutPixels)
{
    EXPECT_THROW((void)encodePng(Image(0, 5)), ContractViolation);
    Image cut(4, 4);
    cut.pixels.pop_back();
    EXPECT_THROW((void)encodePng(cut), ContractViolation);
}

TEST(Base64, MatchesTheExamplesOfRfc4648)
{
    EXPECT_EQ(base64(""), "");
    EXPECT_EQ(base64("f"), "Zg==");
    EXPECT_EQ(base64("fo"), "Zm8=");
    EXPECT_EQ(base64("foo"), "Zm9v");
    EXPECT_EQ(base64("foob"), "Zm9vYg==");
    EXPECT_EQ(base64("fooba"), "Zm9vYmE=");
    EXPECT_EQ(base64("foobar"), "Zm9vYmFy");
    EXPECT_EQ(base64("\xff\xfe\xfd"), "//79");
}

} // namespace
} // namespace palp
