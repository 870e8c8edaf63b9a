#include "engine/cloud/detail/npy_cloud.h"

#include <cmath>

#include "engine/core/counted.h"
#include "tests/cloud/cloud_parsing.h"

namespace palp {
namespace {

/// An array of rows as numpy.save() writes it.
std::string npy(const std::vector<std::vector<double>>& rows, const std::string& type = "<f8")
{
    std::string header = "{'descr': '" + type + "', 'fortran_order': False, 'shape': (" + std::to_string(rows.size()) +
                         ", " + std::to_string(rows.front().size()) + "), }";
    header.append(117 - header.size(), ' ');
    std::string bytes = std::string("\x93NUMPY\1\0\x76\0", 10) + header + "\n";
    for (const auto& row : rows)
        for (const double value : row) type == "<f8" ? append(bytes, value) : append(bytes, float(value));
    return bytes;
}

LoadedCloud read(const std::vector<std::vector<double>>& rows, const CloudReadSettings& settings = {})
{
    return parsed(npy(rows), CloudFormat::npy, settings);
}

TEST(NpyCloud, ThreeFourAndSevenColumnsAreUnderstood)
{
    const LoadedCloud three = read({{1, 2, 3}, {4, 5, 6}});
    const LoadedCloud four  = parsed(npy({{1, 2, 3, 500}, {4, 5, 6, 700}}, "<f4"), CloudFormat::npy);
    const LoadedCloud seven = read({{1, 2, 3, 0, 0, -2, 500}, {4, 5, 6, 0, NAN, 0, 700}});

    EXPECT_TRUE(three.report.stiffnessAssumed);
    EXPECT_TRUE(three.normals.empty());
    for (const LoadedCloud* loaded : {&three, &four, &seven})
        EXPECT_EQ(loaded->cloud.positions()[1], glm::dvec3(4, 5, 6));
    for (const LoadedCloud* loaded : {&four, &seven}) EXPECT_EQ(loaded->cloud.stiffness()[1], 700);
    EXPECT_EQ(seven.normals.at(0), glm::vec3(0, 0, -1));
    EXPECT_EQ(seven.normals.at(1), glm::vec3(0));
    EXPECT_EQ(seven.report.format, "NumPy, 7 columns");
}

TEST(NpyCloud, OtherShapesAreRefused)
{
    const auto refusal = [](const std::vector<std::vector<double>>& rows) {
        return refusalOf(npy(rows), CloudFormat::npy);
    };

    EXPECT_TRUE(contains(refusal({{1, 2}, {3, 4}}), {"test: ", "3 columns", "7", "found 2"}));
    EXPECT_TRUE(contains(refusal({{1, 2, 3, 4, 5, 6}, {1, 2, 3, 4, 5, 6}}), {"found 6", "array[:, :4]"}));
    EXPECT_TRUE(
        contains(refusalOf(npy({{1, 2, 3}, {4, 5, 6}}).substr(0, 170), CloudFormat::npy), {"2 x 3", "found 42 bytes"}));
}

TEST(NpyCloud, BytesAfterTheLastRowAreAWarning)
{
    const std::string two = npy({{1, 2, 3}, {4, 5, 6}});
    for (const std::string& tail : {std::string("\n"), std::string(48, '\0')}) {
        const LoadedCloud loaded = parsed(two + tail, CloudFormat::npy);
        EXPECT_EQ(loaded.cloud.positions()[1], glm::dvec3(4, 5, 6));
        ASSERT_EQ(loaded.report.warnings.size(), 1u);
        EXPECT_TRUE(contains(loaded.report.warnings[0],
                             {counted(tail.size(), "byte") + " after", "byte " + std::to_string(two.size())}));
    }
    EXPECT_TRUE(parsed(two, CloudFormat::npy).report.warnings.empty());
}

TEST(NpyCloud, NumbersThatAreNotFiniteAreRefusedOrDropped)
{
    CloudReadSettings lenient;
    lenient.dropInvalid = true;

    EXPECT_TRUE(contains(refusalOf(npy({{1, 2, 3}, {4, NAN, 6}}), CloudFormat::npy), {"point 1", "\"y\" nan"}));
    EXPECT_TRUE(contains(refusalOf(npy({{1, 2, 3, -1}, {4, 5, 6, 1}}), CloudFormat::npy), {"point 0", "above zero"}));
    EXPECT_EQ(read({{1, 2, 3}, {INFINITY, 2, 3}, {4, 5, 6}}, lenient).cloud.size(), 2u);
}

} // namespace
} // namespace palp
