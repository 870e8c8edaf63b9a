#include "engine/tools/cli/scene_source.h"

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <span>

#include <unistd.h>

#include "engine/cloud/cloud_format.h"
#include "engine/cloud/samples.h"
#include "engine/core/contract.h"
#include "engine/core/file.h"
#include "engine/core/nearest_name.h"
#include "engine/core/shown_text.h"
#include "engine/tools/cli/cloud_report.h"
#include "engine/tools/study/hunt_scene.h"

namespace palp {
namespace {

const char* titleOf(SceneKey::Group group)
{
    switch (group) {
    case SceneKey::Group::object:
        return "What is touched (over PALPATE_<KEY> and the scene file)";
    case SceneKey::Group::touch:
        return "Where it is touched, and how it bends";
    case SceneKey::Group::session:
        return "From tick to tick";
    }
    return "";
}

std::string helpOf(const SceneKey& key)
{
    std::string help(key.help);
    if (!key.words.empty() && key.name != "preset") help += ": " + key.expected();
    if (!key.unit.empty() && key.unit != "1") help += " [" + std::string(key.unit) + "]";
    if (key.name != "stiffness") return help;
    return help + "; NAME:key=value,... in SI units:\n"
                  "  constant: value\n"
                  "  linear, hyperbolic, exponential: from, to, and axis (x, y or z; x if absent) or start, end\n"
                  "  gaussian: from, to, centre or centres, sigma\n"
                  "  disc: from, to, centre or centres, radius\n"
                  "  box: from, to, low, high\n"
                  "  checker: from, to, edge\n"
                  "  grid: file (.npy, .nii or .nii.gz), factor, outside, along (points or thickness); of .npy origin, "
                  "spacing; of .nii length_unit\n"
                  "such as linear:from=2e4,to=2e6,axis=x or gaussian:from=3e5,to=3e6,centre=0;0;0,sigma=0.003";
}

/// Returns the end of the sentence on a variable that nothing reads.
/// \param key  what follows the prefix, in small letters
std::string adviceOn(const std::string& key, std::span<const std::string_view> known)
{
    if (const auto today = keyNamedOnce(key))
        return "; the key is " + std::string(*today) + " now: " + variableOf(*today);
    if (const auto meant = nearestName(key, known)) return "; did you mean " + variableOf(*meant) + "?";
    return "; palpate info --keys lists the keys";
}

/// Returns whether the text holds a number other than zero without a unit.
bool holdsPlainNumber(const std::string& text)
{
    for (std::size_t begin = 0; begin <= text.size();) {
        const std::size_t end   = std::min(text.find(',', begin), text.size());
        const std::string part  = text.substr(begin, end - begin);
        char*             rest  = nullptr;
        const double      value = std::strtod(part.c_str(), &rest);
        if (value != 0 && rest && *rest == '\0') return true;
        begin = end + 1;
    }
    return false;
}

} // namespace

void SceneSource::addTo(CLI::App& command, SceneKey::Group upTo)
{
    auto* const positional = command.add_option(
        "SCENE", name, "a scene file (.json), a cloud file (" + extensionsFor(CloudUse::reading) + "), or sample:NAME");
    if (name.empty())
        positional->required();
    else
        positional->capture_default_str();
    for (const SceneKey* key : sceneKeysWith(&study::huntKeys())) {
        if (key->group > upTo) continue;
        const std::string text(key->name);
        CLI::Option*      option =
            key->kind == SceneKey::Kind::yesNo
                     ? command.add_flag_callback(
                           flagOf(key->name), [this, text] { flags[text] = "true"; }, helpOf(*key))
                     : command.add_option_function<std::string>(
                      flagOf(key->name), [this, text](const std::string& value) { flags[text] = value; }, helpOf(*key));
        option->group(titleOf(key->group));
        if (key->name != "theory") continue;
        command
            .add_flag_callback(
                "--flat", [this, text] { flags[text] = palp::name(Theory::plate); },
                "bends what is curved as a flat plate, also where the scene asks for a shell: --theory plate")
            ->group(titleOf(key->group))
            ->excludes(option);
    }
}

Scene sceneFrom(const std::string& name, const std::map<std::string, std::string, std::less<>>& flags)
{
    SceneOverrides overrides{flags, processEnvironment(), true, &study::huntKeys()};
    if (name.ends_with(".json")) return readScene(name, overrides);
    if (name.starts_with(kSamplePrefix)) // first, refuses an unknown sample
        static_cast<void>(sampleNamed(std::string_view(name).substr(kSamplePrefix.size())));
    else
        static_cast<void>(openRegularFile(name));
    if (flags.contains("cloud"))
        throw Error("--cloud: the cloud is already named, " + shownPath(name) + "; omit one of the two");
    overrides.flags.try_emplace("cloud", name); // not as JSON: a file's name may hold bytes that JSON cannot
    return parseScene("{}", name, ".", overrides);
}

Scene SceneSource::load() const
{
    if (flags.contains("stiffness"))
        for (const char* key : {"stiffness_property", "stiffness_range", "log_range", "uniform"})
            if (flags.contains(key))
                throw Error(flagOf(key) + ": --stiffness replaces the stiffness that this option describes; omit it");
    return sceneFrom(name, flags);
}

LoadedObject SceneSource::loadObject(const Scene& scene) const
{
    return objectOf(loadCloud(scene), scene);
}

LoadedCloud SceneSource::loadCloud(const Scene& scene) const
{
    LoadedCloud        loaded = palp::loadCloud(scene);
    const std::string& source = loaded.report.lengthUnitSource;
    if (!scene.reading.lengthUnit.empty() || loaded.report.lengthUnitAssumed || source.starts_with("m,")) return loaded;
    for (const auto& [key, text] : flags) {
        const auto& keys     = sceneKeys();
        const auto  found    = std::ranges::find(keys, key, &SceneKey::name);
        const bool  isLength = found != keys.end() && (key == "place" || found->dimension == Dimension::length);
        if (isLength && holdsPlainNumber(text))
            throw Error(flagOf(key) + ": " + text +
                        " has no unit and would mean metres, but the file's lengths are in " + source +
                        "; write units, or add --length-unit");
    }
    return loaded;
}

std::string SceneSource::title() const
{
    return name.starts_with(kSamplePrefix) ? name : std::filesystem::path(name).stem().string();
}

std::vector<std::string> unusedVariables()
{
    constexpr std::string_view kPrefix  = "PALPATE_";
    constexpr std::string_view kReads[] = {
        "PALPATE_HOST_ISA", // hostVariant()
        "PALPATE_HAPLY",    // the driver of the Haply
        "PALPATE_LIBRARY",  // Python's package
        "PALPATE_BUILD",    // the scripts of a checkout
    };
    std::vector<std::string_view> known;
    for (const SceneKey* key : sceneKeysWith(&study::huntKeys())) known.push_back(key->name);
    std::vector<std::string> said;
    for (char** entry = environ; *entry; ++entry) {
        const std::string_view text(*entry), name = text.substr(0, text.find('='));
        if (!name.starts_with(kPrefix) || text.size() <= name.size() + 1) continue;
        if (std::ranges::find(kReads, name) != std::end(kReads)) continue;
        std::string key;
        for (const char c : name.substr(kPrefix.size())) key += c >= 'A' && c <= 'Z' ? char(c - 'A' + 'a') : c;
        if (std::ranges::find(known, key) != known.end() && variableOf(key) == name) continue;
        said.push_back("the environment's " + std::string(name) + " is not used" + adviceOn(key, known));
    }
    return said;
}

void refuseSourcesAsTarget(const SceneSource& source, const Scene& scene, const std::string& option,
                           const std::string& target)
{
    for (const std::string& law : filesOfLaws(scene)) refuseSourceAsTarget(option, law, target);
    for (const std::string& file : {source.name, scene.cloud}) refuseSourceAsTarget(option, file, target);
}

double metresPerPlainNumber(const SceneSource& source, const Scene& scene)
{
    if (const auto unit = source.flags.find("length_unit"); unit != source.flags.end()) return metresPer(unit->second);
    return scene.reading.lengthUnit.empty() ? 1 : metresPer(scene.reading.lengthUnit);
}

} // namespace palp
