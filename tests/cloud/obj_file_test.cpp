#include "engine/cloud/detail/obj_file.h"

#include <gtest/gtest.h>

#include "tests/cloud/cloud_parsing.h"

namespace palp {
namespace {

LoadedCloud obj(const std::string& text, const CloudReadSettings& settings = {})
{
    return parsed(text, CloudFormat::obj, settings);
}

std::string refusal(const std::string& text)
{
    return refusalOf(text, CloudFormat::obj);
}

const std::string kFour = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

TEST(ObjFile, CornersHaveAnyFormAndMayBeCountedFromTheLastVertex)
{
    const std::vector<Triangle> expected = {{0, 1, 2}, {0, 2, 3}};
    for (const char* face :
         {"f 1 2 3 4", "f 1/1 2/2 3/3 4/4", "f 1//1 2//1 3//1 4//1", "f 1/1/1 2/2/1 3/3/1 4/4/1", "f -4 -3 -2 -1",
          "f -4//7 2 -2/1 4", "f 1 2 \\\n  3 4", "f 1 2 3 4 # a remark", "fo 1 2 3 4", "\tf  1\t2 3 4\r"})
        EXPECT_EQ(obj(kFour + face + "\n").faces, expected) << face;
    // A comment ends where its line does, also with the name of a folder.
    EXPECT_EQ(obj("# by C:\\models\\\n" + kFour + " # and D:\\\nf 1 2 3 4\n").faces, expected);
    // -1 is the last one above, not of the file.
    EXPECT_EQ(obj("v 0 0 0\nv 1 0 0\nv 1 1 0\nf -3 -2 -1\nv 0 1 0\n").faces, (std::vector<Triangle>{{0, 1, 2}}));
}

// As Blender 3.6 exports a cube's side, with a material and groups.
TEST(ObjFile, WhatDoesNotMatterForTouchIsPassedOver)
{
    const LoadedCloud loaded =
        obj("# Blender 3.6.0\n# www.blender.org\nmtllib cube.mtl\no Cube\nvn -0.0000 1.0000 -0.0000\n"
            "vt 0.625000 0.500000\nv 0 0 0 0.8 0.1 0.1\nv 1 0 0 0.8 0.1 0.1\nv 1 1 0 1.0\nv 0 1 0\n"
            "g side\ns 0\nusemtl Material\nf 1/1/1 2/1/1 3/1/1 4/1/1\nl 1 2\n");

    EXPECT_EQ(loaded.report.format, "OBJ");
    EXPECT_EQ(loaded.cloud.size(), 4u);
    EXPECT_EQ(loaded.cloud.positions()[1], glm::dvec3(1, 0, 0));
    EXPECT_EQ(loaded.faces.size(), 2u);
    EXPECT_EQ(loaded.report.faces, 1u);
    EXPECT_TRUE(loaded.report.warnings.empty());
    EXPECT_TRUE(loaded.report.stiffnessAssumed);
}

TEST(ObjFile, LinesThatAreNotKnownAreCounted)
{
    const LoadedCloud loaded = obj(kFour + "cstype bezier\nf 1 2 3\ncurv 0 1 2\n");

    ASSERT_EQ(loaded.report.warnings.size(), 1u);
    EXPECT_TRUE(contains(loaded.report.warnings[0], {"2 lines omitted", "in line 5"}));
}

// A first vertex that was passed over would give every face the wrong corners.
TEST(ObjFile, AByteOrderMarkHidesNoVertex)
{
    const LoadedCloud loaded = obj("\xEF\xBB\xBF" + kFour + "f 1 2 3\n");

    EXPECT_EQ(loaded.cloud.size(), 4u);
    EXPECT_EQ(loaded.faces, (std::vector<Triangle>{{0, 1, 2}}));
    EXPECT_TRUE(loaded.report.warnings.empty());
}

TEST(ObjFile, ACommentMayStateTheUnitAndASettingWins)
{
    EXPECT_EQ(obj("# length_unit mm\n" + kFour).cloud.bounds().high.x, 1e-3);
    CloudReadSettings cm;
    cm.lengthUnit = "cm";
    EXPECT_EQ(obj(kFour, cm).cloud.bounds().high.x, 1e-2);
    EXPECT_TRUE(contains(refusal(kFour + "# length_unit mm\n"), {"test: line 5", "before the first vertex"}));
    EXPECT_TRUE(contains(refusal(kFour + "# stiffness_unit Pa\n"), {"test: line 5", "before the first vertex"}));
    EXPECT_EQ(obj(kFour + "v 2 0 0 # the last one\n").cloud.bounds().high.x, 2);
}

TEST(ObjFile, VerticesAtOnePlaceBecomeOneAndFacesFollow)
{
    const LoadedCloud loaded = obj(kFour + "v 1 1 0\nf 1 2 5\nf 3 4 5\n");

    EXPECT_EQ(loaded.cloud.size(), 4u);
    EXPECT_EQ(loaded.faces, (std::vector<Triangle>{{0, 1, 2}}));
    EXPECT_EQ(loaded.report.degenerateFaces, 1u);
}

TEST(ObjFile, ARefusalNamesTheLineAndWhatWasExpected)
{
    for (const char* face : {"f 1 2 5", "f 1 2 -5", "f 0 1 2", "f 1 2 3.5", "f 1 2 x", "f 1 2 /3",
                             "f 1 2 99999999999999999999", "f 1 2 +3"})
        EXPECT_TRUE(
            contains(refusal(kFour + face + "\n"), {"test: line 5: expected the number of a vertex above", "1 to 4"}))
            << face;
    EXPECT_TRUE(contains(refusal("f 1 2 3\n" + kFour), {"test: line 1", "from 1 to 0"}));
    EXPECT_TRUE(contains(refusal("v 1 2\n"), {"test: line 1: expected the three coordinates", "2 numbers"}));
    EXPECT_TRUE(contains(refusal("v 1 2 a\n"), {"test: line 1: expected a number, found \"a\""}));
    EXPECT_TRUE(contains(refusal("v 1 2 nan\nv 1 2 3\n"), {"test: line 1: point 0", "nan"}));
    EXPECT_TRUE(contains(refusal("v 1 2 3\nv 1 2 inf\n"), {"test: line 2: point 1", "inf"}));
    EXPECT_TRUE(contains(refusal("# nothing\n"), {"test: expected vertices"}));
    EXPECT_TRUE(contains(refusal(""), {"test: expected vertices"}));
    std::string endless = kFour + "f";
    for (int i = 0; i < 40'000; ++i) endless += " 1 \\\n";
    EXPECT_TRUE(contains(refusal(endless), {"test: line", "goes on for longer"}));
}

} // namespace
} // namespace palp
