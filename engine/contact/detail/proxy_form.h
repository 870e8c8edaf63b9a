#pragma once
#include <memory>

#include <glm/vec3.hpp>

#include <glm/geometric.hpp>

#include "engine/contact/proxy.h"

namespace palp {

/// Returns the step, shortened to `longest` [m] if it is longer.
[[nodiscard]] inline glm::dvec3 capped(const glm::dvec3& step, double longest) noexcept
{
    const double length = glm::length(step);
    return length <= longest ? step : step * (longest / length);
}

/// One form of the proxy. Internal to the contact layer.
/// \thread one; step and reset allocate nothing
struct Proxy::Impl {
    virtual ~Impl()                                    = default;
    virtual void step(const glm::dvec3& hip) noexcept  = 0;
    virtual void reset(const glm::dvec3& hip) noexcept = 0;

    ProxyState state;
    bool       placed = false; ///< the first HIP is known
};

[[nodiscard]] std::unique_ptr<Proxy::Impl> hybridProxy(const SoftObject& object, const ProxySettings& settings);
[[nodiscard]] std::unique_ptr<Proxy::Impl> sphereProxy(const SoftObject& object, const ProxySettings& settings);

} // namespace palp
