#include "engine/pipeline/dent_length.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
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
        // What is curved one way ends nothing, whichever side of it the fits' noise says that it bends to the other way.
        const bool   bulges = bend.gaussian > kOneWay * bend.largest * bend.largest;
        const double ends   = 12 * (1 - nu * nu) * (bulges ? bend.gaussian : 0) / (h * h) +
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

/// Returns the width of a square as large as the disc about a place of which the object's surface fills four fifths [m].
///
/// Of a sample of points each stands for the area around it, and areas are compared with those near the place, so that it
/// does not matter whether one face of the object was given or two.
/// \param sample  even over the object
double filledWidth(const SoftObject& object, const std::vector<std::uint32_t>& sample, const glm::dvec3& place)
{
    constexpr double      kFilled = 0.8; // [1]
    constexpr std::size_t kNear   = 64;  // points: the density near the place is then known to an eighth
    struct Near {
        double square, area; ///< of the distance, and around the point [m^2]
    };
    std::vector<Near> near;
    for (const std::uint32_t point : sample) {
        const glm::dvec3 d       = object.positions()[point] - place;
        const double     spacing = object.survey().spacing(point);
        near.push_back({glm::dot(d, d), spacing * spacing});
    }
    std::ranges::sort(near, {}, &Near::square);
    double area = 0, density = 0, reach = 0; // [m^2]; [1]; [m^2]
    for (std::size_t k = 0; k < near.size(); ++k) {
        area += near[k].area;
        if (k + 1 == std::min(kNear, near.size())) density = area / near[k].square;
        if (k + 1 >= kNear && area >= kFilled * density * near[k].square) reach = near[k].square;
    }
    return std::sqrt(std::numbers::pi * (reach > 0 ? reach : near.back().square));
}

/// Returns the width up to which windows about the places in the object's middle are filled [m]: beside a border none is.
double widthOfObject(const SoftObject& object)
{
    constexpr std::size_t      kSample = 1500, kEnough = 32; // points, places
    constexpr double           kMiddle = 0.9;                // of the places less is filled at so many [1]
    std::vector<std::uint32_t> sample(std::min(kSample, object.size()));
    for (std::size_t k = 0; k < sample.size(); ++k)
        sample[k] = std::uint32_t((2 * k + 1) * object.size() / (2 * sample.size()));
    std::vector<double> widths;
    for (std::size_t k = 0; k < std::min(kEnough, sample.size()); ++k)
        widths.push_back(filledWidth(object, sample, object.positions()[sample[k * sample.size() / kEnough]]));
    const auto middle = widths.begin() + std::ptrdiff_t(kMiddle * double(widths.size() - 1));
    std::ranges::nth_element(widths, middle);
    return *middle;
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
    if (const auto lengths = lengthsOf(object, settings, bends))
        return std::max(std::min(lengths->window(), widthOfObject(object)), least);
    return std::min(settings.window, std::max(shallowWindow(bends), least));
}

} // namespace palp
