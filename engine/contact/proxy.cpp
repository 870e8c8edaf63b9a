#include "engine/contact/proxy.h"

#include <cmath>
#include <string>

#include "engine/contact/detail/proxy_form.h"
#include "engine/core/contract.h"

namespace palp {

Proxy::Proxy(const SoftObject& object, const ProxySettings& settings)
{
    for (const double friction : {settings.staticFriction, settings.dynamicFriction})
        PALP_EXPECT(std::isfinite(friction) && friction >= 0, "friction is " + std::to_string(friction));
    PALP_EXPECT(settings.dynamicFriction <= settings.staticFriction,
                "dynamic friction " + std::to_string(settings.dynamicFriction) + " exceeds static friction " +
                    std::to_string(settings.staticFriction));
    impl_ = settings.form == ProxyForm::hybrid ? hybridProxy(object, settings) : sphereProxy(object, settings);
}

Proxy::~Proxy()                           = default;
Proxy::Proxy(Proxy&&) noexcept            = default;
Proxy& Proxy::operator=(Proxy&&) noexcept = default;

const ProxyState& Proxy::step(const glm::dvec3& hip) noexcept
{
    if (!(std::isfinite(hip.x) && std::isfinite(hip.y) && std::isfinite(hip.z))) return impl_->state;
    if (!impl_->placed) reset(hip);
    impl_->step(hip);
    return impl_->state;
}

void Proxy::reset(const glm::dvec3& hip) noexcept
{
    impl_->reset(hip);
    impl_->placed = true;
}

const ProxyState& Proxy::state() const noexcept
{
    return impl_->state;
}

} // namespace palp
