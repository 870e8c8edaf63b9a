#include "engine/pipeline/curvature_doubt.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <utility>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "engine/core/quantity.h"
#include "engine/pipeline/detail/curvature_sites.h"
#include "engine/pipeline/patch_warnings.h"

namespace palp {
namespace {

constexpr double kSpacings = 5; ///< of the points in the radius of a fit, at least: see curvatureField() [1]

std::string percent(double share)
{
    constexpr double kMost = 0.5; // beyond it the measured shares are less than fitBias() says [1]
    return std::to_string(std::lround(100 * std::min(share, kMost))) + " %" + (share > kMost ? " or more" : "");
}

/// Says what points that are too far apart do to a curvature.
std::string onSparse(double spacing, double larger, double bias)
{
    constexpr double kFelt = 1.3; // share felt too stiff over that read too strong, measured [1]
    const double     dense = spacing * std::sqrt(kMostFitBias / bias); // [m]
    return "the points are " + formatQuantity(spacing, "m") + " apart where the surface has a radius of " +
           formatQuantity(1 / std::abs(larger), "m") + ": its curvature is read some " + percent(bias) +
           " too strong, expected at most 5, and felt too stiff by up to " + percent(kFelt * bias) +
           "; take points at most " + formatQuantity(dense, "m") + " apart";
}

using Corner = std::uint32_t;

glm::dvec3 areaOf(const SurfaceMesh& mesh, const Triangle& face)
{
    const glm::dvec3 a = mesh.vertices[face[0]], b = mesh.vertices[face[1]], c = mesh.vertices[face[2]];
    return glm::cross(b - a, c - a) / 2.0;
}

/// Returns whether a triangle has a place within a distance of a point, or nearly.
bool comesNear(const SurfaceMesh& mesh, const Triangle& face, const glm::dvec3& place, double reach)
{
    glm::dvec3 low = mesh.vertices[face[0]], high = low;
    for (const Corner corner : face) {
        low  = glm::min(low, mesh.vertices[corner]);
        high = glm::max(high, mesh.vertices[corner]);
    }
    return glm::distance(glm::clamp(place, low, high), place) < reach;
}

/// Returns the larger curvature of the surface at a plate's contact [1/m]; 0 of a shell, or where it is not known.
double bendOfPlate(const SoftObject& object, const Patch& patch, const PatchSettings& settings)
{
    constexpr double kPart = 0.25; // of the window, as far as a dent's middle reaches [1]
    if (settings.theory != Theory::plate || settings.neighbourhood != Neighbourhood::surface || !patch.deformed())
        return 0;
    const double radius = std::max(kSpacings * patch.spacing,
                                   std::max(quietFitRadius(patch.noise, patch.spacing), kPart * bentSize(patch)));
    const auto   fit    = faceCurvature(object, patch.chart.origin, patch.chart.frame.normal, radius);
    return fit ? principalOf(*fit).first : 0;
}

} // namespace

double fitBias(double radius, double larger, double smaller) noexcept
{
    constexpr double kOneWayBias = 0.10, kBothBias = 0.06; // [1]
    return radius * radius * (kOneWayBias * larger * larger + kBothBias * std::max(0.0, larger * smaller));
}

double facetWidth(const SurfaceMesh& mesh, const glm::dvec3& place, double reach)
{
    constexpr double kLeast = 0.99985,
                     kMost  = 0.766; // cosines of 1 and 40 degrees: flat, and an edge that is meant [1]
    std::map<std::pair<Corner, Corner>, std::vector<const Triangle*>> edges;
    for (const Triangle& face : mesh.faces) {
        if (!comesNear(mesh, face, place, reach)) continue;
        for (std::size_t k = 0; k < 3; ++k) edges[std::minmax(face[k], face[(k + 1) % 3])].push_back(&face);
    }
    double sum = 0, all = 0; // [m^3]; [m^2]
    for (const auto& [edge, faces] : edges) {
        if (faces.size() != 2) continue;
        const std::array areas{areaOf(mesh, *faces[0]), areaOf(mesh, *faces[1])};
        const double     sizes = glm::length(areas[0]) * glm::length(areas[1]);
        if (!(sizes > 0)) continue;
        const double cosine = glm::dot(areas[0], areas[1]) / sizes;
        if (cosine > kLeast || cosine < kMost) continue;
        const double along = glm::distance(mesh.vertices[edge.first], mesh.vertices[edge.second]);
        for (const glm::dvec3& area : areas) {
            sum += glm::length(area) * 2 * glm::length(area) / along; // the triangle's height over that edge
            all += glm::length(area);
        }
    }
    return all > 0 ? sum / all : 0;
}

std::vector<std::string> curvatureDoubts(const SoftObject& object, const Patch& patch, const PatchSettings& settings)
{
    std::vector<std::string> said;
    if (const double bend = bendOfPlate(object, patch, settings); bend != 0) {
        const auto leftOut = [&](double k) { return membraneLeftOut(patch, settings, object.material(), k); };
        if (leftOut(bend) > kMembraneFelt && !(leftOut(patch.sphere.fit.curvature) > kMembraneFelt))
            said.push_back(bentFlat(bend));
    }
    if (!patch.curvature) return said;
    const auto [larger, smaller] = patch.principal;
    const double radius          = patch.curvature->radius;
    if (const double bias = fitBias(radius, larger, smaller); bias > kMostFitBias)
        said.push_back(onSparse(patch.spacing, larger, bias));
    if (object.mesh().faces.empty()) return said;
    constexpr double kBeside = 2; // radii: in the middle of a facet its neighbours are farther than one [1]
    if (const double facet = facetWidth(object.mesh(), patch.contact.point, kBeside * radius); facet > radius)
        said.push_back(
            "the facets of the mesh are " + formatQuantity(facet, "m") + " wide and its curvature is fitted within " +
            formatQuantity(radius, "m") +
            ": it is read from the facets, weaker on them and stronger at their edges, and not from the shape "
            "that they stand for; take a mesh with edges of at most " +
            formatQuantity(radius, "m"));
    return said;
}

std::string sparseForCurvature(const SoftObject& object)
{
    constexpr std::size_t kPlaces = 48;
    constexpr double      kShare  = 0.1; // of the places [1]
    struct Found {
        double bias, spacing, larger;
    };
    std::vector<Found> found;
    if (object.survey().spacings().empty()) return {}; // too few points for a surface
    const std::size_t places = std::min(kPlaces, object.size());
    for (std::size_t k = 0; k < places; ++k) {
        const auto   point   = std::uint32_t((2 * k + 1) * object.size() / (2 * places));
        const double spacing = object.survey().spacing(point), radius = kSpacings * spacing;
        if (object.survey().noise(point) > spacing)
            continue; // such fits reach farther, and these would see nothing else
        const auto fit = faceCurvature(object, object.positions()[point], object.survey().normal(point), radius);
        if (!fit) continue;
        const auto [larger, smaller] = principalOf(*fit);
        found.push_back({fitBias(radius, larger, smaller), spacing, larger});
    }
    if (found.empty()) return {};
    const auto tenth = found.begin() + std::ptrdiff_t(kShare * double(found.size()));
    std::ranges::nth_element(found, tenth, std::greater{}, &Found::bias);
    return tenth->bias > kMostFitBias ? onSparse(tenth->spacing, tenth->larger, tenth->bias) : "";
}

} // namespace palp
