#include "engine/cloud/detail/text_file.h"

#include "tests/cloud/cloud_parsing.h"

namespace palp {
namespace {

LoadedCloud text(const std::string& bytes, const CloudReadSettings& settings = {})
{
    return parsed(bytes, CloudFormat::text, settings);
}

std::string textRefusal(const std::string& bytes, const CloudReadSettings& settings = {})
{
    return refusalOf(bytes, CloudFormat::text, settings);
}

CloudReadSettings withColumns(const std::string& columns)
{
    CloudReadSettings settings;
    settings.columns = columns;
    return settings;
}

TEST(TextFile, ThreeNumbersArePositionsAndAFourthIsStiffness)
{
    EXPECT_EQ(text("1 2 3\n4 5 6\n").cloud.positions()[1], glm::dvec3(4, 5, 6));
    EXPECT_EQ(text("1 2 3\n4 5 6\n").cloud.stiffness()[1], kDefaultModulus);
    EXPECT_EQ(text("1 2 3 70\n4 5 6 80").cloud.stiffness()[1], 80);
}

TEST(TextFile, BlanksBeforeACommentOrAHeaderDoNotCount)
{
    EXPECT_EQ(text("  # a remark\n1 2 3\n4 5 6\n").cloud.positions().size(), 2U);
    EXPECT_EQ(text(" \t\n 1 2 3\n4 5 6\n").cloud.positions()[0], glm::dvec3(1, 2, 3));
    EXPECT_EQ(text("  x,y,z,stiffness  \n1,2,3,70\n4,5,6,80\n").cloud.stiffness()[0], 70);
}

TEST(TextFile, OtherPropertiesAreFoundByTheirNameUnlessTheyAreTheStiffness)
{
    const std::string bytes = "x,y,z,foundation,stiffness,stiffening,held\n1,2,3,70,8e4,300,0\n4,5,6,90,9e4,400,1\n";
    const LoadedCloud found = text(bytes);
    EXPECT_EQ(found.cloud.stiffness()[1], 9e4);
    EXPECT_EQ(found.foundation, (std::vector<double>{70, 90}));
    EXPECT_EQ(found.stiffening, (std::vector<double>{300, 400}));
    EXPECT_EQ(found.held, (std::vector<double>{0, 1}));

    CloudReadSettings chosen;
    chosen.stiffnessProperty = "foundation";
    const LoadedCloud other  = text(bytes, chosen);
    EXPECT_EQ(other.cloud.stiffness()[1], 90);
    EXPECT_TRUE(other.foundation.empty());
    EXPECT_EQ(other.stiffening.size(), 2U);
}

TEST(TextFile, TheLargestCoordinateIsStillACoordinate)
{
    EXPECT_EQ(text("0 0 0\n1e9 1e9 1e9\n").cloud.positions()[1], glm::dvec3(1e9));
    for (const std::string beyond : {"1.1e9 0 0", "0 -1.1e9 0", "0 0 1.1e9"})
        EXPECT_FALSE(textRefusal("0 0 0\n" + beyond + "\n").empty()) << beyond;
}

TEST(TextFile, BlanksTabsCommasAndSemicolonsSeparate)
{
    for (const std::string bytes : {"1 2 3 7\n4 5 6 8\n", "  1   2 3\t7 \n\t4\t5\t6\t8\t\n", "1,2,3,7\n4,5,6,8\n",
                                    "1, 2 ,3\t, 7\n4,5,6,8\n", "1;2;3;7\n4;5;6;8\n", "1;2;3;7\r\n4;5;6;8\r\n"}) {
        const LoadedCloud loaded = text(bytes);

        EXPECT_EQ(loaded.cloud.positions()[1], glm::dvec3(4, 5, 6)) << bytes;
        EXPECT_EQ(loaded.cloud.stiffness()[1], 8) << bytes;
    }
}

TEST(TextFile, AHeaderLineNamesTheColumnsInAnyOrder)
{
    for (const std::string bytes :
         {"z,label,y,x,D\n3,soft,2,1,7\n6,stiff,5,4,8\n", "\"z\";\"t\";\"Y\";\"X\";\"D\"\n3;;2;1;7\n6;;5;4;8",
          "# made by hand\n\n//Z quality Y X D\n3 0 2 1 7\n\n# half way\n6 0 5 4 8\n",
          "\xEF\xBB\xBFz quality y x D\n3 0 2 1 7\n6 0 5 4 8\n"}) {
        const LoadedCloud loaded = text(bytes);

        EXPECT_EQ(loaded.cloud.positions()[1], glm::dvec3(4, 5, 6)) << bytes;
        EXPECT_EQ(loaded.cloud.stiffness()[1], 8) << bytes;
        EXPECT_EQ(loaded.cloud.kind(), StiffnessKind::rigidity) << bytes;
    }
}

TEST(TextFile, ColumnsOfTheSettingOverruleTheHeaderAndSkipTheRest)
{
    for (const std::string bytes : {"1 2 a 3 b 7\n4 5 a 6 b 8\n", "x y q z w quality\n1 2 a 3 b 7\n4 5 a 6 b 8\n"}) {
        const LoadedCloud loaded = text(bytes, withColumns("x, y, -, z, colour, d"));

        EXPECT_EQ(loaded.cloud.positions()[1], glm::dvec3(4, 5, 6));
        EXPECT_EQ(loaded.cloud.stiffness()[1], 8);
        EXPECT_EQ(loaded.cloud.size(), 2u);
        EXPECT_TRUE(contains(loaded.report.stiffnessSource, {"\"D\"", "rigidity", "by its name"}));
    }
}

TEST(TextFile, ASmallLetterInAHeaderIsNotStiffness)
{
    EXPECT_TRUE(contains(text("x y z d\n1 2 3 7\n4 5 6 8\n").report.stiffnessSource, {"uniform"}));
    EXPECT_EQ(text("x y z d\n1 2 3 7\n4 5 6 8\n", withProperty("d")).cloud.stiffness()[1], 8);
}

TEST(TextFile, TwoSlashesMarkAHeaderEvenIfANameIsANumber)
{
    EXPECT_EQ(text("//X Y Z 7\n1 2 3 8\n4 5 6 9\n", withProperty("7")).cloud.stiffness()[1], 9);
}

TEST(TextFile, ASemicolonSeparatesEvenWhereWordsHoldCommas)
{
    EXPECT_EQ(text("x;y;z;label\n1;2;3;a,b\n4;5;6;c,d\n").cloud.positions()[1], glm::dvec3(4, 5, 6));
    EXPECT_EQ(text("1;2;3;a,b\n4;5;6;c,d\n", withColumns("x,y,z,-")).cloud.positions()[1], glm::dvec3(4, 5, 6));
}

TEST(TextFile, AQuoteAtOneEndOfANameBelongsToIt)
{
    for (const std::string name : {"a\"", "\"a"})
        EXPECT_EQ(text("x;y;z;" + name + "\n1;2;3;7\n4;5;6;8\n", withProperty(name)).cloud.stiffness()[1], 8) << name;
    EXPECT_EQ(text("x;y;z;\"a\"\n1;2;3;7\n4;5;6;8\n", withProperty("a")).cloud.stiffness()[1], 8);
}

TEST(TextFile, APropertyThatTheUserNamesKeepsItsSpelling)
{
    CloudReadSettings settings = withProperty("e");
    settings.columns           = withColumns("x,y,z,e").columns;

    EXPECT_EQ(text("1 2 3 7\n4 5 6 8\n", settings).cloud.stiffness()[1], 8);
}

TEST(TextFile, MoreThanFourColumnsNeedNames)
{
    EXPECT_TRUE(contains(textRefusal("1 2 3 0 0 1\n4 5 6 0 0 1\n"), {"line 1", "found 6 values", "--columns"}));
}

TEST(TextFile, UnitsInCommentsAreHonouredAndLateOnesRefused)
{
    const LoadedCloud loaded = text("# length_unit mm\n# stiffness_unit N_m\n1 2 3 7\n4 5 6 8\n");

    EXPECT_EQ(loaded.cloud.positions()[1], 1e-3 * glm::dvec3(4, 5, 6));
    EXPECT_EQ(loaded.cloud.kind(), StiffnessKind::rigidity);
    EXPECT_EQ(loaded.report.lengthUnitSource, "mm, from the file's comment");
    EXPECT_TRUE(contains(textRefusal("1 2 3\n# length_unit mm\n4 5 6\n"), {"line 2", "before the first point"}));
}

TEST(TextFile, RaggedLinesAreRefused)
{
    EXPECT_TRUE(contains(textRefusal("1 2 3\n4 5\n"), {"line 2", "expected 3 values between blanks", "found 2"}));
    EXPECT_TRUE(contains(textRefusal("1 2 3\n4 5 6 7\n"), {"line 2", "expected 3 values", "found 4"}));
    EXPECT_TRUE(contains(textRefusal("1,2,3\n4,5,6,\n"), {"line 2", "between commas", "found 4"}));
    EXPECT_TRUE(contains(textRefusal("1 2 3\n4,5,6\n"), {"line 2", "expected a number", "found \"4,5,6\""}));
    EXPECT_TRUE(contains(textRefusal("1 2 3 4\n", withColumns("x,y,z")), {"line 1", "columns setting", "found 4"}));
    EXPECT_TRUE(contains(textRefusal("x y z\n1 2 3 4\n"), {"line 2", "expected 3 values"}));
}

TEST(TextFile, WordsThatAreNoNumbersAreRefusedEvenOnTheFirstLine)
{
    EXPECT_TRUE(contains(textRefusal("1 2 3\n4 5 six\n"), {"line 2", "\"z\"", "\"six\""}));
    EXPECT_TRUE(contains(textRefusal("1.0 2.o 3\n4 5 6\n"), {"line 1", "\"y\"", "\"2.o\""}));
    EXPECT_TRUE(contains(textRefusal("1;2;3\n1,5;2;3\n"), {"line 2", "\"x\"", "\"1,5\""}));
    EXPECT_TRUE(contains(textRefusal("1,2,3\n4,,6\n"), {"line 2", "\"y\"", "\"\""}));
}

TEST(TextFile, FilesWithoutPointsOrCoordinatesAreRefused)
{
    for (const std::string bytes : {"", "\n\n", "# nothing\n", "x y z\n"})
        EXPECT_TRUE(contains(textRefusal(bytes), {"the cloud is empty"})) << bytes;
    EXPECT_TRUE(contains(textRefusal("1 2\n3 4\n"), {"number z for each point", "x, y"}));
    EXPECT_TRUE(contains(textRefusal("a b c\n1 2 3\n"), {"number x for each point", "a, b, c"}));
    EXPECT_TRUE(contains(textRefusal("x y z x\n1 2 3 4\n"), {"one property \"x\""}));
    EXPECT_TRUE(contains(textRefusal("1 2 3\n", withColumns("x,y,y")), {"one property \"y\""}));
    EXPECT_TRUE(contains(textRefusal("1 2 3\n", withColumns("x,y,-")), {"number z"}));
}

TEST(TextFile, BinaryNoiseIsRefused)
{
    EXPECT_FALSE(textRefusal(std::string("\0\1\2\3\n\0\0\0", 8)).empty());
    EXPECT_TRUE(contains(textRefusal(std::string(200'000, '7')), {"line 1", "65536 bytes"}));
}

TEST(TextFile, WrittenTextStatesUnitsAndNames)
{
    const PointCloud          cloud({{0, 0.1, -1e-300}, {1, 1, 1}}, {2, 3}, StiffnessKind::modulus);
    const std::vector<double> deflection = {0.25, 0.5};
    const NamedField          field{"deflection", "m", deflection};
    std::ostringstream        stream;

    CloudWriteSettings commas;
    commas.separator = ',';
    formatText(stream, cloud, {&field, 1}, commas);

    EXPECT_EQ(stream.str(), "# length_unit m\n# stiffness_unit Pa\n# unit deflection m\nx,y,z,stiffness,deflection\n"
                            "0,0.1,-1e-300,2,0.25\n1,1,1,3,0.5\n");
}

} // namespace
} // namespace palp
