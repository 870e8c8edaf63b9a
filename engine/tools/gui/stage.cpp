#include "engine/tools/gui/stage.h"

#include <algorithm>
#include <utility>

#include <glm/geometric.hpp>

#include "engine/core/contract.h"

namespace palp {

HandPlace startPlace(const Scene& scene, const PointCloud& cloud, const NeighbourIndex& index)
{
    try {
        return handPlace(scene, cloud, index);
    } catch (const Error&) {
        const auto highest = std::ranges::max_element(cloud.positions(), {}, [](const glm::dvec3& p) { return p.z; });
        return {*highest, {0, 0, 1}};
    }
}

Stage::Stage(const Scene& scene)
    : scene_(scene), loaded_(loadCloud(scene)), index_(loaded_.cloud.positions()),
      view_(loaded_.cloud, index_, scene.patch, loaded_.faces), painting_(loaded_.cloud, index_),
      place_(startPlace(scene, loaded_.cloud, index_)), painted_(std::make_shared<const PointCloud>(loaded_.cloud)),
      solved_(painted_), deformation_(std::make_unique<Deformation>(*solved_, index_, scene_)),
      solvedOn_(deformation_->device().name())
{
}

void Stage::change(const Scene& scene)
{
    auto made    = std::make_unique<Deformation>(*painted_, index_, scene);
    deformation_ = std::move(made);
    solved_      = painted_;
    fresh_.take(); // older than that
    scene_    = scene;
    place_    = startPlace(scene, loaded_.cloud, index_);
    solvedOn_ = deformation_->device().name();
    view_.use(scene.patch);
}

void Stage::takePaint()
{
    painted_ = std::make_shared<const PointCloud>(painting_.cloud());
    view_.repaint(painting_.stiffness());
    fresh_.draft() = painted_;
    fresh_.publish();
}

PatchSolver Stage::solver()
{
    return [this](const Touch& touch, double period) {
        if (fresh_.take()) {
            const auto before = std::exchange(solved_, *fresh_.held()); // repaint() looks at it once more
            deformation_->repaint(*solved_);
        }
        return deformation_->solve(touch, period);
    };
}

} // namespace palp
