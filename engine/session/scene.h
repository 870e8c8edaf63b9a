#pragma once
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <glm/vec3.hpp>

#include "engine/cloud/point_cloud_io.h"
#include "engine/cloud/soft_object.h"
#include "engine/contact/proxy.h"
#include "engine/core/enum_names.h"
#include "engine/force/compliance_tracker.h"
#include "engine/pipeline/pipeline.h"
#include "engine/session/hunt.h"

namespace palp {

/// Where a value of a scene came from; a later one wins.
enum class Origin {
    standard,    ///< what this program takes if nobody says anything
    sample,      ///< what suits the procedural cloud
    scene,       ///< the scene file
    environment, ///< PALPATE_<KEY>
    flag         ///< the command line
};
constexpr auto namesOf(Origin)
{
    using enum Origin;
    return std::to_array<NamedValue<Origin>>(
        {{standard, "default"}, {sample, "sample"}, {scene, "scene"}, {environment, "environment"}, {flag, "flag"}});
}

struct ValueOrigin {
    Origin      origin = Origin::standard;
    std::string where; ///< "sample:skin", a file, "PALPATE_THICKNESS", "--thickness"; empty for a default
};

/// Everything that decides a session but the hand: what is touched, how it bends, how that becomes a force.
///
/// Invariant of what readScene() returns: every value is within the bounds that sceneKeys() state, and a cloud's file
/// existed when the scene was read.
struct Scene {
    std::string   cloud;      ///< "sample:NAME", or the path of a cloud file
    std::size_t   points = 0; ///< of a sample [1]; 0: a file's own
    std::uint64_t seed   = 1; ///< of a sample [1]
    std::string   lengthUnit; ///< of a file's coordinates; empty: its comment, else m
    std::string   stiffness;  ///< law of the modulus over the cloud, see parseSpatialLaw [Pa]; empty: the cloud's own
    Material      material;   ///< of the object
    PatchSettings patch;      ///< foundation, window, map, force law, ...

    ComplianceLaw handOver = ComplianceLaw::table;
    int    tableSize       = 0; ///< footprints a side of the table, odd [1]; reaches (size - 1)/2 radii; 0: tableSide()
    double deformationRate = 60; ///< of the plate's thread [Hz]

    ProxyForm proxy           = ProxyForm::hybrid;
    double    staticFriction  = 0.5;  ///< mu_s [1]; skin on skin 0.5 to 1
    double    dynamicFriction = 0.3;  ///< mu_d [1], at most mu_s
    double    maxForce        = 6;    ///< beyond it the governor clamps [N]
    double    stiffnessCap    = 1000; ///< of what the device renders at a period of 1 ms [N/m]

    std::string device = "auto"; ///< of the plate, as `--device` takes it

    glm::dvec3                place{};             ///< [m] on the cloud, where there is something to feel
    std::optional<glm::dvec3> from{};              ///< [1] the hand's side there; empty: away from the cloud's middle
    double                    startHeight = 10e-3; ///< [m] of the hand above `place` when the session starts

    std::optional<Hunt>          hunt{};     ///< nodules that are hidden in the cloud, see engine/session/hunt.h
    std::optional<std::uint64_t> huntSeed{}; ///< places them anew [1]

    std::map<std::string, ValueOrigin, std::less<>> origins; ///< of every key that has a value
};

/// One value of a scene, under the same name in a file ("max_force"), the environment (PALPATE_MAX_FORCE) and as a
/// flag (--max-force). Quantities may be plain numbers in `unit` or texts with a unit of the same dimension ("4 mm").
struct SceneKey {
    std::string_view name;
    std::string_view unit;     ///< of plain numbers; "1" for a ratio or a count, empty for names and texts
    std::string_view means;    ///< one line
    std::string_view expected; ///< its bounds, as complaints state them
};

/// All keys, in the order in which help texts and printConfig() list them.
[[nodiscard]] std::span<const SceneKey> sceneKeys();

/// "--max-force" and "PALPATE_MAX_FORCE".
[[nodiscard]] std::string flagOf(std::string_view key);
[[nodiscard]] std::string variableOf(std::string_view key);

/// The value of an environment variable, or nullptr; an empty value counts as none.
using Environment = std::function<const char*(const char*)>;

/// That of this process.
[[nodiscard]] Environment processEnvironment();

/// What the user says beside the file.
struct SceneOverrides {
    std::map<std::string, std::string, std::less<>> flags;       ///< text per key ("max_force": "4 N")
    Environment                                     environment; ///< none: no variable counts, as in replays
};

/// Reads a scene file: JSON, comments allowed, SI unless a text says its unit. samples/scenes/scene.schema.json
/// describes every key. Precedence: default < sample < scene < environment < flag.
///
/// A relative path of a cloud starts at the scene file's folder; in the environment or a flag at the current one.
/// \throws Error, one sentence: the file, variable or flag, the key, what was expected and found, what to try
[[nodiscard]] Scene readScene(const std::filesystem::path& file, const SceneOverrides& overrides = {});

/// The same from the text of a file that is called `name` and lies in `folder`.
[[nodiscard]] Scene parseScene(std::string_view text, const std::string& name, const std::filesystem::path& folder,
                               const SceneOverrides& overrides = {});

/// The scene as one JSON object that parseScene() reads back to the same values; a file's path is absolute in it.
[[nodiscard]] std::string sceneJson(const Scene& scene);

enum class ConfigFormat { text, json };

/// Every key with its value, its unit and where the value came from: what `--print-config` shows.
[[nodiscard]] std::string printConfig(const Scene& scene, ConfigFormat format);

inline constexpr std::string_view kSamplePrefix = "sample:";

/// Whether the cloud is a procedural one, and its name without the prefix.
[[nodiscard]] inline bool isSample(const Scene& scene)
{
    return scene.cloud.starts_with(kSamplePrefix);
}
[[nodiscard]] inline std::string_view sampleName(const Scene& scene)
{
    return std::string_view(scene.cloud).substr(kSamplePrefix.size());
}

/// The cloud with the scene's law, if it has one, and the nodules of its hunt.
/// \throws Error as readCloud() and hiddenNodules() do
[[nodiscard]] LoadedCloud loadCloud(const Scene& scene);

/// What is touched in a scene, and how its file was understood.
struct LoadedObject {
    SoftObject      object;
    CloudFileReport report;
};

/// loadCloud() with its index, of the scene's material.
[[nodiscard]] LoadedObject loadObject(const Scene& scene);

/// The nodules that loadCloud() has hidden in this cloud; none without a hunt.
[[nodiscard]] std::vector<Nodule> nodulesOf(const Scene& scene, const PointCloud& cloud);

/// 16 hexadecimal digits that tell clouds apart: FNV-1a over the bits of places and stiffnesses. Not against malice.
[[nodiscard]] std::string fingerprint(const PointCloud& cloud);

} // namespace palp
