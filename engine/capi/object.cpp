#include <algorithm>
#include <limits>
#include <span>
#include <sstream>
#include <utility>
#include <vector>

#include <glm/geometric.hpp>

#include "engine/capi/detail/border.h"

// Objects, from arrays, scenes and files.

namespace palp::capi {
namespace {

/// An array of the caller, of either type and any stride.
class Numbers {
public:
    Numbers(const void* data, int type, std::size_t stride, std::size_t perPoint, const char* what)
        : data_(static_cast<const char*>(data)), isFloat_(type == PALPATE_FLOAT32),
          stride_(stride == 0 ? perPoint * (isFloat_ ? sizeof(float) : sizeof(double)) : stride)
    {
        demand(data_, what);
        if (type != PALPATE_FLOAT32 && type != PALPATE_FLOAT64)
            throw Error(std::string(what) + ": expected the type PALPATE_FLOAT64 or PALPATE_FLOAT32, found " +
                        std::to_string(type));
    }

    [[nodiscard]] double at(std::size_t point, std::size_t part = 0) const noexcept
    {
        const char* from = data_ + point * stride_;
        if (isFloat_) {
            float value = 0;
            std::memcpy(&value, from + part * sizeof value, sizeof value);
            return double(value);
        }
        double value = 0;
        std::memcpy(&value, from + part * sizeof value, sizeof value);
        return value;
    }

private:
    const char* data_;
    bool        isFloat_;
    std::size_t stride_; ///< [bytes]
};

/// Returns true if the points come with a stiffness, and not from a law of the scene.
bool haveStiffness(const palpate_points& points)
{
    return points.stiffness || points.uniform_stiffness != 0;
}

StiffnessKind kindOf(const palpate_points& points)
{
    switch (points.stiffness_kind) {
    case PALPATE_MODULUS:
        return StiffnessKind::modulus;
    case PALPATE_RIGIDITY:
        return StiffnessKind::rigidity;
    case PALPATE_FELT:
        return StiffnessKind::felt;
    default:
        throw Error("stiffness_kind: expected PALPATE_MODULUS, PALPATE_RIGIDITY or PALPATE_FELT, found " +
                    std::to_string(points.stiffness_kind));
    }
}

PointCloud cloudOf(const palpate_points& points)
{
    if (points.count == 0 || points.count > kMostInArray)
        throw Error("points: expected a count from 1 to " + std::to_string(kMostInArray) + ", found " +
                    std::to_string(points.count));
    const Numbers           at(points.positions, points.position_type, points.position_stride, 3, "positions");
    std::vector<glm::dvec3> positions(points.count);
    for (std::size_t n = 0; n < points.count; ++n) positions[n] = {at.at(n, 0), at.at(n, 1), at.at(n, 2)};
    std::vector<double> stiffness(points.count, haveStiffness(points) ? points.uniform_stiffness : 1.0);
    if (points.stiffness) {
        const Numbers values(points.stiffness, points.stiffness_type, points.stiffness_stride, 1, "stiffness");
        for (std::size_t n = 0; n < points.count; ++n) stiffness[n] = values.at(n);
    }
    return {std::move(positions), std::move(stiffness), kindOf(points)};
}

/// Returns what a caller says of each point; empty for null.
/// \throws Error naming the first point whose value is out of bounds
std::vector<double> valuesOf(const palpate_points& points, const void* data, int type, std::size_t stride, double least,
                             double most, const char* what, const char* unit)
{
    if (!data) return {};
    const Numbers       at(data, type, stride, 1, what);
    std::vector<double> values(points.count);
    for (std::size_t n = 0; n < points.count; ++n) {
        values[n] = at.at(n);
        if (values[n] >= least && values[n] <= most) continue;
        std::ostringstream sentence;
        sentence << what << ": expected " << least << " to " << most << " " << unit << ", found " << values[n]
                 << " at point " << n;
        throw Error(sentence.str());
    }
    return values;
}

std::vector<glm::vec3> normalsOf(const palpate_points& points)
{
    if (!points.normals) return {};
    const Numbers          at(points.normals, points.normal_type, points.normal_stride, 3, "normals");
    std::vector<glm::vec3> normals(points.count);
    for (std::size_t n = 0; n < points.count; ++n) {
        const glm::dvec3 normal{at.at(n, 0), at.at(n, 1), at.at(n, 2)};
        if (!isFinite(normal))
            throw Error("normals: point " + std::to_string(n) + ": expected finite numbers, found " + shown(normal));
        const double length = glm::length(normal);
        if (length > 0 && std::isfinite(length)) normals[n] = glm::vec3(normal / length);
    }
    return normals;
}

std::vector<Triangle> facesOf(const palpate_points& points)
{
    std::vector<Triangle> faces;
    if (points.face_count == 0) return faces;
    if (points.face_count > kMostInArray)
        throw Error("faces: expected a count of at most " + std::to_string(kMostInArray) + ", found " +
                    std::to_string(points.face_count));
    const std::uint32_t* const corners = &demand(points.faces, "faces");
    faces.resize(points.face_count);
    for (std::size_t n = 0; n < points.face_count; ++n)
        for (std::size_t k = 0; k < 3; ++k) {
            faces[n][k] = corners[3 * n + k];
            if (faces[n][k] >= points.count)
                throw Error("faces: expected points below " + std::to_string(points.count) + ", found " +
                            std::to_string(faces[n][k]) + " in face " + std::to_string(n));
        }
    return faces;
}

/// Settles whether the stiffness is the caller's or the scene's.
/// \throws Error if it is both, or none
void settleStiffness(const palpate_points& points, Scene& scene)
{
    const auto said       = scene.origins.find("stiffness");
    const bool ofMaterial = said != scene.origins.end() && said->second.where.find(": material ") != std::string::npos;
    if (haveStiffness(points)) {
        if (!scene.stiffness.empty() && !ofMaterial)
            throw Error(openingOf(scene, "stiffness") +
                        ": expected points without stiffness, found some; omit one of the two");
        scene.stiffness.clear();
    } else if (scene.stiffness.empty()) {
        throw Error("stiffness: expected an array, a uniform_stiffness other than 0, or the scene's key stiffness or "
                    "material, found none of them");
    } else if (points.stiffness_kind != PALPATE_MODULUS) {
        throw Error("stiffness_kind: expected PALPATE_MODULUS, because the scene states a modulus, found " +
                    std::to_string(points.stiffness_kind));
    }
}

palpate_object objectOf(const palpate_points& points, Scene scene)
{
    settleStiffness(points, scene);
    LoadedCloud given{.cloud = cloudOf(points), .report = {}, .faces = facesOf(points), .normals = normalsOf(points)};
    given.stiffening  = valuesOf(points, points.stiffening, points.stiffening_type, points.stiffening_stride, 0,
                                 kMostStiffening, "stiffening", "1/m");
    given.foundation  = valuesOf(points, points.foundation, points.foundation_type, points.foundation_stride,
                                 kLeastFoundation, kMostFoundation, "foundation", "Pa/m");
    auto       own    = std::make_shared<const LoadedCloud>(asTouched(std::move(given), scene));
    SoftObject object = palp::objectOf(*own, scene).object;
    object.survey().expectSurface();
    return {std::move(scene), std::move(object), std::move(own)};
}

palpate_object objectOf(Scene scene)
{
    SoftObject object = loadObject(scene).object;
    return {std::move(scene), std::move(object), nullptr};
}

} // namespace
} // namespace palp::capi

