#include "engine/session/scene.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <sstream>
#include <vector>

#include <nlohmann/json.hpp>

#include "engine/cloud/samples.h"
#include "engine/core/contract.h"
#include "engine/core/file.h"
#include "engine/core/json_object.h"
#include "engine/core/quantity.h"
#include "engine/core/spatial_law.h"
#include "engine/session/scene_keys.h"

namespace palp {
namespace {

using Json = nlohmann::json;

/// A key that editors look for in a file, and that has no meaning for the scene.
constexpr std::string_view kSchemaKey = "$schema";
/// The largest scene file that is read [bytes]: real ones have a thousand.
constexpr std::size_t kLargestFile = std::size_t(1) << 20;

/// Returns the JSON kind that a kind of key may have, besides a text.
std::optional<JsonObject::Kind> jsonKindOf(SceneKey::Kind kind)
{
    switch (kind) {
    case SceneKey::Kind::number:
    case SceneKey::Kind::count:
        return JsonObject::Kind::number;
    case SceneKey::Kind::yesNo:
        return JsonObject::Kind::other;
    case SceneKey::Kind::point:
    case SceneKey::Kind::range:
        return JsonObject::Kind::list;
    case SceneKey::Kind::object:
    case SceneKey::Kind::objects:
        return JsonObject::Kind::object;
    default:
        return {};
    }
}

/// Returns {"x0": "free"} as x0=free.
std::string edgesOf(const JsonObject& edges)
{
    edges.allowOnly({"x0", "x1", "z0", "z1"});
    std::string sides;
    for (const char* side : {"x0", "x1", "z0", "z1"})
        if (edges.has(side)) sides += (sides.empty() ? "" : ",") + std::string(side) + "=" + edges.text(side);
    return sides.empty() ? "clamped" : sides;
}

/// Returns a value of a file in the spelling of a flag.
std::string textOf(const JsonObject& file, const SceneKey& key)
{
    const std::string_view name = key.name;
    const auto             kind = file.kind(name);
    if (kind == JsonObject::Kind::text) return file.text(name);
    if (kind == JsonObject::Kind::list && key.kind == SceneKey::Kind::objects) return file.json(name);
    if (kind != jsonKindOf(key.kind)) file.refuse(name, key.expected());
    if (kind == JsonObject::Kind::list) {
        std::string list;
        for (const double value : file.numbers(name, key.kind == SceneKey::Kind::point ? 3 : 2))
            list += (list.empty() ? "" : ",") + plainNumber(value);
        return list;
    }
    if (kind == JsonObject::Kind::number) { // 64.0 is a count too
        const double     value  = file.number(name);
        constexpr double kExact = 9007199254740992; // 2^53: larger doubles are not all whole numbers
        return value == std::floor(value) && value >= 0 && value < kExact ? std::to_string(std::uint64_t(value))
                                                                          : file.json(name);
    }
    if (kind == JsonObject::Kind::other && file.json(name) == "null") file.refuse(name, key.expected());
    return name == "edges" ? edgesOf(file.object(name)) : file.json(name);
}

/// The statement of one source about one key.
struct Statement {
    std::string text;
    std::string what; ///< opens complaints
    ValueOrigin origin;
};

/// The file, the environment and the flags, each with its preset and its material.
class Sources {
public:
    Sources(const JsonObject& file, const SceneOverrides& overrides) : file_(file), overrides_(overrides)
    {
        for (const Origin origin : kRanks)
            for (const char* const name : {"material", "preset"}) {
                const SceneKey& key  = sceneKey(name);
                const auto      said = statedBy(origin, key);
                if (!said) continue;
                const WrittenValue given{key, said->text, said->what};
                sets_[origin].push_back({&key, key.name == "preset" ? presetValues(given.value<Preset>())
                                                                    : materialValues(*materialNamed(given.word()))});
            }
    }

    /// Returns the statement of the strongest source about the key, by itself, by its material or by its preset.
    [[nodiscard]] std::optional<Statement> about(const SceneKey& key) const
    {
        // A window of a shell is as wide as its dents ask for, and cut from a larger body: clamped edges, which presets
        // have, would hold its membrane as well.
        if (key.name == "edges")
            if (auto edges = itselfOrOfShells(key, name(Edge::supported))) {
                if (isShell()) nameAllSides(edges->text, Edge::supported);
                return edges;
            }
        if (key.name == "window")
            if (auto window = itselfOrOfShells(key, name(WindowOf::dent))) return window;
        for (const Origin origin : kRanks) {
            if (auto stated = statedBy(origin, key)) return stated;
            const auto sets = sets_.find(origin);
            if (sets == sets_.end()) continue;
            for (const auto& [by, values] : sets->second) {
                const auto value = values.find(key.name);
                if (value == values.end()) continue;
                const auto        source = statedBy(origin, *by);
                const std::string where  = source->origin.where + ": " + std::string(by->name) + " " + source->text;
                return Statement{value->second, source->what, {origin, where}};
            }
        }
        return std::nullopt;
    }

private:
    static constexpr std::array kRanks{Origin::flag, Origin::environment, Origin::scene}; // the strongest first

