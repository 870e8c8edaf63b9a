#include "engine/cloud/point_cloud_io.h"

#include <istream>
#include <new>
#include <ostream>

#include "engine/cloud/detail/coordinate_rounding.h"
#include "engine/core/contract.h"
#include "engine/core/file.h"

namespace palp {

LoadedCloud parseCloud(std::istream& stream, std::uint64_t size, const std::string& name, CloudFormat format,
                       const CloudReadSettings& settings)
{
    if (format != CloudFormat::text && !settings.columns.empty())
        throw Error(name + ": columns are for text files, but this file names its own properties; name the "
                           "stiffness property instead");
    try {
        LoadedCloud loaded = recordOf(format).parse(stream, size, name, settings);
        warnOfRounding(loaded);
        return loaded;
    } catch (const std::bad_alloc&) {
        throw Error(name + ": the points do not fit into memory; take fewer, such as by CloudCompare's Subsample");
    }
}

LoadedCloud readCloud(const std::filesystem::path& path, const CloudReadSettings& settings)
{
    const CloudFormat   format = formatToRead(path).format;
    InputFile           file   = openRegularFile(path);
    const std::uint64_t size   = sizeOfFile(path);
    return parseCloud(file, size, path.string(), format, settings);
}

FieldsBeside::FieldsBeside(const LoadedCloud& loaded, std::span<const double> stiffening)
{
    if (!loaded.foundation.empty()) fields_.push_back({"foundation", "Pa/m", loaded.foundation});
    if (!stiffening.empty()) fields_.push_back({"stiffening", "1/m", stiffening});
    if (!loaded.held.empty()) fields_.push_back({"held", "1", loaded.held});
    for (int k = 0; k < 3 && !loaded.normals.empty(); ++k) {
        std::vector<double>& component = normals_[std::size_t(k)];
        for (const glm::vec3& normal : loaded.normals) component.push_back(double(normal[k]));
        fields_.push_back({std::string("n") + "xyz"[k], "", component});
    }
}

void formatCloud(std::ostream& stream, CloudFormat format, const PointCloud& cloud,
                 std::span<const NamedField> extraFields, const CloudWriteSettings& settings)
{
    const CloudFormatRecord& record = recordOf(format);
    PALP_EXPECT(record.write, std::string(record.name) + " files are only read");
    record.write(stream, cloud, extraFields, settings);
}

void writeCloud(const std::filesystem::path& path, const PointCloud& cloud, std::span<const NamedField> extraFields,
                const CloudWriteSettings& settings)
{
    const CloudFormatRecord& record = formatToWrite(path);
    CloudWriteSettings       chosen = settings;
    if (lowerExtension(path) == ".csv") chosen.separator = ',';
    writeFileWhole(path, [&](std::ostream& stream) { record.write(stream, cloud, extraFields, chosen); });
}

} // namespace palp
