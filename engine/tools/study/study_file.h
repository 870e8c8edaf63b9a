#pragma once
#include <filesystem>
#include <string>
#include <string_view>

#include <nlohmann/json.hpp>

namespace palp::study {

/// Name of the file that describes the study in a participant's folder.
inline constexpr const char* kStudyFile = "study.json";

/// Reads such a file's text: an object of format 1 with the texts "participant" and "plan", and the list "clouds".
/// \param what  opens complaints
/// \throws Error
[[nodiscard]] nlohmann::json parseStudyFile(std::string_view text, const std::string& what);

/// Reads that of a participant.
/// \throws Error naming the file
[[nodiscard]] nlohmann::json readStudyFile(const std::filesystem::path& participantFolder);

} // namespace palp::study
