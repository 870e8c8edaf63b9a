#include "engine/tools/study/study_file.h"

#include <cstddef>

#include <nlohmann/json.hpp>

#include "engine/core/file.h"
#include "engine/core/json_object.h"

namespace palp::study {
namespace {

using Json = nlohmann::json;

constexpr const char* kFelt = "felt_stiffness_N_per_m";

std::optional<std::string> textIn(const JsonObject& file, const char* key)
{
    return file.has(key) ? std::optional(file.text(key)) : std::nullopt;
}

std::map<std::string, std::optional<double>> feltIn(const JsonObject& file)
{
    std::map<std::string, std::optional<double>> felt;
    if (!file.has(kFelt)) return felt;
    if (file.kind(kFelt) != JsonObject::Kind::object) file.refuse(kFelt, "an object of numbers");
    const JsonObject object = file.object(kFelt);
    for (const std::string& condition : object.keys()) {
        const bool isNumber = object.kind(condition) == JsonObject::Kind::number;
        if (!isNumber && object.json(condition) != "null") file.refuse(kFelt, "an object of numbers");
        felt[condition] = isNumber ? std::optional(object.number(condition)) : std::nullopt;
    }
    return felt;
}

} // namespace

StudyFile parseStudyFile(std::string_view text, const std::string& what)
{
    const JsonObject file = JsonObject::parse(text, what);
    static_cast<void>(file.wholeNumber("format", 1, 1));
    return {.participant   = file.text("participant"),
            .title         = textIn(file, "title").value_or(""),
            .plan          = file.text("plan"),
            .clouds        = file.texts("clouds"),
            .hand          = textIn(file, "hand"),
            .path          = textIn(file, "hand_path"),
            .clock         = textIn(file, "clock"),
            .motion        = textIn(file, "motion"),
            .feltStiffness = feltIn(file),
            .version       = textIn(file, "version").value_or("")};
}

std::string studyJson(const StudyFile& file)
{
    Json json{{"format", 1},           {"participant", file.participant}, {"title", file.title},    {"plan", file.plan},
              {"clouds", file.clouds}, {kFelt, Json::object()},           {"version", file.version}};
    if (file.hand) json["hand"] = *file.hand;
    if (file.path) json["hand_path"] = *file.path;
    if (file.clock) json["clock"] = *file.clock;
    if (file.motion) json["motion"] = *file.motion;
    for (const auto& [condition, stiffness] : file.feltStiffness)
        json[kFelt][condition] = stiffness ? Json(*stiffness) : Json();
    return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

StudyFile readStudyFile(const std::filesystem::path& participantFolder)
{
    constexpr std::size_t       kLargest = std::size_t(16) << 20; // [bytes]
    const std::filesystem::path path     = participantFolder / kStudyFile;
    return parseStudyFile(readWhole(path, kLargest, "a study's description", Pipes::refused), path.string());
}

} // namespace palp::study
