#include "engine/cloud/point_cloud_io.h"

#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <random>

#include "engine/cloud/tokens.h"
#include "tests/cloud/cloud_parsing.h"
#include "tests/support/temporary_folder.h"

namespace palp {
namespace {

class CloudFiles : public testing::Test {
protected:
    TemporaryFolder folder_;
};

/// Random points, and at the front the doubles that are hardest to bring back.
PointCloud hardCloud(StiffnessKind kind)
{
    using Limits                                     = std::numeric_limits<double>;
    std::vector<glm::dvec3>                positions = {{0.1, 1.0 / 3, -0.0},
                                                        {Limits::denorm_min(), -Limits::min(), 1 + Limits::epsilon()},
                                                        {123456789.123456789, -1e-300, 4.35}};
    std::vector<double>                    stiffness = {Limits::denorm_min(), Limits::max(), 5e-324 + 1e-5};
    std::mt19937_64                        generator(7);
    std::uniform_real_distribution<double> exponent(-12, 6);
    for (int i = 0; i < 1000; ++i) {
        const auto number = [&] { return std::pow(10.0, exponent(generator)) * (generator() % 2 ? 1 : -1); };
        positions.emplace_back(number(), number(), number());
        stiffness.push_back(std::abs(number()));
    }
    return {std::move(positions), std::move(stiffness), kind};
}

bool sameBits(double a, double b)
{
    return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b);
}

void expectSame(const PointCloud& read, const PointCloud& written, const std::string& what)
{
    ASSERT_EQ(read.size(), written.size()) << what;
    EXPECT_EQ(read.kind(), written.kind()) << what;
    for (std::size_t i = 0; i < read.size(); ++i) {
        for (int k = 0; k < 3; ++k)
            ASSERT_TRUE(sameBits(read.positions()[i][k], written.positions()[i][k])) << what << ", point " << i;
        ASSERT_TRUE(sameBits(read.stiffness()[i], written.stiffness()[i])) << what << ", point " << i;
    }
}

TEST_F(CloudFiles, EveryFormatBringsTheSameDoublesBack)
{
    for (const StiffnessKind kind : {StiffnessKind::modulus, StiffnessKind::rigidity}) {
        const PointCloud          cloud = hardCloud(kind);
        const std::vector<double> values(cloud.size(), std::numeric_limits<double>::quiet_NaN());
        const NamedField          field{"deflection", "m", values};
        for (const CloudEncoding encoding :
             {CloudEncoding::binaryLittleEndian, CloudEncoding::binaryBigEndian, CloudEncoding::ascii})
            for (const std::string name : {"c.ply", "c.pcd", "c.xyz", "c.txt", "c.csv", "C.PLY"}) {
                if (name == "c.pcd" && encoding == CloudEncoding::binaryBigEndian) continue;

                writeCloud(folder_ / name, cloud, {&field, 1}, {encoding});
                const LoadedCloud loaded = readCloud(folder_ / name);

                expectSame(loaded.cloud, cloud, name);
                EXPECT_EQ(loaded.report.properties.back(), "deflection");
                EXPECT_EQ(loaded.report.lengthUnitSource, "m, from the file's comment");
                EXPECT_TRUE(contains(loaded.report.stiffnessSource, {"by the file's comment"}));
            }
    }
}

TEST_F(CloudFiles, TheExtensionChoosesTheSeparator)
{
    const PointCloud cloud({{0, 0, 0}, {1, 1, 1}}, {2, 3}, StiffnessKind::modulus);
    for (const auto& [name, lastLine] : {std::pair("c.csv", "1,1,1,3"), {"c.xyz", "1 1 1 3"}, {"c.txt", "1 1 1 3"}}) {
        writeCloud(folder_ / name, cloud);

        std::ifstream file(folder_ / name);
        std::string   last;
        for (std::string line; std::getline(file, line);) last = line;
        EXPECT_EQ(last, lastLine) << name;
    }
}

TEST_F(CloudFiles, TheKindOfStiffnessSurvivesProgramsThatDropComments)
{
    writeCloud(folder_ / "c.csv", hardCloud(StiffnessKind::rigidity));
    std::ifstream file(folder_ / "c.csv");
    std::string   bytes;
    for (std::string line; std::getline(file, line);)
        if (!line.starts_with('#')) bytes += line + "\n";

    EXPECT_EQ(parsed(bytes, CloudFormat::text).cloud.kind(), StiffnessKind::rigidity);
}

TEST_F(CloudFiles, AFailedWriteLeavesTheOlderFile)
{
    const PointCloud cloud({{0, 0, 0}, {1, 1, 1}}, {2, 3}, StiffnessKind::modulus);
    writeCloud(folder_ / "c.pcd", cloud);

    EXPECT_THROW(writeCloud(folder_ / "c.pcd", hardCloud(StiffnessKind::modulus), {}, {CloudEncoding::binaryBigEndian}),
                 Error);

    EXPECT_EQ(readCloud(folder_ / "c.pcd").cloud.size(), 2u);
    EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder_.path()), {}), 1);
}

