#include "engine/program/scene_source.h"

#include <filesystem>

#include <nlohmann/json.hpp>

#include "engine/core/contract.h"
#include "engine/core/file.h"

namespace palp {

Scene sceneFrom(const std::string& what, const SceneFlags& flags, PlaceNeeded place)
{
    const SceneOverrides overrides{flags, processEnvironment()};
    if (what.ends_with(".json")) return readScene(what, overrides);
    if (!what.starts_with("sample:")) {
        static_cast<void>(openForReading(what)); // a file that is not there is the first thing to say
        if (place == PlaceNeeded::yes && !flags.contains("place"))
            throw Error("--at: expected a place X,Y,Z for a cloud from a file, found none; palpate info " + what +
                        " shows where the cloud is");
    }
    return parseScene(nlohmann::json{{"cloud", what}}.dump(), what, std::filesystem::current_path(), overrides);
}

void addSceneOptions(CLI::App& command, SceneFlags& flags)
{
    for (const SceneKey& key : sceneKeys())
        command
            .add_option_function<std::string>(
                key.name == "place" ? "--at,--place" : flagOf(key.name),
                [&flags, name = std::string(key.name)](const std::string& text) { flags[name] = text; },
                std::string(key.means) + (key.unit.empty() ? "" : " [" + std::string(key.unit) + "]"))
            ->group("Values of the scene (over PALPATE_<KEY> and the file)");
}

} // namespace palp
