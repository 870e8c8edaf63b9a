#pragma once
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace palp::study {

/// Name of the file that says, in a participant's folder, what the study is.
inline constexpr const char* kStudyFile = "study.json";

/// That file: what later runs of the participant have to agree with, and what answers are compared with.
struct StudyFile {
    std::string                participant{}, title{};
    std::string                plan{};   ///< StudyPlan::canonical
    std::vector<std::string>   clouds{}; ///< fingerprint() of each condition's
    std::optional<std::string> hand{};   ///< as --hand; files of earlier versions have none
    std::optional<std::string> path{};   ///< fingerprint() of the hand's file; none of other hands and in earlier files
    std::optional<std::string> clock{};  ///< as --clock; files of earlier versions have none
    std::optional<std::string> motion{}; ///< how the hand moves, and --threads; files of earlier versions have none
    /// [N/m] felt at the place of each condition's scene, as a device renders it; empty: nothing can be felt there
    std::map<std::string, std::optional<double>> feltStiffness{};
    std::string                                  version{}; ///< of the program that wrote it

    bool operator==(const StudyFile&) const = default;
};

/// Reads such a file's text, of format 1.
/// \param what  opens complaints
/// \throws Error naming the key, what was expected and found
[[nodiscard]] StudyFile parseStudyFile(std::string_view text, const std::string& what);

/// Writes what parseStudyFile() reads. Bytes of a name that are no UTF-8 become U+FFFD.
[[nodiscard]] std::string studyJson(const StudyFile& file);

/// Reads that of a participant.
/// \throws Error naming the file
[[nodiscard]] StudyFile readStudyFile(const std::filesystem::path& participantFolder);

} // namespace palp::study
