#include "engine/cloud/detail/stl_file.h"

#include <cmath>

#include <gtest/gtest.h>

#include "engine/core/counted.h"
#include "tests/cloud/cloud_parsing.h"

namespace palp {
namespace {

/// A binary file of triangles, each as nine floats.
std::string binary(const std::vector<std::array<float, 9>>& triangles, std::string head = "made by a test")
{
    head.resize(80, ' ');
    append(head, std::uint32_t(triangles.size()));
    for (const auto& corners : triangles) {
        for (int k = 0; k < 3; ++k) append(head, 0.0F); // no normal, as many programs write
        for (const float number : corners) append(head, number);
        append(head, std::uint16_t(0));
    }
    return head;
}

const std::vector<std::array<float, 9>> kTwo = {{0, 0, 0, 1, 0, 0, 1, 1, 0}, {0, 0, 0, 1, 1, 0, 0, 1, 0}};

// As printed by OpenSCAD 2021, with its indents.
const std::string kAscii = "solid OpenSCAD_Model\n"
                           "  facet normal 0 0 1\n    outer loop\n      vertex 0 0 0\n      vertex 1 0 0\n"
                           "      vertex 1 1 0\n    endloop\n  endfacet\n"
                           "  facet normal 0 0 1\n    outer loop\n      vertex 0 0 0\n      vertex 1 1 0\n"
                           "      vertex 0 1 0\n    endloop\n  endfacet\nendsolid OpenSCAD_Model\n";

std::string refusal(const std::string& bytes)
{
    return refusalOf(bytes, CloudFormat::stl);
}

std::string replaced(std::string text, const std::string& before, const std::string& after)
{
    return text.replace(text.find(before), before.size(), after);
}

TEST(StlFile, CornersAtOnePlaceBecomeOnePoint)
{
    for (const std::string& bytes : {binary(kTwo), kAscii}) {
        const LoadedCloud loaded = parsed(bytes, CloudFormat::stl);

        EXPECT_EQ(loaded.cloud.size(), 4u);
        EXPECT_EQ(loaded.cloud.positions()[3], glm::dvec3(0, 1, 0));
        EXPECT_EQ(loaded.faces, (std::vector<Triangle>{{0, 1, 2}, {0, 2, 3}}));
        EXPECT_EQ(loaded.report.faces, 2u);
        EXPECT_EQ(loaded.report.duplicatePositions, 0u);
        for (const std::string& warning : loaded.report.warnings)
            EXPECT_FALSE(contains(warning, {"one place"})) << warning;
        EXPECT_TRUE(loaded.report.lengthUnitAssumed);
        EXPECT_TRUE(loaded.report.stiffnessAssumed);
    }
}

TEST(StlFile, EachCornerHasItsOwnThreeNumbers)
{
    const std::string ascii = "solid\nfacet normal 0 0 1\nouter loop\nvertex 1 2 3\nvertex 4 -5 6\nvertex 7 8 -9\n"
                              "endloop\nendfacet\nendsolid\n";
    for (const std::string& bytes : {binary({{1, 2, 3, 4, -5, 6, 7, 8, -9}}), ascii}) {
        const LoadedCloud loaded = parsed(bytes, CloudFormat::stl);
        ASSERT_EQ(loaded.cloud.size(), 3u);
        EXPECT_EQ(loaded.cloud.positions()[0], glm::dvec3(1, 2, 3));
        EXPECT_EQ(loaded.cloud.positions()[1], glm::dvec3(4, -5, 6));
        EXPECT_EQ(loaded.cloud.positions()[2], glm::dvec3(7, 8, -9));
    }
}

TEST(StlFile, TheLengthDecidesWhetherItIsBinaryNotTheFirstWord)
{
    const LoadedCloud loaded = parsed(binary(kTwo, "solid made by a program that should not"), CloudFormat::stl);

    EXPECT_EQ(loaded.report.format, "STL, binary");
    EXPECT_EQ(loaded.faces.size(), 2u);
    EXPECT_EQ(parsed(kAscii, CloudFormat::stl).report.format, "STL, ascii");
}

TEST(StlFile, PaddingAfterTheLastTriangleIsSaidAndDoesNoHarm)
{
    for (const std::string head : {"made by a test", "solid made by a test"})
        for (const std::string& tail : {std::string("\n"), std::string(200, '\0')}) {
            const LoadedCloud loaded = parsed(binary(kTwo, head) + tail, CloudFormat::stl);
            EXPECT_EQ(loaded.faces, (std::vector<Triangle>{{0, 1, 2}, {0, 2, 3}}));
            ASSERT_FALSE(loaded.report.warnings.empty());
            EXPECT_TRUE(contains(loaded.report.warnings[0], {counted(tail.size(), "byte") + " after", "byte 184"}));
        }
}

TEST(StlFile, AsciiWordsMayBeCapitalsOnOneLineAndInSeveralSolids)
{
    std::string line = "SOLID a b c\n";
    for (const char c : kAscii.substr(kAscii.find('\n'))) line += c == '\n' ? ' ' : char(std::toupper(c));
    const std::string two = kAscii + replaced(kAscii, "vertex 1 0 0", "vertex 5 -1e-1 +0");

    EXPECT_EQ(parsed("solid" + line.substr(5), CloudFormat::stl).faces.size(), 2u);
    EXPECT_EQ(parsed(two, CloudFormat::stl).faces.size(), 4u);
    EXPECT_EQ(parsed(two, CloudFormat::stl).cloud.size(), 5u);
    // Programs print what they divided by nothing.
    EXPECT_EQ(parsed(replaced(kAscii, "normal 0 0 1", "normal -nan(ind) nan 1.#IND"), CloudFormat::stl).faces.size(),
              2u);
}

TEST(StlFile, TheUnitIsASettings)
{
    CloudReadSettings mm;
    mm.lengthUnit = "mm";
    EXPECT_EQ(parsed(binary(kTwo), CloudFormat::stl, mm).cloud.bounds().high, glm::dvec3(1e-3, 1e-3, 0));
}

TEST(StlFile, ATriangleWithACornerTwiceIsOmittedAndCounted)
{
    auto triangles = kTwo;
    triangles.push_back({0, 0, 0, 1, 0, 0, 0, 0, 0});
    triangles.push_back({0, 0, 0, 1, 0, 0, 1, 1, -0.0F}); // minus zero is zero: the first once more
    const LoadedCloud loaded = parsed(binary(triangles), CloudFormat::stl);

    EXPECT_EQ(loaded.report.degenerateFaces, 1u);
    EXPECT_EQ(loaded.faces, (std::vector<Triangle>{{0, 1, 2}, {0, 2, 3}, {0, 1, 2}}));
}

TEST(StlFile, ARefusalNamesThePlaceAndWhatWasExpected)
{
    const std::string whole = binary(kTwo);
    EXPECT_TRUE(contains(refusal(whole.substr(0, 170)), {"test: byte 80", "184 bytes for 2 triangles", "found 170"}));
    const std::string solid = binary(kTwo, "solid made by a program that should not");
    EXPECT_TRUE(contains(refusal(solid.substr(0, 170)), {"test: byte 80", "184 bytes for 2 triangles", "found 170"}));
    EXPECT_TRUE(contains(refusal("nonsense"), {"test: byte 0: expected an STL file", "8 other bytes"}));
    EXPECT_TRUE(contains(refusal(""), {"test: byte 0"}));
    EXPECT_TRUE(contains(refusal(binary({})), {"test", "at least one point"}));
    EXPECT_TRUE(contains(refusal("solid\nendsolid\n"), {"test", "at least one point"}));
    std::string lies = whole;
    lies.replace(80, 4, "\xff\xff\xff\xff");
    EXPECT_TRUE(contains(refusal(lies), {"test: byte 80", "4294967295 triangles", "found 184"}));
    EXPECT_TRUE(contains(refusal(binary({{0, 0, 0, 1, 0, 0, NAN, 1, 0}})), {"test: before byte 134: point 2", "nan"}));
    EXPECT_TRUE(
        contains(refusal(binary({{0, 0, 0, 1, INFINITY, 0, 1, 1, 0}})), {"test: before byte 134: point 1", "inf"}));

    EXPECT_TRUE(
        contains(refusal(replaced(kAscii, "outer", "inner")), {"test: line 3: expected outer, found \"inner\""}));
    EXPECT_TRUE(contains(refusal(replaced(kAscii, "vertex 1 0 0", "vertex 1 0")),
                         {"test: line 6: expected a number, found \"vertex\""}));
    EXPECT_TRUE(
        contains(refusal(replaced(kAscii, "vertex 1 0 0", "vertex 1 nan 0")), {"test: line 5: point 1", "nan"}));
    const std::size_t cut = kAscii.find("    endloop");
    EXPECT_TRUE(contains(refusal(kAscii.substr(0, cut)),
                         {"test: byte " + std::to_string(cut) + ": the file ends too early: expected endloop"}));
    EXPECT_TRUE(contains(refusal(kAscii + "facet\n"), {"test: line 17: expected solid, found \"facet\""}));
}

} // namespace
} // namespace palp
