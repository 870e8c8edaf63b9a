#pragma once
#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <sstream>
#include <string>

#include "engine/cloud/point_cloud_io.h"
#include "tests/fuzz/fuzz_expect.h"

namespace palp {

inline bool sameBits(double a, double b)
{
    return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b);
}

inline void fuzzExpectSame(const PointCloud& a, const PointCloud& b)
{
    fuzzExpect(a.size() == b.size() && a.kind() == b.kind());
    for (std::size_t i = 0; i < a.size(); ++i) {
        for (int k = 0; k < 3; ++k) fuzzExpect(sameBits(a.positions()[i][k], b.positions()[i][k]));
        fuzzExpect(sameBits(a.stiffness()[i], b.stiffness()[i]));
    }
}

/// What must hold for every file that is accepted: the report agrees with the cloud, and writing it brings it back, as
/// PLY if its own format is only read.
inline void fuzzCheckAccepted(const LoadedCloud& loaded, CloudFormat format)
{
    const PointCloud& cloud = loaded.cloud;
    const auto&       faces = loaded.faces;
    fuzzExpect(loaded.report.points == cloud.size());
    fuzzExpect(loaded.normals.empty() || loaded.normals.size() == cloud.size());
    for (const std::uint32_t point : loaded.pointOfRow) fuzzExpect(point < cloud.size() || point == kNoPoint);
    fuzzExpect(cloud.bounds().diagonal() > 0);
    for (const Triangle& t : faces)
        fuzzExpect(std::max({t[0], t[1], t[2]}) < cloud.size() && t[0] != t[1] && t[1] != t[2] && t[2] != t[0]);
    fuzzExpect(recordOf(format).holdsFaces || faces.empty());
    const CloudFormat written = recordOf(format).write ? format : CloudFormat::ply;
    for (const CloudEncoding encoding : {CloudEncoding::binaryLittleEndian, CloudEncoding::ascii}) {
        std::stringstream stream;
        formatCloud(stream, written, cloud, {}, {encoding, faces});
        const LoadedCloud again = parseCloud(stream, stream.str().size(), "again", written);
        fuzzExpectSame(cloud, again.cloud);
        fuzzExpect(again.faces == faces);
        fuzzExpect(again.report.duplicatePositions == 0);
    }
}

/// Reads the bytes under several settings. Only Error is allowed to come out, and only in one printable line.
inline void fuzzCloud(const std::uint8_t* data, std::size_t size, CloudFormat format)
{
    CloudReadSettings lenient;
    lenient.dropInvalid = true;
    lenient.lengthUnit  = "mm";
    CloudReadSettings mapped;
    mapped.stiffnessProperty = "z";
    mapped.range             = StiffnessRange{1e3, 1e5, RangeScale::logarithmic};
    CloudReadSettings named;
    named.columns = "x,y,-,z,e";

    const std::string bytes(reinterpret_cast<const char*>(data), size);
    for (const CloudReadSettings& settings : {CloudReadSettings{}, lenient, mapped, named}) {
        if (!settings.columns.empty() && format != CloudFormat::text) continue;
        fuzzRefusals([&] {
            std::istringstream stream(bytes);
            fuzzCheckAccepted(fuzzRead([&] { return parseCloud(stream, bytes.size(), "fuzz", format, settings); }),
                              format);
        });
    }
}

} // namespace palp
