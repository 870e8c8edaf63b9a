#include "engine/cloud/detail/ply_file.h"

#include <cmath>
#include <limits>

#include "tests/cloud/cloud_parsing.h"

namespace palp {
namespace {

LoadedCloud ply(const std::string& bytes, const CloudReadSettings& settings = {})
{
    return parsed(bytes, CloudFormat::ply, settings);
}

std::string plyRefusal(const std::string& bytes, const CloudReadSettings& settings = {})
{
    return refusalOf(bytes, CloudFormat::ply, settings);
}

/// An ascii header for `rows` points whose properties are the given lines.
std::string asciiHeader(std::uint64_t rows, const std::string& properties = "property float x\nproperty float y\n"
                                                                            "property float z\n")
{
    return "ply\nformat ascii 1.0\nelement vertex " + std::to_string(rows) + "\n" + properties + "end_header\n";
}

constexpr const char* kBinaryXyz = "ply\nformat binary_little_endian 1.0\nelement vertex 2\nproperty float x\n"
                                   "property float y\nproperty float z\nend_header\n";

/// Two points of floats behind kBinaryXyz.
std::string binaryXyz()
{
    std::string bytes = kBinaryXyz;
    for (const float value : {1.f, 2.f, 3.f, 4.f, 5.f, 6.f}) append(bytes, value);
    return bytes;
}

void appendAs(std::string& bytes, const std::string& type, double value, std::endian order)
{
    if (type == "char" || type == "int8") append(bytes, std::int8_t(value), order);
    if (type == "uchar" || type == "uint8") append(bytes, std::uint8_t(value), order);
    if (type == "short" || type == "int16") append(bytes, std::int16_t(value), order);
    if (type == "ushort" || type == "uint16") append(bytes, std::uint16_t(value), order);
    if (type == "int" || type == "int32") append(bytes, std::int32_t(value), order);
    if (type == "uint" || type == "uint32") append(bytes, std::uint32_t(value), order);
    if (type == "float" || type == "float32") append(bytes, float(value), order);
    if (type == "double" || type == "float64") append(bytes, value, order);
}

struct Scalar {
    std::string type;
    double      smallest; ///< that the type holds and an ascii file of it may state
    double      largest;
};

const std::vector<Scalar> kScalars = {
    {"char", -128, 127},      {"int8", -128, 127},       {"uchar", 0, 255},         {"uint8", 0, 255},
    {"short", -32768, 32767}, {"int16", -32768, 32767},  {"ushort", 0, 65535},      {"uint16", 0, 65535},
    {"int", -1e9, 1e9},       {"int32", -1e9, 1e9},      {"uint", 0, 1e9},          {"uint32", 0, 1e9},
    {"float", -0.375, 0.25},  {"float32", -0.375, 0.25}, {"double", -0.1, 1.0 / 3}, {"float64", -0.1, 1.0 / 3}};

class PlyTypes : public testing::TestWithParam<Scalar> {};

TEST_P(PlyTypes, AreReadExactlyInEveryEncodingAndSpelling)
{
    const auto& [type, smallest, largest] = GetParam();
    for (const std::string format : {"ascii", "binary_little_endian", "binary_big_endian"}) {
        const std::endian order = format == "binary_big_endian" ? std::endian::big : std::endian::little;
        std::string       bytes = "ply\nformat " + format + " 1.0\nelement vertex 2\n";
        for (const std::string name : {"x", "y", "z", "stiffness"}) bytes += "property " + type + " " + name + "\n";
        bytes += "end_header\n";
        for (const double value : {smallest, largest, 1.0, 2.0, largest, smallest, 0.0, 3.0}) {
            if (format == "ascii") {
                std::ostringstream text;
                text.precision(17);
                text << value << (value == 2.0 || value == 3.0 ? "\n" : " ");
                bytes += text.str();
            } else {
                appendAs(bytes, type, value, order);
            }
        }

        const LoadedCloud loaded = ply(bytes);

        EXPECT_EQ(loaded.cloud.positions()[0], glm::dvec3(smallest, largest, 1)) << format;
        EXPECT_EQ(loaded.cloud.positions()[1], glm::dvec3(largest, smallest, 0)) << format;
        EXPECT_EQ(loaded.cloud.stiffness()[0], 2) << format;
        EXPECT_EQ(loaded.cloud.stiffness()[1], 3) << format;
    }
}

INSTANTIATE_TEST_SUITE_P(All, PlyTypes, testing::ValuesIn(kScalars),
                         [](const auto& tested) { return tested.param.type; });

TEST(PlyFile, UnsignedThirtyTwoBitValuesAreNotReadAsSigned)
{
    std::string bytes = "ply\nformat binary_little_endian 1.0\nelement vertex 2\nproperty uchar x\nproperty uchar y\n"
                        "property uchar z\nproperty uint stiffness\nend_header\n";
    for (const std::uint8_t x : {1, 2}) {
        for (int k = 0; k < 3; ++k) append(bytes, x);
        append(bytes, std::uint32_t(0xFFFF'FFFE) + x - 1);
    }

    EXPECT_EQ(ply(bytes).cloud.stiffness()[1], 4294967295.0);
}

TEST(PlyFile, PropertiesMayComeInAnyOrderAndBetweenUnusedOnesAndLists)
{
    for (const std::endian order : {std::endian::little, std::endian::big}) {
        std::string bytes = std::string("ply\nformat ") +
                            (order == std::endian::big ? "binary_big_endian" : "binary_little_endian") +
                            " 1.0\nelement vertex 2\nproperty list uchar short neighbours\nproperty double z\n"
                            "property uchar red\nproperty float D\nproperty float y\nproperty list int float weights\n"
                            "property short x\nend_header\n";
        for (const int point : {0, 1}) {
            append(bytes, std::uint8_t(point), order);
            for (int k = 0; k < point; ++k) append(bytes, std::int16_t(7), order);
            append(bytes, 0.5 + point, order);
            append(bytes, std::uint8_t(200), order);
            append(bytes, 2.5f, order);
            append(bytes, -1.5f, order);
            append(bytes, std::int32_t(3), order);
            for (int k = 0; k < 3; ++k) append(bytes, 9.f, order);
            append(bytes, std::int16_t(-4), order);
        }

        const LoadedCloud loaded = ply(bytes);

        EXPECT_EQ(loaded.cloud.positions()[1], glm::dvec3(-4, -1.5, 1.5));
        EXPECT_EQ(loaded.cloud.stiffness()[1], 2.5);
        EXPECT_EQ(loaded.report.properties, (std::vector<std::string>{"z", "red", "D", "y", "x"}));
    }
}

TEST(PlyFile, OtherElementsBeforeAndAfterThePointsAreSkipped)
{
    const std::string text =
        "ply\nformat ascii 1.0\nelement camera 1\nproperty float view\nproperty list uchar int bits\n"
        "element vertex 2\nproperty float x\nproperty float y\nproperty float z\n"
        "element face 2\nproperty list uchar int vertex_indices\nelement nothing 5\nend_header\n"
        "0.5 2 8 9\n1 2 3\n4 5 6\n3 0 1 0\n0\n";
    std::string bytes = "ply\nformat binary_little_endian 1.0\nelement camera 1\nproperty float view\n"
                        "property double far\nelement vertex 2\nproperty float x\nproperty float y\nproperty float z\n"
                        "element face 2\nproperty list uchar int vertex_indices\nelement nothing 1000000000000\n"
                        "end_header\n";
    append(bytes, 0.5f);
    append(bytes, 0.5);
    for (const float value : {1.f, 2.f, 3.f, 4.f, 5.f, 6.f}) append(bytes, value);
    append(bytes, std::uint8_t(3));
    for (const int index : {0, 1, 0}) append(bytes, std::int32_t(index));
    append(bytes, std::uint8_t(0));

    EXPECT_EQ(ply(text).cloud.positions()[1], glm::dvec3(4, 5, 6));
    EXPECT_EQ(ply(bytes).cloud.positions()[1], glm::dvec3(4, 5, 6));
}

TEST(PlyFile, CarriageReturnsCommentsAndObjectInfoAreAccepted)
{
    const auto withCarriageReturns = [](const std::string& text) {
        std::string changed;
        for (const char c : text) {
            if (c == '\n') changed += '\r';
            changed += c;
        }
        return changed;
    };
    const std::string ascii =
        withCarriageReturns("ply\nformat ascii 1.0\ncomment made by hand\nobj_info num_cols 512\nelement vertex 2\n"
                            "property float x\nproperty float y\nproperty float z\nend_header\n1 2 3\n\n4 5 6\n\n");
    const std::string body   = binaryXyz().substr(std::string(kBinaryXyz).size());
    const std::string binary = withCarriageReturns(kBinaryXyz) + body;

    EXPECT_EQ(ply(ascii).cloud.positions()[1], glm::dvec3(4, 5, 6));
    EXPECT_EQ(ply(binary).cloud.positions()[1], glm::dvec3(4, 5, 6));
}

TEST(PlyFile, TheLastAsciiLineMayLackItsEnd)
{
    EXPECT_EQ(ply(asciiHeader(2) + "1 2 3\n4 5 6").cloud.size(), 2u);
}

TEST(PlyFile, QualityOfMeshLabBecomesStiffnessOnlyWhenItIsNamed)
{
    std::string bytes =
        "ply\nformat binary_little_endian 1.0\ncomment VCGLIB generated\nelement vertex 2\n"
        "property float x\nproperty float y\nproperty float z\nproperty uchar red\nproperty uchar green\n"
        "property uchar blue\nproperty uchar alpha\nproperty float quality\nelement face 1\n"
        "property list uchar int vertex_indices\nend_header\n";
    for (const float x : {1.f, 2.f}) {
        for (int k = 0; k < 3; ++k) append(bytes, x);
        append(bytes, std::uint32_t(0xFF00FF00));
        append(bytes, x * 10);
    }
    append(bytes, std::uint8_t(3));
    for (const int index : {0, 1, 0}) append(bytes, std::int32_t(index));

    const LoadedCloud unnamed = ply(bytes);
    const LoadedCloud named   = ply(bytes, withProperty("quality"));

    EXPECT_EQ(unnamed.cloud.stiffness()[1], kDefaultModulus);
    EXPECT_TRUE(contains(unnamed.report.stiffnessSource, {"uniform", "x, y, z, red, green, blue, alpha, quality"}));
    EXPECT_FALSE(unnamed.report.stiffnessProperty);
    EXPECT_EQ(named.cloud.stiffness()[1], 20);
    EXPECT_TRUE(contains(named.report.stiffnessSource, {"\"quality\"", "modulus [Pa]"}));
    EXPECT_EQ(named.report.stiffnessProperty->smallest, 10);
    EXPECT_EQ(named.report.stiffnessProperty->largest, 20);
    EXPECT_EQ(named.report.format, "PLY, binary little-endian");
}

TEST(PlyFile, ScalarFieldsOfCloudCompareAreFoundByTheirPrefix)
{
    const std::string bytes = "ply\nformat ascii 1.0\ncomment Created by CloudCompare v2.11.3\n"
                              "comment Created Sat Jan 1 00:00:00 2022\nobj_info Generated by CloudCompare!\n"
                              "element vertex 2\nproperty float x\nproperty float y\nproperty float z\n"
                              "property float scalar_intensity\nproperty float scalar_stiffness\nend_header\n"
                              "1 2 3 0.5 1000\n4 5 6 0.5 2000\n";

    const LoadedCloud loaded = ply(bytes);

    EXPECT_EQ(loaded.cloud.stiffness()[1], 2000);
    EXPECT_EQ(loaded.cloud.kind(), StiffnessKind::modulus);
    EXPECT_TRUE(contains(loaded.report.stiffnessSource, {"\"scalar_stiffness\""}));
}

TEST(PlyFile, AHeaderThatPromisesMoreThanTheFileHoldsIsRefusedBeforeAnythingIsAllocated)
{
    const std::string binary = "ply\nformat binary_little_endian 1.0\nelement vertex 1000000000000\nproperty float x\n"
                               "property float y\nproperty float z\nend_header\n1234";
    const std::string before =
        "ply\nformat binary_little_endian 1.0\nelement camera 1000000000000\nproperty float v\n"
        "element vertex 1\nproperty float x\nproperty float y\nproperty float z\nend_header\n1234";

    EXPECT_TRUE(contains(plyRefusal(binary), {"1000000000000 points", "12 bytes", "only 4 bytes",
                                              "byte " + std::to_string(binary.size() - 4)}));
    EXPECT_TRUE(contains(plyRefusal(before), {"1000000000000 rows of element \"camera\"", "only 4 bytes"}));
    EXPECT_TRUE(contains(plyRefusal(asciiHeader(1000000000000) + "1 2 3\n"), {"1000000000000 points", "6 bytes"}));
    EXPECT_TRUE(contains(plyRefusal(asciiHeader(3) + "1 2 3\n4 5 6\n"), {"3 points of at least 6 bytes", "only 12"}));
}

TEST(PlyFile, MorePointsThanAnIndexHoldsAreRefusedEvenIfTheFileIsLargeEnough)
{
    std::istringstream stream(asciiHeader(4294967295u) + "1 2 3\n");

    try {
        static_cast<void>(parseCloud(stream, std::uint64_t(1) << 40, "test", CloudFormat::ply));
        FAIL() << "4294967295 points were accepted";
    } catch (const Error& error) {
        EXPECT_TRUE(contains(error.what(), {"at most 4294967294 points", "found 4294967295"}));
    }
}

TEST(PlyFile, ATruncatedBodyIsRefusedWithItsByte)
{
    std::string whole = binaryXyz();
    std::string lists = "ply\nformat binary_little_endian 1.0\nelement vertex 2\nproperty list uchar int n\n"
                        "property uchar x\nproperty uchar y\nproperty uchar z\nend_header\n";
    const auto  body  = lists.size();
    lists += std::string("\1....123\0", 9);

    EXPECT_TRUE(contains(
        plyRefusal(whole.substr(0, whole.size() - 1)),
        {"byte " + std::to_string(std::string(kBinaryXyz).size()), "2 points", "12 bytes each", "only 23 bytes"}));
    EXPECT_TRUE(contains(plyRefusal(lists), {"byte " + std::to_string(body + 9), "expected 1 more bytes, found 0"}));
    EXPECT_TRUE(contains(plyRefusal(asciiHeader(2) + "1 2 3           \n"), {"expected 2 rows", "found 1"}));
    EXPECT_TRUE(contains(plyRefusal(asciiHeader(2) + "1 2 3\n4 5     \n"), {"line 9", "\"z\"", "end of the line"}));
}

TEST(PlyFile, AStreamThatEndsBeforeItsStatedSizeIsRefused)
{
    const std::string  bytes = binaryXyz();
    std::istringstream stream(bytes.substr(0, bytes.size() - 5));

    EXPECT_THROW(static_cast<void>(parseCloud(stream, bytes.size(), "test", CloudFormat::ply)), Error);
}

TEST(PlyFile, ListsThatLieAboutTheirLengthAreRefused)
{
    const auto with = [](const char* type, auto length) {
        std::string bytes = std::string("ply\nformat binary_little_endian 1.0\nelement vertex 1\nproperty list ") +
                            type + " double n\nproperty uchar x\nproperty uchar y\nproperty uchar z\nend_header\n";
        append(bytes, length);
        return bytes + "12345678"; // room for one number
    };

    EXPECT_TRUE(
        contains(plyRefusal(with("int", std::int32_t(-1))),
                 {"byte " + std::to_string(with("int", std::int32_t(-1)).size() - 12), "list \"n\" promises -1"}));
    EXPECT_TRUE(contains(plyRefusal(with("uint", 0xFFFF'FFFFu)), {"promises 4294967295", "from 0 to 1"}));
    EXPECT_TRUE(contains(plyRefusal(with("uchar", std::uint8_t(200))), {"promises 200", "from 0 to 1"}));
    EXPECT_TRUE(contains(plyRefusal(asciiHeader(1, "property list int int n\nproperty int x\nproperty int y\n"
                                                   "property int z\n") +
                                    "999999999999 1 2 3\n"),
                         {"line 9", "list \"n\" promises 999999999999", "ends after 3"}));
    EXPECT_TRUE(contains(plyRefusal(asciiHeader(1, "property list int int n\nproperty int x\nproperty int y\n"
                                                   "property int z\n") +
                                    "-1 1 2 3\n"),
                         {"line 9", "found \"-1\""}));
    EXPECT_TRUE(contains(plyRefusal(asciiHeader(1, "property list float int n\n")), {"line 4", "whole-number type"}));
}

TEST(PlyFile, HeadersThatMakeNoSenseAreRefusedWithTheirLine)
{
    const std::string xyz = "property float x\nproperty float y\nproperty float z\n";
    const std::vector<std::pair<std::string, std::vector<std::string>>> cases = {
        {"", {"no PLY file"}},
        {"solid cube\n", {"line 1", "no PLY file"}},
        {"ply\nformat ascii 1.0\nelement vertex 1\n" + xyz, {"ends inside the header", "end_header"}},
        {"ply\nelement vertex 1\n" + xyz + "end_header\n1 2 3\n", {"line format", "found none"}},
        {"ply\nformat ascii 1.0\nformat ascii 1.0\n", {"line 3", "found a second"}},
        {"ply\nformat binary_middle_endian 1.0\n", {"line 2", "binary_middle_endian"}},
        {"ply\nformat ascii 2.0\n", {"line 2", "version 1.0", "\"2.0\""}},
        {"ply\nformat ascii 1.0 beta\n", {"line 2", "unexpected words"}},
        {"ply\nformat ascii 1.0\nelement vertex -5\n", {"line 3", "from 0 up", "\"-5\""}},
        {"ply\nformat ascii 1.0\nelement vertex 1e3\n", {"line 3", "\"1e3\""}},
        {"ply\nformat ascii 1.0\nelement vertex 99999999999999999999\n", {"line 3", "from 0 up"}},
        {"ply\nformat ascii 1.0\nelement vertex\n", {"line 3", "\"\""}},
        {"ply\nformat ascii 1.0\nelement\n", {"line 3", "found no name"}},
        {"ply\nformat ascii 1.0\nproperty float x\n", {"line 3", "element before the first property"}},
        {"ply\nformat ascii 1.0\nelement vertex 1\nproperty half x\n", {"line 4", "\"half\"", "float64"}},
        {"ply\nformat ascii 1.0\nelement vertex 1\nproperty float\n", {"line 4", "found no name"}},
        {"ply\nformat ascii 1.0\nvertices 5\n", {"line 3", "\"vertices 5\""}},
        {"ply\nformat ascii 1.0\nelement face 1\nproperty int a\nend_header\n1\n", {"element vertex", "found none"}},
        {"ply\nformat ascii 1.0\nelement vertex 1\n" + xyz + "element vertex 1\n" + xyz + "end_header\n",
         {"one element vertex", "several"}},
        {asciiHeader(0), {"the cloud is empty"}},
        {asciiHeader(1, "property float x\nproperty float y\n") + "1 2\n", {"number z for each point", "x, y"}},
        {asciiHeader(1, "property float x\nproperty float y\nproperty list uchar float z\n") + "1 2 1 3\n",
         {"number z for each point", "x, y"}},
        {asciiHeader(1, xyz + "property float x\n") + "1 2 3 4\n", {"one property \"x\"", "found several"}},
        {asciiHeader(1, xyz + "property float E\nproperty float E\n") + "1 2 3 4 5\n", {"one property \"E\""}},
        {asciiHeader(1, ""), {"number x for each point", "none"}},
    };
    for (const auto& [bytes, parts] : cases) EXPECT_TRUE(contains(plyRefusal(bytes), parts)) << bytes;
}

TEST(PlyFile, AnAbsurdlyLongLineIsRefused)
{
    const std::string noise(100'000, 'a');

    EXPECT_TRUE(contains(plyRefusal("ply\nformat ascii 1.0\ncomment " + noise + "\n"), {"line 3", "65536 bytes"}));
    EXPECT_TRUE(contains(plyRefusal(noise), {"line 1", "65536 bytes"}));
    EXPECT_EQ(ply("ply\nformat ascii 1.0\ncomment " + noise.substr(0, 60'000) + "\n" + asciiHeader(2).substr(21) +
                  "1 2 3\n4 5 6\n")
                  .cloud.size(),
              2u);
}

TEST(PlyFile, WhatFollowsTheLastElementIsRefusedInTextAndAWarningInBytes)
{
    const std::string text = asciiHeader(2) + "1 2 3\n4 5 6\n";

    EXPECT_EQ(ply(text + " \n\t\r\n").cloud.size(), 2u);
    EXPECT_TRUE(contains(plyRefusal(text + "7 8 9\n"),
                         {"byte " + std::to_string(text.size()), "end of the file", "6 more bytes"}));
    EXPECT_TRUE(contains(ply(binaryXyz() + "\n").report.warnings.at(0),
                         {"1 byte after the last row, from byte " + std::to_string(binaryXyz().size())}));
    EXPECT_TRUE(ply(binaryXyz()).report.warnings.empty());
}

TEST(PlyFile, WordsThatAreNoNumbersAreRefusedWithLineAndName)
{
    for (const std::string word : {"1,5", "0x10", "one", "1e999", "--1", "+-1", "1.0f"})
        EXPECT_TRUE(contains(plyRefusal(asciiHeader(2) + "1 2 3\n4 " + word + " 6\n"),
                             {"test: line 9", "\"y\"", "\"" + word + "\""}));
    EXPECT_TRUE(contains(plyRefusal(asciiHeader(2) + "1 2 3\n4 5 6 7\n"), {"line 9", "found more numbers"}));
}

TEST(PlyFile, MessagesRepeatNoControlCharactersOfAFile)
{
    const std::string refusal = plyRefusal("ply\nformat ascii 1.0\nelement vertex \x1b[31mred\a\n");

    EXPECT_TRUE(contains(refusal, {"?[31mred?"}));
    EXPECT_EQ(refusal.find('\x1b'), std::string::npos);
}

TEST(PlyFile, WrittenHeadersStateUnitsAndNames)
{
    const PointCloud          cloud({{0, 0, 0}, {1, 1, 1}}, {2, 3}, StiffnessKind::rigidity);
    const std::vector<double> deflection = {0.25, 0.5};
    const NamedField          field{"deflection", "m", deflection};
    std::ostringstream        stream;

    formatPly(stream, cloud, {&field, 1}, {CloudEncoding::ascii});

    EXPECT_EQ(stream.str(), "ply\nformat ascii 1.0\ncomment length_unit m\ncomment stiffness_unit N_m\n"
                            "comment unit deflection m\nelement vertex 2\nproperty double x\nproperty double y\n"
                            "property double z\nproperty double flexural_rigidity\nproperty double deflection\n"
                            "end_header\n0 0 0 2 0.25\n1 1 1 3 0.5\n");
}

} // namespace
} // namespace palp
