#include <algorithm>

#include "engine/cloud/cloud_format.h"
#include "engine/cloud/face_orientation.h"
#include "engine/cloud/mesh_points.h"
#include "engine/cloud/samples.h"
#include "engine/core/contract.h"
#include "engine/core/counted.h"
#include "engine/core/fingerprint.h"
#include "engine/core/quantity.h"
#include "engine/core/spatial_law.h"
#include "engine/session/scene_keys.h"
#include "engine/session/scene_mesh.h"

// The cloud of a scene.

namespace palp {
namespace {

/// Returns the law's values through the sheet below each point.
std::vector<double> valuesBelow(const SpatialLaw& law, const LoadedCloud& loaded, const Scene& scene)
{
    const SoftObject object(loaded.cloud, scene.material, loaded.faces, loaded.normals); // settles normals and sides
    object.survey().expectSurface();
    std::vector<double> values;
    for (std::size_t n = 0; n < object.size(); ++n) {
        const SpatialLaw::Below below{object.survey().normal(n), object.survey().sided(n), scene.material.thickness};
        values.push_back(law.valueBelow(object.positions()[n], below, "point " + std::to_string(n)));
    }
    return values;
}

/// Returns true if the cloud's stiffness depends on the thickness of the sheet.
bool thicknessDecidesCloud(const Scene& scene)
{
    // A file of that name only costs that the cloud is made once more.
    return scene.stiffness.find("grid") != std::string::npos && scene.stiffness.find("thickness") != std::string::npos;
}

/// Applies the scene's law at every place, instead of the stiffness that the cloud has.
/// \param bounds  of the cloud as it is in its file: points on a mesh do not quite reach its corners
PointCloud withLaw(const LoadedCloud& loaded, const Bounds& bounds, const Scene& scene, StiffnessKind kind)
{
    const SpatialLaw    law = parseSpatialLaw(scene.stiffness, bounds.low, bounds.high, SpatialLaw::Space::volume);
    const auto          positions = loaded.cloud.positions();
    std::vector<double> stiffness;
    if (law.along == SpatialLaw::Along::thickness) {
        if (kind != StiffnessKind::modulus)
            throw Error(openingOf(scene, "stiffness") +
                        ": \"along\": \"thickness\" takes Young's modulus from a volume, found stiffness_unit " +
                        std::string(unitOf(kind)) +
                        "; omit "
                        "one of the two");
        stiffness = valuesBelow(law, loaded, scene);
    } else {
        for (const glm::dvec3& p : positions)
            stiffness.push_back(law.valueAt(p, "point " + std::to_string(stiffness.size())));
    }
    return {{positions.begin(), positions.end()}, std::move(stiffness), kind};
}

LoadedCloud sampleOf(const Scene& scene)
{
    const Sample&             sample = sampleNamed(sampleName(scene));
    const Bounds              bounds = boundsOf(sample);
    std::optional<SpatialLaw> law;
    if (!scene.stiffness.empty())
        law = parseSpatialLaw(scene.stiffness, bounds.low, bounds.high, SpatialLaw::Space::volume, LawFiles::left);
    CloudFileReport report;
    report.format           = "procedural sample";
    report.points           = scene.points;
    report.lengthUnitSource = "m, by construction";
    report.stiffnessSource  = law ? "the scene's law [Pa]" : "the sample's own law [Pa]";
    if (law && law->kind == SpatialLaw::Kind::grid) // may have no value somewhere, and says so
        return {withLaw({makeSample(sample, scene.points, scene.seed), {}}, bounds, scene, StiffnessKind::modulus),
                std::move(report)};
    return {makeSample(sample, scene.points, scene.seed, law), std::move(report)};
}

/// Returns true if the distance between points on the faces of a mesh depends on the fingertip.
bool fingertipDecidesCloud(const Scene& scene)
{
    return !isSample(scene) && scene.scatter != Scatter::off && scene.scatterDistance == 0 &&
           formatToRead(scene.cloud).holdsFaces;
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

/// \throws Error with scatterRefusal() of the plan, if it is refused
void refuseTooLarge(const Scene& scene, const ScatterPlan& plan)
{
    if (const std::string why = scatterRefusal(plan); !why.empty()) throw Error(cloudName(scene) + ": " + why);
}

/// Turns flipped triangles round: their normals are the points' sides, and what lies behind a seam between two sides is
/// another sheet to the finger. A closed body that lies inside out is turned whole, or a finger would feel the far face
/// of its thin parts.
void turnFlippedFaces(LoadedCloud& loaded)
{
    std::vector<std::string>& warnings = loaded.report.warnings;
    const std::size_t         turned   = turnToNeighbours(loaded.faces, loaded.cloud.positions());
    if (turned > 0)
        warnings.push_back(std::to_string(turned) + " of " + counted(loaded.faces.size(), "triangle") +
                           " faced against their neighbours and were turned round");
    const TurnedOutward outward = turnOutward(loaded.faces, loaded.cloud.positions(), loaded.normals);
    if (outward.faces > 0)
        warnings.push_back(counted(outward.faces, "triangle") +
                           " of closed surfaces that lay inside out faced inward and were turned round");
    if (outward.normals > 0)
        warnings.push_back(std::to_string(outward.normals) +
                           " of the file's normals pointed into closed surfaces and were turned round");
}

} // namespace

std::string openingOf(const Scene& scene, const std::string& key)
{
    const auto found = scene.origins.find(key);
    if (found == scene.origins.end()) return "key \"" + key + "\"";
    const auto& [origin, where] = found->second;
    return origin == Origin::scene ? where + ": key \"" + key + "\"" : where;
}

std::string cloudName(const Scene& scene)
{
    return scene.cloud.empty() ? "the given points" : scene.cloud;
}

LoadedCloud loadBareCloud(const Scene& scene)
{
    if (isSample(scene)) return sampleOf(scene);
    LoadedCloud loaded = readCloud(scene.cloud, scene.reading);
    refuseContradiction(scene, loaded);
    return asTouched(std::move(loaded), scene);
}

LoadedCloud asTouched(LoadedCloud loaded, const Scene& scene)
{
    turnFlippedFaces(loaded);
    const Bounds bounds = loaded.cloud.bounds();
    if (const auto plan = scatterPlan(scene, loaded)) {
        refuseTooLarge(scene, *plan);
        scatterOverFaces(loaded, *plan);
    }
    if (scene.stiffness.empty()) return loaded;
    const StiffnessKind kind      = scene.reading.stiffnessKind.value_or(StiffnessKind::modulus);
    loaded.cloud                  = withLaw(loaded, bounds, scene, kind);
    loaded.report.stiffnessSource = std::string("the scene's law [") + unitOf(kind) + "]";
    return loaded;
}

LoadedCloud loadCloud(const Scene& scene)
{
    LoadedCloud loaded = loadBareCloud(scene);
    if (scene.overlay) loaded.cloud = scene.overlay->over(loaded.cloud, scene);
    return loaded;
}

bool statesStiffening(const Scene& scene)
{
    const auto stated = scene.origins.find("stiffening");
    return stated != scene.origins.end() && stated->second.origin != Origin::standard;
}

SoftObject heldAs(const Scene& scene, const SoftObject& object, const LoadedCloud& loaded)
{
    if (!scene.held.isThere()) return object;
    return object.withHeld(heldShares(object.positions(), scene.held, loaded.held, openingOf(scene, "held")));
}

LoadedObject objectOf(LoadedCloud loaded, const Scene& scene)
{
    if (loaded.cloud.kind() == StiffnessKind::felt)
        throw Error(cloudName(scene) +
                    ": expected a modulus [Pa] or a flexural rigidity [N_m], found a map of what a probe "
                    "felt [N/m]; palpate fit makes an object of it");
    SoftObject object(std::move(loaded.cloud), scene.material, std::move(loaded.faces), loaded.normals);
    if (!statesStiffening(scene)) object = object.withStiffening(std::move(loaded.stiffening));
    object = heldAs(scene, object, loaded);
    return {onTissue(object.standingFor(std::move(loaded.mesh)), scene, loaded.foundation), std::move(loaded.report)};
}

LoadedObject loadObject(const Scene& scene)
{
    return objectOf(loadCloud(scene), scene);
}

bool haveSameCloud(const Scene& a, const Scene& b)
{
    if (fingertipDecidesCloud(a) && a.patch.footprintRadius != b.patch.footprintRadius) return false;
    if (thicknessDecidesCloud(a) && a.material.thickness != b.material.thickness) return false;
    if (a.below.isThere() &&
        (a.patch.footprintRadius != b.patch.footprintRadius || a.material.thickness != b.material.thickness))
        return false; // how deep a finger feels depends on both
    if (a.below.isThere() && !a.below.isTissue() && a.patch.foundation != b.patch.foundation) return false;
    if (a.toolKeys != b.toolKeys) return false;
    return std::ranges::all_of(sceneKeysWith(a.toolKeys), [&](const SceneKey* key) {
        return !key->decidesCloud || key->write(a) == key->write(b);
    });
}

std::vector<std::string> filesOfLaws(const Scene& scene)
{
    std::vector<std::string> files;
    for (const std::string& law : {scene.stiffness, scene.below.volume, scene.below.foundation}) {
        if (law.empty()) continue;
        const std::string file =
            parseSpatialLaw(law, {-1, -1, -1}, {1, 1, 1}, SpatialLaw::Space::volume, LawFiles::left).file;
        if (!file.empty()) files.push_back(file);
    }
    return files;
}

std::string fingerprint(const PointCloud& cloud)
{
    Fingerprint print;
    for (const glm::dvec3& p : cloud.positions()) {
        print.add(p.x);
        print.add(p.y);
        print.add(p.z);
    }
    for (const double stiffness : cloud.stiffness()) print.add(stiffness);
    return print.text();
}

} // namespace palp
