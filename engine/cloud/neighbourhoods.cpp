#include "engine/cloud/neighbourhoods.h"

namespace palp {

bool Neighbourhoods::search(const glm::dvec3& middle, double reach)
{
    constexpr std::size_t kMost = 16'384; // beside a step in density of eight spacings to one it finds some 9000
    return index_.gatherRanks(middle, reach * (1 + 1e-9), kMost, found_);
}

void Neighbourhoods::takeFound(const glm::dvec3& middle)
{
    for (std::vector<double>* v : {&x_, &y_, &z_, &distance2_}) v->resize(found_.size());
    for (std::size_t n = 0; n < found_.size(); ++n) {
        const glm::dvec3 d = positions_[found_[n]] - middle;
        x_[n]              = d.x;
        y_[n]              = d.y;
        z_[n]              = d.z;
    }
}

void Neighbourhoods::keepNear(const glm::dvec3& place, double radius)
{
    // Two loops: the compiler turns the first one into vector instructions.
    const std::size_t   count = found_.size();
    const double *const x = x_.data(), *const y = y_.data(), *const z = z_.data();
    double* const d2 = distance2_.data();
    for (std::size_t n = 0; n < count; ++n) {
        const double dx = x[n] - place.x, dy = y[n] - place.y, dz = z[n] - place.z;
        d2[n] = dx * dx + dy * dy + dz * dz;
    }
    // Every number is written, and counted if it is wanted: a branch that nobody can foresee would cost more.
    kept_.resize(count);
    std::size_t kept = 0;
    for (std::size_t n = 0; n < count; ++n) {
        kept_[kept] = std::uint32_t(n);
        kept += d2[n] <= radius * radius;
    }
    near_.resize(kept);
    for (std::size_t k = 0; k < kept; ++k) {
        const std::size_t n = kept_[k];
        near_[k]            = {found_[n], {x[n] - place.x, y[n] - place.y, z[n] - place.z}, d2[n]};
    }
}

} // namespace palp
