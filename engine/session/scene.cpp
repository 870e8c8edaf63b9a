#include "engine/session/scene.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <sstream>
#include <vector>

#include <nlohmann/json.hpp>

#include "engine/cloud/samples.h"
#include "engine/cloud/tokens.h"
#include "engine/core/contract.h"
#include "engine/core/file.h"
#include "engine/core/json_object.h"
#include "engine/core/nearest_name.h"
#include "engine/core/quantity.h"
#include "engine/core/spatial_law.h"
#include "engine/plate/multigrid/multigrid_plate_solver.h"

namespace palp {
namespace {

using Json = nlohmann::json;

/// A key that editors look for in a file, and that says nothing about the scene.
constexpr std::string_view kSchemaKey = "$schema";
/// The largest scene file that is read [bytes]: real ones have a thousand.
constexpr std::size_t kLargestFile = std::size_t(1) << 20;

/// A value as somebody wrote it. Numbers, lists and objects of a file arrive in the same spelling as texts of a flag,
/// so that each key has one reader.
struct Given {
    const std::string& text;
    const std::string& what;     ///< "skin.json: key \"thickness\"", "--thickness"
    std::string_view   expected; ///< of the key
    std::string_view   unit{};   ///< of the key; empty where it has none

    [[noreturn]] void refuse(const std::string& hint = {}) const
    {
        constexpr std::size_t kMost = 200; // [bytes] of a user's own text in a complaint
        std::string           found;
        for (const char c : text.substr(0, kMost))
            found += static_cast<unsigned char>(c) < 0x20 || c == 0x7f ? '?' : c; // a terminal would obey them
        throw Error(what + ": expected " + std::string(expected) + ", found \"" + found +
                    (text.size() > kMost ? "..." : "") + "\"" + hint);
    }

    /// A number without a dimension of its own may still carry the key's unit: "60 Hz".
    [[nodiscard]] double quantity(Dimension dimension, double least, double most) const
    {
        std::string_view plain = text;
        if (dimension == Dimension::none && !unit.empty() && plain.ends_with(unit)) plain.remove_suffix(unit.size());
        const double value = parseQuantity(plain, dimension, what);
        if (!(value >= least && value <= most)) refuse();
        return value;
    }

    [[nodiscard]] std::uint64_t count(std::uint64_t least, std::uint64_t most) const
    {
        const auto value = parseCount(text);
        if (!value || *value < least || *value > most) refuse();
        return *value;
    }

