// The paper's proxy: a sphere that the points inside push out, each by its radial overshoot r - d along its radius.
// It is kept as published, and in a regulated form, to measure the hybrid against.

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "engine/contact/detail/friction.h"
#include "engine/contact/detail/near_points.h"
#include "engine/contact/detail/proxy_form.h"

namespace palp {
namespace {

constexpr double kRadius     = 3;    // [spacings] above 1.9, the radius of holes in random clouds: it must not sink in
constexpr int    kSteps      = 100;  // per tick
constexpr double kSubStep    = 0.25; // [radius] no step is longer
constexpr double kApproach   = 0.05; // [radius] step of the regulated form while it is alone
constexpr double kOverlap    = 0.1;  // [radius] largest overshoot that the regulated form keeps
constexpr double kSlideGain  = 0.1;  // [1]
constexpr double kTolerance  = 1e-5; // [spacings]
constexpr double kTinyNormal = 1e-9; // [radius] mean overshoot of a sphere that is buried evenly: keep the last normal

class SphereProxy final : public Proxy::Impl {
public:
    SphereProxy(const SoftObject& object, const ProxySettings& settings)
        : points_(ContactPoints(object)), friction_(settings.staticFriction, settings.dynamicFriction),
          regulated_(settings.form == ProxyForm::sphere)
    {
    }

    void step(const glm::dvec3& hip) noexcept override;
    void reset(const glm::dvec3& hip) noexcept override;

private:
    /// The overshoots of the points inside the sphere, together.
    struct Overshoot {
        int        count = 0;
        glm::dvec3 mean{};      ///< [m]
        double     largest = 0; ///< [m]
        double     spacing = 0; ///< [m] mean of the points'
    };

    [[nodiscard]] Overshoot overshoot();
    bool                    slide(const glm::dvec3& hip, const Overshoot& over) noexcept;

    NearPoints points_;
    Friction   friction_;
    bool       regulated_;
};

void SphereProxy::reset(const glm::dvec3& hip) noexcept
{
    state              = {};
    state.position     = hip;
    state.spacing      = points_.usualSpacing();
    friction_.slipping = false;
}

SphereProxy::Overshoot SphereProxy::overshoot()
{
    Overshoot    over;
    const double radius = kRadius * state.spacing;
    points_.inside(state.position, radius, state.spacing, [&](const NearPoint& point, double d2) {
        const double distance = std::sqrt(d2);
        ++over.count;
        over.spacing += point.spacing;
        over.largest = std::max(over.largest, radius - distance);
        if (distance > 0) over.mean += (radius / distance - 1) * (state.position - point.position);
    });
    if (over.count > 0) {
        over.mean /= over.count;
        over.spacing /= over.count;
    }
    return over;
}

/// Takes one step on the surface.
/// \return  true if nothing moved any more
bool SphereProxy::slide(const glm::dvec3& hip, const Overshoot& over) noexcept
{
    const double     radius = kRadius * state.spacing;
    const glm::dvec3 pull   = hip - state.position;
    const double     inward = glm::dot(pull, state.normal);
    const glm::dvec3 way    = friction_.shortened(pull - inward * state.normal, std::abs(inward));
    const double     push   = regulated_ ? 0.3 * (over.largest - kOverlap * radius) : 0.5 * glm::length(over.mean);
    const glm::dvec3 out    = capped(push * state.normal, kSubStep * radius);
    const glm::dvec3 along  = capped(kSlideGain * way, kSubStep * radius);
    state.position += out + along;
    return std::max(glm::length(out), glm::length(along)) < kTolerance * state.spacing;
}

void SphereProxy::step(const glm::dvec3& hip) noexcept
{
    bool decided   = false;
    state.limited  = true;
    state.touching = false;
    for (int k = 0; k < kSteps && state.limited; ++k) {
        const Overshoot over   = overshoot();
        const double    radius = kRadius * state.spacing;
        if (const double length = glm::length(over.mean); length > kTinyNormal * radius)
            state.normal = over.mean / length;
        state.touching = over.count > 0 && glm::dot(state.normal, hip - state.position) < 0;
        if (over.count > 0) state.spacing += 0.5 * (over.spacing - state.spacing);
        if (state.touching) {
            const glm::dvec3 pull   = hip - state.position;
            const double     inward = glm::dot(pull, state.normal);
            if (!decided) friction_.decide(pull - inward * state.normal, std::abs(inward));
            decided       = true;
            state.limited = !slide(hip, over);
        } else {
            const double longest = regulated_ && over.count == 0 ? kApproach : kSubStep;
            state.limited        = state.position != hip;
            state.position += capped(hip - state.position, longest * radius);
            if (glm::length(hip - state.position) < kTolerance * state.spacing) state.position = hip;
        }
    }
    if (!state.touching) friction_.slipping = false;
    state.slipping = friction_.slipping;
    state.fade     = state.touching ? 1 : 0;
    state.support  = state.fade;
    state.pull     = state.touching ? state.position - hip : glm::dvec3(0); // in free space it may lag behind the hand
}

} // namespace

std::unique_ptr<Proxy::Impl> sphereProxy(const SoftObject& object, const ProxySettings& settings)
{
    return std::make_unique<SphereProxy>(object, settings);
}

} // namespace palp
