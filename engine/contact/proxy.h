#pragma once
#include <memory>

#include <glm/vec3.hpp>

#include "engine/cloud/soft_object.h"
#include "engine/core/enum_names.h"

namespace palp {

/// The methods by which the proxy finds the surface in the points.
enum class ProxyForm {
    hybrid,     ///< a ball finds planes, planes carry the contact
    sphere,     ///< the paper's radial overshoot, pushed out to a fixed small overlap
    plainSphere ///< the paper's radial overshoot as published: slower to slide, noisier
};
constexpr auto namesOf(ProxyForm)
{
    using enum ProxyForm;
    return std::to_array<NamedValue<ProxyForm>>(
        {{hybrid, "hybrid"}, {sphere, "sphere"}, {plainSphere, "plain-sphere"}});
}

struct ProxySettings {
    ProxyForm form            = ProxyForm::hybrid;
    double    staticFriction  = 0; ///< [1] tangential over normal force that still holds
    double    dynamicFriction = 0; ///< [1] the same while slipping, at most `staticFriction`
};

/// The state of the proxy after a tick.
struct ProxyState {
    glm::dvec3 position{};       ///< [m] on the surface in contact, at the HIP in free space
    glm::dvec3 normal{0, 0, 1};  ///< [1] unit, towards the hand, of the surface that carries most
    glm::dvec3 pull{};           ///< [m] what is felt, from the HIP: fade * (position - HIP), without jumps
    bool       touching = false; ///< the surface lies between the HIP and where it came from
    double     fade     = 0;     ///< [1] share of the force to be shown: falls to 0 in 20 ms past a border
    double     spacing  = 0;     ///< [m] of the points around here
    double     support  = 0;     ///< [1] 1: points all around; 0: past a border
    bool       slipping = false; ///< dynamic friction acts
    bool       limited  = false; ///< the tick ran out of iterations; the next goes on from here
};

/// The point of the surface nearest to the hand that the hand has not passed through.
///
/// In free space it is the HIP (haptic interface point, where the hand is). In contact it stays on the surface, with
/// the HIP behind it; the force law makes the force, k * pull. The cloud needs neither normals nor a mesh; the side of
/// a sheet is the one that the hand came from, so a session must start in free space.
///
/// Where the object is sharper than its points are close (at an edge, at a rim, or when a second wall comes into sight)
/// the position jumps, as it does on the ideal surface. The pull follows by at most a tenth of itself and the way of
/// the HIP per tick: after an abrupt end it dies away within 40 ms, in free space. The spheres' pull is not held back.
///
/// One tick is one millisecond: fade, slip and pull are bounded per call.
/// \thread one, the servo; step() allocates, locks and throws nothing, and the same input gives the same bits
/// \source Kumari & Chaudhuri, section 2.1, for the sphere; the hybrid is our own reconstruction
/// \differs the paper's "dynamic function", which keeps the proxy on the surface, is not published: the sphere's push
///          out to a tenth of its radius, as here, is a guess
class Proxy {
public:
    /// \param object  outlives the proxy
    /// \throws Error if most of the points coincide; ContractViolation if friction is negative or not finite
    Proxy(const SoftObject& object, const ProxySettings& settings);
    ~Proxy();
    Proxy(Proxy&&) noexcept;
    Proxy& operator=(Proxy&&) noexcept;

    /// Moves on by one tick. The first call only sets where the hand starts.
    /// \param hip  [m] where the hand is now; if it is not finite nothing moves
    const ProxyState& step(const glm::dvec3& hip) noexcept;

    /// Forgets every contact and puts the proxy at `hip` [m], which must be in free space.
    void reset(const glm::dvec3& hip) noexcept;

    [[nodiscard]] const ProxyState& state() const noexcept;

    struct Impl; ///< one form's arithmetic

private:
    std::unique_ptr<Impl> impl_;
};

} // namespace palp
