#include "engine/tools/study/study_file.h"

#include <cstddef>

#include "engine/core/contract.h"
#include "engine/core/file.h"
#include "engine/core/json_depth.h"

namespace palp::study {

using Json = nlohmann::json;

Json parseStudyFile(std::string_view text, const std::string& what)
{
    Json       file = tooDeepAt(text) ? Json() : Json::parse(text, nullptr, false);
    const auto has  = [&](const char* key, bool (Json::*isRight)() const noexcept) {
        return file.contains(key) && (file[key].*isRight)();
    };
    if (!file.is_object() || file.value("format", Json()) != 1 || !has("plan", &Json::is_string) ||
        !has("participant", &Json::is_string) || !has("clouds", &Json::is_array))
        throw Error(what + ": expected a file of palpate study, found something else");
    return file;
}

Json readStudyFile(const std::filesystem::path& participantFolder)
{
    constexpr std::size_t       kLargest = std::size_t(16) << 20; // [bytes]
    const std::filesystem::path path     = participantFolder / kStudyFile;
    return parseStudyFile(readWhole(path, kLargest, "a study's description", Pipes::refused), path.string());
}

} // namespace palp::study
