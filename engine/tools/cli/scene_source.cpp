#include "engine/tools/cli/scene_source.h"

#include <filesystem>

#include <nlohmann/json.hpp>

#include "engine/core/contract.h"
#include "engine/core/file.h"

namespace palp {

void SceneSource::addTo(CLI::App& command)
{
    command.add_option("SCENE", name, "scene file, cloud file or sample:NAME")->required();
    addFlagsTo(command);
}

void SceneSource::addFlagsTo(CLI::App& command, Seed seed)
{
    const auto flagsOf = [&](std::string_view key) {
        if (key == "place") return std::string("--at,--place");
        if (seed == Seed::ofTheHunt && key == "hunt_seed") return std::string("--seed,--hunt-seed");
        return flagOf(key);
    };
    for (const SceneKey& key : sceneKeys()) {
        if (seed == Seed::ofTheHunt && key.name == "seed") continue; // of the sample's points: in the file alone
        command
            .add_option_function<std::string>(
                flagsOf(key.name),
                [this, text = std::string(key.name)](const std::string& value) { flags[text] = value; },
                std::string(key.means) + (key.unit.empty() ? "" : " [" + std::string(key.unit) + "]"))
            ->group("Values of the scene (over PALPATE_<KEY> and the file)");
    }
}

Scene SceneSource::load(PlaceNeeded place) const
{
    const SceneOverrides overrides{flags, processEnvironment()};
    if (name.ends_with(".json")) return readScene(name, overrides);
    if (!name.starts_with("sample:") && !flags.contains("place")) {
        static_cast<void>(openForReading(name)); // a file that is not there is the first thing to say
        if (place == PlaceNeeded::yes)
            throw Error("--at: expected a place X,Y,Z for a cloud from a file, found none; palpate info " + name +
                        " shows where the cloud is");
    }
    nlohmann::json scene{{"cloud", name}};
    if (place == PlaceNeeded::no && !name.starts_with("sample:") && !flags.contains("place"))
        scene["place"] = {0, 0, 0}; // whoever needs none finds one
    return parseScene(scene.dump(), name, std::filesystem::current_path(), overrides);
}

std::string SceneSource::title() const
{
    return name.starts_with("sample:") ? name : std::filesystem::path(name).stem().string();
}

std::vector<std::string> assumptions(const Scene& scene, const CloudFileReport& report)
{
    std::vector<std::string> said;
    if (report.lengthUnitAssumed)
        said.emplace_back("assumed metres: the scene has no length_unit, and the file no comment that names one");
    if (report.stiffnessAssumed && scene.stiffness.empty())
        said.emplace_back("no stiffness in the file: uniform 300 kPa assumed; the scene's stiffness says otherwise");
    return said;
}

} // namespace palp
