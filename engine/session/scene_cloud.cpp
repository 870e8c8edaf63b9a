#include <algorithm>
#include <bit>
#include <cstdio>

#include "engine/cloud/samples.h"
#include "engine/core/contract.h"
#include "engine/core/spatial_law.h"
#include "engine/session/scene_keys.h"

// The cloud of a scene.

namespace palp {
namespace {

/// Applies the scene's law at every place, instead of the stiffness that the cloud has.
PointCloud withLaw(const PointCloud& cloud, const Scene& scene, StiffnessKind kind)
{
    const Bounds&       bounds = cloud.bounds();
    const SpatialLaw    law    = parseSpatialLaw(scene.stiffness, bounds.low, bounds.high, SpatialLaw::Space::volume);
    std::vector<double> stiffness;
    stiffness.reserve(cloud.size());
    for (const glm::dvec3& p : cloud.positions()) stiffness.push_back(law(p));
    return {{cloud.positions().begin(), cloud.positions().end()}, std::move(stiffness), kind};
}

LoadedCloud sampleOf(const Scene& scene)
{
    const Sample&             sample = sampleNamed(sampleName(scene));
    const Bounds              bounds = boundsOf(sample);
    std::optional<SpatialLaw> law;
    if (!scene.stiffness.empty())
        law = parseSpatialLaw(scene.stiffness, bounds.low, bounds.high, SpatialLaw::Space::volume);
    CloudFileReport report;
    report.format           = "procedural sample";
    report.points           = scene.points;
    report.lengthUnitSource = "m, by construction";
    report.stiffnessSource  = law ? "the scene's law [Pa]" : "the sample's own law [Pa]";
    return {makeSample(sample, scene.points, scene.seed, law), std::move(report)};
}

/// Returns the opening of a complaint about a key: "--uniform", or "skin.json: key \"uniform\"".
std::string openingOf(const Scene& scene, const std::string& key)
{
    const auto found = scene.origins.find(key);
    if (found == scene.origins.end()) return "key \"" + key + "\"";
    const auto& [origin, where] = found->second;
    return origin == Origin::scene ? where + ": key \"" + key + "\"" : where;
}

/// Refuses a file whose own statement on its stiffness contradicts the user's, or that has one beside a uniform one.
void refuseContradiction(const Scene& scene, const LoadedCloud& loaded)
{
    if (!scene.stiffness.empty() || !loaded.report.stiffnessProperty) return;
    if (scene.reading.uniformStiffness)
        throw Error(openingOf(scene, "uniform") + ": expected a file without stiffness, found " +
                    loaded.report.stiffnessSource + "; to replace it give stiffness constant:value=PASCAL");
    const auto stated = loaded.report.statedKind;
    if (stated && *stated != loaded.cloud.kind())
        throw Error(openingOf(scene, "stiffness_unit") + ": " + unitOf(loaded.cloud.kind()) +
                    " contradicts the file's comment, stiffness_unit " + unitOf(*stated) +
                    "; omit stiffness_unit or correct the comment in " + scene.cloud);
}

} // namespace

LoadedCloud loadBareCloud(const Scene& scene)
{
    if (isSample(scene)) return sampleOf(scene);
    LoadedCloud loaded = readCloud(scene.cloud, scene.reading);
    refuseContradiction(scene, loaded);
    if (scene.stiffness.empty()) return loaded;
    const StiffnessKind kind      = scene.reading.stiffnessKind.value_or(StiffnessKind::modulus);
    loaded.cloud                  = withLaw(loaded.cloud, scene, kind);
    loaded.report.stiffnessSource = std::string("the scene's law [") + unitOf(kind) + "]";
    return loaded;
}

LoadedCloud loadCloud(const Scene& scene)
{
    LoadedCloud loaded = loadBareCloud(scene);
    if (scene.overlay) loaded.cloud = scene.overlay->over(loaded.cloud, scene);
    return loaded;
}

LoadedObject loadObject(const Scene& scene)
{
    LoadedCloud loaded = loadCloud(scene);
    return {SoftObject(std::move(loaded.cloud), scene.material, std::move(loaded.faces), loaded.normals),
            std::move(loaded.report)};
}

bool haveSameCloud(const Scene& a, const Scene& b)
{
    if (a.toolKeys != b.toolKeys) return false;
    return std::ranges::all_of(sceneKeysWith(a.toolKeys), [&](const SceneKey* key) {
        return !key->decidesCloud || key->write(a) == key->write(b);
    });
}

std::string fingerprint(const PointCloud& cloud)
{
    std::uint64_t hash = 14695981039346656037U;
    const auto    add  = [&](double value) {
        std::uint64_t bits = std::bit_cast<std::uint64_t>(value);
        for (int k = 0; k < 8; ++k, bits >>= 8U) hash = (hash ^ (bits & 0xFFU)) * 1099511628211U;
    };
    for (const glm::dvec3& p : cloud.positions()) {
        add(p.x);
        add(p.y);
        add(p.z);
    }
    for (const double stiffness : cloud.stiffness()) add(stiffness);
    char text[17];
    std::snprintf(text, sizeof text, "%016llx", static_cast<unsigned long long>(hash));
    return text;
}

} // namespace palp
