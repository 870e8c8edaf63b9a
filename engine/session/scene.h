#pragma once
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <glm/vec3.hpp>

#include "engine/cloud/point_cloud_io.h"
#include "engine/cloud/soft_object.h"
#include "engine/contact/proxy.h"
#include "engine/core/enum_names.h"
#include "engine/force/compliance_tracker.h"
#include "engine/pipeline/patch.h"
#include "engine/pipeline/presets.h"
#include "engine/session/scene_below.h"
#include "engine/session/scene_held.h"

namespace palp {

/// The origin of a scene's value; a later one wins.
enum class Origin {
    standard,    ///< the program's default
    sample,      ///< of the procedural cloud
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

/// The points through which a cloud with faces is touched.
enum class Scatter {
    automatic, ///< the cloud's own if they are dense enough for the fingertip, else points on the faces
    on,        ///< points on the faces
    off        ///< the cloud's own
};
constexpr auto namesOf(Scatter)
{
    using enum Scatter;
    return std::to_array<NamedValue<Scatter>>({{automatic, "auto"}, {on, "on"}, {off, "off"}});
}

/// Bounds of Scene::workspaceScale [1]. Above, a millimetre of a trembling hand is a centimetre of the object.
inline constexpr double kLeastWorkspaceScale = 0.1, kMostWorkspaceScale = 10;

struct ValueOrigin {
    Origin      origin = Origin::standard;
    std::string where; ///< "sample:skin", a file, "PALPATE_THICKNESS", "--preset paper"; empty for a default
};

struct Scene;
struct SceneKey;

/// A change that a tool makes to the cloud of a scene, by keys of its own in the scene's file: nodules to be found, for
/// example. A scene carries it into recordings and replays; the library does not interpret it.
class CloudOverlay {
public:
    virtual ~CloudOverlay() = default;

    /// Returns the cloud with the overlay.
    /// \throws Error if it does not fit the cloud
    [[nodiscard]] virtual PointCloud over(const PointCloud& cloud, const Scene& scene) const = 0;

    /// Returns the nodules that it lays below the sheet.
    /// \throws Error likewise
    [[nodiscard]] virtual std::vector<BuriedNodule> below(const PointCloud& cloud, const Scene& scene) const = 0;
};

/// Everything that decides a session but the hand: what is touched, how it bends, how that becomes a force.
///
/// Invariant of what readScene() returns: every value is within the bounds that sceneKeys() state, and a cloud's file
/// existed when the scene was read.
struct Scene {
    std::string       cloud;                                ///< "sample:NAME", or the path of a cloud file
    std::size_t       points = 0;                           ///< of a sample; 0: a file's own
    std::uint64_t     seed   = 1;                           ///< of a sample
    CloudReadSettings reading;                              ///< how a cloud file is read
    Scatter           scatter         = Scatter::automatic; ///< of a file with faces
    double            scatterDistance = 0;                  ///< between points on faces [m]; 0: a part of the fingertip
    std::string stiffness; ///< law of the modulus over the cloud, see parseSpatialLaw [Pa]; empty: the cloud's own

    std::optional<glm::dvec3> place{}; ///< [m] on the cloud; empty: nearest to a viewer who looks along -z
    std::optional<glm::dvec3> from{};  ///< the hand's side there, of any length; empty: away from the cloud's middle

    Preset        preset = Preset::palpate; ///< the last one that was asked for; its values stand in `patch`
    std::string   materialName;             ///< of knownMaterials(), the last that was asked for; empty: none
    Material      material{};               ///< of the sheet
    SceneBelow    below{};                  ///< what varies below the sheet
    SceneHeld     held{};                   ///< what holds the object where it is
    PatchSettings patch;                    ///< foundation, window, map, force law, ...
    std::string   solver = "auto";          ///< of the plate, as PlateSolver takes it

    ComplianceLaw complianceLaw = ComplianceLaw::table;
    int           tableSize = 0; ///< footprints a side of the table, odd; reaches (size - 1)/2 radii; 0: tableSide()
    double        deformationRate = 60; ///< of the plate's thread [Hz]

    ProxyForm proxy           = ProxyForm::hybrid;
    double    staticFriction  = 0.5;   ///< mu_s [1]; skin on skin 0.5 to 1
    double    dynamicFriction = 0.3;   ///< mu_d [1], at most mu_s
    double    maxForce        = 6;     ///< the governor clamps the force to it [N]
    double    stiffnessCap    = 1000;  ///< of what the device renders at a period of 1 ms [N/m]
    double    startHeight     = 10e-3; ///< of the hand above the place when the session starts [m]
    double    workspaceScale  = 1;     ///< metres of the scene per metre of the device [1]; forces are not scaled
    int       clutchButton    = 0;     ///< of the device, counted from 1; 0: none

    std::shared_ptr<const CloudOverlay> overlay{};          ///< of a tool; empty: the cloud as it is loaded
    const std::vector<SceneKey>*        toolKeys = nullptr; ///< of the tool that read the scene; null: none