    /// Returns what is said about a key by itself; else the value that shells have, if the theory is theirs.
    [[nodiscard]] std::optional<Statement> itselfOrOfShells(const SceneKey& key, std::string_view value) const
    {
        for (const Origin origin : kRanks)
            if (auto stated = statedBy(origin, key)) return stated;
        const auto theory = about(sceneKey("theory"));
        if (!isShell()) return std::nullopt;
        return Statement{std::string(value),
                         theory->what,
                         {theory->origin.origin, theory->origin.where + ": theory " + theory->text}};
    }

    [[nodiscard]] bool isShell() const
    {
        const auto theory = about(sceneKey("theory"));
        if (!theory) return false;
        const WrittenValue given{sceneKey("theory"), theory->text, theory->what};
        return given.value<Theory>() == Theory::shell;
    }

    /// Adds the sides that a list of edges does not name.
    static void nameAllSides(std::string& edges, Edge others)
    {
        if (edges.find('=') == std::string::npos) return;
        for (const char* const side : {"x0=", "x1=", "z0=", "z1="})
            if (edges.find(side) == std::string::npos) edges += std::string(",") + side + name(others);
    }

    [[nodiscard]] std::optional<Statement> statedBy(Origin origin, const SceneKey& key) const
    {
        const std::string name(key.name), flag = flagOf(name), variable = variableOf(name);
        if (origin == Origin::flag) {
            const auto found = overrides_.flags.find(name);
            if (found == overrides_.flags.end()) return std::nullopt;
            if (found->second.empty()) throw Error(flag + ": expected a value, found \"\"");
            return Statement{found->second, flag, {Origin::flag, flag}};
        }
        if (origin == Origin::environment) {
            const char* const value = overrides_.environment ? overrides_.environment(variable.c_str()) : nullptr;
            if (!value || !*value) return std::nullopt;
            return Statement{value, variable, {Origin::environment, variable}};
        }
        if (!file_.has(name)) return std::nullopt;
        return Statement{textOf(file_, key), file_.where() + ": key \"" + name + "\"", {Origin::scene, file_.where()}};
    }