    /// One of the names of an enumeration.
    template <class Enum>
    [[nodiscard]] Enum oneOf(std::initializer_list<Enum> values) const
    {
        std::vector<std::string_view> names;
        for (const Enum value : values) {
            if (name(value) == text) return value;
            names.emplace_back(name(value));
        }
        const auto meant = nearestName(text, names);
        refuse(meant ? "; did you mean \"" + std::string(*meant) + "\"?" : "");
    }
};

std::string number(double value)
{
    return Json(value).dump();
}

std::string quoted(const std::string& text)
{
    return Json(text).dump(-1, ' ', false, Json::error_handler_t::replace);
}

std::string vectorJson(const glm::dvec3& v)
{
    return Json{v.x, v.y, v.z}.dump();
}

std::string orNothing(const std::string& text)
{
    return text.empty() ? "" : quoted(text);
}

constexpr auto kNumber = JsonObject::Kind::number;
constexpr auto kList   = JsonObject::Kind::list;
constexpr auto kObject = JsonObject::Kind::object;

void readLaw(Scene& scene, const Given& given)
{
    if (given.text == "own") return scene.stiffness.clear();
    try { // across any region: the cloud is not there yet
        static_cast<void>(parseSpatialLaw(given.text, {-1, -1, -1}, {1, 1, 1}, SpatialLaw::Space::volume));
    } catch (const Error& error) {
        throw Error(given.what + ": " + error.what());
    }
    scene.stiffness = given.text;
}

void readFrom(Scene& scene, const Given& given)
{
    const glm::dvec3 from  = parsePoint(given.text, given.what);
    const double     scale = std::max({std::abs(from.x), std::abs(from.y), std::abs(from.z)});
    if (scale == 0) given.refuse();
    scene.from =
        scale < 1e100 && scale > 1e-100 ? from : from / scale; // its length says nothing, and must not overflow
}

void readPlace(Scene& scene, const Given& given)
{
    constexpr double kFar = 1e9; // [m] as of clouds: surveyors count from far away
    scene.place           = parsePoint(given.text, given.what);
    for (int k = 0; k < 3; ++k)
        if (!(std::abs(scene.place[k]) <= kFar)) given.refuse();
}

/// The plate's own bound is nu <= 0.5: its equations hold there. A scene is of a material, and none is incompressible:
/// nu of 0.5 and more is a slip (per cent, or another number in the wrong place).
void readPoisson(Scene& scene, const Given& given)
{
    const double nu = parseQuantity(given.text, Dimension::none, given.what);
    if (!(nu > -1 && nu < 0.5))
        given.refuse(nu >= 0.5 ? "; no material is incompressible: take 0.49 for rubber, which is 1.3 % softer" : "");
    scene.material.poissonRatio = nu;
}

struct Key {
    SceneKey                        key;
    std::optional<JsonObject::Kind> kind; ///< of JSON, besides a text
    void (*read)(Scene&, const Given&);
    std::string (*write)(const Scene&); ///< as JSON; empty: has no value
};

using D = Dimension;
using S = Scene;

/// The only list of keys: the reader, the environment, the flags and printConfig() walk it.
constexpr std::array kKeys = {
    Key{{"cloud", "", "what is touched: a .ply, .pcd, .xyz, .txt or .csv file, or a procedural sample",
         "the path of a cloud file, or sample:NAME"},
        {},
        nullptr, // see readCloudKey
        [](const S& s) { return quoted(s.cloud); }},
    Key{{"points", "1", "number of points of a sample", "a whole number from 16 to 10000000"},
        {kNumber},
        [](S& s, const Given& g) { s.points = std::size_t(g.count(16, 10'000'000)); },
        [](const S& s) { return s.points ? std::to_string(s.points) : ""; }},
    Key{{"seed", "1", "of a sample's random points", "a whole number from 0 to 4294967295"},
        {kNumber},
        [](S& s, const Given& g) { s.seed = g.count(0, 4294967295); },
        [](const S& s) { return isSample(s) ? std::to_string(s.seed) : ""; }},
    Key{{"length_unit", "", "of the coordinates in a cloud file; absent: the file's own comment, else m",
         "m, mm, cm, um, km, in or ft"},
        {},
        [](S& s, const Given& g) {
            static_cast<void>(metresPer(g.text));
            s.lengthUnit = g.text;
        },
        [](const S& s) { return orNothing(s.lengthUnit); }},
    Key{{"stiffness", "Pa", "law of Young's modulus over the cloud, in place of the cloud's own",
         "a law such as {\"law\":\"linear\",\"from\":3e5,\"to\":3e6,\"axis\":\"x\"}, or own"},
        {kObject},
        readLaw,
        [](const S& s) { return s.stiffness.starts_with('{') ? s.stiffness : orNothing(s.stiffness); }},
    Key{{"thickness", "m", "h of the soft sheet; skin 1.5 mm, palm 4 mm", "a thickness from 1e-6 to 1 m, such as 4 mm"},
        {kNumber},
        [](S& s, const Given& g) { s.material.thickness = g.quantity(D::length, 1e-6, 1); },
        [](const S& s) { return number(s.material.thickness); }},
    Key{{"poisson", "1", "Poisson's ratio; skin 0.45, rubber 0.49", "a ratio above -1 and below 0.5"},
        {kNumber},
        readPoisson,
        [](const S& s) { return number(s.material.poissonRatio); }},
    Key{{"foundation", "Pa/m", "pressure per deflection of what lies below the sheet; 0: nothing",
         "a number from 0 to 1e15 Pa/m, such as 1.74 MPa/m"},
        {kNumber},
        [](S& s, const Given& g) { s.patch.foundation = g.quantity(D::foundation, 0, 1e15); },
        [](const S& s) { return number(s.patch.foundation); }},
    Key{{"window", "m", "edge of the square of surface that bends with the finger",
         "a length from 1e-6 to 100 m, such as 70 mm"},
        {kNumber},
        [](S& s, const Given& g) { s.patch.window = g.quantity(D::length, 1e-6, 100); },
        [](const S& s) { return number(s.patch.window); }},
    Key{{"cells", "1", "of the plate's grid along a side of the window", "an even number from 8 to 1024"},
        {kNumber},
        [](S& s, const Given& g) {
            s.patch.cells = int(g.count(8, 1024));
            if (s.patch.cells % 2) g.refuse();
        },
        [](const S& s) { return std::to_string(s.patch.cells); }},
    Key{{"footprint_radius", "m", "of the fingertip's smooth load", "a length from 1e-6 to 10 m, such as 4 mm"},
        {kNumber},
        [](S& s, const Given& g) { s.patch.footprintRadius = g.quantity(D::length, 1e-6, 10); },
        [](const S& s) { return number(s.patch.footprintRadius); }},
    Key{{"map", "", "from the fitted sphere to the plane", "lambert-azimuthal, lambert-cylindrical or gall-peters"},
        {},
        [](S& s, const Given& g) {
            s.patch.map = g.oneOf({Map::lambertAzimuthal, Map::lambertCylindrical, Map::gallPeters});
        },
        [](const S& s) { return quoted(name(s.patch.map)); }},
    Key{{"sampling", "", "of the rigidity at the grid's nodes", "log-mean or nearest"},
        {},
        [](S& s, const Given& g) {
            s.patch.sampling = g.oneOf({Resampling::logMean, Resampling::nearest});
        },
        [](const S& s) { return quoted(name(s.patch.sampling)); }},
    Key{{"edges", "", "of the window: one name for all, or SIDE=EDGE of the sides x0, x1, z0, z1",
         "clamped, supported or free, or a list such as x0=free,z1=supported"},
        {kObject},
        [](S& s, const Given& g) { s.patch.edges = parseEdges(g.text, g.what); },
        [](const S& s) { return quoted(edgesText(s.patch.edges)); }},
    Key{{"force_law", "", "how depth becomes force", "series or paper"},
        {},
        [](S& s, const Given& g) {
            s.patch.forceLaw = g.oneOf({ForceLaw::series, ForceLaw::paper});
        },
        [](const S& s) { return quoted(name(s.patch.forceLaw)); }},
    Key{{"tolerance", "1", "of the plate's solution, relative in the energy norm", "a number from 1e-7 to 0.1"},
        {kNumber},
        [](S& s, const Given& g) {
            s.patch.tolerance = g.quantity(D::none, MultigridPlateSolver::kLeastTolerance, 0.1);
        },
        [](const S& s) { return number(s.patch.tolerance); }},
    Key{{"hand_over", "", "between two answers of the plate", "table, hold or blend"},
        {},
        [](S& s, const Given& g) {
            s.handOver = g.oneOf({ComplianceLaw::table, ComplianceLaw::hold, ComplianceLaw::blend});
        },
        [](const S& s) { return quoted(name(s.handOver)); }},
    Key{{"table_size", "1",
         "footprints a side of the table of compliances; 0: as many as the rate asks for, 3 at 60 Hz",
         "0, 1, 3, 5 or 7"},
        {kNumber},
        [](S& s, const Given& g) {
            s.tableSize = int(g.count(0, ComplianceTable::kMostSide));
            if (s.tableSize > 0 && s.tableSize % 2 == 0) g.refuse();
        },
        [](const S& s) { return std::to_string(s.tableSize); }},
    Key{{"deformation_rate", "Hz", "of the plate's answers", "a number from 1 to 1000 [Hz]"},
        {kNumber},
        [](S& s, const Given& g) { s.deformationRate = g.quantity(D::none, 1, 1000); },
        [](const S& s) { return number(s.deformationRate); }},
    Key{{"proxy", "", "what stands for the finger", "hybrid, sphere or plain-sphere"},
        {},
        [](S& s, const Given& g) {
            s.proxy = g.oneOf({ProxyForm::hybrid, ProxyForm::sphere, ProxyForm::plainSphere});
        },
        [](const S& s) { return quoted(name(s.proxy)); }},
    Key{{"static_friction", "1", "coefficient of a finger at rest", "a number from 0 to 10"},
        {kNumber},
        [](S& s, const Given& g) { s.staticFriction = g.quantity(D::none, 0, 10); },
        [](const S& s) { return number(s.staticFriction); }},
    Key{{"dynamic_friction", "1", "coefficient of a finger that slides, at most static_friction",
         "a number from 0 to 10"},
        {kNumber},
        [](S& s, const Given& g) { s.dynamicFriction = g.quantity(D::none, 0, 10); },
        [](const S& s) { return number(s.dynamicFriction); }},
    Key{{"max_force", "N", "beyond it the governor clamps", "a force from 0.01 to 8 N"},
        {kNumber},
        [](S& s, const Given& g) { s.maxForce = g.quantity(D::force, 0.01, 8); },
        [](const S& s) { return number(s.maxForce); }},
    Key{{"stiffness_cap", "N/m",
         "of what is rendered at a servo period of 1 ms; a released arm swings from 2120 N/m on",
         "a number from 1 to 2000 [N/m]"},
        {kNumber},
        [](S& s, const Given& g) { s.stiffnessCap = g.quantity(D::none, 1, 2000); },
        [](const S& s) { return number(s.stiffnessCap); }},
    Key{{"device", "", "where the plate is solved", "auto, host, lavapipe, reference, or an index or name of a GPU"},
        {},
        [](S& s, const Given& g) {
            if (g.text.empty()) g.refuse();
            s.device = g.text;
        },
        [](const S& s) { return quoted(s.device); }},
    Key{{"place", "m", "on the cloud, where there is something to feel", "a place [x, y, z] in m"},
        {kList},
        readPlace,
        [](const S& s) { return vectorJson(s.place); }},
    Key{{"from", "1", "from which side of the surface the hand comes; absent: away from the cloud's middle",
         "a direction [x, y, z] that is not zero"},
        {kList},
        readFrom,
        [](const S& s) { return s.from ? vectorJson(*s.from) : ""; }},
    Key{{"start_height", "m", "of the hand above the place when the session starts", "a length from 0 to 1 m"},
        {kNumber},
        [](S& s, const Given& g) { s.startHeight = g.quantity(D::length, 0, 1); },
        [](const S& s) { return number(s.startHeight); }},
    Key{{"hunt", "", "nodules that are hidden under the surface, and what counts when somebody looks for them",
         "a hunt such as {\"nodules\":[{\"at\":[0,0,0],\"radius\":4e-3,\"modulus\":3e6}]}"},
        {kObject},
        [](S& s, const Given& g) { s.hunt = parseHunt(g.text, g.what); },
        [](const S& s) { return s.hunt ? huntJson(*s.hunt) : ""; }},
    Key{{"hunt_seed", "1", "hides the nodules anew, at other places for each number; absent: where the hunt has them",
         "a whole number from 0 to 4294967295"},
        {kNumber},
        [](S& s, const Given& g) { s.huntSeed = g.count(0, 4294967295); },
        [](const S& s) { return s.huntSeed ? std::to_string(*s.huntSeed) : ""; }},
};

/// A value of a file in the spelling of a flag.
std::string textOf(const JsonObject& file, const Key& key)
{
    const std::string_view name = key.key.name;
    const auto             kind = file.kind(name);
    if (kind == JsonObject::Kind::text) return file.text(name);
    if (kind != key.kind) file.refuse(name, std::string(key.key.expected));
    if (kind == kList) {
        const std::vector<double> v = file.numbers(name, 3);
        return number(v[0]) + "," + number(v[1]) + "," + number(v[2]);
    }
    if (kind == kNumber) { // 64.0 is a count too
        const double     value  = file.number(name);
        constexpr double kExact = 9007199254740992; // 2^53: larger doubles are not all whole numbers
        return value == std::floor(value) && value >= 0 && value < kExact ? std::to_string(std::uint64_t(value))
                                                                          : file.json(name);
    }
    if (name != "edges") return file.json(name);
    const JsonObject edges = file.object(name);
    edges.allowOnly({"x0", "x1", "z0", "z1"});
    std::string sides;
    for (const char* side : {"x0", "x1", "z0", "z1"})
        if (edges.has(side)) sides += (sides.empty() ? "" : ",") + std::string(side) + "=" + edges.text(side);
    return sides.empty() ? "clamped" : sides;
}

/// What the three sources say about one key: the last one wins.
struct Said {
    std::string text;
    std::string what; ///< opens complaints
    ValueOrigin origin;
};

class Sources {
public:
    Sources(const JsonObject& file, const SceneOverrides& overrides) : file_(file), overrides_(overrides) {}

