#include "engine/cloud/detail/glb_file.h"

#include <gtest/gtest.h>

#include <glm/geometric.hpp>

#include "engine/core/counted.h"
#include "tests/cloud/cloud_parsing.h"

namespace palp {
namespace {

/// A file of JSON and binary data.
std::string glb(std::string json, std::string binary)
{
    while (json.size() % 4 != 0) json += ' ';
    while (binary.size() % 4 != 0) binary += '\0';
    std::string bytes = "glTF";
    append(bytes, std::uint32_t(2));
    append(bytes, std::uint32_t(12 + 8 + json.size() + 8 + binary.size()));
    append(bytes, std::uint32_t(json.size()));
    bytes += "JSON" + json;
    append(bytes, std::uint32_t(binary.size()));
    return bytes + std::string("BIN\0", 4) + binary;
}

/// Four corners of a square and the indices of its two triangles, as shorts.
std::string squareBytes()
{
    std::string binary;
    for (const float number : {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0}) append(binary, number);
    for (const int corner : {0, 1, 2, 0, 2, 3}) append(binary, std::uint16_t(corner));
    return binary;
}

const std::string kSquare = R"({"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}],
    "nodes": [{"mesh": 0}], "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1, "material": 3}]}],
    "accessors": [{"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3"},
                  {"bufferView": 1, "componentType": 5123, "count": 6, "type": "SCALAR"}],
    "bufferViews": [{"buffer": 0, "byteLength": 48}, {"buffer": 0, "byteOffset": 48, "byteLength": 12}],
    "buffers": [{"byteLength": 60}]})";

std::string with(const std::string& before, const std::string& after)
{
    std::string       json = kSquare;
    const std::size_t at   = json.find(before);
    EXPECT_NE(at, std::string::npos) << before;
    return json.replace(at, before.size(), after);
}

LoadedCloud read(const std::string& json)
{
    return parsed(glb(json, squareBytes()), CloudFormat::glb);
}

std::string refusal(const std::string& json)
{
    return refusalOf(glb(json, squareBytes()), CloudFormat::glb);
}

TEST(GlbFile, TrianglesOfTheSceneAreReadInMetres)
{
    const LoadedCloud loaded = read(kSquare);

    EXPECT_EQ(loaded.cloud.size(), 4u);
    EXPECT_EQ(loaded.cloud.positions()[2], glm::dvec3(1, 1, 0));
    EXPECT_EQ(loaded.faces, (std::vector<Triangle>{{0, 1, 2}, {0, 2, 3}}));
    EXPECT_EQ(loaded.report.format, "glTF 2, binary");
    EXPECT_FALSE(loaded.report.lengthUnitAssumed);
}

TEST(GlbFile, NodesPlaceTheirMeshesOneWithinTheOther)
{
    // Turned by a quarter about z, then twice as large, then moved; the parent moves all once more.
    const LoadedCloud loaded =
        read(with(R"("nodes": [{"mesh": 0}])", R"("nodes": [{"children": [1, 2], "translation": [10, 0, 0]},
        {"mesh": 0, "rotation": [0, 0, 0.7071067811865476, 0.7071067811865476], "scale": [2, 2, 2], "translation": [0, 0, 5]},
        {"mesh": 0, "matrix": [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 7, 0, 1]}])"));

    ASSERT_EQ(loaded.cloud.size(), 8u);
    EXPECT_EQ(loaded.faces, (std::vector<Triangle>{{0, 1, 2}, {0, 2, 3}, {4, 5, 6}, {4, 6, 7}}));
    EXPECT_EQ(loaded.cloud.positions()[1], glm::dvec3(11, 7, 0)); // the last child comes first
    EXPECT_LT(glm::length(loaded.cloud.positions()[5] - glm::dvec3(10, 2, 5)), 1e-12);
}

