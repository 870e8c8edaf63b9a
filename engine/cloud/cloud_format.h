#pragma once
#include <array>
#include <cstdint>
#include <filesystem>
#include <iosfwd>
#include <span>
#include <string>
#include <string_view>

namespace palp {

class PointCloud;
struct CloudReadSettings;
struct CloudWriteSettings;
struct LoadedCloud;
struct NamedField;

enum class CloudFormat { ply, pcd, text, vtk, vtkXml, obj, stl, glb, npy };

/// One format of cloud files. Reading, writing, help texts and errors go by the table of all of them.
struct CloudFormatRecord {
    CloudFormat                     format;
    std::string_view                name;       ///< such as "PLY"
    std::array<std::string_view, 3> extensions; ///< lower-case and with their dot; those that are left over are empty
    bool                            holdsFaces; ///< a file has a place for faces

    /// Reads a stream of `size` bytes; see parseCloud.
    LoadedCloud (*parse)(std::istream& stream, std::uint64_t size, const std::string& name,
                         const CloudReadSettings& settings);

    /// Writes a cloud; see formatCloud. Null: the format is only read.
    void (*write)(std::ostream& stream, const PointCloud& cloud, std::span<const NamedField> extraFields,
                  const CloudWriteSettings& settings);
};

/// Returns the table, in the order of help texts.
[[nodiscard]] std::span<const CloudFormatRecord> cloudFormats() noexcept;

/// Returns the extension of a file's name with its dot, in small letters; empty if there is none.
[[nodiscard]] std::string lowerExtension(const std::filesystem::path& path);

/// Returns the row of a format.
[[nodiscard]] const CloudFormatRecord& recordOf(CloudFormat format);

/// Returns the format of a file by its extension, in small or capital letters.
/// \throws Error naming the path and the extensions that are known
[[nodiscard]] const CloudFormatRecord& formatToRead(const std::filesystem::path& path);

/// Returns the same for a file that is to be written.
/// \throws Error naming the path and the extensions that can be written
[[nodiscard]] const CloudFormatRecord& formatToWrite(const std::filesystem::path& path);

/// The files that a list of extensions is about.
enum class CloudUse { reading, writing, writingFaces };

/// Returns the extensions as a help text lists them: ".ply, .pcd or .csv".
[[nodiscard]] std::string extensionsFor(CloudUse use);

} // namespace palp
