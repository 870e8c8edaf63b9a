// The default proxy. One tick in contact:
//
//   fit the surfaces near the proxy -> find where it would rest on them, nearest to the HIP -> shorten the way by
//   friction -> take one step of it -> repeat until nothing moves.
//
// The step is a share b of the way, from the two last ways (Barzilai-Borwein): on ground that bends up, deeper than its
// radius, the whole way would overshoot further each time. A step that turned the way round was too long and is taken
// again, shorter. The distance to the HIP must not decide that: the ripple of fitted planes, 0.01 to 0.04 spacings,
// times the depth makes false minima of it.

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

#include "engine/contact/detail/free_travel.h"
#include "engine/contact/detail/friction.h"
#include "engine/contact/detail/near_points.h"
#include "engine/contact/detail/proxy_form.h"
#include "engine/contact/detail/surfaces.h"

namespace palp {
namespace {

// Lengths are in local spacings unless noted.
constexpr int    kIterations  = 24;   // per tick
constexpr double kTolerance   = 2e-5; // nothing moves by more: done
constexpr double kFadePerTick = 0.05; // [1] 20 ms from all of the force to none
constexpr double kLookAfter   = 0.25; // travel after which a new surface may have come into sight
constexpr double kLostHeight  = 1.5;  // one of several surfaces this far below is no longer felt
constexpr double kSlipOfDepth = 0.1;  // [1] way per tick beyond the hand's own, of the depth, ...
constexpr double kLeastSlip   = 0.05; // ... at least
constexpr double kMostSlip    = 0.5;  // ... and at most: bounds the force step when the proxy slides off something
constexpr double kSlipOfHand  = 2;    // [1] way per tick, of the way of the HIP
constexpr double kPullPerTick = 0.1;  // [1] change of the pull per tick beyond the way of the HIP, of the pull, ...
constexpr double kLeastPull   = 0.02; // ... at least
constexpr double kTurned      = 0.5;  // [1] share of the way turned round that makes a step too long
constexpr double kShorter     = 0.35; // [1] it is taken again with this share
constexpr double kLeastShare  = 0.05; // [1] bounds of b
constexpr double kMostShare   = 3;    // [1]

class HybridProxy final : public Proxy::Impl {
public:
    HybridProxy(const SoftObject& object, const ProxySettings& settings)
        : points_(ContactPoints(object)), tracker_(points_), travel_(points_, tracker_),
          friction_(settings.staticFriction, settings.dynamicFriction)
    {
    }

    void step(const glm::dvec3& hip) noexcept override;
    void reset(const glm::dvec3& hip) noexcept override;

private:
    /// The last step, for the next one of the same tick.
    struct Descent {
        glm::dvec3 fromPlace{}, fromWay{}, step{}; ///< [m] before the last step, and that step
        Surfaces   fromSurfaces{};
        bool       stepped   = false;
        double     budget    = 0;  ///< [m] that may still be slid in this tick
        double     sinceLook = -1; ///< [m] travelled since the last look for new surfaces; negative: look now
    };

    void                 travelFreely(const glm::dvec3& hip) noexcept;
    void                 followSurfaces(const glm::dvec3& hip) noexcept;
    bool                 iterate(const glm::dvec3& hip, Descent& descent, bool& decided) noexcept;
    double               updateSurfaces(const glm::dvec3& hip, Descent& descent) noexcept;
    bool                 takeStep(Descent& descent, const glm::dvec3& way, double corrected) noexcept;
    void                 fadeForce() noexcept;
    void                 updatePull(const glm::dvec3& hip) noexcept;
    void                 forgetSurfaces(const glm::dvec3& hip) noexcept;
    [[nodiscard]] double spacing() const noexcept { return surfaces_.spacing; }