TEST_F(CloudFiles, UnknownExtensionsAreRefusedBothWays)
{
    const PointCloud cloud({{0, 0, 0}, {1, 1, 1}}, {2, 3}, StiffnessKind::modulus);
    for (const std::string name : {"scan.las", "scan", "scan.obj"}) {
        EXPECT_THROW(static_cast<void>(readCloud(folder_ / name)), Error);
        EXPECT_THROW(writeCloud(folder_ / name, cloud), Error);
    }
    EXPECT_THROW(static_cast<void>(readCloud(folder_ / "missing.ply")), Error);
    EXPECT_THROW(static_cast<void>(readCloud("/dev/null/a.ply")), Error);
}

TEST_F(CloudFiles, ErrorsNameTheFile)
{
    std::ofstream(folder_ / "bad.xyz") << "1 2 3\n4 five 6\n";
    try {
        static_cast<void>(readCloud(folder_ / "bad.xyz"));
        FAIL() << "accepted";
    } catch (const Error& error) {
        EXPECT_TRUE(contains(error.what(), {(folder_ / "bad.xyz").string() + ": line 2: "}));
    }
}

TEST(WrittenFields, WithATakenNameOrAWrongLengthAreMistakesOfTheCaller)
{
    const PointCloud          cloud({{0, 0, 0}, {1, 1, 1}}, {2, 3}, StiffnessKind::modulus);
    const std::vector<double> values = {1, 2}, one = {1};
    std::ostringstream        stream;
    for (const std::string name : {"", "x", "stiffness", "E", "two words", "a,b", "new\nline"}) {
        const NamedField field{name, "", values};
        EXPECT_THROW(formatCloud(stream, CloudFormat::ply, cloud, {&field, 1}), ContractViolation) << name;
    }
    const NamedField              tooShort{"short", "", one};
    const std::vector<NamedField> twice = {{"a", "", values}, {"a", "", values}};
    EXPECT_THROW(formatCloud(stream, CloudFormat::ply, cloud, {&tooShort, 1}), ContractViolation);
    EXPECT_THROW(formatCloud(stream, CloudFormat::ply, cloud, twice), ContractViolation);
}

// What the numbers mean is the same for all formats, so the rest uses the shortest one: text.

LoadedCloud text(const std::string& bytes, const CloudReadSettings& settings = {})
{
    return parsed(bytes, CloudFormat::text, settings);
}

std::string textRefusal(const std::string& bytes, const CloudReadSettings& settings = {})
{
    return refusalOf(bytes, CloudFormat::text, settings);
}

TEST(LengthUnit, IsTheSettingThenTheCommentThenMetres)
{
    CloudReadSettings centimetres;
    centimetres.lengthUnit = "cm";

    const LoadedCloud set     = text("# length_unit mm\n1 2 3\n4 5 6\n", centimetres);
    const LoadedCloud comment = text("# length_unit mm\n1 2 3\n4 5 6\n");
    const LoadedCloud assumed = text("# length: mm\n1 2 3\n4 5 6\n");

    EXPECT_EQ(set.cloud.positions()[1], 0.01 * glm::dvec3(4, 5, 6));
    EXPECT_EQ(set.report.lengthUnitSource, "cm, from the setting");
    EXPECT_EQ(comment.cloud.positions()[1], 0.001 * glm::dvec3(4, 5, 6));
    EXPECT_EQ(comment.report.lengthUnitSource, "mm, from the file's comment");
    EXPECT_EQ(assumed.cloud.positions()[1], glm::dvec3(4, 5, 6));
    EXPECT_TRUE(contains(assumed.report.lengthUnitSource, {"m, because neither"}));
}

