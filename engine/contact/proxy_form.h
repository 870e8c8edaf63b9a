#pragma once
#include <memory>
#include <span>

#include <glm/vec3.hpp>

#include "engine/cloud/neighbour_index.h"
#include "engine/contact/proxy.h"

namespace palp {

/// One form of the proxy. Internal to the contact layer.
/// \thread one; step and reset allocate nothing
struct Proxy::Impl {
    virtual ~Impl()                                    = default;
    virtual void step(const glm::dvec3& hip) noexcept  = 0;
    virtual void reset(const glm::dvec3& hip) noexcept = 0;

    ProxyState state;
    bool       placed = false; ///< the first HIP is known
};

[[nodiscard]] std::unique_ptr<Proxy::Impl> hybridProxy(std::span<const glm::dvec3> positions,
                                                       const NeighbourIndex& index, const ProxySettings& settings);
[[nodiscard]] std::unique_ptr<Proxy::Impl> sphereProxy(std::span<const glm::dvec3> positions,
                                                       const NeighbourIndex& index, const ProxySettings& settings);

} // namespace palp