    [[nodiscard]] std::optional<Said> about(const Key& key) const
    {
        const std::string name(key.key.name), flag = flagOf(name), variable = variableOf(name);
        if (const auto found = overrides_.flags.find(name); found != overrides_.flags.end()) {
            if (found->second.empty()) throw Error(flag + ": expected a value, found \"\"");
            return Said{found->second, flag, {Origin::flag, flag}};
        }
        const char* const value = overrides_.environment ? overrides_.environment(variable.c_str()) : nullptr;
        if (value && *value) return Said{value, variable, {Origin::environment, variable}};
        if (!file_.has(name)) return std::nullopt;
        return Said{textOf(file_, key), file_.where() + ": key \"" + name + "\"", {Origin::scene, file_.where()}};
    }

private:
    const JsonObject&     file_;
    const SceneOverrides& overrides_;
};

void readCloudKey(Scene& scene, const Said& said, const std::filesystem::path& folder)
{
    scene.cloud = said.text;
    if (said.text.empty()) Given{said.text, said.what, kKeys.front().key.expected}.refuse();
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
        static_cast<void>(openForReading(path));
    } catch (const Error& error) {
        throw Error(said.what + ": expected " + std::string(kKeys.front().key.expected) +
                    ", found one that is not there: " + error.what() +
                    (inScene && named.is_relative() ? "; paths start at the scene's folder" : ""));
    }
    scene.cloud = path.lexically_normal().string();
}

/// What suits the cloud, where nobody says anything else.
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

/// What no value is wrong in by itself.
void refuseContradictions(const Scene& scene, const std::map<std::string, std::string>& said)
{
    const auto whatSays = [&](const std::string& key) {
        const auto found = said.find(key);
        return found == said.end() ? "key \"" + key + "\"" : found->second;
    };
    const auto refuse = [](const std::string& what, const std::string& expected, const std::string& found) {
        throw Error(what + ": expected " + expected + ", found " + found);
    };
    for (const char* key : {"points", "seed"})
        if (!isSample(scene) && said.contains(key))
            refuse(whatSays(key), "a sample as the cloud", "the file " + scene.cloud + "; leave \"" + key + "\" away");
    if (isSample(scene) && said.contains("length_unit"))
        refuse(whatSays("length_unit"), "a cloud file", scene.cloud + ", which is in m; leave \"length_unit\" away");
    if (!isSample(scene) && !said.contains("place"))
        refuse(whatSays("cloud"), "a key \"place\" beside a cloud file",
               "none; palpate info " + scene.cloud + " shows where the cloud is");
    if (!(2 * scene.patch.footprintRadius < scene.patch.window))
        refuse(whatSays("footprint_radius"), "a fingertip within the window of " + number(scene.patch.window) + " m",
               "a radius of " + number(scene.patch.footprintRadius) + " m");
    if (scene.huntSeed && !scene.hunt)
        refuse(whatSays("hunt_seed"), "a key \"hunt\" beside it", "none; nothing is hidden in this scene");
    if (scene.dynamicFriction > scene.staticFriction)
        refuse(whatSays("dynamic_friction"), "at most static_friction, " + number(scene.staticFriction),
               number(scene.dynamicFriction));
}

Scene sceneOf(const JsonObject& file, const std::filesystem::path& folder, const SceneOverrides& overrides)
{
    std::vector<std::string_view> names{kSchemaKey};
    for (const Key& key : kKeys) names.push_back(key.key.name);
    file.allowOnly(names);
    for (const auto& [key, text] : overrides.flags)
        PALP_EXPECT(std::ranges::find(names, key) != names.end(),
                    "a flag of a scene has the name of a key, not " + key);

    const Sources                      sources(file, overrides);
    std::map<std::string, std::string> said; // key: what opens complaints about it
    Scene                              scene;
    const auto                         cloud = sources.about(kKeys.front());
    if (!cloud)
        throw Error(file.where() + ": the key \"cloud\" is missing; expected " +
                    std::string(kKeys.front().key.expected) + ", such as sample:skin");
    readCloudKey(scene, *cloud, folder);
    if (isSample(scene)) takeSample(scene);
    scene.origins["cloud"] = cloud->origin;
    said["cloud"]          = cloud->what;
    for (const Key& key : std::span(kKeys).subspan(1)) {
        const auto one = sources.about(key);
        if (!one) continue;
        try {
            key.read(scene, Given{one->text, one->what, key.key.expected,
                                  key.key.unit == "1" ? std::string_view() : key.key.unit});
        } catch (const Error& error) { // of the readers of quantities and units
            const std::string sentence = error.what();
            throw sentence.starts_with(one->what) ? error : Error(one->what + ": " + sentence);
        }
        scene.origins[std::string(key.key.name)] = one->origin;
        said[std::string(key.key.name)]          = one->what;
    }
    refuseContradictions(scene, said);
    for (const Key& key : kKeys)
        if (!key.write(scene).empty()) scene.origins.try_emplace(std::string(key.key.name));
    return scene;
}

} // namespace