/// glTF 2.0, 3.7.4: a mirror turns the order of a triangle's corners around, two do not.
TEST(GlbFile, AMirroredNodesTrianglesFaceTheSameWay)
{
    const auto facing = [](const std::string& nodes) {
        const LoadedCloud   loaded = read(with(R"("nodes": [{"mesh": 0}])", R"("nodes": )" + nodes));
        std::vector<double> up;
        for (const Triangle& t : loaded.faces) {
            const auto p = loaded.cloud.positions();
            up.push_back(glm::normalize(glm::cross(p[t[1]] - p[t[0]], p[t[2]] - p[t[0]])).z);
        }
        return up;
    };
    const std::vector<double> up{1, 1};
    EXPECT_EQ(facing(R"([{"mesh": 0}])"), up);
    EXPECT_EQ(facing(R"([{"mesh": 0, "scale": [-2, 1, 1]}])"), up);
    EXPECT_EQ(facing(R"([{"mesh": 0, "scale": [-1, -1, 1]}])"), up);
    EXPECT_EQ(facing(R"([{"children": [1], "scale": [-1, 1, 1]}, {"mesh": 0, "scale": [1, -3, 1]}])"), up);
}

TEST(GlbFile, EachAxisHasAScaleOfItsOwn)
{
    const LoadedCloud loaded =
        read(with(R"({"mesh": 0})", R"({"mesh": 0, "scale": [2, 3, 4], "translation": [0, 0, 1]})"));

    EXPECT_EQ(loaded.cloud.bounds().high, glm::dvec3(2, 3, 1));
}