    std::map<std::string, ValueOrigin, std::less<>> origins; ///< of every key that has a value
};

/// Returns the value of an environment variable, or nullptr; an empty value counts as none.
using Environment = std::function<const char*(const char*)>;

/// Returns the environment of this process.
[[nodiscard]] Environment processEnvironment();

/// The user's statements beside the file.
struct SceneOverrides {
    std::map<std::string, std::string, std::less<>> flags{};       ///< text per key ("max_force": "4 N")
    Environment                                     environment{}; ///< none: no variable counts, as in replays

    /// Plain numbers of lengths among the flags are in the scene's length_unit, as a command line takes them; in files
    /// and in the environment they are metres.
    bool flagsInLengthUnit = false;

    const std::vector<SceneKey>* toolKeys = nullptr; ///< that a tool adds to the library's, see scene_keys.h

    /// The caller has the object: the scene needs no cloud, and must name none.
    bool withoutCloud = false;
};

/// Reads a scene file: JSON, comments allowed, SI unless a text states its unit. samples/scenes/scene.schema.json
/// describes every key. Precedence: default < sample < scene < environment < flag. A preset sets its values where it is
/// asked for: a file's preset below the file's own keys, that of a flag above all of the file, below other flags.
///
/// A relative path of a cloud starts at the scene file's folder; in the environment or a flag, at the current one.
/// \throws Error, one sentence: the file, variable or flag, the key, what was expected and found, what to try
[[nodiscard]] Scene readScene(const std::filesystem::path& file, const SceneOverrides& overrides = {});

/// Reads a scene from the text of a file that is called `name` and lies in `folder`.
[[nodiscard]] Scene parseScene(std::string_view text, const std::string& name, const std::filesystem::path& folder,
                               const SceneOverrides& overrides = {});

/// Returns the scene as one JSON object that parseScene() reads back to the same values. A stiffening that nobody stated
/// is left out, because a stated one counts in place of the cloud's.
/// \param folder  that the text is stored in: the name of a cloud in it is relative to it, else a file's path is
///                absolute
[[nodiscard]] std::string sceneJson(const Scene& scene, const std::filesystem::path& folder = {});

enum class ConfigFormat { text, json };

/// Returns every key with its value, its unit and the value's origin: the output of `--print-config`.
[[nodiscard]] std::string printConfig(const Scene& scene, ConfigFormat format);

inline constexpr std::string_view kSamplePrefix = "sample:";

/// Returns true if the cloud is a procedural one; sampleName() returns its name without the prefix.
[[nodiscard]] inline bool isSample(const Scene& scene)
{
    return scene.cloud.starts_with(kSamplePrefix);
}
[[nodiscard]] inline std::string_view sampleName(const Scene& scene)
{
    return std::string_view(scene.cloud).substr(kSamplePrefix.size());
}

/// Returns the opening of a complaint about a key: "--uniform", or "skin.json: key \"uniform\"".
[[nodiscard]] std::string openingOf(const Scene& scene, const std::string& key);

/// Returns true if two scenes have the same cloud, as far as their keys tell.
[[nodiscard]] bool haveSameCloud(const Scene& a, const Scene& b);

/// Loads the cloud as the scene states, with the scene's law and overlay, if it has them. A mesh whose vertices are too
/// far apart for the fingertip is touched through points on its faces, see scene_mesh.h.
/// \throws Error as readCloud() and CloudOverlay::over() do, and if the file's stiffness contradicts the scene
[[nodiscard]] LoadedCloud loadCloud(const Scene& scene);

/// The touched object of a scene, and how its file was understood.
struct LoadedObject {
    SoftObject      object;
    CloudFileReport report;
};

/// Loads the cloud by loadCloud(), with its index and the scene's material.
[[nodiscard]] LoadedObject loadObject(const Scene& scene);

/// Makes the object of a loaded cloud: with its index, faces or mesh, normals and the scene's material.
/// \throws Error if the cloud is a map of felt stiffness
[[nodiscard]] LoadedObject objectOf(LoadedCloud loaded, const Scene& scene);

/// Returns the object of these points with what the scene says that holds it.
/// \throws Error if the scene holds what its cloud does not say
[[nodiscard]] SoftObject heldAs(const Scene& scene, const SoftObject& object, const LoadedCloud& loaded);

/// Does the same as loadCloud() without the overlay.
[[nodiscard]] LoadedCloud loadBareCloud(const Scene& scene);

/// Returns a cloud that was read, or that a caller has made, as the scene touches it: with triangles turned round that
/// face against their neighbours, a mesh through points on its faces, and the scene's law in place of the stiffness.
/// \throws Error as loadCloud()
[[nodiscard]] LoadedCloud asTouched(LoadedCloud loaded, const Scene& scene);

/// Returns whether the scene, or its material, says how the force stiffens: it wins over what a file says of its
/// points.
[[nodiscard]] bool statesStiffening(const Scene& scene);

/// Returns the files of the scene's laws: the volumes of grids.
/// \throws Error as parseSpatialLaw() does
[[nodiscard]] std::vector<std::string> filesOfLaws(const Scene& scene);

/// Returns what complaints call the scene's cloud.
[[nodiscard]] std::string cloudName(const Scene& scene);

/// Returns 16 hexadecimal digits that tell clouds apart: FNV-1a over the bits of places and stiffnesses. They do not
/// protect against malice.
[[nodiscard]] std::string fingerprint(const PointCloud& cloud);

} // namespace palp