TEST(LengthUnit, UnknownOrContradictoryOnesAreRefused)
{
    CloudReadSettings furlongs;
    furlongs.lengthUnit = "furlong";

    EXPECT_TRUE(contains(textRefusal("1 2 3\n", furlongs), {"from the setting", "\"furlong\"", "known units"}));
    EXPECT_TRUE(contains(textRefusal("# length_unit\n1 2 3\n"), {"from the file's comment", "\"\""}));
    EXPECT_TRUE(contains(textRefusal("# length_unit mm\n# length_unit m\n1 2 3\n"), {"line 2", "\"m\"", "\"mm\""}));
}

TEST(Stiffness, IsLookedUpInAFixedOrder)
{
    const std::vector<std::string> order = {
        "stiffness", "scalar_stiffness", "flexural_rigidity", "scalar_flexural_rigidity", "D", "E"};
    for (std::size_t first = 0; first < order.size(); ++first) {
        std::string names = "x y z quality confidence intensity", numbers = " 9 9 9";
        for (std::size_t k = order.size(); k-- > first;) {
            names.append(" ").append(order[k]);
            numbers.append(" ").append(std::to_string(100 + k));
        }
        const LoadedCloud loaded = text(names + "\n1 2 3" + numbers + "\n4 5 6" + numbers + "\n");

        EXPECT_EQ(loaded.cloud.stiffness()[0], 100 + double(first));
        EXPECT_TRUE(contains(loaded.report.stiffnessSource, {"\"" + order[first] + "\""}));
    }
}

TEST(Stiffness, QualityConfidenceAndIntensityAreNeverGuessed)
{
    const LoadedCloud loaded =
        text("x y z quality confidence intensity scalar_quality\n1 2 3 7 7 7 7\n4 5 6 8 8 8 8\n");

    EXPECT_EQ(loaded.cloud.stiffness()[1], kDefaultModulus);
    EXPECT_EQ(loaded.cloud.kind(), StiffnessKind::modulus);
    EXPECT_TRUE(contains(loaded.report.stiffnessSource, {"uniform modulus [Pa] 3", "by default", "quality"}));
}

TEST(Stiffness, AMissingPropertyIsRefusedWithTheOnesThereAre)
{
    EXPECT_TRUE(contains(textRefusal("x y z quality\n1 2 3 4\n", withProperty("Quality")),
                         {"\"Quality\"", "x, y, z, quality"}));
}

TEST(Stiffness, KindIsTheSettingThenTheCommentThenTheName)
{
    const auto kindOf = [](const std::string& comment, const std::string& name, std::optional<StiffnessKind> setting) {
        CloudReadSettings settings;
        settings.stiffnessKind = setting;
        return text(comment + "x y z " + name + "\n1 2 3 7\n4 5 6 8\n", settings).cloud.kind();
    };
    using enum StiffnessKind;

    EXPECT_EQ(kindOf("", "E", {}), modulus);
    EXPECT_EQ(kindOf("", "stiffness", {}), modulus);
    EXPECT_EQ(kindOf("", "D", {}), rigidity);
    EXPECT_EQ(kindOf("", "flexural_rigidity", {}), rigidity);
    EXPECT_EQ(kindOf("", "felt_stiffness", {}), felt);
    EXPECT_EQ(kindOf("", "scalar_felt_stiffness", {}), felt);
    EXPECT_EQ(kindOf("# stiffness_unit N_m\n", "E", {}), rigidity);
    EXPECT_EQ(kindOf("# stiffness_unit N/m\n", "stiffness", {}), felt);
    EXPECT_EQ(kindOf("# stiffness_unit Pa\n", "D", {}), modulus);
    EXPECT_EQ(kindOf("# stiffness_unit Pa\n", "D", rigidity), rigidity);
    EXPECT_EQ(kindOf("# stiffness_unit kPa\n", "stiffness", modulus), modulus);
    EXPECT_TRUE(contains(textRefusal("# stiffness_unit kPa\n1 2 3 7\n"), {"Pa, N_m or N/m", "\"kPa\""}));
}

