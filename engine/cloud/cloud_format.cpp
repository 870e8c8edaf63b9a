#include "engine/cloud/cloud_format.h"

#include <algorithm>
#include <vector>

#include "engine/cloud/detail/glb_file.h"
#include "engine/cloud/detail/npy_cloud.h"
#include "engine/cloud/detail/obj_file.h"
#include "engine/cloud/detail/pcd_file.h"
#include "engine/cloud/detail/ply_file.h"
#include "engine/cloud/detail/stl_file.h"
#include "engine/cloud/detail/text_file.h"
#include "engine/cloud/detail/vtk_file.h"
#include "engine/cloud/detail/vtk_xml_file.h"
#include "engine/core/contract.h"

namespace palp {
namespace {

constexpr bool kFaces   = true;
constexpr bool kNoFaces = false;

constexpr std::array kFormats = {
    CloudFormatRecord{CloudFormat::ply, "PLY", {".ply"}, kFaces, parsePly, formatPly},
    CloudFormatRecord{CloudFormat::pcd, "PCD", {".pcd"}, kNoFaces, parsePcd, formatPcd},
    CloudFormatRecord{CloudFormat::text, "text", {".xyz", ".txt", ".csv"}, kNoFaces, parseText, formatText},
    CloudFormatRecord{CloudFormat::vtk, "VTK", {".vtk"}, kFaces, parseVtk, nullptr},
    CloudFormatRecord{CloudFormat::vtkXml, "VTK XML", {".vtp", ".vtu"}, kFaces, parseVtkXml, nullptr},
    CloudFormatRecord{CloudFormat::obj, "OBJ", {".obj"}, kFaces, parseObj, nullptr},
    CloudFormatRecord{CloudFormat::stl, "STL", {".stl"}, kFaces, parseStl, nullptr},
    CloudFormatRecord{CloudFormat::glb, "glTF", {".glb"}, kFaces, parseGlb, nullptr},
    CloudFormatRecord{CloudFormat::npy, "NumPy", {".npy"}, kNoFaces, parseNpyCloud, nullptr},
};

bool serves(const CloudFormatRecord& record, CloudUse use)
{
    return use == CloudUse::reading || (record.write && (use == CloudUse::writing || record.holdsFaces));
}

/// Returns the row with the extension of a file's name; null if there is none.
const CloudFormatRecord* find(const std::filesystem::path& path)
{
    const std::string extension = lowerExtension(path);
    for (const CloudFormatRecord& record : kFormats)
        if (!extension.empty() && std::ranges::find(record.extensions, extension) != record.extensions.end())
            return &record;
    return nullptr;
}

[[noreturn]] void refuse(const std::filesystem::path& path, CloudUse use, const std::string& advice)
{
    throw Error(path.string() + ": expected a name that ends with " + extensionsFor(use) + ", found \"" +
                path.extension().string() + "\"; " + advice);
}

} // namespace

std::span<const CloudFormatRecord> cloudFormats() noexcept
{
    return kFormats;
}

std::string lowerExtension(const std::filesystem::path& path)
{
    std::string extension = path.extension().string();
    for (char& c : extension)
        if (c >= 'A' && c <= 'Z') c = char(c - 'A' + 'a');
    return extension;
}

const CloudFormatRecord& recordOf(CloudFormat format)
{
    for (const CloudFormatRecord& record : kFormats)
        if (record.format == format) return record;
    PALP_EXPECT(false, "format " + std::to_string(int(format)) + " has no row in the table of formats");
    return kFormats.front();
}

const CloudFormatRecord& formatToRead(const std::filesystem::path& path)
{
    const CloudFormatRecord* const record = find(path);
    if (!record)
        refuse(path, CloudUse::reading,
               "MeshLab (meshes) and CloudCompare (scans, .las, .e57) save such files as .ply");
    return *record;
}

const CloudFormatRecord& formatToWrite(const std::filesystem::path& path)
{
    const CloudFormatRecord* const record = find(path);
    if (!record) refuse(path, CloudUse::writing, "other programs read .ply and convert it further");
    if (!record->write) refuse(path, CloudUse::writing, std::string(record->name) + " files are read but not written");
    return *record;
}

std::string extensionsFor(CloudUse use)
{
    std::vector<std::string_view> all;
    for (const CloudFormatRecord& record : kFormats)
        for (const std::string_view extension : record.extensions)
            if (!extension.empty() && serves(record, use)) all.push_back(extension);
    std::string text;
    for (std::size_t i = 0; i < all.size(); ++i)
        text += std::string(i == 0 ? "" : i + 1 == all.size() ? " or " : ", ") + std::string(all[i]);
    return text;
}

} // namespace palp
