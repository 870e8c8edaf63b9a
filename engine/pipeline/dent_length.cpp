#include "engine/pipeline/dent_length.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>

#include "engine/pipeline/detail/curvature_sites.h"

namespace palp {
namespace {

constexpr std::size_t kPlaces = 48;

/// How the surface bends about a place.
struct Bend {
    std::uint32_t point    = 0; ///< of the object
    double        gaussian = 0; ///< curvature [1/m^2]
    double        largest  = 0; ///< of the principal curvatures, by size [1/m]
};

/// Returns how a shell bends at places spread evenly over the object, where its points determine it; a plate does not.
std::vector<Bend> bendsOf(const SoftObject& object, const PatchSettings& settings)
{
    constexpr double  kSpacings = 6, kShare = 1.0 / 16; // radius of the fits: at least; of the diagonal [1]
    const double      radius = std::max(kSpacings * object.spacing(), kShare * object.cloud().bounds().diagonal());
    const std::size_t places = std::min(kPlaces, object.size());
    std::vector<Bend> bends;
    for (std::size_t k = 0; k < places; ++k) {
        const auto point = std::uint32_t((2 * k + 1) * object.size() / (2 * places));
        if (settings.theory != Theory::shell) {
            bends.push_back({point});
            continue;
        }
        const auto found = faceCurvature(object, object.positions()[point], object.survey().normal(point), radius);
        if (!found) continue;
        const glm::dmat3& t       = found->tensor;
        const double      trace   = t[0][0] + t[1][1] + t[2][2];
        double            squares = 0; // of all its numbers: the sum of the squared principal curvatures
        for (int i = 0; i < 3; ++i) squares += glm::dot(t[i], t[i]);
        const double apart = std::sqrt(std::max(0.0, 2 * squares - trace * trace));
        bends.push_back({point, (trace * trace - squares) / 2, (std::abs(trace) + apart) / 2});
    }
    return bends;
}

std::optional<DentLengths> lengthsOf(const SoftObject& object, const PatchSettings& settings,
                                     const std::vector<Bend>& bends)
{
    const Material&     material = object.material();
    const double        nu = material.poissonRatio, h = material.thickness;
    std::vector<double> found; // [m]
    for (const Bend& bend : bends) {
        const double ends = 12 * (1 - nu * nu) * std::max(bend.gaussian, 0.0) / (h * h) +
                            settings.foundation / object.rigidity(bend.point); // [1/m^4]
        const double length = std::pow(ends, -0.25);
        if (length < object.cloud().bounds().diagonal()) found.push_back(length);
    }
    if (found.empty() || 2 * found.size() < bends.size()) return {};
    std::ranges::sort(found);
    return DentLengths{found.front(), found[found.size() / 2], found.back()};
}

/// Returns the width of a window that sags no more than it may at nearly all places [m].
double shallowWindow(std::vector<Bend> bends)
{
    constexpr double kNearly = 0.95; // rims and tips bend as sharply as the fits can tell [1]
    if (bends.empty()) return std::numeric_limits<double>::infinity();
    const auto sharp = bends.begin() + std::ptrdiff_t(kNearly * double(bends.size() - 1));
    std::ranges::nth_element(bends, sharp, {}, &Bend::largest);
    return 8 * kMostSag / sharp->largest;
}

} // namespace

std::optional<DentLengths> dentLengths(const SoftObject& object, const PatchSettings& settings)
{
    return lengthsOf(object, settings, bendsOf(object, settings));
}

double dentWindow(const SoftObject& object, const PatchSettings& settings)
{
    const auto   bends = bendsOf(object, settings);
    const double least = 4 * settings.footprintRadius;
    // A dent that dies away hardly feels what is steep, see patch_warnings.cpp, and would feel edges that are nearer.
    if (const auto lengths = lengthsOf(object, settings, bends)) return std::max(lengths->window(), least);
    return std::min(settings.window, std::max(shallowWindow(bends), least));
}

} // namespace palp