using namespace palp;
using namespace palp::capi;

int palpate_object_from_points(const palpate_points* points, const char* scene, palpate_object** out)
{
    return guarded([&] {
        demand(out, "out")         = nullptr;
        const palpate_points given = taken(points, "palpate_points");
        Scene                whole = parseScene(scene ? scene : "{}", "scene", ".", {.withoutCloud = true});
        *out                       = new palpate_object(capi::objectOf(given, std::move(whole)));
    });
}

int palpate_object_from_scene(const char* scene, const char* folder, palpate_object** out)
{
    return guarded([&] {
        demand(out, "out") = nullptr;
        *out = new palpate_object(capi::objectOf(parseScene(&demand(scene, "scene"), "scene", folder ? folder : ".")));
    });
}

int palpate_object_from_file(const char* path, palpate_object** out)
{
    return guarded([&] {
        demand(out, "out") = nullptr;
        *out               = new palpate_object(capi::objectOf(readScene(&demand(path, "path"))));
    });
}

void palpate_object_destroy(palpate_object* object)
{
    delete object;
}

size_t palpate_object_size(const palpate_object* object)
{
    return object ? object->object.size() : 0;
}

int palpate_object_positions(const palpate_object* object, double* xyz, size_t count)
{
    return guarded([&] {
        const SoftObject& of = demand(object, "object").object;
        demandRoom(count, of.size());
        demand(xyz, "xyz");
        for (std::size_t n = 0; n < of.size(); ++n) put(of.positions()[n], xyz + 3 * n);
    });
}

int palpate_object_stiffness(const palpate_object* object, double* values, size_t count)
{
    return guarded([&] {
        const auto of = demand(object, "object").object.cloud().stiffness();
        demandRoom(count, of.size());
        std::ranges::copy(of, &demand(values, "values"));
    });
}

int palpate_object_scene(const palpate_object* object, char* text, size_t size, size_t* needed)
{
    return guarded([&] {
        const std::string json = sceneJson(demand(object, "object").scene);
        if (needed) *needed = json.size() + 1;
        if (text || !needed) giveText(json, text, size);
    });
}
