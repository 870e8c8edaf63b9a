#include "engine/cloud/detail/pcd_file.h"

#include "tests/cloud/cloud_parsing.h"

namespace palp {
namespace {

LoadedCloud pcd(const std::string& bytes, const CloudReadSettings& settings = {})
{
    return parsed(bytes, CloudFormat::pcd, settings);
}

std::string pcdRefusal(const std::string& bytes, const CloudReadSettings& settings = {})
{
    return refusalOf(bytes, CloudFormat::pcd, settings);
}

struct Header {
    std::string fields = "x y z";
    std::string size   = "4 4 4";
    std::string type   = "F F F";
    std::string count  = "1 1 1";
    std::string width  = "2";
    std::string height = "1";
    std::string points = "2";
    std::string data   = "ascii";

    std::string text() const
    {
        return "# .PCD v.7 - Point Cloud Data file format\nVERSION .7\nFIELDS " + fields + "\nSIZE " + size +
               "\nTYPE " + type + "\nCOUNT " + count + "\nWIDTH " + width + "\nHEIGHT " + height +
               "\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS " + points + "\nDATA " + data + "\n";
    }
};

constexpr const char* kTwoPoints = "1 2 3\n4 5 6\n";

TEST(PcdFile, AsciiIsRead)
{
    const LoadedCloud loaded = pcd(Header{}.text() + kTwoPoints);

    EXPECT_EQ(loaded.cloud.positions()[1], glm::dvec3(4, 5, 6));
    EXPECT_EQ(loaded.report.format, "PCD, ascii");
}

TEST(PcdFile, EveryBinaryTypeIsReadExactly)
{
    struct Scalar {
        std::string type, size;
        void (*append)(std::string& bytes, double value);
    };
    const std::vector<Scalar> scalars = {{"I", "1", [](std::string& b, double v) { append(b, std::int8_t(v)); }},
                                         {"I", "2", [](std::string& b, double v) { append(b, std::int16_t(v)); }},
                                         {"I", "4", [](std::string& b, double v) { append(b, std::int32_t(v)); }},
                                         {"I", "8", [](std::string& b, double v) { append(b, std::int64_t(v)); }},
                                         {"U", "1", [](std::string& b, double v) { append(b, std::uint8_t(v)); }},
                                         {"U", "2", [](std::string& b, double v) { append(b, std::uint16_t(v)); }},
                                         {"U", "4", [](std::string& b, double v) { append(b, std::uint32_t(v)); }},
                                         {"U", "8", [](std::string& b, double v) { append(b, std::uint64_t(v)); }},
                                         {"F", "4", [](std::string& b, double v) { append(b, float(v)); }},
                                         {"F", "8", [](std::string& b, double v) { append(b, v); }}};
    for (const auto& [type, size, appendAs] : scalars) {
        const auto   four  = [](const std::string& word) { return word + " " + word + " " + word + " " + word; };
        std::string  bytes = Header{"x y z E", four(size), four(type), "1 1 1 1", "1", "2", "2", "binary"}.text();
        const double low   = type == "U" ? 200 : -100;
        for (const double value : {low, 0.0, 1.0, 5.0, 1.0, low, 2.0, 7.0}) appendAs(bytes, value);

        const LoadedCloud loaded = pcd(bytes);

        EXPECT_EQ(loaded.cloud.positions()[0], glm::dvec3(low, 0, 1)) << type << size;
        EXPECT_EQ(loaded.cloud.positions()[1], glm::dvec3(1, low, 2)) << type << size;
        EXPECT_EQ(loaded.cloud.stiffness()[1], 7) << type << size;
    }
}

TEST(PcdFile, FieldsOfSeveralNumbersAndPaddingAreSkipped)
{
    const Header ascii{"normal x _ y z D _", "4 4 1 4 4 8 1", "F F U F F F U", "3 1 1 1 1 1 2", "2", "1", "2", "ascii"};
    Header       binary = ascii;
    binary.data         = "binary";
    std::string bytes   = binary.text();
    for (const float base : {1.f, 4.f}) {
        for (int k = 0; k < 3; ++k) append(bytes, 9.f);
        append(bytes, base);
        append(bytes, std::uint8_t(0));
        append(bytes, base + 1);
        append(bytes, base + 2);
        append(bytes, 0.5);
        append(bytes, std::uint16_t(0));
    }

    const LoadedCloud fromText  = pcd(ascii.text() + "9 9 9 1 0 2 3 0.5 0 0\n9 9 9 4 0 5 6 0.5 0 0\n");
    const LoadedCloud fromBytes = pcd(bytes);

    for (const LoadedCloud* loaded : {&fromText, &fromBytes}) {
        EXPECT_EQ(loaded->cloud.positions()[1], glm::dvec3(4, 5, 6));
        EXPECT_EQ(loaded->cloud.stiffness()[1], 0.5);
        EXPECT_EQ(loaded->cloud.kind(), StiffnessKind::rigidity);
        EXPECT_EQ(loaded->report.properties, (std::vector<std::string>{"x", "y", "z", "D"}));
    }
}

TEST(PcdFile, CountPointsAndViewpointMayBeLeftOut)
{
    EXPECT_EQ(pcd("VERSION 0.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nWIDTH 1\nHEIGHT 2\nDATA ascii\n1 2 3\n4 5 6")
                  .cloud.size(),
              2u);
}

/// Columns x, y, z and E of 40 points in rows of eight, x = i mod 8, y = i / 8, z = 0 and E = 1000 + i, as floats,
/// packed by lzf_compress() of liblzf 3.6.
constexpr std::string_view kPackedByLiblzf =
    "010000400001803f20050040200220030080200300a0200300c0200300e020034000e0771fe01300409be0130340d7e0130340f3"
    "e01303410fe01303e09700037a44004020030080200300c0200301007b200f20030080200300c0200301007c200f200300802003"
    "00c0200301007d200f20030080200300c0200301007e200f20030080200300c0200301007f200f20030080200300c02003040080"
    "440020200300402003006020030080200300a0200300c0200300e02003010081201f200300402003006020030080200300a02003"
    "00c0200302e08144";

std::string compressed(std::uint32_t packed, std::uint32_t unpacked, const std::string& data)
{
    std::string bytes =
        Header{"x y z _ E", "4 4 4 1 4", "F F F U F", "1 1 1 3 1", "8", "5", "40", "binary_compressed"}.text();
    append(bytes, packed);
    append(bytes, unpacked);
    return bytes + data;
}

TEST(PcdFile, CompressedFilesOfAnotherProgramAreRead)
{
    const std::string data = bytesOfHex(kPackedByLiblzf);

    const LoadedCloud loaded = pcd(compressed(216, 640, data));

    ASSERT_EQ(loaded.cloud.size(), 40u) << "padding has a field in the header, but is not stored";
    for (std::size_t i = 0; i < 40; ++i) {
        EXPECT_EQ(loaded.cloud.positions()[i], glm::dvec3(double(i % 8), double(i / 8), 0)) << i;
        EXPECT_EQ(loaded.cloud.stiffness()[i], 1000 + double(i)) << i;
    }
    EXPECT_EQ(loaded.report.format, "PCD, binary_compressed");
    EXPECT_TRUE(loaded.report.warnings.empty());
    EXPECT_TRUE(contains(pcd(compressed(216, 640, data + "\n")).report.warnings.at(0), {"1 byte after the last row"}));
}

TEST(PcdFile, CompressedFilesThatDoNotUnpackAreRefused)
{
    const std::string data = bytesOfHex(kPackedByLiblzf);
    const auto        bad  = [&](std::size_t at, char byte) {
        std::string damaged = data;
        damaged[at]         = byte;
        return pcdRefusal(compressed(216, 640, damaged));
    };

    EXPECT_TRUE(contains(pcdRefusal(compressed(217, 640, data)), {"byte", "claims 217 bytes", "only 216"}));
    EXPECT_TRUE(contains(pcdRefusal(compressed(216, 641, data)), {"40 points of 16 bytes", "found 641"}));
    EXPECT_TRUE(contains(pcdRefusal(compressed(216, 0xFFFFFFFF, data)), {"40 points", "found 4294967295"}));
    EXPECT_TRUE(contains(pcdRefusal(compressed(215, 640, data.substr(0, 215))), {"packed byte", "beyond the end"}));
    EXPECT_TRUE(contains(pcdRefusal(compressed(211, 640, data.substr(0, 211))), {"lacks its distance"}));
    EXPECT_TRUE(contains(pcdRefusal(compressed(3, 640, data.substr(0, 3))),
                         {"packed byte 3", "expected 640 unpacked bytes, found 2"}));
    EXPECT_TRUE(contains(bad(3, '\x41'), {"packed byte", "before the first byte"}));
    EXPECT_TRUE(contains(pcdRefusal(compressed(4, 640, bytesOfHex("00412001"))), {"before the first byte"}))
        << "by one byte";
    EXPECT_TRUE(
        contains(pcdRefusal(compressed(219, 640, data + bytesOfHex("e0ff00"))), {"more bytes than the file states"}));
    EXPECT_TRUE(
        contains(pcdRefusal(compressed(218, 640, data + bytesOfHex("0041"))), {"more bytes than the file states"}));
    EXPECT_TRUE(contains(pcdRefusal(compressed(216, 640, data).substr(0, 200)), {"only", "cut short"}));
}

TEST(PcdFile, CompressedDataCannotClaimMoreThanItsFileCanHold)
{
    Header      header{"x y z", "4 4 4", "F F F", "1 1 1", "100000000", "1", "100000000", "binary_compressed"};
    std::string bytes = header.text();
    append(bytes, std::uint32_t(4));
    append(bytes, std::uint32_t(1200000000));

    EXPECT_TRUE(contains(pcdRefusal(bytes + "abcd"), {"claims to hold 1200000000 bytes", "100 times"}));
}

TEST(PcdFile, HeadersThatMakeNoSenseAreRefused)
{
    const auto with = [](auto change) {
        Header header;
        change(header);
        return pcdRefusal(header.text() + kTwoPoints);
    };

    EXPECT_TRUE(contains(with([](Header& h) { h.size = "4 4"; }), {"3 values of SIZE", "found 2"}));
    EXPECT_TRUE(contains(with([](Header& h) { h.type = "F F X"; }), {"field \"z\"", "TYPE \"X\""}));
    EXPECT_TRUE(contains(with([](Header& h) { h.size = "4 4 2"; }), {"field \"z\"", "SIZE \"2\""}));
    EXPECT_TRUE(contains(with([](Header& h) { h.count = "1 1 0"; }), {"COUNT", "\"z\"", "found \"0\""}));
    EXPECT_TRUE(contains(with([](Header& h) { h.count = "1 1 -1"; }), {"COUNT", "found \"-1\""}));
    EXPECT_TRUE(contains(with([](Header& h) { h.count = "1 1 99999999999"; }), {"COUNT", "65536"}));
    EXPECT_TRUE(contains(with([](Header& h) { h.count = "1 1 3"; }), {"number z for each point", "x, y"}));
    EXPECT_TRUE(contains(with([](Header& h) { h.width = "-2"; }), {"WIDTH", "\"-2\""}));
    EXPECT_TRUE(contains(with([](Header& h) { h.points = "3"; }), {"POINTS", "2, found 3"}));
    EXPECT_TRUE(contains(with([](Header& h) { h.points = h.width = "0"; }), {"the cloud is empty"}));
    EXPECT_TRUE(contains(with([](Header& h) { h.width = h.height = "8589934592"; }), {"too large"}));
    EXPECT_TRUE(contains(with([](Header& h) { h.points = h.width = "1000000000000"; }), {"1000000000000 points"}));
    EXPECT_TRUE(contains(with([](Header& h) { h.fields = "x y y"; }), {"one property \"y\"", "several"}));
    EXPECT_TRUE(contains(with([](Header& h) { h.fields = "x y w"; }), {"number z for each point"}));
    EXPECT_TRUE(contains(with([](Header& h) { h.data = "zip"; }), {"line 11", "\"zip\""}));
    EXPECT_TRUE(contains(with([](Header& h) { h.height += "\nHEIGHT 1"; }), {"one line HEIGHT", "second"}));
    EXPECT_TRUE(contains(with([](Header& h) { h.height += "\nDEPTH 1"; }), {"\"DEPTH 1\""}));
    EXPECT_TRUE(contains(pcdRefusal("VERSION 9\nDATA ascii\n"), {"VERSION", "\"9\""}));
    EXPECT_TRUE(contains(pcdRefusal("DATA ascii\n"), {"VERSION", "found none"}));
    EXPECT_TRUE(contains(pcdRefusal("VERSION .7\nDATA ascii\n"), {"FIELDS", "found none"}));
    EXPECT_TRUE(contains(pcdRefusal("VERSION .7\n"), {"ends inside the header"}));
    EXPECT_TRUE(contains(pcdRefusal(""), {"ends inside the header"}));
}

TEST(PcdFile, BodiesThatDoNotFitTheHeaderAreRefused)
{
    Header header;
    header.data        = "binary";
    std::string binary = header.text();
    for (int k = 0; k < 6; ++k) append(binary, float(k));
    const std::string ascii = Header{}.text();

    EXPECT_EQ(pcd(binary).cloud.size(), 2u);
    EXPECT_TRUE(contains(pcdRefusal(binary.substr(0, binary.size() - 1)), {"byte", "2 points", "only 23 bytes"}));
    EXPECT_TRUE(contains(pcd(binary + "!").report.warnings.at(0), {"1 byte after the last row"})) << "no error";
    EXPECT_TRUE(contains(pcdRefusal(ascii + "1 2 3        "), {"expected 2 points, found 1"}));
    EXPECT_TRUE(contains(pcdRefusal(ascii + "1 2 3\n4 5   \n"), {"line 13", "\"z\""}));
    EXPECT_TRUE(contains(pcdRefusal(ascii + "1 2 3\n4 5 six\n"), {"line 13", "\"z\"", "\"six\""}));
    EXPECT_TRUE(contains(pcdRefusal(ascii + "1 2 3 4\n4 5 6\n"), {"line 12", "more numbers"}));
    EXPECT_TRUE(contains(pcdRefusal(ascii + kTwoPoints + "7 8 9\n"), {"end of the file"}));
}

TEST(PcdFile, PointsThatTheInstrumentDidNotSeeAreOmittedAndCounted)
{
    Header three;
    three.width = three.points = "3";
    CloudReadSettings settings;
    settings.dropInvalid = true;

    const LoadedCloud loaded = pcd(three.text() + "1 2 3\nnan nan nan\n4 5 6\n");
    const LoadedCloud asked  = pcd(three.text() + "1 2 3\ninf nan nan\n4 5 6\n", settings);

    EXPECT_EQ(loaded.cloud.size(), 2u);
    EXPECT_EQ(loaded.report.droppedPoints, 1u);
    EXPECT_TRUE(contains(loaded.report.warnings.at(0), {"NaN", "stands in 1 of 3 points"}));
    EXPECT_EQ(asked.report.droppedPoints, 1u);
    EXPECT_TRUE(asked.report.warnings.empty()) << "it was asked for";
    EXPECT_TRUE(contains(pcdRefusal(Header{}.text() + "1 2 3\ninf 1 2\n"), {"line 13", "point 1", "\"x\" inf"}));
    EXPECT_TRUE(contains(pcdRefusal(Header{}.text() + "nan 2 3\nnan 1 2\n"), {"all 2 points"}));
}

TEST(PcdFile, BigEndianCannotBeWritten)
{
    const PointCloud   cloud({{0, 0, 0}, {1, 1, 1}}, {2, 3}, StiffnessKind::modulus);
    std::ostringstream stream;

    EXPECT_THROW(formatPcd(stream, cloud, {}, {CloudEncoding::binaryBigEndian}), Error);
}

} // namespace
} // namespace palp
