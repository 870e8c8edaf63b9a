#include "engine/cloud/soft_object.h"

#include <utility>

#include <glm/geometric.hpp>

#include "engine/cloud/coarse_object.h"

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
      material_(material)
{
}

SoftObject SoftObject::repainted(std::vector<double> stiffness) const
{
    SoftObject painted = *this;
    painted.cloud_     = PointCloud(cloud_, std::move(stiffness));
    painted.coarse_    = coarseShape();
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
    other.coarse_    = coarseShape();
    return other;
}

std::shared_ptr<const CoarseObject> SoftObject::coarse(double side) const
{
    const std::lock_guard lock(coarse_->mutex);
    auto&                 known = coarse_->object;
    if (!known || known->side() != side)
        known = std::make_shared<const CoarseObject>(*this, side);
    else if (!coarse_->own)
        known = std::make_shared<const CoarseObject>(*known, *this);
    coarse_->own = true;
    return known;
}

/// Returns the coarse object, if there is one, for others of the same points.
std::shared_ptr<SoftObject::Coarse> SoftObject::coarseShape() const
{
    auto                  shape = std::make_shared<Coarse>();
    const std::lock_guard lock(coarse_->mutex);
    shape->object = coarse_->object;
    shape->own    = false;
    return shape;
}

} // namespace palp
