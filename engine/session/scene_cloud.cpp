#include <bit>
#include <cstdio>

#include "engine/cloud/samples.h"
#include "engine/core/spatial_law.h"
#include "engine/session/scene.h"

// What a scene's cloud is made of.

namespace palp {
namespace {

LoadedCloud loadBare(const Scene& scene)
{
    const auto lawAcross = [&](const Bounds& bounds) {
        return parseSpatialLaw(scene.stiffness, bounds.low, bounds.high, SpatialLaw::Space::volume);
    };
    if (isSample(scene)) {
        const Sample&             sample = sampleNamed(sampleName(scene));
        std::optional<SpatialLaw> law;
        if (!scene.stiffness.empty()) law = lawAcross(boundsOf(sample));
        CloudFileReport report;
        report.format           = "procedural sample";
        report.points           = scene.points;
        report.lengthUnitSource = "m, by construction";
        report.stiffnessSource  = law ? "the scene's law [Pa]" : "the sample's own law [Pa]";
        return {makeSample(sample, scene.points, scene.seed, law), std::move(report)};
    }
    CloudReadSettings settings;
    settings.lengthUnit = scene.lengthUnit;
    LoadedCloud loaded  = readCloud(scene.cloud, settings);
    if (scene.stiffness.empty()) return loaded;
    const SpatialLaw    law = lawAcross(loaded.cloud.bounds());
    std::vector<double> stiffness;
    stiffness.reserve(loaded.cloud.size());
    for (const glm::dvec3& p : loaded.cloud.positions()) stiffness.push_back(law(p));
    loaded.cloud = PointCloud({loaded.cloud.positions().begin(), loaded.cloud.positions().end()}, std::move(stiffness),
                              StiffnessKind::modulus);
    loaded.report.stiffnessSource = "the scene's law [Pa]";
    return loaded;
}

} // namespace

std::vector<Nodule> nodulesOf(const Scene& scene, const PointCloud& cloud)
{
    if (!scene.hunt) return {};
    return hiddenNodules(*scene.hunt, scene.huntSeed, cloud, scene.place, scene.patch.footprintRadius);
}

LoadedCloud loadCloud(const Scene& scene)
{
    LoadedCloud loaded = loadBare(scene);
    if (scene.hunt) loaded.cloud = withNodules(loaded.cloud, nodulesOf(scene, loaded.cloud), scene.material);
    return loaded;
}

LoadedObject loadObject(const Scene& scene)
{
    LoadedCloud loaded = loadCloud(scene);
    return {SoftObject(std::move(loaded.cloud), scene.material, std::move(loaded.faces)), std::move(loaded.report)};
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