std::span<const SceneKey> sceneKeys()
{
    static const std::vector<SceneKey> keys = [] {
        std::vector<SceneKey> list;
        for (const Key& key : kKeys) list.push_back(key.key);
        return list;
    }();
    return keys;
}

std::string flagOf(std::string_view key)
{
    std::string flag = "--" + std::string(key);
    std::ranges::replace(flag, '_', '-');
    return flag;
}

std::string variableOf(std::string_view key)
{
    std::string variable = "PALPATE_";
    for (const char c : key) variable += c >= 'a' && c <= 'z' ? char(c - 'a' + 'A') : c;
    return variable;
}

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

std::string sceneJson(const Scene& scene)
{
    Scene whole = scene;
    if (!isSample(whole)) whole.cloud = std::filesystem::absolute(whole.cloud).string();
    std::string text;
    for (const Key& key : kKeys)
        if (const std::string value = key.write(whole); !value.empty())
            text += (text.empty() ? "{" : ",\n ") + quoted(std::string(key.key.name)) + ": " + value;
    return text + "}";
}

std::string printConfig(const Scene& scene, ConfigFormat format)
{
    std::ostringstream     text;
    nlohmann::ordered_json all         = nlohmann::ordered_json::object();
    std::size_t            widestValue = 5; // "value"
    for (const Key& key : kKeys)
        widestValue = std::max(widestValue, std::min<std::size_t>(key.write(scene).size(), 32));
    const auto row = [&](std::string_view name, std::string_view value, std::string_view unit, std::string_view where) {
        const auto padded = [](std::string_view word, std::size_t width) {
            return std::string(word) + std::string(word.size() < width ? width - word.size() : 0, ' ') + "  ";
        };
        text << padded(name, 16) << padded(value, widestValue) << padded(unit, 4) << where << "\n";
    };
    row("key", "value", "unit", "where from");
    for (const Key& key : kKeys) {
        const std::string name(key.key.name), value = key.write(scene);
        const auto        found  = scene.origins.find(name);
        const ValueOrigin origin = found == scene.origins.end() ? ValueOrigin{} : found->second;
        const auto        json   = value.empty() ? nlohmann::ordered_json() : nlohmann::ordered_json::parse(value);
        row(name,
            value.empty()      ? "-"
            : json.is_string() ? json.get<std::string>()
                               : value,
            key.key.unit.empty() ? "-" : key.key.unit,
            std::string(palp::name(origin.origin)) + (origin.where.empty() ? "" : " " + origin.where));
        all[name] = {
            {"value", json}, {"unit", key.key.unit}, {"origin", palp::name(origin.origin)}, {"where", origin.where}};
    }
    return format == ConfigFormat::text ? text.str() : all.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

} // namespace palp
