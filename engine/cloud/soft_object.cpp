#include "engine/cloud/soft_object.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <glm/geometric.hpp>

#include "engine/cloud/body_note.h"
#include "engine/cloud/coarse_object.h"
#include "engine/cloud/curvature_notes.h"
#include "engine/cloud/surface_links.h"
#include "engine/core/contract.h"

namespace palp {

namespace {

/// Returns the normals of the faces about each point, by area; 0 for points that lie in none or whose faces disagree.
std::vector<glm::vec3> normalsOf(std::span<const Triangle> faces, std::span<const glm::dvec3> positions)
{
    constexpr double        kAgreeing = 0.3; // [1] length of the sum over the sum of lengths: a sharp cone has more
    std::vector<glm::dvec3> sums(faces.empty() ? 0 : positions.size());
    std::vector<double>     lengths(sums.size());
    for (const Triangle& face : faces) {
        const glm::dvec3 a = positions[face[0]], b = positions[face[1]], c = positions[face[2]];
        const glm::dvec3 normal = glm::cross(b - a, c - a);
        for (const std::uint32_t corner : face) {
            sums[corner] += normal;
            lengths[corner] += glm::length(normal);
        }
    }
    std::vector<glm::vec3> normals(sums.size());
    for (std::size_t i = 0; i < sums.size(); ++i)
        if (const double length = glm::length(sums[i]); length > kAgreeing * lengths[i])
            normals[i] = glm::vec3(sums[i] / length);
    return normals;
}

} // namespace

SoftObject::SoftObject(PointCloud cloud, const Material& material, std::vector<Triangle> faces,
                       std::span<const glm::vec3> normals)
    : cloud_(std::move(cloud)), index_(std::make_shared<const NeighbourIndex>(cloud_.positions())),
      faces_(std::make_shared<const std::vector<Triangle>>(std::move(faces))),
      mesh_(std::make_shared<const SurfaceMesh>()),
      survey_(std::make_shared<const SurfaceSurvey>(
          *index_, normals.empty() ? std::span<const glm::vec3>(normalsOf(*faces_, cloud_.positions())) : normals)),
      links_(std::make_shared<SurfaceLinks>(index_, survey_)), curvatureNotes_(std::make_shared<CurvatureNotes>()),
      bodyNote_(std::make_shared<BodyNote>()), foundationShape_(std::make_shared<const std::vector<double>>()),
      stiffening_(std::make_shared<const std::vector<double>>()), held_(std::make_shared<const std::vector<double>>()),
      material_(material)
{
    extent_ = extentOf(cloud_.positions(), survey_->spacings());
}

SoftObject SoftObject::repainted(std::vector<double> stiffness) const
{
    SoftObject painted = *this;
    painted.cloud_     = PointCloud(cloud_, std::move(stiffness));
    painted.coarse_    = coarseShapes();
    painted.bodyNote_  = std::make_shared<BodyNote>();
    return painted;
}

SoftObject SoftObject::standingFor(SurfaceMesh mesh) const
{
    SoftObject other = *this;
    other.mesh_      = std::make_shared<const SurfaceMesh>(std::move(mesh));
    return other;
}

SoftObject SoftObject::withMaterial(const Material& material) const
{
    SoftObject other = *this;
    other.material_  = material;
    other.coarse_    = coarseShapes();
    other.bodyNote_  = std::make_shared<BodyNote>();
    if (material.thickness != material_.thickness) // the sheet's faces are told apart by it
        other.curvatureNotes_ = std::make_shared<CurvatureNotes>();
    return other;
}

SoftObject SoftObject::withFoundation(std::vector<double> shape) const
{
    const auto isGood = [](double s) { return std::isfinite(s) && s > 0; };
    PALP_EXPECT((shape.empty() || shape.size() == size()) && std::ranges::all_of(shape, isGood),
                "one positive number for each point");
    SoftObject other       = *this;
    other.foundationShape_ = std::make_shared<const std::vector<double>>(std::move(shape));
    other.coarse_          = coarseShapes();
    return other;
}

SoftObject SoftObject::withStiffening(std::vector<double> b) const
{
    const auto isGood = [](double value) { return value >= 0 && value <= kMostStiffening; };
    PALP_EXPECT((b.empty() || b.size() == size()) && std::ranges::all_of(b, isGood), "a stiffening for each point");
    SoftObject other  = *this;
    other.stiffening_ = std::make_shared<const std::vector<double>>(std::move(b));
    other.coarse_     = coarseShapes();
    return other;
}

SoftObject SoftObject::withHeld(std::vector<double> share) const
{
    const auto isGood = [](double value) { return value >= 0 && value <= 1; };
    PALP_EXPECT((share.empty() || share.size() == size()) && std::ranges::all_of(share, isGood),
                "a share from 0 to 1 for each point");
    SoftObject other = *this;
    other.held_      = std::make_shared<const std::vector<double>>(std::move(share));
    other.coarse_    = coarseShapes();
    other.bodyNote_  = std::make_shared<BodyNote>();
    return other;
}

std::shared_ptr<const CoarseObject> SoftObject::coarse(double side) const
{
    constexpr std::size_t kMost = 4; // sides: scenes ask for one or two
    const std::lock_guard lock(coarse_->mutex);
    auto&                 made  = coarse_->made;
    const auto            known = std::ranges::find_if(made, [&](const Coarse& c) { return c.object->side() == side; });
    if (known != made.end()) {
        if (!known->own) *known = {std::make_shared<const CoarseObject>(*known->object, *this)};
        return known->object;
    }
    if (made.size() == kMost) made.erase(made.begin());
    made.push_back({std::make_shared<const CoarseObject>(*this, side)});
    return made.back().object;
}

/// Returns the coarse objects that there are for others of the same points.
std::shared_ptr<SoftObject::CoarseObjects> SoftObject::coarseShapes() const
{
    auto                  shapes = std::make_shared<CoarseObjects>();
    const std::lock_guard lock(coarse_->mutex);
    for (const Coarse& c : coarse_->made) shapes->made.push_back({c.object, false});
    return shapes;
}

} // namespace palp