TEST(Stiffness, IsUniformOnlyWhereTheFileHasNone)
{
    CloudReadSettings settings;
    settings.uniformStiffness = 50;
    const LoadedCloud without = text("1 2 3\n4 5 6\n", settings);
    const LoadedCloud with    = text("1 2 3 7\n4 5 6 8\n", settings);
    settings.stiffnessKind    = StiffnessKind::rigidity;
    const LoadedCloud plate   = text("1 2 3\n4 5 6\n", settings);

    EXPECT_EQ(without.cloud.stiffness()[1], 50);
    EXPECT_TRUE(contains(without.report.stiffnessSource, {"uniform", "50", "by the setting", "x, y, z"}));
    EXPECT_EQ(with.cloud.stiffness()[1], 8);
    EXPECT_EQ(plate.cloud.kind(), StiffnessKind::rigidity);

    settings.uniformStiffness.reset();
    EXPECT_TRUE(contains(textRefusal("1 2 3\n4 5 6\n", settings), {"uniform flexural rigidity"}));
    for (const double bad : {0.0, -1.0, std::nan("")}) {
        settings.uniformStiffness = bad;
        EXPECT_TRUE(contains(textRefusal("1 2 3\n4 5 6\n", settings), {"uniform stiffness above zero"}));
    }
}

TEST(Stiffness, ZeroAndNegativeValuesAreRefusedWithTheirRow)
{
    for (const std::string value : {"0", "-0", "-2.5"})
        EXPECT_TRUE(
            contains(textRefusal("1 2 3 7\n4 5 6 " + value + "\n"),
                     {"line 2", "point 1", "above zero", "\"stiffness\" " + value, "--stiffness-range FROM,TO"}));
    EXPECT_EQ(text("1 2 3 7\n4 5 6 -2\n", withRange("stiffness", 10, 20)).cloud.stiffness()[1], 10);
}

TEST(Range, MapsSmallestAndLargestExactlyOntoItsEnds)
{
    const std::string bytes = "x y z quality\n0 0 0 -1\n1 0 0 0\n2 0 0 3\n";

    const LoadedCloud linear   = text(bytes, withRange("quality", 1000, 9000));
    const LoadedCloud log      = text(bytes, withRange("quality", 1000, 16000, RangeScale::logarithmic));
    const LoadedCloud inverted = text(bytes, withRange("quality", 9000, 1000));

    EXPECT_EQ(linear.cloud.stiffness()[0], 1000);
    EXPECT_DOUBLE_EQ(linear.cloud.stiffness()[1], 3000);
    EXPECT_EQ(linear.cloud.stiffness()[2], 9000);
    EXPECT_EQ(log.cloud.stiffness()[0], 1000);
    EXPECT_NEAR(log.cloud.stiffness()[1], 2000, 2000 * 1e-14) << "1000 * 16^(1/4), logarithm and exponential round";
    EXPECT_EQ(log.cloud.stiffness()[2], 16000);
    EXPECT_EQ(inverted.cloud.stiffness()[0], 9000);
    EXPECT_EQ(inverted.cloud.stiffness()[2], 1000);
    EXPECT_EQ(linear.report.stiffnessProperty->smallest, -1);
    EXPECT_EQ(linear.report.stiffnessProperty->largest, 3);
    EXPECT_TRUE(contains(linear.report.stiffnessSource, {"\"quality\"", "-1 to 3", "linearly", "1000 to 9000 Pa"}));
    EXPECT_TRUE(contains(log.report.stiffnessSource, {"logarithmically"}));
}

TEST(Range, SurvivesTheLargestAndTheSmallestDoubles)
{
    const auto middle = [](const std::string& low, const std::string& mid, const std::string& high) {
        return text("x y z q\n0 0 0 " + low + "\n1 0 0 " + mid + "\n2 0 0 " + high + "\n", withRange("q", 1, 3))
            .cloud.stiffness()[1];
    };

    EXPECT_DOUBLE_EQ(middle("-1.7e308", "0", "1.7e308"), 2);
    EXPECT_DOUBLE_EQ(middle("0", "5e-324", "1e-323"), 2);
    EXPECT_DOUBLE_EQ(middle("1e-320", "0.5", "1"), 2);
    EXPECT_EQ(text("x y z q\n0 0 0 0\n2 0 0 1\n", withRange("q", 1e-300, 1e300, RangeScale::logarithmic))
                  .cloud.stiffness()[1],
              1e300);
}

