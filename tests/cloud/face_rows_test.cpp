#include "engine/cloud/detail/face_rows.h"

#include <cmath>
#include <limits>

#include <glm/geometric.hpp>
#include <glm/vec2.hpp>

#include "tests/cloud/cloud_parsing.h"
#include "tests/support/temporary_folder.h"

namespace palp {
namespace {

using Triangles = std::vector<Triangle>;

LoadedCloud ply(const std::string& bytes, const CloudReadSettings& settings = {})
{
    return parsed(bytes, CloudFormat::ply, settings);
}

const std::string kFivePoints = "0 0 0\n1 0 0\n1 1 0\n0 1 0\n0 0 1\n";

/// An ascii file of five points and the given rows of faces.
std::string withFaces(std::size_t count, const std::string& rows, const std::string& list = "uchar int vertex_indices")
{
    return "ply\nformat ascii 1.0\nelement vertex 5\nproperty float x\nproperty float y\nproperty float z\n"
           "element face " +
           std::to_string(count) + "\nproperty list " + list + "\nend_header\n" + kFivePoints + rows;
}

TEST(FaceRows, PolygonsBecomeFansAboutTheirFirstCorner)
{
    const LoadedCloud loaded = ply(withFaces(3, "3 0 1 2\n4 3 2 1 0\n5 4 3 2 1 0\n"));

    EXPECT_EQ(loaded.faces, (Triangles{{0, 1, 2}, {3, 2, 1}, {3, 1, 0}, {4, 3, 2}, {4, 2, 1}, {4, 1, 0}}));
    EXPECT_EQ(loaded.report.faces, 3u);
    EXPECT_EQ(loaded.report.degenerateFaces, 0u);
}

/// Area of the triangles of a flat file, and of those that face against an axis [m^2].
std::pair<double, double> areas(const LoadedCloud& loaded, int axis)
{
    double all = 0, down = 0;
    for (const Triangle& t : loaded.faces) {
        const glm::dvec3 a = loaded.cloud.positions()[t[0]];
        const double     along =
            glm::cross(loaded.cloud.positions()[t[1]] - a, loaded.cloud.positions()[t[2]] - a)[axis] / 2;
        all += std::abs(along);
        down += std::max(0.0, -along);
    }
    return {all, down};
}

/// Each polygon across each axis and from each corner on: a notched square, a spiral, a star and a comb, one that is
/// drawn on the same line twice, and a frame, whose hole is reached by a cut that is passed in both directions.
TEST(FaceRows, ConcavePolygonsBecomeTrianglesWithinThem)
{
    using Places = std::vector<glm::dvec2>;
    Places star, comb{{0, 0}, {9, 0}};
    for (int k = 0; k < 14; ++k)
        star.emplace_back((k % 2 ? 1 : 3) * std::cos(k * 0.4488), (k % 2 ? 1 : 3) * std::sin(k * 0.4488));
    for (int k = 9; k >= 0; --k) comb.emplace_back(k, k % 2 ? 5 : 1);
    for (Places places :
         {Places{{0, 0}, {4, 0}, {4, 4}, {2, 1}, {0, 4}},
          Places{{0, 0}, {5, 0}, {5, 5}, {1, 5}, {1, 2}, {3, 2}, {3, 3}, {2, 3}, {2, 4}, {4, 4}, {4, 1}, {0, 1}}, star,
          comb, Places{{0, 0}, {2, 0}, {4, 0}, {4, 4}, {3, 4}, {3, 1}, {1, 1}, {1, 4}, {0, 4}},
          Places{{0, 0}, {6, 0}, {6, 6}, {0, 6}, {0, 0}, {2, 2}, {2, 4}, {4, 4}, {4, 2}, {2, 2}}}) {
        double area = 0;
        for (std::size_t k = 0; k < places.size(); ++k) {
            const glm::dvec2 a = places[k], b = places[(k + 1) % places.size()];
            area += 0.5 * (a.x * b.y - a.y * b.x);
        }
        for (std::size_t turn = 0; turn < 3 * places.size(); ++turn) {
            const int axis = int(turn / places.size());
            std::rotate(places.begin(), places.begin() + 1, places.end());
            std::string text, face = std::to_string(places.size());
            for (std::size_t k = 0; k < places.size(); ++k) {
                glm::dvec3 corner(0);
                corner[(axis + 1) % 3] = places[k].x;
                corner[(axis + 2) % 3] = places[k].y;
                for (int n = 0; n < 3; ++n) text += std::to_string(corner[n]) + (n < 2 ? " " : "\n");
                face += " " + std::to_string(k);
            }
            const LoadedCloud loaded = ply("ply\nformat ascii 1.0\nelement vertex " + std::to_string(places.size()) +
                                           "\nproperty float x\nproperty float y\nproperty float z\nelement face 1\n"
                                           "property list uchar int vertex_indices\nend_header\n" +
                                           text + face + "\n");
            const auto [all, down]   = areas(loaded, axis);
            EXPECT_EQ(loaded.faces.size(), places.size() - 2);
            EXPECT_NEAR(all, area, 1e-5 * area) << "corners are written with six digits";
            EXPECT_EQ(down, 0);
        }
    }
}

TEST(FaceRows, APolygonThatCrossesItselfStaysAFan)
{
    EXPECT_EQ(ply("ply\nformat ascii 1.0\nelement vertex 5\nproperty float x\nproperty float y\nproperty float z\n"
                  "element face 1\nproperty list uchar int vertex_indices\nend_header\n"
                  "0 1 0\n-.59 -.81 0\n.95 .31 0\n-.95 .31 0\n.59 -.81 0\n5 0 1 2 3 4\n")
                  .faces.size(),
              3u);
}

TEST(FaceRows, TooFewCornersAndOneTwiceAreLeftOutAndCounted)
{
    const LoadedCloud loaded = ply(withFaces(7, "0\n1 4\n2 0 1\n3 0 1 0\n4 0 1 2 1\n6 0 1 2 3 4 0\n3 2 3 4\n"));

    EXPECT_EQ(loaded.faces, (Triangles{{2, 3, 4}}));
    EXPECT_EQ(loaded.report.faces, 7u);
    EXPECT_EQ(loaded.report.degenerateFaces, 6u);
}

TEST(FaceRows, EveryTypeOfListIsReadInBothByteOrders)
{
    const auto appendAs = [](std::string& bytes, const std::string& type, double value, std::endian order) {
        if (type == "char") append(bytes, std::int8_t(value), order);
        if (type == "uchar") append(bytes, std::uint8_t(value), order);
        if (type == "short") append(bytes, std::int16_t(value), order);
        if (type == "uint16") append(bytes, std::uint16_t(value), order);
        if (type == "int") append(bytes, std::int32_t(value), order);
        if (type == "uint") append(bytes, std::uint32_t(value), order);
        if (type == "float") append(bytes, float(value), order);
        if (type == "double") append(bytes, value, order);
    };
    for (const std::string length : {"char", "uchar", "short", "uint16", "int", "uint"})
        for (const std::string corner : {"char", "uchar", "short", "uint16", "int", "uint", "float", "double"})
            for (const std::endian order : {std::endian::little, std::endian::big}) {
                std::string bytes =
                    std::string("ply\nformat binary_") + (order == std::endian::big ? "big" : "little") +
                    "_endian 1.0\nelement vertex 3\nproperty uchar x\nproperty uchar y\n"
                    "property uchar z\nelement face 1\nproperty uchar flags\nproperty list " +
                    length + " " + corner + " vertex_index\nproperty list uchar float texcoord\n" + "end_header\n";
                for (const char c : {0, 0, 0, 1, 0, 0, 0, 1, 0}) append(bytes, c);
                append(bytes, std::uint8_t(7));
                appendAs(bytes, length, 3, order);
                for (const int index : {2, 0, 1}) appendAs(bytes, corner, index, order);
                append(bytes, std::uint8_t(2));
                for (const float u : {0.5f, 0.25f}) append(bytes, u, order);

                EXPECT_EQ(ply(bytes).faces, (Triangles{{2, 0, 1}})) << length << " " << corner;
            }
}

TEST(FaceRows, FacesMayComeBeforeThePointsAndOtherListsAreNone)
{
    const std::string before = "ply\nformat ascii 1.0\nelement face 1\nproperty list uchar int vertex_indices\n"
                               "element vertex 5\nproperty float x\nproperty float y\nproperty float z\nend_header\n"
                               "3 0 4 2\n" +
                               kFivePoints;

    EXPECT_EQ(ply(before).faces, (Triangles{{0, 4, 2}}));
    EXPECT_TRUE(ply(withFaces(1, "3 0 1 2\n", "uchar int corners")).faces.empty());
}

TEST(FaceRows, ACornerThatIsNoPointRefusesTheFile)
{
    const auto refused = [](const std::string& corner) {
        return refusalOf(withFaces(2, "3 0 1 2\n3 0 " + corner + " 2\n"), CloudFormat::ply);
    };
    std::string bytes = "ply\nformat binary_little_endian 1.0\nelement vertex 2\nproperty uchar x\nproperty uchar y\n"
                        "property uchar z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n";
    for (const char c : {0, 0, 0, 1, 0, 0, 3}) append(bytes, c);
    for (const int index : {0, 1, 2}) append(bytes, index);

    for (const std::string corner : {"5", "-1", "0.5", "nan", "inf", "4294967296", "1e+300"})
        EXPECT_TRUE(
            contains(refused(corner), {"test: line 16: face 1: expected the number of a point from 0 to below 5",
                                       "found " + corner.substr(0, 3)}))
            << refused(corner);
    EXPECT_EQ(refused("4"), "");
    EXPECT_TRUE(contains(refused("a"), {"line 16", "expected a number for \"vertex_indices\", found \"a\""}));
    EXPECT_TRUE(contains(refusalOf(bytes, CloudFormat::ply),
                         {"before byte " + std::to_string(bytes.size()), "face 0", "below 2, found 2"}));
}

TEST(FaceRows, AFaceThatLosesAPointIsLeftOutWholeAndTheOthersAreRenumbered)
{
    CloudReadSettings lenient;
    lenient.dropInvalid      = true;
    const std::string header = "ply\nformat ascii 1.0\nelement vertex 7\nproperty float x\nproperty float y\n"
                               "property float z\nelement face 6\nproperty list uchar int vertex_indices\nend_header\n";
    const std::string points = "0 0 0\nnan 0 0\n1 0 0\n1 1 0\ninf 0 0\n0 1 0\n0 0 1\n";

    const LoadedCloud loaded =
        ply(header + points + "4 0 2 3 5\n5 0 2 4 3 5\n3 0 1 2\n3 2 3 1\n3 4 3 2\n3 3 5 6\n", lenient);

    EXPECT_EQ(loaded.faces, (Triangles{{0, 1, 2}, {0, 2, 3}, {2, 3, 4}}));
    EXPECT_EQ(loaded.report.droppedFaces, 4u);
    EXPECT_EQ(loaded.report.degenerateFaces, 0u);
    EXPECT_EQ(loaded.report.faces, 6u);
}

TEST(FaceRows, FacesOfMergedPointsNameTheOneThatIsLeft)
{
    // Two triangles as STL files hold them, each with corners of its own; then faces that collapse, in part or whole.
    const std::string header = "ply\nformat ascii 1.0\nelement vertex 7\nproperty float x\nproperty float y\n"
                               "property float z\nelement face 4\nproperty list uchar int vertex_indices\nend_header\n";
    const std::string points = "0 0 0\n1 0 0\n0 1 0\n1 0 0\n1 1 0\n0 1 0\n5 5 5\n";

    const LoadedCloud loaded = ply(header + points + "3 0 1 2\n3 3 4 5\n4 0 1 3 4\n3 1 3 6\n");

    EXPECT_EQ(loaded.cloud.size(), 5u);
    EXPECT_EQ(loaded.faces, (Triangles{{0, 1, 2}, {1, 3, 2}, {0, 1, 3}}));
    EXPECT_EQ(loaded.report.faces, 4u);
    EXPECT_EQ(loaded.report.degenerateFaces, 1u);
    EXPECT_EQ(loaded.report.droppedFaces, 0u);
}

TEST(FaceRows, AHeaderThatPromisesMoreFacesThanTheFileHoldsIsRefusedBeforeAnythingIsAllocated)
{
    std::string bytes = "ply\nformat binary_little_endian 1.0\nelement vertex 2\nproperty uchar x\nproperty uchar y\n"
                        "property uchar z\nelement face 1000000000000\nproperty list uchar int vertex_indices\n"
                        "end_header\n";
    bytes += std::string("\0\0\0\1\0\0", 6) + std::string(100, '\0');
    std::string longList =
        "ply\nformat binary_little_endian 1.0\nelement vertex 2\nproperty uchar x\nproperty uchar y\n"
        "property uchar z\nelement face 1\nproperty list uint int vertex_indices\nend_header\n";
    longList += std::string("\0\0\0\1\0\0", 6);
    append(longList, std::numeric_limits<std::uint32_t>::max());
    longList += "1234";

    EXPECT_TRUE(contains(refusalOf(bytes, CloudFormat::ply), {"1000000000000 rows of element \"face\"", "only 100"}));
    EXPECT_TRUE(contains(refusalOf(longList, CloudFormat::ply), {"promises 4294967295", "from 0 to 1"}));
}

TEST(FaceRows, WrittenFacesAreReadAgainInEveryEncoding)
{
    const LoadedCloud loaded = ply(withFaces(2, "4 0 1 2 3\n3 4 1 0\n"));
    for (const CloudEncoding encoding :
         {CloudEncoding::ascii, CloudEncoding::binaryLittleEndian, CloudEncoding::binaryBigEndian}) {
        std::ostringstream stream;
        formatCloud(stream, CloudFormat::ply, loaded.cloud, {}, {encoding, loaded.faces});

        EXPECT_EQ(ply(stream.str()).faces, (Triangles{{0, 1, 2}, {0, 2, 3}, {4, 1, 0}}));
        EXPECT_TRUE(contains(stream.str(), {"element face 3\nproperty list uchar int vertex_indices\nend_header\n"}));
    }
}

TEST(FaceRows, WithoutFacesNoElementIsWrittenAndOneOfNoPointIsAMistake)
{
    const PointCloud   cloud({{0, 0, 0}, {1, 0, 0}}, {1, 1}, StiffnessKind::modulus);
    const Triangles    wrong = {{0, 1, 2}};
    std::ostringstream stream, other;

    formatCloud(stream, CloudFormat::ply, cloud);

    EXPECT_EQ(stream.str().find("face"), std::string::npos);
    EXPECT_THROW(formatCloud(other, CloudFormat::ply, cloud, {}, {CloudEncoding::ascii, wrong}), ContractViolation);
}

} // namespace
} // namespace palp