    /// A key that stands for others, and what it says of them.
    struct KeySet {
        const SceneKey*                                 by;
        std::map<std::string, std::string, std::less<>> values;
    };
    const JsonObject&                     file_;
    const SceneOverrides&                 overrides_;
    std::map<Origin, std::vector<KeySet>> sets_; ///< the stronger first
};

/// Reads the key of the cloud, before all other keys: the defaults of a sample depend on it.
void readCloudKey(Scene& scene, const Statement& said, const std::filesystem::path& folder)
{
    const std::string expected = sceneKey("cloud").expected();
    scene.cloud                = said.text;
    if (said.text.empty()) throw Error(said.what + ": expected " + expected + ", found \"\"");
    if (isSample(scene)) {
        try {
            static_cast<void>(sampleNamed(sampleName(scene)));
        } catch (const Error& error) {
            throw Error(said.what + ": " + error.what());
        }
        return;
    }
    const std::filesystem::path named   = said.text;
    const bool                  inScene = said.origin.origin == Origin::scene;
    const std::filesystem::path path    = inScene ? folder / named : named;
    try {
        static_cast<void>(openRegularFile(path));
    } catch (const Error& error) {
        throw Error(said.what + ": expected " + expected + ", found one that cannot be opened: " + error.what() +
                    (inScene && named.is_relative() ? "; paths start at the scene's folder" : ""));
    }
    scene.cloud = path.lexically_normal().string();
}

/// Takes the sample's own values, which other sources may replace.
void takeSample(Scene& scene)
{
    const Sample& sample        = sampleNamed(sampleName(scene));
    scene.points                = sample.points;
    scene.material              = sample.material;
    scene.patch.foundation      = sample.foundation;
    scene.patch.window          = sample.window;
    scene.patch.footprintRadius = sample.footprintRadius;
    scene.place                 = sample.place;
    scene.from                  = sample.from;
    for (const char* key : {"points", "thickness", "poisson", "foundation", "window", "footprint_radius", "place"})
        scene.origins[key] = {Origin::sample, scene.cloud};
    if (scene.from) scene.origins["from"] = {Origin::sample, scene.cloud};
}

/// Refuses keys that contradict each other though each is right by itself.
/// \param said  by key: the opening of complaints about it
void refuseContradictions(const Scene& scene, const std::map<std::string, std::string>& said)
{
    const auto whatSays = [&](const std::string& key) {
        const auto found = said.find(key);
        return found == said.end() ? "key \"" + key + "\"" : found->second;
    };
    const auto refuse = [](const std::string& what, const std::string& expected, const std::string& found) {
        throw Error(what + ": expected " + expected + ", found " + found);
    };
    if (scene.patch.windowOf == WindowOf::contact && !(2 * scene.patch.footprintRadius < scene.patch.window))
        refuse(whatSays("footprint_radius"),
               "a fingertip within the patch window of " + plainNumber(scene.patch.window) + " m",
               "a radius of " + plainNumber(scene.patch.footprintRadius) + " m");
    if (scene.patch.windowOf == WindowOf::object && !scene.held.isThere() && scene.patch.foundation == 0)
        refuse(whatSays("window"), "something that holds the object, the key held or a foundation, beside \"object\"",
               "neither");
    if (scene.patch.windowOf == WindowOf::object && scene.patch.neighbourhood == Neighbourhood::ball)
        refuse(whatSays("window"), "neighbourhood surface beside \"object\"", "ball, whose points have no border");
    if (scene.dynamicFriction > scene.staticFriction)
        refuse(whatSays("dynamic_friction"), "at most static_friction, " + plainNumber(scene.staticFriction),
               plainNumber(scene.dynamicFriction));
}

/// Returns the metres in one unit of a plain number of a length that `origin` states.
double metresPerPlainNumber(const SceneOverrides& overrides, const Sources& sources, Origin origin)
{
    if (origin != Origin::flag || !overrides.flagsInLengthUnit) return 1;
    const auto unit = sources.about(sceneKey("length_unit"));
    if (!unit) return 1;
    return metresPer(WrittenValue{sceneKey("length_unit"), unit->text, unit->what}.word());
}

/// Checks that a key is about the kind of cloud that the scene has.
/// \throws Error if the key is about samples and the cloud is a file, or the other way round
void demandUse(const Scene& scene, const SceneKey& key, const Statement& one)
{
    const std::string omit = "; omit " + std::string(one.origin.origin == Origin::flag ? flagOf(key.name) : key.name);
    if (scene.cloud.empty() && key.cloud != SceneKey::For::anyCloud && key.name != "scatter")
        throw Error(one.what + ": expected a file or a sample as the cloud, found points of the caller's" + omit);
    if (key.cloud == SceneKey::For::sample && !isSample(scene))
        throw Error(one.what + ": expected a sample as the cloud, found the file " + scene.cloud + omit);
    if (key.cloud == SceneKey::For::file && isSample(scene))
        throw Error(one.what + ": expected a file as the cloud, found " + scene.cloud +
                    ", which is in m and has a stiffness of its own [Pa]" + omit);
}

void readKey(Scene& scene, const SceneKey& key, const Statement& one, double metresPerPlainNumber)
{
    try {
        key.read(scene, WrittenValue{key, one.text, one.what, metresPerPlainNumber});
    } catch (const Error& error) { // of the readers of quantities and units
        const std::string sentence = error.what();
        throw sentence.starts_with(one.what) ? error : Error(one.what + ": " + sentence);
    }
}

Scene sceneOf(const JsonObject& file, const std::filesystem::path& folder, const SceneOverrides& overrides)
{
    const auto                    keys = sceneKeysWith(overrides.toolKeys);
    std::vector<std::string_view> names{kSchemaKey};
    for (const SceneKey* key : keys) names.push_back(key->name);
    file.allowOnly(names);
    for (const auto& [key, text] : overrides.flags)
        PALP_EXPECT(std::ranges::find(names, key) != names.end(),
                    "a flag of a scene has the name of a key, not " + key);

    const Sources                      sources(file, overrides);
    std::map<std::string, std::string> said; // by key: the opening of complaints about it
    Scene                              scene;
    scene.toolKeys   = overrides.toolKeys;
    const auto cloud = sources.about(sceneKey("cloud"));
    if (cloud && overrides.withoutCloud)
        throw Error(cloud->what + ": expected a scene without a cloud, because the object is given, found " +
                    cloud->text + "; omit the key");
    if (!cloud && !overrides.withoutCloud)
        throw Error(file.where() + ": the key \"cloud\" is missing; expected " + sceneKey("cloud").expected() +
                    ", such as sample:skin");
    if (cloud) readCloudKey(scene, *cloud, folder);
    if (isSample(scene)) takeSample(scene);
    for (const SceneKey* key : keys) {
        auto one = sources.about(*key);
        if (!one) continue;
        if (key->name == "stiffness" && one->origin.origin == Origin::scene)
            one->text = lawWithFileIn(one->text, folder); // as the path of the cloud
        if (key->name == "below" && one->origin.origin == Origin::scene) one->text = belowWithFileIn(one->text, folder);
        const double metres = metresPerPlainNumber(overrides, sources, one->origin.origin);
        // On the command line a length_unit applies to its plain numbers too, also where no file is read.
        if (key->name == "length_unit" && isSample(scene) && overrides.flagsInLengthUnit &&
            one->origin.origin == Origin::flag)
            continue;
        demandUse(scene, *key, *one);
        readKey(scene, *key, *one, metres);
        scene.origins[std::string(key->name)] = one->origin;
        said[std::string(key->name)]          = one->what;
    }
    refuseContradictions(scene, said);
    for (const SceneKey* key : keys)
        if (!key->write(scene).empty()) scene.origins.try_emplace(std::string(key->name));
    return scene;
}

} // namespace

Environment processEnvironment()
{
    return [](const char* variable) -> const char* { return std::getenv(variable); };
}

Scene parseScene(std::string_view text, const std::string& name, const std::filesystem::path& folder,
                 const SceneOverrides& overrides)
{
    return sceneOf(JsonObject::parse(text, name), folder, overrides);
}

Scene readScene(const std::filesystem::path& file, const SceneOverrides& overrides)
{
    return parseScene(readWhole(file, kLargestFile, "a scene of some thousand bytes, with its cloud in another file"),
                      file.string(), file.parent_path(), overrides);
}

std::string sceneJson(const Scene& scene, const std::filesystem::path& folder)
{
    Scene whole = scene;
    if (!isSample(whole) && !whole.cloud.empty()) {
        const std::filesystem::path cloud   = std::filesystem::absolute(whole.cloud);
        const std::filesystem::path there   = std::filesystem::absolute(folder / cloud.filename());
        const bool                  isThere = !folder.empty() && cloud.lexically_normal() == there.lexically_normal();
        whole.cloud                         = (isThere ? cloud.filename() : cloud).string();
    }
    whole.stiffness = lawWithFileIn(whole.stiffness, std::filesystem::current_path());
    for (std::string* law : {&whole.below.volume, &whole.below.foundation})
        *law = lawWithFileIn(*law, std::filesystem::current_path());
    std::string text;
    const bool  isSpring = scene.material.stiffening == 0 && !statesStiffening(scene);
    for (const SceneKey* key : sceneKeysWith(scene.toolKeys))
        if (const std::string value = key->write(whole); !value.empty() && !(isSpring && key->name == "stiffening"))
            text += (text.empty() ? "{" : ",\n ") + quotedJson(key->name) + ": " + value;
    return text + "}";
}

std::string printConfig(const Scene& scene, ConfigFormat format)
{
    std::ostringstream     text;
    nlohmann::ordered_json all         = nlohmann::ordered_json::object();
    std::size_t            widestValue = 5; // "value"
    const auto             keys        = sceneKeysWith(scene.toolKeys);
    for (const SceneKey* key : keys)
        widestValue = std::max(widestValue, std::min<std::size_t>(key->write(scene).size(), 32));
    const auto row = [&](std::string_view name, std::string_view value, std::string_view unit, std::string_view where) {
        const auto padded = [](std::string_view word, std::size_t width) {
            return std::string(word) + std::string(word.size() < width ? width - word.size() : 0, ' ') + "  ";
        };
        text << padded(name, 18) << padded(value, widestValue) << padded(unit, 4) << where << "\n";
    };
    row("key", "value", "unit", "where from");
    for (const SceneKey* key : keys) {
        const std::string name(key->name), value = key->write(scene);
        const auto        found  = scene.origins.find(name);
        const ValueOrigin origin = found == scene.origins.end() ? ValueOrigin{} : found->second;
        const auto        json   = value.empty() ? nlohmann::ordered_json() : nlohmann::ordered_json::parse(value);
        row(name,
            value.empty()      ? "-"
            : json.is_string() ? json.get<std::string>()
                               : value,
            key->unit.empty() ? "-" : key->unit,
            std::string(palp::name(origin.origin)) + (origin.where.empty() ? "" : " " + origin.where));
        all[name] = {
            {"value", json}, {"unit", key->unit}, {"origin", palp::name(origin.origin)}, {"where", origin.where}};
    }
    return format == ConfigFormat::text ? text.str() : all.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

} // namespace palp