TEST(Range, OfAConstantPropertyIsRefusedUnlessItsEndsAreEqual)
{
    const std::string bytes = "x y z q\n0 0 0 5\n1 0 0 5\n";

    EXPECT_TRUE(contains(textRefusal(bytes, withRange("q", 1, 2)), {"\"q\" is 5 at every point", "equal"}));
    EXPECT_EQ(text(bytes, withRange("q", 7, 7)).cloud.stiffness()[1], 7);
}

TEST(Range, NeedsAPropertyAndPositiveEnds)
{
    const std::string bytes = "x y z quality\n0 0 0 5\n1 0 0 6\n";

    EXPECT_TRUE(contains(textRefusal(bytes, withRange("", 1, 2)), {"range needs a property", "x, y, z, quality"}));
    EXPECT_TRUE(contains(textRefusal(bytes, withRange("quality", 0, 2)), {"lower end", "found 0"}));
    EXPECT_TRUE(contains(textRefusal(bytes, withRange("quality", 1, -2)), {"upper end", "found -2"}));
    EXPECT_TRUE(contains(textRefusal(bytes, withRange("quality", 1, INFINITY)), {"upper end", "found inf"}));
}

TEST(Range, CanMapACoordinate)
{
    const LoadedCloud loaded = text("# length_unit mm\n0 0 0\n1 0 2\n2 0 4\n", withRange("z", 1, 3));

    EXPECT_EQ(loaded.cloud.stiffness()[1], 2);
    EXPECT_EQ(loaded.cloud.positions()[2], 0.001 * glm::dvec3(2, 0, 4));
    EXPECT_EQ(loaded.report.stiffnessProperty->largest, 4) << "in the unit of the file";
}

TEST(InvalidRows, AreRefusedByNameAndRow)
{
    EXPECT_TRUE(contains(textRefusal("1 2 3 4\n1 nan 3 4\n"), {"line 2", "point 1", "\"y\" nan", "dropped"}));
    EXPECT_TRUE(contains(textRefusal("inf 2 3 4\n"), {"line 1", "point 0", "\"x\" inf"}));
    EXPECT_TRUE(contains(textRefusal("1 2 3 4\n1 2 3 -inf\n"), {"line 2", "\"stiffness\" -inf"}));
    EXPECT_TRUE(contains(textRefusal("1 2 3 4\n1 2 3 nan\n", withRange("stiffness", 1, 2)), {"\"stiffness\" nan"}));

    std::string bytes = "ply\nformat binary_little_endian 1.0\nelement vertex 2\nproperty float x\nproperty float y\n"
                        "property float z\nend_header\n";
    for (const float value : {1.f, 2.f, 3.f, 4.f, INFINITY, 6.f}) append(bytes, value);
    EXPECT_TRUE(contains(refusalOf(bytes, CloudFormat::ply),
                         {"before byte " + std::to_string(bytes.size()), "point 1", "\"y\" inf"}));
}

TEST(InvalidRows, AreDroppedAndCountedOnRequestOnly)
{
    CloudReadSettings settings;
    settings.dropInvalid = true;

    const LoadedCloud loaded = text("nan 2 3 4\n1 2 3 4\n1 2 3 inf\n4 5 6 7\n-inf 0 0 1\n", settings);

    EXPECT_EQ(loaded.cloud.size(), 2u);
    EXPECT_EQ(loaded.report.points, 2u);
    EXPECT_EQ(loaded.report.droppedPoints, 3u);
    EXPECT_EQ(loaded.report.stiffnessProperty->largest, 7);
    EXPECT_TRUE(contains(textRefusal("nan 2 3 4\n1 2 3 4\n1 2 3 0\n", settings), {"line 3", "point 2", "above zero"}));
    EXPECT_TRUE(contains(textRefusal("nan 2 3\nnan 0 0\n", settings), {"all 2 points have NaN"}));
    EXPECT_TRUE(contains(textRefusal("1 2 three\n", settings), {"line 1", "\"three\""}));
}