TEST(GlbFile, PositionsMayBeInterleavedAndBeginWithinTheirView)
{
    // Eight bytes of something, then each corner with a number behind it.
    std::string binary(8, '\7');
    for (const auto& corner : {std::array{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}) {
        for (const int number : corner) append(binary, float(number));
        append(binary, 99.0F);
    }
    std::string view = with(R"("bufferView": 0, )", R"("bufferView": 0, "byteOffset": 8, )");
    for (const auto& [before, after] :
         std::vector<std::array<std::string, 2>>{{R"("byteLength": 48})", R"("byteLength": 72, "byteStride": 16})"},
                                                 {R"("byteOffset": 48)", R"("byteOffset": 72)"}})
        view.replace(view.find(before), before.size(), after);
    for (const int corner : {0, 1, 2, 0, 2, 3}) append(binary, std::uint16_t(corner));

    const LoadedCloud loaded = parsed(glb(view, binary), CloudFormat::glb);

    EXPECT_EQ(loaded.cloud.bounds().high, glm::dvec3(1, 1, 0));
    EXPECT_EQ(loaded.cloud.positions()[3], glm::dvec3(0, 1, 0));
    EXPECT_EQ(loaded.faces, (std::vector<Triangle>{{0, 1, 2}, {0, 2, 3}}));
    const std::string beyond = view.replace(view.find(R"("byteLength": 72)"), 16, R"("byteLength": 67)");
    EXPECT_TRUE(
        contains(refusalOf(glb(beyond, binary), CloudFormat::glb), {"accessor 0: expected 4 elements within 67"}))
        << "the last corner ends at byte 68";
}

TEST(GlbFile, IndicesAreBytesShortsOrWords)
{
    const auto read = [](const char* type, const char* length, const std::string& indices) {
        std::string json = with("5123", type);
        json.replace(json.find(R"("byteLength": 12)"), 16, length);
        return parsed(glb(json, squareBytes().substr(0, 48) + indices), CloudFormat::glb).faces;
    };
    std::string bytes, words;
    for (const int corner : {0, 1, 2, 0, 2, 3}) {
        append(bytes, std::uint8_t(corner));
        append(words, std::uint32_t(corner));
    }
    const std::vector<Triangle> expected = {{0, 1, 2}, {0, 2, 3}};

    EXPECT_EQ(read("5121", R"("byteLength": 6)", bytes), expected);
    EXPECT_EQ(read("5125", R"("byteLength": 24)", words), expected);
    std::string floats = with("5123", "5126");
    floats.replace(floats.find(R"("count": 6)"), 10, R"("count": 3)");
    EXPECT_TRUE(contains(refusal(floats), {"mesh 0: expected indices as whole numbers, found floats"}));
}

TEST(GlbFile, BytesBeyondTheStatedLengthAreSaidAndDoNoHarm)
{
    for (const std::string& tail : {std::string("\n"), std::string(9, '\0')}) {
        const LoadedCloud loaded = parsed(glb(kSquare, squareBytes()) + tail, CloudFormat::glb);
        EXPECT_EQ(loaded.faces.size(), 2u);
        ASSERT_EQ(loaded.report.warnings.size(), 1u);
        EXPECT_TRUE(contains(loaded.report.warnings[0], {counted(tail.size(), "byte") + " after"}));
    }
    EXPECT_TRUE(read(kSquare).report.warnings.empty());
}

TEST(GlbFile, OtherVersionsAreRefused)
{
    for (const char version : {1, 3}) {
        std::string bytes = glb(kSquare, squareBytes());
        bytes[4]          = version;
        EXPECT_TRUE(contains(refusalOf(bytes, CloudFormat::glb), {"test: byte 4: expected glTF 2, found version"}));
    }
}

TEST(GlbFile, IndicesMayBeAbsentAndOtherPrimitivesAreCounted)
{
    std::string json = with(R"("indices": 1, )", "");
    json.replace(json.find(R"("count": 4)"), 10, R"("count": 3)");
    EXPECT_EQ(read(json).faces, (std::vector<Triangle>{{0, 1, 2}}));
    const LoadedCloud lines =
        read(with(R"("primitives": [)", R"("primitives": [{"mode": 1, "attributes": {"POSITION": 0}}, )"));
    ASSERT_EQ(lines.report.warnings.size(), 1u);
    EXPECT_TRUE(contains(lines.report.warnings[0], {"1 part of meshes"}));
}

TEST(GlbFile, WhatWouldChangeTheTrianglesIsRefusedByName)
{
    EXPECT_TRUE(
        contains(refusal(with(R"("count": 4)", R"("sparse": {}, "count": 4)")), {"test: ", "accessor 0", "sparse"}));
    EXPECT_TRUE(
        contains(refusal(with(R"("scene": 0)", R"("scene": 0, "extensionsRequired": ["KHR_draco_mesh_compression"])")),
                 {"extensionsRequired", "KHR_draco_mesh_compression"}));
    EXPECT_TRUE(contains(refusal(with(R"("byteLength": 60})", R"("byteLength": 60, "uri": "a.bin"})")),
                         {"accessor 0", ".glb"}));
    EXPECT_TRUE(contains(refusal(with(R"({"mesh": 0})", R"({"mesh": 0, "skin": 0})")), {"node 0", "skin"}));
    for (const char* weights : {"[0.5, 0]", "[0, -1e-3]", R"(["1"])"})
        EXPECT_TRUE(contains(refusal(with(R"({"mesh": 0})", R"({"mesh": 0, "weights": )" + std::string(weights) + "}")),
                             {"node 0", "weights"}));
    EXPECT_EQ(read(with(R"({"mesh": 0})", R"({"mesh": 0, "weights": [0, 0]})")).faces, read(with("", "")).faces);
    const std::string own = with(R"({"primitives")", R"({"weights": [1], "primitives")");
    EXPECT_TRUE(contains(refusal(own), {"mesh 0", "weights"}));
    std::string       unmixed = own; // a node's weights stand for its mesh's
    const std::string node    = R"({"mesh": 0})";
    unmixed.replace(unmixed.find(node), node.size(), R"({"mesh": 0, "weights": [0]})");
    EXPECT_EQ(read(unmixed).faces, read(with("", "")).faces);
}

TEST(GlbFile, ExtensionsOfMaterialsAndTexturesChangeNoTriangle)
{
    const auto asking = [](const std::string& names) {
        return with(R"("scene": 0)", R"("scene": 0, "extensionsRequired": [)" + names + "]");
    };

    EXPECT_EQ(read(asking(R"("KHR_materials_unlit", "KHR_texture_transform")")).faces, read(with("", "")).faces);
    EXPECT_TRUE(contains(refusal(asking(R"("KHR_materials_unlit", "KHR_mesh_quantization")")),
                         {"extensionsRequired", "KHR_mesh_quantization"}));
    EXPECT_TRUE(contains(refusal(asking("7")), {"extensionsRequired", "found 7"}));
}

TEST(GlbFile, ARefusalNamesThePlaceAndWhatWasExpected)
{
    for (const auto& [before, after, said] : std::vector<std::array<std::string, 3>>{
             {R"("count": 4)", R"("count": 5)", "accessor 0: expected 5 elements within 48 bytes"},
             {R"("count": 4)", R"("count": 0)", "accessor 0: expected 0 elements"},
             {R"("count": 4)", R"("count": 9007199254740991)", "accessor 0: expected"},
             {R"("count": 4)", R"("count": -1)", "whole number as \"count\", found -1"},
             {R"("count": 6)", R"("count": 5)", "three indices to a triangle, found 5"},
             {R"("byteOffset": 48)", R"("byteOffset": 50)", "accessor 1: expected 6 elements"},
             {R"("byteOffset": 48)", R"("byteOffset": 4)", "mesh 0: expected an index below 4"},
             {R"("byteLength": 48)", R"("byteLength": 48, "byteStride": 4)", "accessor 0"},
             {"5126", "5120", "componentType"},
             {"5126", "5125", "positions as floats"},
             {"VEC3", "VEC4", "accessor 0: expected the type VEC3"},
             {R"("mesh": 0})", R"("mesh": 1})", "meshes 1: expected a number below 1"},
             {R"("nodes": [0])", R"("nodes": [0, 0])", "node 0: expected one parent"},
             {R"("nodes": [0])", R"("nodes": [7])", "numbers below 1, found 7"},
             {R"({"mesh": 0})", R"({"children": [0]})", "node 0: expected one parent"},
             {R"({"mesh": 0})", R"({"mesh": 0, "scale": [1, 2]})", "node 0: expected 3 numbers"},
             {R"("scene": 0)", R"("scene": 2)", "scenes 2"},
             {R"("buffers")", R"("buffer")", "a list \"buffers\""},
         })
        EXPECT_TRUE(contains(refusal(with(before, after)), {"test: in its JSON, ", said})) << before << " -> " << after;
    const std::string whole = glb(kSquare, squareBytes());
    EXPECT_TRUE(contains(refusalOf(whole.substr(0, whole.size() - 4), CloudFormat::glb), {"test: byte 8", "promises"}));
    std::string claims = whole; // 257 bytes of JSON more than there is of everything
    claims[13]         = char(claims[13] + 1 + int(whole.size() / 256));
    EXPECT_TRUE(contains(refusalOf(claims, CloudFormat::glb),
                         {"test: byte 12: expected at most " + std::to_string(whole.size() - 20) + " bytes of JSON"}));
    EXPECT_TRUE(contains(refusalOf("ply\nand more", CloudFormat::glb), {"test: byte 0: expected a binary glTF file"}));
    EXPECT_TRUE(contains(refusalOf("gl", CloudFormat::glb), {"test: byte 0"}));
    EXPECT_TRUE(contains(refusal("{]"), {"test: byte 20: expected JSON"}));
    EXPECT_TRUE(contains(refusal("[]"), {"test: byte 20: expected an object"}));
    EXPECT_TRUE(contains(refusal(R"({"a": 1e999})"), {"test: byte 20: expected JSON"}));
    std::string nan = glb(kSquare, squareBytes());
    nan.replace(nan.size() - 60, 4, "\xff\xff\xff\xff");
    EXPECT_TRUE(contains(refusalOf(nan, CloudFormat::glb), {"test: point 0", "nan"}));
}

TEST(GlbFile, PartsThatAreLeftOutAreLookedAtInBoundedTime)
{
    std::string nodes, roots, parts;
    for (int n = 0; n < 20'000; ++n) {
        nodes += std::string(n ? "," : "") + R"({"mesh":0})";
        roots += (n ? "," : "") + std::to_string(n);
        parts += std::string(n ? "," : "") + R"({"mode":0})";
    }
    const std::string json = R"({"scenes":[{"nodes":[)" + roots + R"(]}],"nodes":[)" + nodes +
                             R"(],"meshes":[{"primitives":[)" + parts + "]}]}";
    EXPECT_TRUE(contains(refusalOf(glb(json, squareBytes()), CloudFormat::glb), {"100 times the file"}));
}

TEST(GlbFile, AMeshThatNodesRepeatDoesNotTakeAllMemory)
{
    std::string nodes, roots;
    for (int n = 0; n < 20'000; ++n) {
        nodes += std::string(n ? "," : "") + R"({"mesh":0})";
        roots += (n ? "," : "") + std::to_string(n);
    }
    std::string json = with(R"("nodes": [{"mesh": 0}])", "\"nodes\": [" + nodes + "]");
    json.replace(json.find(R"("nodes": [0])"), 12, "\"nodes\": [" + roots + "]");
    std::string binary = squareBytes();
    for (int k = 0; k < 1000; ++k) binary += squareBytes().substr(0, 48);
    json.replace(json.find(R"("count": 4)"), 10, R"("count": 4000)");
    json.replace(json.find(R"("byteLength": 48)"), 16, R"("byteLength": 48060)");
    EXPECT_TRUE(contains(refusalOf(glb(json, binary), CloudFormat::glb), {"100 times the file"}));
}

} // namespace
} // namespace palp
