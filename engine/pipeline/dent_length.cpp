#include "engine/pipeline/dent_length.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <glm/mat3x3.hpp>

#include "engine/chart/curvature_field.h"
#include "engine/core/contract.h"
#include "engine/pipeline/detail/touched_surface.h"

namespace palp {
namespace {

constexpr std::size_t kPlaces = 48;

/// Returns the Gaussian curvature of the surface around a point [1/m^2]; empty where the points determine none.
std::optional<double> gaussianCurvature(const SoftObject& object, std::uint32_t point)
{
    constexpr double kSpacings = 6, kShare = 1.0 / 16; // radius of the fit: at least; of the diagonal [1]
    const double     radius = std::max(kSpacings * object.spacing(), kShare * object.cloud().bounds().diagonal());
    const glm::dvec3 place  = object.positions()[point];
    try {
        const Ball              ball    = ballOf(object, place, radius);
        const TouchedSurface    surface = touchedSurface(object, {place, object.survey().normal(point), false}, ball);
        std::vector<glm::dvec3> around, normals;
        for (std::size_t k = 0; k < surface.size(); ++k) {
            around.push_back(surface.place(k));
            normals.push_back(surface.normalAt(k));
        }
        const auto found = fitCurvature({around, normals}, surface.anchor, radius);
        if (!found) return {};
        const glm::dmat3& t       = found->tensor;
        const double      trace   = t[0][0] + t[1][1] + t[2][2];
        double            squares = 0; // of all its numbers: the sum of the squared principal curvatures
        for (int i = 0; i < 3; ++i) squares += glm::dot(t[i], t[i]);
        return (trace * trace - squares) / 2;
    } catch (const Error&) { // a place without a surface
        return {};
    }
}

} // namespace

std::optional<DentLengths> dentLengths(const SoftObject& object, const PatchSettings& settings)
{
    const Material&     material = object.material();
    const double        nu = material.poissonRatio, h = material.thickness;
    const bool          isShell = settings.theory == Theory::shell;
    std::vector<double> found; // [m]
    std::size_t         places = 0;
    for (std::size_t k = 0; k < std::min(kPlaces, object.size()); ++k) {
        const auto point     = std::uint32_t((2 * k + 1) * object.size() / (2 * std::min(kPlaces, object.size())));
        const auto curvature = isShell ? gaussianCurvature(object, point) : std::optional(0.0);
        if (!curvature) continue;
        ++places;
        const double ends = 12 * (1 - nu * nu) * std::max(*curvature, 0.0) / (h * h) +
                            settings.foundation / object.rigidity(point); // [1/m^4]
        const double length = std::pow(ends, -0.25);
        if (length < object.cloud().bounds().diagonal()) found.push_back(length);
    }
    if (found.empty() || 2 * found.size() < places) return {};
    std::ranges::sort(found);
    return DentLengths{found.front(), found[found.size() / 2], found.back()};
}

} // namespace palp
