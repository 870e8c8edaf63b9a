#include "engine/tools/gui/stage.h"

#include <algorithm>
#include <utility>

#include <glm/geometric.hpp>

#include "engine/core/contract.h"

namespace palp {

HandPlace startPlace(const Scene& scene, const SoftObject& object)
{
    try {
        return handPlace(scene, object);
    } catch (const Error&) {
        const auto highest = std::ranges::max_element(object.positions(), {}, [](const glm::dvec3& p) { return p.z; });
        return {*highest, {0, 0, 1}};
    }
}

Stage::Stage(const Scene& scene)
    : scene_(scene), loaded_(loadObject(scene)), view_(loaded_.object, scene.patch), painting_(loaded_.object),
      place_(startPlace(scene, loaded_.object)), painted_(std::make_shared<const SoftObject>(loaded_.object)),
      solved_(painted_), deformation_(std::make_unique<Deformation>(*solved_, scene_)),
      solvedOn_(deformation_->plateSolver().name())
{
}

void Stage::change(const Scene& scene)
{
    auto object  = std::make_shared<const SoftObject>(painted_->withMaterial(scene.material));
    auto made    = std::make_unique<Deformation>(*object, scene);
    deformation_ = std::move(made);
    painted_     = std::move(object);
    solved_      = painted_;
    fresh_.take(); // the waiting paint is older
    lawIsOld_ = false;
    scene_    = scene;
    place_    = startPlace(scene, loaded_.object);
    solvedOn_ = deformation_->plateSolver().name();
    view_.use(scene.patch);
}

std::optional<Hit> Stage::hitAt(const Camera& camera, const glm::dvec2& at, const glm::dvec2& size) const
{
    const double blur = std::max(0.5 * scene_.patch.footprintRadius, 1e-9); // [m]
    return pick(rayThrough(camera, at, size), painted_->positions(), view_.restNormals(), view_.radii(), blur);
}

void Stage::takePaint()
{
    const auto now = painting_.stiffness();
    painted_       = std::make_shared<const SoftObject>(painted_->repainted({now.begin(), now.end()}));
    view_.repaint(painting_.stiffness());
    fresh_.draft() = painted_;
    fresh_.publish();
}

/// Has the deformation use the newest paint.
void Stage::solveFresh()
{
    if (!fresh_.take()) return;
    const auto before = std::exchange(solved_, *fresh_.held()); // repaint() looks at it once more
    deformation_->repaint(*solved_);
    lawIsOld_ = true;
}

const HomogeneousLaw* Stage::firstLaw()
{
    solveFresh();
    if (std::exchange(lawIsOld_, false)) deformation_->renewFirstLaw();
    return deformation_->firstLaw();
}

PatchSolver Stage::solver()
{
    return [this](const Touch& touch, double lead) {
        solveFresh();
        return deformation_->solve(touch, lead);
    };
}

} // namespace palp
