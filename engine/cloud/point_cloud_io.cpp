#include "engine/cloud/point_cloud_io.h"

#include <istream>
#include <new>
#include <ostream>

#include "engine/cloud/detail/pcd_file.h"
#include "engine/cloud/detail/ply_file.h"
#include "engine/cloud/detail/text_file.h"
#include "engine/core/contract.h"
#include "engine/core/file.h"

namespace palp {
namespace {

std::string extensionOf(const std::filesystem::path& path)
{
    std::string extension = path.extension().string();
    for (char& c : extension)
        if (c >= 'A' && c <= 'Z') c = char(c - 'A' + 'a');
    return extension;
}

CloudFormat formatOf(const std::filesystem::path& path)
{
    const std::string extension = extensionOf(path);
    if (extension == ".ply") return CloudFormat::ply;
    if (extension == ".pcd") return CloudFormat::pcd;
    if (extension == ".xyz" || extension == ".txt" || extension == ".csv") return CloudFormat::text;
    throw Error(path.string() + ": expected a name that ends with .ply, .pcd, .xyz, .txt or .csv, found \"" +
                extension + "\"; MeshLab (meshes) and CloudCompare (scans, .las, .e57) save such files as .ply");
}

} // namespace

bool holdsFaces(const std::filesystem::path& path)
{
    return formatOf(path) == CloudFormat::ply;
}

LoadedCloud parseCloud(std::istream& stream, std::uint64_t size, const std::string& name, CloudFormat format,
                       const CloudReadSettings& settings)
{
    if (format != CloudFormat::text && !settings.columns.empty())
        throw Error(name + ": columns are for text files, but this file names its own properties; name the "
                           "stiffness property instead");
    try {
        switch (format) {
        case CloudFormat::ply:
            return parsePly(stream, size, name, settings);
        case CloudFormat::pcd:
            return parsePcd(stream, size, name, settings);
        case CloudFormat::text:
            break;
        }
        return parseText(stream, size, name, settings);
    } catch (const std::bad_alloc&) {
        throw Error(name + ": the points do not fit into memory; take fewer, such as by CloudCompare's Subsample");
    }
}

LoadedCloud readCloud(const std::filesystem::path& path, const CloudReadSettings& settings)
{
    const CloudFormat   format = formatOf(path);
    std::ifstream       file   = openForReading(path);
    const std::uint64_t size   = sizeOfFile(path);
    return parseCloud(file, size, path.string(), format, settings);
}

void formatCloud(std::ostream& stream, CloudFormat format, const PointCloud& cloud,
                 std::span<const NamedField> extraFields, const CloudWriteSettings& settings, char separator)
{
    switch (format) {
    case CloudFormat::ply:
        return formatPly(stream, cloud, extraFields, settings);
    case CloudFormat::pcd:
        return formatPcd(stream, cloud, extraFields, settings.encoding);
    case CloudFormat::text:
        return formatText(stream, cloud, extraFields, separator);
    }
}

void writeCloud(const std::filesystem::path& path, const PointCloud& cloud, std::span<const NamedField> extraFields,
                const CloudWriteSettings& settings)
{
    const CloudFormat format    = formatOf(path);
    const char        separator = extensionOf(path) == ".csv" ? ',' : ' ';
    writeFileWhole(path,
                   [&](std::ostream& stream) { formatCloud(stream, format, cloud, extraFields, settings, separator); });
}

} // namespace palp