    NearPoints     points_;
    SurfaceTracker tracker_;
    FreeTravel     travel_;
    Friction       friction_;
    Surfaces       surfaces_;
    RestPoint      rest_;
    glm::dvec3     lastHip_{}; ///< [m]
};

void HybridProxy::reset(const glm::dvec3& hip) noexcept
{
    state    = {};
    lastHip_ = hip;
    forgetSurfaces(hip);
}

void HybridProxy::forgetSurfaces(const glm::dvec3& hip) noexcept
{
    surfaces_          = {};
    rest_              = {};
    friction_.slipping = false;
    state.position     = hip;
    state.touching     = false;
    state.fade         = 0;
    state.support      = 0;
    state.spacing      = points_.usualSpacing();
}

void HybridProxy::step(const glm::dvec3& hip) noexcept
{
    state.limited = false;
    if (!state.touching) travelFreely(hip);
    if (state.touching) followSurfaces(hip);
    if (state.touching) fadeForce();
    if (state.touching && state.fade <= 0) forgetSurfaces(hip);
    state.slipping = friction_.slipping;
    updatePull(hip);
    lastHip_ = hip;
}

/// Moves on to the HIP, or to the first surface on the way.
void HybridProxy::travelFreely(const glm::dvec3& hip) noexcept
{
    const Arrival end  = travel_.go(state.position, hip, surfaces_);
    state.position     = end.position;
    state.touching     = end.touched;
    state.limited      = !end.touched && !end.arrived;
    state.fade         = end.touched ? end.support : 0;
    state.support      = end.support;
    friction_.slipping = friction_.slipping && end.touched;
    if (surfaces_.spacing > 0) state.spacing = surfaces_.spacing;
}

void HybridProxy::followSurfaces(const glm::dvec3& hip) noexcept
{
    const double depth = glm::length(hip - state.position);
    Descent      descent;
    descent.budget = kSlipOfHand * glm::length(hip - lastHip_) +
                     std::clamp(kSlipOfDepth * depth, kLeastSlip * spacing(), kMostSlip * spacing());
    bool decided = false;
    for (int k = 0; k <= kIterations; ++k) {
        if (iterate(hip, descent, decided)) break;
        state.limited = state.touching && k == kIterations;
    }
    if (!state.touching) return;
    if (state.limited) rest_ = restPointOn(surfaces_.all(), hip);
    const auto most = std::max_element(rest_.load.begin(), rest_.load.end()) - rest_.load.begin();
    if (rest_.touching()) state.normal = surfaces_.planes[std::size_t(most)].normal;
    state.spacing = spacing();
}

/// Looks for surfaces if a look is due, and fits the known ones.
/// \return  [m] the furthest that a surface was moved
double HybridProxy::updateSurfaces(const glm::dvec3& hip, Descent& descent) noexcept
{
    if (descent.sinceLook < 0 || descent.sinceLook > kLookAfter * spacing()) {
        tracker_.discover(surfaces_, state.position, hip);
        descent.sinceLook = 0;
    }
    const double corrected = tracker_.refresh(surfaces_, state.position);
    for (int j = surfaces_.count - 1; j >= 0 && surfaces_.count > 1; --j) {
        const SurfacePlane& plane = surfaces_.planes[std::size_t(j)];
        if (plane.support == 0 || plane.height(state.position) > kLostHeight * spacing()) surfaces_.remove(j);
    }
    return corrected;
}

/// Runs one iteration of a tick.
/// \return  true if the tick is done
bool HybridProxy::iterate(const glm::dvec3& hip, Descent& descent, bool& decided) noexcept
{
    double corrected = updateSurfaces(hip, descent);
    rest_            = restPointOn(surfaces_.all(), hip);
    if (!rest_.touching()) {
        // The way starts here, never with a jump to the HIP: another wall may be between.
        travelFreely(hip);
        descent.stepped   = false;
        descent.sinceLook = -1;
        return !state.touching;
    }
    const glm::dvec3 onto =
        capped(ontoLoaded(surfaces_.all(), rest_, state.position) - state.position, kStepCap * spacing());
    state.position += onto;
    corrected = std::max(corrected, glm::length(onto));

    const glm::dvec3 pull  = hip - state.position;
    const glm::dvec3 full  = rest_.point - state.position;
    const double     depth = std::sqrt(std::max(0.0, glm::dot(pull, pull) - glm::dot(full, full)));
    if (!decided) friction_.decide(full, depth);
    decided = true;
    return takeStep(descent, friction_.shortened(full, depth), corrected);
}

/// Takes one step of the way, or the last one again, shorter.
/// \return  true if nothing moved any more
bool HybridProxy::takeStep(Descent& descent, const glm::dvec3& way, double corrected) noexcept
{
    if (descent.stepped && glm::dot(way, descent.step) < -kTurned * glm::dot(descent.fromWay, descent.step)) {
        state.position    = descent.fromPlace;
        surfaces_         = descent.fromSurfaces;
        const double back = (1 - kShorter) * glm::length(descent.step);
        descent.budget += back;
        descent.step *= kShorter;
        state.position += descent.step;
        return false;
    }
    double share = 1;
    if (descent.stepped)
        if (const double change = glm::dot(descent.step, descent.fromWay - way); change > 0)
            share = std::clamp(glm::dot(descent.step, descent.step) / change, kLeastShare, kMostShare);
    descent.fromPlace    = state.position;
    descent.fromSurfaces = surfaces_;
    descent.fromWay      = way;
    descent.step         = capped(share * way, std::min(kStepCap * spacing(), descent.budget));
    descent.stepped      = true;
    const double length  = glm::length(descent.step);
    descent.budget       = std::max(0.0, descent.budget - length);
    descent.sinceLook += length;
    state.position += descent.step;
    return std::max(length, corrected) < kTolerance * spacing();
}

/// Fades the force within a few ticks past a border, while the proxy slides on along the last plane.
void HybridProxy::fadeForce() noexcept
{
    double support = 0;
    for (int j = 0; j < surfaces_.count; ++j)
        if (rest_.load[std::size_t(j)] > 0) support = std::max(support, surfaces_.planes[std::size_t(j)].support);
    state.support = support;
    state.fade += std::clamp(support - state.fade, -kFadePerTick, kFadePerTick);
}

/// Updates the pull. Where the HIP presses, slides, curves or stops, the pull changes by no more than the HIP moves; a
/// larger change is a jump.
void HybridProxy::updatePull(const glm::dvec3& hip) noexcept
{
    const glm::dvec3 jump  = state.fade * (state.position - hip) - state.pull;
    const double     least = kLeastPull * state.spacing;
    state.pull += capped(jump, glm::length(hip - lastHip_) + std::max(kPullPerTick * glm::length(state.pull), least));
}

} // namespace

std::unique_ptr<Proxy::Impl> hybridProxy(const SoftObject& object, const ProxySettings& settings)
{
    return std::make_unique<HybridProxy>(object, settings);
}

} // namespace palp
