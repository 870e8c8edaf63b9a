#pragma once
#include <filesystem>
#include <string>
#include <vector>

namespace palp {

/// A scene that is shipped with the programs.
struct ShippedScene {
    std::filesystem::path file;
    std::string           name; ///< "palm_wart": the file's, without its extension
    std::string           feel; ///< what to feel in it, from the file's first line
};

/// Returns the folder of the shipped scenes. A program may have been moved together with its data: they are looked for
/// from where the program is, then in the current folder.
/// \throws Error naming where they were expected
[[nodiscard]] std::filesystem::path shippedScenesFolder();

/// Returns the scenes of a folder by name, without those that only a tool reads, such as hunts.
/// \throws Error if it cannot be read
[[nodiscard]] std::vector<ShippedScene> scenesIn(const std::filesystem::path& folder);

} // namespace palp
