#include "engine/cloud/detail/vtk_file.h"

#include <vector>

#include "tests/cloud/cloud_parsing.h"
#include "tests/cloud/vtk_written.h"

namespace palp {
namespace {

using Triangles = std::vector<Triangle>;

LoadedCloud vtk(const std::string& bytes, const CloudReadSettings& settings = {})
{
    return parsed(bytes, CloudFormat::vtk, settings);
}

std::string vtkRefusal(const std::string& bytes, const CloudReadSettings& settings = {})
{
    return refusalOf(bytes, CloudFormat::vtk, settings);
}

const std::string kHead = "# vtk DataFile Version 3.0\ntitle\nASCII\n";

/// A file of four corners of a square.
std::string square(const std::string& rest, const std::string& dataset = "POLYDATA")
{
    return kHead + "DATASET " + dataset + "\nPOINTS 4 float\n0 0 0 1 0 0\n1 1 0 0 1 0\n" + rest;
}

TEST(VtkFile, FilesOfOtherProgramsGiveTheSameCloudInEveryForm)
{
    const std::vector<std::pair<std::string, std::string>> files = {{"VTK, ascii", std::string(kPolyAscii51)},
                                                                    {"VTK, binary", bytesOfHex(kPolyBinary42)},
                                                                    {"VTK, ascii", std::string(kGridAscii42)},
                                                                    {"VTK, binary", bytesOfHex(kGridBinary51)},
                                                                    {"VTK, binary", bytesOfHex(kMeshioVtk)}};
    for (const auto& [format, bytes] : files) {
        SCOPED_TRACE(bytes.substr(0, 90));
        const LoadedCloud loaded = vtk(bytes);

        expectTheWrittenObject(loaded);
        EXPECT_EQ(loaded.report.faces, 2u);
        EXPECT_EQ(loaded.report.format, format);
        EXPECT_TRUE(loaded.report.lengthUnitAssumed);
        EXPECT_TRUE(loaded.report.warnings.empty());
    }
}

TEST(VtkFile, NamesAreUnescapedAndScalarsAreProperties)
{
    const LoadedCloud loaded = vtk(std::string(kPolyAscii51), withRange("part id", 1, 9));

    EXPECT_EQ(loaded.report.properties,
              (std::vector<std::string>{"x", "y", "z", "nx", "ny", "nz", "stiffness", "part id"}));
    EXPECT_EQ(loaded.cloud.stiffness()[0], 1);
    EXPECT_EQ(loaded.cloud.stiffness()[1], 9);
}

TEST(VtkFile, ComponentsMayBeNamedInPartAndNormalsBeCalledAnything)
{
    const LoadedCloud loaded =
        vtk(square("POINT_DATA 4\nNORMALS outward float\n0 0 1 0 0 1 0 0 1 0 0 1\nMETADATA\nCOMPONENT_NAMES\nX\n\nZ\n"
                   "INFORMATION 1\nNAME L2_NORM_RANGE LOCATION vtkDataArray\nDATA 2 1 1\n\n"
                   "SCALARS E float\nLOOKUP_TABLE default\n5 6 7 8\n"));

    EXPECT_EQ(loaded.normals.size(), 4u);
    EXPECT_EQ(loaded.cloud.stiffness()[3], 8);
}

TEST(VtkFile, EveryKindOfPointDataIsPassedOver)
{
    const LoadedCloud loaded = vtk(square(
        "POINT_DATA 4\nSCALARS a int 2\nLOOKUP_TABLE default\n1 2 1 2 1 2 1 2\nLOOKUP_TABLE t 2\n0 0 0 1 1 1 1 1\n"
        "COLOR_SCALARS c 3\n0 0 0 0 0 0 0 0 0 1 1 1\nVECTORS v float\n1 2 3 1 2 3 1 2 3 1 2 3\n"
        "TEXTURE_COORDINATES t 2 float\n0 0 0 1 1 1 0 1\nTENSORS m float\n" +
        std::string(36 * 2, '1')
            .replace(1, 71,
                     [] {
                         std::string text;
                         for (int i = 0; i < 35; ++i) text += " 1";
                         return text;
                     }()) +
        "\nFIELD f 2\nbits 1 4 bit\n0 1 0 1\nx 1 4 float\n9 9 9 9\nSCALARS E double\n5 6 7 8\n"
        "CELL_DATA 0\nSCALARS stiffness float\nLOOKUP_TABLE default\n"));

    EXPECT_EQ(loaded.report.properties, (std::vector<std::string>{"x", "y", "z", "x (data)", "E"}));
    EXPECT_EQ(loaded.cloud.stiffness()[3], 8) << "data of cells is none of points";
}

TEST(VtkFile, EveryTypeOfNumberIsReadFromBytes)
{
    struct Type {
        std::string name;
        void (*append)(std::string& bytes, double value);
    };
    const auto              big   = std::endian::big;
    const std::vector<Type> types = {
        {"char", [](std::string& b, double v) { append(b, std::int8_t(v), big); }},
        {"unsigned_char", [](std::string& b, double v) { append(b, std::uint8_t(v), big); }},
        {"short", [](std::string& b, double v) { append(b, std::int16_t(v), big); }},
        {"unsigned_short", [](std::string& b, double v) { append(b, std::uint16_t(v), big); }},
        {"int", [](std::string& b, double v) { append(b, std::int32_t(v), big); }},
        {"unsigned_int", [](std::string& b, double v) { append(b, std::uint32_t(v), big); }},
        {"long", [](std::string& b, double v) { append(b, std::int64_t(v), big); }},
        {"unsigned_long", [](std::string& b, double v) { append(b, std::uint64_t(v), big); }},
        {"vtkIdType", [](std::string& b, double v) { append(b, std::int32_t(v), big); }},
        {"vtktypeint64", [](std::string& b, double v) { append(b, std::int64_t(v), big); }},
        {"float", [](std::string& b, double v) { append(b, float(v), big); }},
        {"double", [](std::string& b, double v) { append(b, v, big); }}};
    for (const Type& type : types) {
        std::string bytes = "# vtk DataFile Version 3.0\n\nBINARY\nDATASET POLYDATA\nPOINTS 2 " + type.name + "\n";
        for (const double v : {10.0, 2.0, 3.0, 4.0, 10.0, 6.0}) type.append(bytes, v); // 10 is a line end in one byte
        bytes += "\nPOINT_DATA 2\nSCALARS E " + type.name + " 1\nLOOKUP_TABLE default\n";
        for (const double v : {10.0, 8.0}) type.append(bytes, v);

        const LoadedCloud loaded = vtk(bytes);

        EXPECT_EQ(loaded.cloud.positions()[0], glm::dvec3(10, 2, 3)) << type.name;
        EXPECT_EQ(loaded.cloud.positions()[1], glm::dvec3(4, 10, 6)) << type.name;
        EXPECT_EQ(loaded.cloud.stiffness()[0], 10) << type.name;
    }
}

TEST(VtkFile, StripsBecomeTrianglesThatFaceOneWay)
{
    EXPECT_EQ(vtk(square("TRIANGLE_STRIPS 1 5\n4 0 1 3 2\n")).faces, (Triangles{{0, 1, 3}, {1, 2, 3}}));
}

TEST(VtkFile, OfMixedCellsTheTwoDimensionalBecomeFaces)
{
    // vertex, line, triangle, pixel (row by row), quadratic triangle (corners first), polygon
    const LoadedCloud loaded = vtk(square("CELLS 6 25\n1 0\n2 0 1\n3 0 1 2\n4 0 1 3 2\n6 1 2 3 0 0 0\n3 2 3 0\n"
                                          "CELL_TYPES 6\n1 3 5 8 22 7\n",
                                          "UNSTRUCTURED_GRID"));

    EXPECT_EQ(loaded.faces, (Triangles{{0, 1, 2}, {0, 1, 2}, {0, 2, 3}, {1, 2, 3}, {2, 3, 0}}));
    EXPECT_TRUE(loaded.report.warnings.empty());
}

TEST(VtkFile, OfVolumesOnlyThePointsAreTakenWhichIsSaid)
{
    const LoadedCloud grid  = vtk(square("CELLS 2 9\n4 0 1 2 3\n3 0 1 2\nCELL_TYPES 2\n10 5\n", "UNSTRUCTURED_GRID"));
    std::string       block = kHead + "DATASET STRUCTURED_GRID\nDIMENSIONS 2 2 2\nPOINTS 8 int\n";
    for (int i = 0; i < 8; ++i)
        block += std::to_string(i % 2) + " " + std::to_string(i / 2 % 2) + " " + std::to_string(i / 4) + "\n";

    EXPECT_EQ(grid.faces, (Triangles{{0, 1, 2}}));
    EXPECT_TRUE(contains(grid.report.warnings.at(0), {"1 cells are volumes", "Extract Surface"}));
    EXPECT_TRUE(vtk(block).faces.empty());
    EXPECT_TRUE(contains(vtk(block).report.warnings.at(0), {"the grid is a volume"}));
}

TEST(VtkFile, AGridThatIsASurfaceHasFaces)
{
    std::string bytes = kHead + "DATASET STRUCTURED_GRID\nDIMENSIONS 3 1 2\nPOINTS 6 int\n";
    for (int i = 0; i < 6; ++i) bytes += std::to_string(i % 3) + " 0 " + std::to_string(i / 3) + "\n";

    EXPECT_EQ(vtk(bytes).faces, (Triangles{{0, 1, 4}, {0, 4, 3}, {1, 2, 5}, {1, 5, 4}}));
    EXPECT_TRUE(
        contains(vtkRefusal(bytes.replace(bytes.find("3 1 2"), 5, "3 1 3")), {"product of DIMENSIONS, 9", "found 6"}));
}

TEST(VtkFile, DatasetsWithoutPointsOfTheirOwnAreRefusedWithAWay)
{
    EXPECT_TRUE(contains(vtkRefusal(kHead + "DATASET STRUCTURED_POINTS\n"),
                         {"line 4", "POLYDATA", "STRUCTURED_POINTS", "Extract Surface"}));
    EXPECT_TRUE(contains(vtkRefusal("ply\n"), {"line 1", "# vtk DataFile Version", "\"ply\""}));
    EXPECT_TRUE(contains(vtkRefusal("# vtk DataFile Version 3.0\n\nUTF8\n"), {"ASCII or BINARY"}));
    EXPECT_TRUE(contains(vtkRefusal(""), {"# vtk DataFile Version"}));
    EXPECT_TRUE(contains(vtkRefusal(kHead), {"line 4", "expected DATASET and its type"}));
    EXPECT_TRUE(
        contains(vtkRefusal(square("POLYGONS 2 3\nOFFSETS int\n0 3\n")), {"line 11", "OFFSETS and CONNECTIVITY"}));
    EXPECT_TRUE(contains(vtkRefusal(kHead + "DATASET POLYDATA\n"), {"expected POINTS"}));
}

TEST(VtkFile, NumbersThatDoNotFitAreRefusedWithTheirPlace)
{
    const std::string scalars = "POINT_DATA 4\nSCALARS E float\nLOOKUP_TABLE default\n";

    EXPECT_TRUE(contains(vtkRefusal(square(scalars + "1 2 three 4\n")), {"line 11", "\"E\"", "\"three\""}));
    EXPECT_TRUE(contains(vtkRefusal(square(scalars + "1 2 3\n")), {"\"E\"", "expected 4 numbers", "3 are there"}));
    EXPECT_TRUE(contains(vtkRefusal(square(scalars + "1 2 nan 4\n")), {"point 2", "\"E\" nan"}));
    EXPECT_TRUE(contains(vtkRefusal(square(scalars + "1 2 0 4\n")), {"point 2", "above zero"}));
    EXPECT_TRUE(contains(vtkRefusal(square("POINT_DATA 3\n")), {"line 8", "data for 4 points", "\"3\""}));
    EXPECT_TRUE(
        contains(vtkRefusal(square("POINT_DATA 4\nSCALARS E string\n")), {"line 9", "type of numbers", "string"}));
    EXPECT_TRUE(contains(vtkRefusal(square("POLYGONS 1 4\n3 0 1 4\n")), {"\"POLYGONS\"", "below 4", "found 4"}));
    EXPECT_TRUE(contains(vtkRefusal(square("POLYGONS 1 4\n4 0 1 2\n")), {"\"POLYGONS\"", "more numbers"}));
    EXPECT_TRUE(contains(vtkRefusal(square("POLYGONS 1 5\n3 0 1 2 0\n")), {"\"POLYGONS\"", "found more"}));
    EXPECT_TRUE(contains(vtkRefusal(square("POLYGONS 2 4\nOFFSETS vtktypeint64\n0 4\nCONNECTIVITY int\n0 1 -2 3\n")),
                         {"\"CONNECTIVITY\"", "number 2", "found -2"}));
    EXPECT_TRUE(contains(vtkRefusal(square("POLYGONS 3 4\nOFFSETS int\n0 4 2\nCONNECTIVITY int\n0 1 2 3\n")),
                         {"cell 1 ends at 2", "begins at 4"}));
    EXPECT_TRUE(
        contains(vtkRefusal(square("CELLS 1 4\n3 0 1 2\n", "UNSTRUCTURED_GRID")), {"CELL_TYPES", "found none"}));
    EXPECT_TRUE(contains(vtkRefusal(square("CELLS 1 3\n2 0 1\nCELL_TYPES 1\n5\n", "UNSTRUCTURED_GRID")),
                         {"cell 0", "at least 3 points", "found 2"}));
    EXPECT_TRUE(
        contains(vtkRefusal(kHead + "DATASET POLYDATA\nPOINTS 1 bit\n0 1 1\n"), {"line 5", "POINTS", "\"bit\""}));
    EXPECT_TRUE(contains(vtkRefusal(square("SPHERES 4\n")), {"line 8", "another keyword", "SPHERES"}));
    EXPECT_TRUE(contains(vtkRefusal(square("POINTS 1 float\n0 0 0\n")), {"line 8", "POINTS once"}));
    EXPECT_TRUE(contains(vtkRefusal(square("POLYGONS 0 0\nPOLYGONS 1 4\n3 0 1 2\n")), {"line 9", "POLYGONS once"}));
}

TEST(VtkFile, PromisesThatTheFileCannotKeepAreRefusedBeforeMemoryIsTaken)
{
    const std::string binary = "# vtk DataFile Version 3.0\n\nBINARY\nDATASET POLYDATA\n";

    EXPECT_TRUE(contains(vtkRefusal(binary + "POINTS 1000000000000 float\n1234"), {"claimed are 3 of 1000000000000"}));
    EXPECT_TRUE(contains(vtkRefusal(binary + "POINTS 300 float\n1234"), {"byte", "3600 bytes", "found 4"}));
    EXPECT_TRUE(contains(vtkRefusal(kHead + "DATASET POLYDATA\nPOINTS 18446744073709551615 float\n1"), {"claimed"}));
    const std::string bytes = bytesOfHex(kPolyBinary42);
    for (std::size_t size = 0; size < bytes.size() - 1; size += 5) {
        if (size >= 160 && size <= 354)
            continue; // where some cuts are at the end of an array, which ends a file as well
        EXPECT_NE(vtkRefusal(bytes.substr(0, size)), "") << "cut to " << size;
    }
}

} // namespace
} // namespace palp