TEST(InvalidRows, DoNotMatterInPropertiesThatAreNotUsed)
{
    EXPECT_EQ(text("x y z quality\n1 2 3 nan\n4 5 6 inf\n").cloud.size(), 2u);
}

TEST(Positions, BeyondAnythingThatAHandCanFeelAreRefused)
{
    CloudReadSettings kilometres;
    kilometres.lengthUnit = "km";

    EXPECT_EQ(text("1e9 0 0\n0 0 0\n").cloud.bounds().high.x, 1e9);
    EXPECT_TRUE(contains(textRefusal("0 0 0\n0 -1.1e9 0\n"), {"line 2", "\"y\"", "length unit"}));
    EXPECT_TRUE(contains(textRefusal("0 0 0\n0 0 1.1e6\n", kilometres), {"\"z\"", "length unit"}));
    EXPECT_TRUE(contains(textRefusal("0 0 0\n0 1e308 0\n"), {"\"y\""}));
}

TEST(Positions, ThatAllCoincideAreRefused)
{
    EXPECT_TRUE(contains(textRefusal("1 2 3\n1 2 3\n1 2 3\n"), {"all 3 points coincide at (1, 2, 3) m"}));
    EXPECT_TRUE(contains(textRefusal("1 2 3\n"), {"its only point lies at (1, 2, 3) m"}));
    EXPECT_TRUE(contains(textRefusal("0 0 0\n-0 0 0\n"), {"all 2 points coincide"}));
    EXPECT_TRUE(contains(textRefusal("0 0 0\n0 1e-200 0\n"), {"all 2 points coincide"})) << "its square is zero";
}

TEST(Positions, ExactDuplicatesBecomeOnePointInThePlaceOfTheFirst)
{
    const LoadedCloud loaded = text("1 2 3\n4 5 6\n1 2 3\n-0 0 0\n0 0 0\n1 2 3\n1 2 3.0000000000000004\n");

    ASSERT_EQ(loaded.cloud.size(), 4u);
    EXPECT_EQ(loaded.cloud.positions()[1], glm::dvec3(4, 5, 6));
    EXPECT_EQ(loaded.cloud.positions()[2], glm::dvec3(0, 0, 0));
    EXPECT_EQ(loaded.report.points, 4u);
    EXPECT_EQ(loaded.report.duplicatePositions, 3u) << "two of (1 2 3), one of zero";
    EXPECT_EQ(loaded.pointOfRow, (std::vector<std::uint32_t>{0, 1, 0, 2, 2, 0, 3}));
    EXPECT_TRUE(contains(loaded.report.warnings.at(0), {"3 points", "merged"}));
    EXPECT_TRUE(text("1 2 3\n4 5 6\n").pointOfRow.empty());
}

TEST(Positions, EightCopiesOfEachPointAreTheCloudItself)
{
    std::string once, eightTimes;
    for (int i = 0; i < 30; ++i) {
        const std::string line =
            std::to_string(i % 6) + " " + std::to_string(i / 6) + " 0 " + std::to_string(i + 7) + "\n";
        once += line;
        for (int copy = 0; copy < 8; ++copy) eightTimes += line;
    }

    const PointCloud a = text(once).cloud, b = text(eightTimes).cloud;

    EXPECT_TRUE(std::ranges::equal(a.positions(), b.positions()));
    EXPECT_TRUE(std::ranges::equal(a.stiffness(), b.stiffness())) << "equal values stay to the bit";
}

TEST(Positions, DuplicatesHaveTheMeanOfTheLogarithmsOfTheirStiffness)
{
    const LoadedCloud loaded = text("0 0 0 100\n1 0 0 7\n0 0 0 400\n0 0 0 800\n");

    ASSERT_EQ(loaded.cloud.size(), 2u);
    EXPECT_NEAR(loaded.cloud.stiffness()[0], std::cbrt(100.0 * 400 * 800), 1e-9) << "rounding of three logarithms";
    EXPECT_EQ(loaded.cloud.stiffness()[1], 7);
}

