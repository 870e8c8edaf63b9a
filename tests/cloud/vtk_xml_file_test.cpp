#include "engine/cloud/detail/vtk_xml_file.h"

#include <vector>

#include "tests/cloud/cloud_parsing.h"
#include "tests/cloud/vtk_written.h"

namespace palp {
namespace {

using Triangles = std::vector<Triangle>;

LoadedCloud vtk(const std::string& bytes, const CloudReadSettings& settings = {})
{
    return parsed(bytes, CloudFormat::vtkXml, settings);
}

std::string vtkRefusal(const std::string& bytes)
{
    return refusalOf(bytes, CloudFormat::vtkXml);
}

std::string replaced(std::string text, const std::string& from, const std::string& to)
{
    const std::size_t at = text.find(from);
    EXPECT_NE(at, std::string::npos) << from;
    return at == std::string::npos ? text : text.replace(at, from.size(), to);
}

/// A PolyData of pieces.
std::string polyData(const std::string& pieces)
{
    return "<?xml version='1.0'?>\n<!-- of a test -->\n<VTKFile type=\"PolyData\">\n<PolyData>\n" + pieces +
           "</PolyData>\n</VTKFile>\n";
}

std::string piece(const std::string& points, const std::string& stiffness, const std::string& polys)
{
    return "<Piece NumberOfPoints=\"3\" NumberOfPolys=\"1\"><PointData><DataArray type=\"Float32\" Name=\"E\" "
           "format=\"ascii\">" +
           stiffness +
           "</DataArray></PointData><Points><DataArray type=\"Float32\" NumberOfComponents=\"3\" format=\"ascii\">" +
           points + "</DataArray></Points>\n<Polys><DataArray type=\"Int32\" Name=\"connectivity\" format=\"ascii\">" +
           polys +
           "</DataArray><DataArray type=\"Int32\" Name=\"offsets\" format=\"ascii\">3</DataArray></Polys></Piece>\n";
}

const std::string kPoints = "0 0 0 1 0 0 0 1 0";

TEST(VtkXmlFile, FilesOfOtherProgramsGiveTheSameCloudInEveryForm)
{
    for (const std::string& bytes : {std::string(kXmlAscii), std::string(kXmlBinary), std::string(kXmlAppendedBase64),
                                     bytesOfHex(kXmlAppendedRaw), std::string(kMeshioVtu)}) {
        SCOPED_TRACE(bytes.substr(0, 120));
        const LoadedCloud loaded = vtk(bytes);

        expectTheWrittenObject(loaded);
        EXPECT_TRUE(contains(loaded.report.format, {"VTK XML, "}));
        EXPECT_TRUE(loaded.report.warnings.empty());
    }
}

TEST(VtkXmlFile, AByteOrderMarkMayStandBeforeIt)
{
    for (const std::string& bytes : {std::string(kXmlAscii), bytesOfHex(kXmlAppendedRaw)})
        expectTheWrittenObject(vtk("\xEF\xBB\xBF" + bytes));
}

TEST(VtkXmlFile, PiecesFollowEachOther)
{
    const LoadedCloud loaded =
        vtk(polyData(piece(kPoints, "1 2 3", "0 1 2") + piece("5 0 0 6 0 0 5 1 0", "4 5 6", "2 1 0")));

    ASSERT_EQ(loaded.cloud.size(), 6u);
    EXPECT_EQ(loaded.cloud.stiffness()[5], 6);
    EXPECT_EQ(loaded.faces, (Triangles{{0, 1, 2}, {5, 4, 3}}));
}

TEST(VtkXmlFile, PiecesWithoutPointsArePassedOver)
{
    const std::string empty = "<Piece NumberOfPoints=\"0\" NumberOfPolys=\"1\"><Points/></Piece>\n";

    EXPECT_EQ(vtk(polyData(empty + piece(kPoints, "1 2 3", "0 1 2") + empty)).cloud.size(), 3u);
    EXPECT_TRUE(contains(vtkRefusal(polyData(empty)), {"the cloud is empty"}));
    EXPECT_TRUE(contains(vtkRefusal(replaced(polyData(piece(kPoints, "1 2 3", "0 1 2")), "NumberOfPoints", "Points")),
                         {"the cloud is empty"}));
}

TEST(VtkXmlFile, EveryPieceMustHaveTheStiffness)
{
    EXPECT_TRUE(contains(vtkRefusal(polyData(piece(kPoints, "1 2 3", "0 1 2") +
                                             replaced(piece("5 0 0 6 0 0 5 1 0", "4 5 6", "2 1 0"), "\"E\"", "\"F\""))),
                         {"array \"E\"", "every piece"}));
}

TEST(VtkXmlFile, NumbersThatDoNotFitAreRefusedWithTheirPlace)
{
    EXPECT_TRUE(contains(vtkRefusal(polyData(piece("0 0 0 1 0 0 0 1", "1 2 3", "0 1 2"))),
                         {"line 5", "\"points\"", "3 times 3 numbers", "room for 8"}));
    EXPECT_TRUE(contains(vtkRefusal(polyData(piece("0 0 0 1 0 0 0 1 0 9", "1 2 3", "0 1 2"))),
                         {"\"points\"", "expected 9 numbers, found more"}));
    EXPECT_TRUE(contains(vtkRefusal(polyData(piece(kPoints, "1 2", "0 1 2"))), {"line 5", "\"E\"", "only 2"}));
    EXPECT_TRUE(contains(vtkRefusal(polyData(piece(kPoints, "1 inf 3", "0 1 2"))), {"point 1", "\"E\" inf"}));
    EXPECT_TRUE(contains(vtkRefusal(polyData(piece(kPoints, "1 2 x", "0 1 2"))), {"line 5", "\"E\"", "\"x\""}));
    EXPECT_TRUE(contains(vtkRefusal(polyData(piece(kPoints, "1 2 3", "0 1 3"))),
                         {"line 6", "\"connectivity\"", "below 3", "found 3"}));
    EXPECT_TRUE(contains(vtkRefusal(replaced(polyData(piece(kPoints, "1 2 3", "0 1 2")), "NumberOfPoints=\"3\"",
                                             "NumberOfPoints=\"900000000000\"")),
                         {"\"points\"", "expected 900000000000 times 3 numbers", "cut short"}));
    EXPECT_TRUE(contains(vtkRefusal(polyData(piece(kPoints, "1 2 3", "0 1 1.5"))),
                         {"\"connectivity\"", "a whole number", "found 1.5"}));
    EXPECT_TRUE(contains(vtkRefusal(polyData("")), {"the cloud is empty"}));
    for (const char* components : {"0", "65537"})
        EXPECT_TRUE(contains(vtkRefusal(replaced(polyData(piece(kPoints, "1 2 3", "0 1 2")), "Name=\"E\"",
                                                 "Name=\"E\" NumberOfComponents=\"" + std::string(components) + "\"")),
                             {"line 5", "expected 1 to 65536 components, found", components}));
}

TEST(VtkXmlFile, StripsBecomeTrianglesThatFaceTheSameWay)
{
    std::string bytes = polyData(piece("0 0 0 1 0 0 0 1 0 1 1 0", "1 2 3 4", "0 1 2 3"));
    for (const auto& [from, to] : {std::pair{"NumberOfPoints=\"3\"", "NumberOfPoints=\"4\""},
                                   {"NumberOfPolys", "NumberOfStrips"},
                                   {"<Polys>", "<Strips>"},
                                   {"</Polys>", "</Strips>"},
                                   {"\"ascii\">3<", "\"ascii\">4<"}})
        bytes = replaced(bytes, from, to);

    EXPECT_EQ(vtk(bytes).faces, (Triangles{{0, 1, 2}, {1, 3, 2}}));
}

TEST(VtkXmlFile, WhatIsCountedMustBeThereAndHaveAType)
{
    const std::string good = polyData(piece(kPoints, "1 2 3", "0 1 2"));
    for (const char* type : {"", "Float16"})
        EXPECT_TRUE(contains(vtkRefusal(replaced(good, "Float32", type)),
                             {"line 5", "expected a type such as Float32", "found \"" + std::string(type) + "\""}));
    for (const char* none : {"<Points/><Other>", "<Other>"})
        EXPECT_TRUE(contains(vtkRefusal(replaced(replaced(good, "<Points>", none), "</Points>", "</Other>")),
                             {"line 5", "expected Points with a DataArray, found", "none"}));
    EXPECT_TRUE(contains(vtkRefusal(replaced(replaced(good, "<Polys>", "<Lines>"), "</Polys>", "</Lines>")),
                         {"line 5", "expected an element Polys, found", "none"}));
    EXPECT_TRUE(contains(vtkRefusal(replaced(good, "\"offsets\"", "\"ends\"")),
                         {"line 6", "expected a DataArray offsets, found", "none"}));
}

TEST(VtkXmlFile, ArraysWithoutTextAreRefusedWithTheirLine)
{
    for (const std::string format : {"ascii", "binary"}) {
        const std::string bytes =
            replaced(polyData(piece(kPoints, "1 2 3", "0 1 2")), "format=\"ascii\">" + kPoints + "</DataArray>",
                     "format=\"" + format + "\"/>");

        const std::size_t at    = bytes.find("DataArray", bytes.find("<Points>")) + 9;
        const std::string place = format == "ascii" ? "line 5" : "byte " + std::to_string(at);
        EXPECT_TRUE(contains(vtkRefusal(bytes), {place, format == "ascii" ? "room for 0" : "found at most 0"}));
    }
}

TEST(VtkXmlFile, XmlThatIsNotWholeIsRefusedWithItsLine)
{
    const std::string good = polyData(piece(kPoints, "1 2 3", "0 1 2"));
    ASSERT_EQ(vtkRefusal(good), "");

    EXPECT_TRUE(
        contains(vtkRefusal(replaced(good, "</PolyData>", "</Polydata>")), {"line 7", "the end of \"PolyData\""}));
    EXPECT_TRUE(contains(vtkRefusal(replaced(good, "<PolyData>", "<PolyData a=1>")), {"line 4", "in quotes"}));
    EXPECT_TRUE(contains(vtkRefusal(replaced(good, "<PolyData>", "<PolyData a='1' a='2'>")), {"line 4", "\"a\" once"}));
    EXPECT_TRUE(contains(vtkRefusal(replaced(good, "<PolyData>", "<!DOCTYPE x><PolyData>")),
                         {"line 4", "expected an element"}));
    EXPECT_TRUE(contains(vtkRefusal(good + "<more/>"), {"the end of the file after its root", "found \"<more/>\""}));
    EXPECT_TRUE(contains(vtkRefusal("solid cube\n"), {"line 1", "expected XML"}));
    EXPECT_TRUE(contains(vtkRefusal(replaced(good, "VTKFile type", "VTKFile kind")),
                         {"PolyData or UnstructuredGrid", "no type"}));
    EXPECT_TRUE(contains(vtkRefusal(replaced(good, "\"PolyData\"", "\"ImageData\"")),
                         {"line 3", "ImageData", "Extract Surface"}));
    std::string deep;
    for (int i = 0; i < 100; ++i) deep += "<a>";
    EXPECT_TRUE(contains(vtkRefusal(deep), {"within each other"}));
    for (const std::size_t levels : {33U, 34U}) { // a root and 32 within it
        std::string nested;
        for (std::size_t n = 0; n < levels; ++n) nested = "<a>" + nested + "</a>";
        EXPECT_EQ(vtkRefusal(nested).find("within each other") == std::string::npos, levels == 33U) << levels;
    }
    for (std::size_t size = 0; size + 1 < good.size(); size += 3)
        EXPECT_NE(vtkRefusal(good.substr(0, size)), "") << "cut to " << size;
}

TEST(VtkXmlFile, NumbersOfBytesAreCountedInARefusal)
{
    const std::string fewer = replaced(std::string(kXmlBinary), "NumberOfPoints=\"5\"", "NumberOfPoints=\"4\"");
    EXPECT_TRUE(contains(vtkRefusal(fewer), {"expected 12 numbers, found more"}));
}

TEST(VtkXmlFile, FilesThatWereCutShortAreRefused)
{
    for (const std::string& bytes :
         {std::string(kXmlAppendedBase64), bytesOfHex(kXmlAppendedRaw), std::string(kXmlBinary)})
        for (std::size_t size = 0; size + 2 < bytes.size(); size += 11)
            EXPECT_NE(vtkRefusal(bytes.substr(0, size)), "") << "cut to " << size;
}

TEST(VtkXmlFile, PiecesThatShareAnArrayDoNotTakeAllMemory)
{
    constexpr std::uint32_t kShared = 20'000;
    std::string             pieces, data = "_";
    for (int n = 0; n < 1000; ++n)
        pieces += "<Piece NumberOfPoints=\"" + std::to_string(kShared) +
                  "\"><Points><DataArray type=\"Int8\" NumberOfComponents=\"3\" format=\"appended\" "
                  "offset=\"0\"/></Points></Piece>";
    append(data, 3 * kShared);
    data.append(3 * kShared, '\1');
    const std::string whole = "<?xml version=\"1.0\"?><VTKFile type=\"PolyData\" byte_order=\"LittleEndian\" "
                              "header_type=\"UInt32\"><PolyData>" +
                              pieces + "</PolyData><AppendedData encoding=\"raw\">" + data +
                              "</AppendedData></VTKFile>";
    EXPECT_TRUE(contains(vtkRefusal(whole), {"100 times the file"}));
}

TEST(VtkXmlFile, RawBytesWithoutCompressionAreReadAndTheirSizeIsNotBelieved)
{
    const auto file = [](std::uint32_t bytes) {
        std::string text = replaced(polyData(piece(kPoints, "1 2 3", "0 1 2")), "format=\"ascii\">" + kPoints,
                                    "format=\"appended\" offset=\"1\">");
        std::string data = "!"; // the array begins behind it
        append(data, bytes);
        for (const float v : {0.f, 0.f, 0.f, 10.f, 0.f, 0.f, 0.f, 60.f, 0.f}) append(data, v);
        return replaced(text, "</VTKFile>", "<AppendedData encoding=\"raw\">\n _" + data + "</AppendedData></VTKFile>");
    };

    EXPECT_EQ(vtk(file(36)).cloud.positions()[2], glm::dvec3(0, 60, 0));
    EXPECT_TRUE(contains(vtkRefusal(file(0xFFFFFFFF)), {"byte", "expected 4294967295 more bytes", "cut short"}));
    EXPECT_TRUE(contains(vtkRefusal(file(35)), {"\"points\"", "3 times 3 numbers", "room for 8"}));
}

TEST(VtkXmlFile, DamagedAndDishonestArraysAreRefused)
{
    const std::string base64 = std::string(kXmlAppendedBase64), meshio = std::string(kMeshioVtu);

    EXPECT_TRUE(contains(vtkRefusal(replaced(base64, "eF5j", "eF5k")), {"block 0", "zlib", "damaged"}));
    EXPECT_TRUE(contains(vtkRefusal(replaced(base64, "_AgAA", "_A*AA")), {"byte", "base 64", "\"*\""}));
    EXPECT_TRUE(
        contains(vtkRefusal(replaced(base64, "offset=\"200\"", "offset=\"999\"")), {"line 13", "an offset of up to"}));
    const std::size_t rest = base64.size() - base64.find("_AgAA") - 1;
    EXPECT_TRUE(contains(vtkRefusal(replaced(base64, "offset=\"200\"", "offset=\"" + std::to_string(rest + 1) + "\"")),
                         {"an offset of up to " + std::to_string(rest)}));
    EXPECT_TRUE(contains(vtkRefusal(replaced(base64, "offset=\"200\"", "offset=\"" + std::to_string(rest) + "\"")),
                         {"found at most 0"}));
    EXPECT_TRUE(contains(vtkRefusal(replaced(base64, "vtkZLibDataCompressor", "vtkLZ4DataCompressor")),
                         {"line 2", "vtkLZ4DataCompressor"}));
    EXPECT_TRUE(
        contains(vtkRefusal(replaced(base64, "encoding=\"base64\"", "encoding=\"hex\"")), {"raw or base64", "hex"}));
    // Headers of one block of 32768 bytes of which the last has 32769, of 2^30 + 1, of 2^30, and of 2^32 - 1 blocks.
    EXPECT_TRUE(contains(vtkRefusal(replaced(meshio, "AQAAAACAAAA8AAAA", "AQAAAACAAAABgAAA")),
                         {"up to 1 GiB, found 1 of 32768 bytes, the last of 32769"}));
    EXPECT_TRUE(contains(vtkRefusal(replaced(meshio, "AQAAAACAAAA8AAAA", "AQAAAAEAAEA8AAAA")),
                         {"up to 1 GiB, found 1 of 1073741825 bytes, the last of 60"}));
    EXPECT_TRUE(contains(vtkRefusal(replaced(meshio, "AQAAAACAAAA8AAAA", "AQAAAAAAAEAAAABA")),
                         {"claims to hold 1073741824 bytes", "100 times"}));
    EXPECT_TRUE(
        contains(vtkRefusal(replaced(meshio, "AQAAAACAAAA8AAAA", "/////wCAAAA8AAAA")), {"found 4294967295 of"}));
}

} // namespace
} // namespace palp
