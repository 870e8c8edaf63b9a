#include "engine/tools/plot/svg.h"

#include <gtest/gtest.h>

#include "engine/core/contract.h"
#include "tests/tools/plot/svg_reader.h"

namespace palp {
namespace {

TEST(Svg, TextOfAnyBytesStaysWellFormed)
{
    SvgDrawing svg;
    svg.text({0, 0}, "<a href=\"x\">&amp;</a>");
    svg.text({0, 0}, "tab\tbell\x07 caf\u00e9 \U0001F600 bad \xff \xc3");
    svg.text({0, 0}, "surrogate \xed\xa0\x80, overlong \xc0\xaf");

    const auto texts = test::textsOf(svg.finish({10, 10}, "\"quoted\" & <tagged>"));

    EXPECT_EQ(texts, (std::vector<std::string>{"<a href=\"x\">&amp;</a>", "tab bell  caf\u00e9 \U0001F600 bad ? ?",
                                               "surrogate ???, overlong ??"}));
}

TEST(Svg, GroundIsExplicitlyWhite)
{
    const std::string svg  = SvgDrawing().finish({20, 10}, "");
    const auto        rect = test::elementsOf(svg, "rect").at(0);

    EXPECT_EQ(rect.attributes.at("fill"), "#ffffff") << "readable on a dark page";
    EXPECT_EQ(rect.attributes.at("width"), "20");
}

TEST(Svg, ElementsHaveNoIdentifiers)
{
    SvgDrawing svg;
    svg.beginClip({1, 2}, {3, 4});
    svg.image({0, 0}, {5, 5}, Image(2, 2));
    svg.endClip();

    for (const auto& element : test::readSvg(svg.finish({10, 10}, "t")))
        EXPECT_FALSE(element.attributes.contains("id")) << "identifiers of several pictures would clash on one page";
}

TEST(Svg, NumbersAreShortAndPlain)
{
    EXPECT_EQ(svgNumber(12.5), "12.5");
    EXPECT_EQ(svgNumber(-0.001), "0");
    EXPECT_EQ(svgNumber(1.0 / 3), "0.33");
    EXPECT_EQ(svgNumber(1e6), "1000000") << "an exponent is not read everywhere";
    EXPECT_THROW((void)svgNumber(1e9), ContractViolation);
}

} // namespace
} // namespace palp