TEST(Positions, RowsThatWereDroppedAndMergedAreMappedToTheirPoints)
{
    CloudReadSettings settings;
    settings.dropInvalid = true;

    const LoadedCloud loaded = text("nan 0 0\n1 0 0\n2 0 0\n1 inf 0\n1 0 0\n3 0 0\n", settings);

    EXPECT_EQ(loaded.pointOfRow, (std::vector<std::uint32_t>{kNoPoint, 0, 1, kNoPoint, 0, 2}));
}

TEST(Normals, AreReadByTheirUsualNamesAndMadeUnits)
{
    for (const std::string names : {"nx ny nz", "normal_x normal_y normal_z", "Nx Ny Nz"}) {
        const LoadedCloud loaded =
            text("x y z " + names + "\n0 0 0 0 0 5\n1 0 0 nan 0 1\n2 0 0 0 0 0\n3 0 0 3e200 0 -4e200\n");

        ASSERT_EQ(loaded.normals.size(), 4u) << names;
        EXPECT_EQ(loaded.normals[0], glm::vec3(0, 0, 1));
        EXPECT_EQ(loaded.normals[1], glm::vec3(0)) << "NaN counts as missing";
        EXPECT_EQ(loaded.normals[2], glm::vec3(0)) << "so does zero";
        EXPECT_EQ(loaded.normals[3], glm::vec3(0.6f, 0, -0.8f)) << "whose square overflows";
        EXPECT_EQ(loaded.report.droppedPoints, 0u);
    }
}

TEST(Normals, AreEmptyWhereAFileHasNone)
{
    EXPECT_TRUE(text("x y z nx ny\n0 0 0 0 1\n1 0 0 0 1\n").normals.empty()) << "two components are none";
    EXPECT_TRUE(text("x y z nx ny nz\n0 0 0 0 0 0\n1 0 0 0 nan 0\n").normals.empty()) << "none has a direction";
}

TEST(Normals, OfDuplicatesAreAveragedAndDroppedPointsTakeTheirsAlong)
{
    CloudReadSettings settings;
    settings.dropInvalid = true;

    const LoadedCloud loaded = text("x y z nx ny nz\n0 0 0 1 0 0\nnan 0 0 9 9 9\n1 0 0 0 0 1\n0 0 0 0 1 0\n"
                                    "2 0 0 1 0 0\n2 0 0 -1 0 0\n",
                                    settings);

    ASSERT_EQ(loaded.normals.size(), 3u);
    EXPECT_NEAR(loaded.normals[0].x, std::sqrt(0.5), 1e-7) << "rounding of a float";
    EXPECT_EQ(loaded.normals[0].x, loaded.normals[0].y);
    EXPECT_EQ(loaded.normals[1], glm::vec3(0, 0, 1));
    EXPECT_EQ(loaded.normals[2], glm::vec3(0)) << "both faces of a sheet have no common side";
}

TEST(Normals, AComponentCanBeTheStiffnessToo)
{
    const LoadedCloud loaded = text("x y z nx ny nz\n0 0 0 3 0 4\n1 0 0 0 0 1\n", withRange("nz", 1, 7));

    EXPECT_EQ(loaded.cloud.stiffness()[0], 7);
    EXPECT_EQ(loaded.normals.at(0), glm::vec3(0.6f, 0, 0.8f));
}

/// A square of 20 x 20 points, `spacing` apart, that begins at (0, north, 0).
std::string square(double north, double spacing, bool asFloats)
{
    std::string bytes;
    for (int i = 0; i < 400; ++i) {
        const double x = i % 20 * spacing, y = north + i / 20 * spacing;
        bytes += shown(asFloats ? double(float(x)) : x) + " " + shown(asFloats ? double(float(y)) : y) + " 0\n";
    }
    return bytes;
}

TEST(Rounding, IsSaidWhereItExceedsAQuarterOfTheSpacing)
{
    const CloudFileReport coarse = text(square(5.4e6, 1.7, true)).report;
    const CloudFileReport lost   = text(square(5.4e6, 0.01, true)).report;

    EXPECT_EQ(coarse.coordinateRounding, 0.5) << "of a float at 5.4e6";
    EXPECT_TRUE(contains(coarse.warnings.at(0), {"steps of 500 mm", "apart", "single precision"}));
    EXPECT_TRUE(contains(lost.warnings.back(), {"steps of 500 mm"}));
}

