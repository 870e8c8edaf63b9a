#include "engine/tools/fit/felt_fit.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

#include "engine/core/contract.h"
#include "engine/core/parallel.h"
#include "engine/perception/felt_map.h"

namespace palp::fit {
namespace {

double medianSize(std::vector<double> values)
{
    for (double& value : values) value = std::abs(value);
    const auto middle = values.begin() + std::ptrdiff_t(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

/// Returns the mean of the values about each point on its side of the object, weighted by a Gaussian.
std::vector<double> smoothed(const std::vector<double>& values, const SoftObject& object, double deviation)
{
    constexpr double      kReach  = 2.5; // [deviations] where the weight is 4 %
    constexpr std::size_t kFewest = 200; // points that are worth a thread
    std::vector<double>   result(values.size());
    inParallel(values.size(), kFewest, [&](std::size_t begin, std::size_t end) {
        std::vector<std::uint32_t> near;
        for (std::size_t n = begin; n < end; ++n) {
            const glm::dvec3& p = object.positions()[n];
            object.index().gather(p, kReach * deviation, near);
            double sum = 0, weights = 0;
            for (const std::uint32_t other : near) {
                if (object.survey().apart(n, other)) continue; // a touch feels one face of a thin body
                const glm::dvec3 away   = object.positions()[other] - p;
                const double     weight = std::exp(-glm::dot(away, away) / (2 * deviation * deviation));
                sum += weight * values[other];
                weights += weight;
            }
            result[n] = weights > 0 ? sum / weights : values[n];
        }
    });
    return result;
}

/// Returns what is felt at each point: what a touch told where one was, else between the touches.
std::vector<double> feltAt(FeltMap map)
{
    for (std::size_t n = 0; n < map.places.size(); ++n) map.atPoints[map.places[n]] = map.stiffness[n];
    return std::move(map.atPoints);
}

} // namespace

FeltFit fitFeltMap(const SoftObject& start, std::span<const double> measured, const FeltFitSettings& settings,
                   PlateSolver& solver)
{
    PALP_EXPECT(start.cloud().kind() == StiffnessKind::modulus, "the object has no modulus to begin with");
    PALP_EXPECT(measured.size() == start.size(),
                std::to_string(measured.size()) + " measured values for " + std::to_string(start.size()) + " points");
    constexpr double kExponent = 4.0 / 3;
    constexpr double kSettled  = 2e-3; // [1] median of the corrections that counts as none: a fiftieth of a map's noise
    constexpr double kGains    = 0.5;  // [1] a step that leaves more has met what is as fine as a touch: noise grows
    std::vector<double> modulus(start.cloud().stiffness().begin(), start.cloud().stiffness().end());
    FeltFit             fit{start, {}, {}};
    fit.reach = std::max(2 * settings.patch.footprintRadius, 1.2 * start.spacing());
    for (;; ++fit.steps) {
        const auto whole = std::size_t(settings.mostSteps + 1);
        if (settings.onStep) settings.onStep(std::size_t(fit.steps), whole);
        FeltMap map = feltMap(fit.object, settings.patch, settings.places, solver);
        fit.leftOut = map.leftOut;
        fit.felt    = feltAt(std::move(map));
        std::vector<double> wanting(modulus.size());
        for (std::size_t n = 0; n < wanting.size(); ++n) wanting[n] = std::log(measured[n] / fit.felt[n]);
        const std::vector<double> correction = smoothed(wanting, fit.object, fit.reach);
        const double              before     = fit.unsettled;
        fit.rest                             = medianSize(wanting);
        fit.unsettled                        = medianSize(correction);
        if (fit.unsettled < kSettled || fit.steps == settings.mostSteps) break;
        if (fit.steps > 0 && fit.unsettled > kGains * before) break;
        for (std::size_t n = 0; n < modulus.size(); ++n) modulus[n] *= std::exp(kExponent * correction[n]);
        fit.object = fit.object.repainted(modulus);
    }
    for (std::size_t n = 0; n < modulus.size(); ++n) fit.residual.push_back(fit.felt[n] / measured[n] - 1);
    return fit;
}

} // namespace palp::fit
