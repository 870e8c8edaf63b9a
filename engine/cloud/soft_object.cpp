#include "engine/cloud/soft_object.h"

#include <utility>

namespace palp {

SoftObject::SoftObject(PointCloud cloud, const Material& material, std::vector<Triangle> faces)
    : cloud_(std::move(cloud)), index_(std::make_shared<const NeighbourIndex>(cloud_.positions())),
      faces_(std::make_shared<const std::vector<Triangle>>(std::move(faces))), material_(material)
{
}

SoftObject SoftObject::repainted(std::vector<double> stiffness) const
{
    SoftObject painted = *this;
    painted.cloud_     = PointCloud(cloud_, std::move(stiffness));
    return painted;
}

SoftObject SoftObject::withMaterial(const Material& material) const
{
    SoftObject other = *this;
    other.material_  = material;
    return other;
}

} // namespace palp