TEST(Rounding, IsNotSaidWhereItIsFine)
{
    const CloudFileReport doubles = text(square(5.4e6, 0.01, false)).report;
    const CloudFileReport near    = text(square(0, 0.01, true)).report;
    const CloudFileReport wide    = text(square(5.4e6, 2.5, true)).report;

    EXPECT_LT(doubles.coordinateRounding, 2e-9) << "of a double at 5.4e6";
    EXPECT_TRUE(doubles.warnings.empty());
    EXPECT_LT(near.coordinateRounding, 2e-8) << "of a float at 0.2";
    EXPECT_TRUE(near.warnings.empty());
    EXPECT_TRUE(wide.warnings.empty()) << "0.5 m is a fifth of the spacing";
}

TEST(Rounding, IsInMetresWhateverTheUnit)
{
    CloudReadSettings settings;
    settings.lengthUnit = "mm";

    EXPECT_NEAR(text(square(5.4e6, 2.5, true), settings).report.coordinateRounding, 5e-4, 1e-18) << "rounding of 0.001";
}

TEST(Positions, ThatDifferButShareAHashAreNoDuplicates)
{
    // Found by search: both have the same hash, and a reader that trusts it counts one duplicate.
    const LoadedCloud loaded = text("1 2 0\n0.13400000000000001 0.24781989622850306 0\n");

    EXPECT_EQ(loaded.report.duplicatePositions, 0u);
}

TEST(Positions, DuplicatesAreCountedAsASlowCountDoes)
{
    std::mt19937                    generator(11);
    std::string                     bytes;
    std::vector<std::array<int, 3>> seen;
    std::size_t                     expected = 0;
    for (int i = 0; i < 500; ++i) {
        const std::array<int, 3> p = {int(generator() % 8), int(generator() % 8), int(generator() % 8)};
        expected += std::find(seen.begin(), seen.end(), p) != seen.end() ? 1 : 0;
        seen.push_back(p);
        bytes += std::to_string(p[0]) + " " + std::to_string(p[1]) + " " + std::to_string(p[2]) + "\n";
    }

    EXPECT_EQ(text(bytes).report.duplicatePositions, expected);
}

TEST(Columns, AreRefusedForFilesThatNameTheirProperties)
{
    CloudReadSettings settings;
    settings.columns = "x,y,z";

    EXPECT_TRUE(contains(refusalOf("ply\n", CloudFormat::ply, settings), {"text files"}));
    EXPECT_TRUE(contains(refusalOf("", CloudFormat::pcd, settings), {"text files"}));
}

TEST(LargeFiles, AreReadRightAcrossTheBlocksOfTheReader)
{
    // A row of 27 bytes and lines of changing length end at every place of the reader's blocks.
    constexpr std::uint32_t kPoints = 120'000;
    std::string             binary = "ply\nformat binary_little_endian 1.0\nelement vertex " + std::to_string(kPoints) +
                         "\nproperty double x\nproperty double y\nproperty double z\nproperty uchar E\n"
                         "property list uchar uchar c\nend_header\n";
    std::string ascii;
    for (std::uint32_t i = 0; i < kPoints; ++i) {
        const double x = i, y = i * 0.37, z = 1.0 / (i + 1);
        for (const double value : {x, y, z}) append(binary, value);
        append(binary, std::uint8_t(i % 250 + 1));
        append(binary, std::uint8_t(1));
        append(binary, std::uint8_t(i));
        ascii += std::to_string(i) + " 0 " + std::to_string(i % 7) + std::string(i % 5, ' ') + "\n";
    }

    const LoadedCloud fromBytes = parsed(binary, CloudFormat::ply);
    const LoadedCloud fromText  = text(ascii);

    ASSERT_EQ(fromBytes.cloud.size(), kPoints);
    ASSERT_EQ(fromText.cloud.size(), kPoints);
    for (std::uint32_t i = 0; i < kPoints; ++i) {
        ASSERT_EQ(fromBytes.cloud.positions()[i], glm::dvec3(i, i * 0.37, 1.0 / (i + 1)));
        ASSERT_EQ(fromBytes.cloud.stiffness()[i], i % 250 + 1);
        ASSERT_EQ(fromText.cloud.positions()[i], glm::dvec3(i, 0, i % 7));
    }
}

} // namespace
} // namespace palp
