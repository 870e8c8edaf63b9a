#include "engine/pipeline/curvature_doubt.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <utility>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "engine/cloud/cloud_quality.h"
#include "engine/core/quantity.h"
#include "engine/pipeline/dent_length.h"
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

/// Says what a curvature that changes within its fits is read as.
std::string onChanging(double radius, double share)
{
    return "the curvature is fitted within " + formatQuantity(radius, "m") +
           ", and changes within that: where it is largest it is read some " + percent(share) +
           " too weak, expected at most 5, and felt too soft by up to as much; points that are denser, and without "
           "noise, are fitted over less";
}

/// Returns the width of an object's widest border, if it is open: at least half as wide as the object is long [m]; 0 if
/// not.
double openWidth(const SoftObject& object)
{
    constexpr double kOpen   = 0.5; // [1]
    const auto       borders = cloudQuality(object).borderWidths;
    if (borders.empty()) return 0;
    const glm::dvec3 size = object.cloud().bounds().high - object.cloud().bounds().low;
    return borders.front() >= kOpen * std::max({size.x, size.y, size.z}) ? borders.front() : 0;
}

/// Says that a window about the contact takes an open object for one that goes on. A hemisphere of R 40 mm that is held
/// at its bottom alone is 4 to 70 times softer than in such a window, and one that is held up to 46 degrees 1.6 to 9
/// times, 20 to 5 mm from its rim.
std::string openObject(double width)
{
    return "the object is open, with a border " + formatQuantity(width, "m") +
           " wide, and is taken to go on beyond the patch window: unless that border is held all around, it may "
           "be felt several times too stiff, and the support range does not tell; set window object and what holds it";
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

double changeBias(const Patch& patch)
{
    constexpr double      kPerChange = 0.115, kSome = 0.5; // [1]
    const CurvatureField& field = *patch.curvature;
    const PlateGrid&      grid  = patch.plate.grid;
    const auto [i, j]           = nodeAtContact(patch);
    const double x = field.x(i, j), z = field.z(i, j), xz = field.xz(i, j);
    const double sign  = x + z < 0 ? -1 : 1; // of the curvature that is larger by size
    const double angle = 0.5 * std::atan2(sign * 2 * xz, sign * (x - z)), c = std::cos(angle), s = std::sin(angle);
    const auto   along = [&](int m, int n) {
        return c * c * field.x(m, n) + s * s * field.z(m, n) + 2 * c * s * field.xz(m, n);
    };
    const int di = int(std::lround(field.radius * c / grid.spacingX)),
              dj = int(std::lround(field.radius * s / grid.spacingZ));
    if (i - std::abs(di) < 0 || i + std::abs(di) > grid.cellsX || j - std::abs(dj) < 0 ||
        j + std::abs(dj) > grid.cellsZ)
        return 0;
    for (const int side : {-1, 1})
        if (!isOnSheet(patch, std::size_t(i + side * di) * std::size_t(grid.nodesZ()) + std::size_t(j + side * dj)))
            return 0;
    const double here = along(i, j), before = along(i - di, j - dj), behind = along(i + di, j + dj);
    if (std::abs(here) < kSome * std::max(std::abs(before), std::abs(behind))) return 0;
    return kPerChange * (2 * here - before - behind) / here;
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
    if (asksForBody(settings) && !object.held().empty() && !patch.isCut)
        said.push_back(
            "what holds the object counts only within the patch window: its points are those of a sheet's two "
            "faces, or too few of them are beside what is held, so that no shell of the whole object is made; "
            "try --window object, or the points of one face");
    if (!patch.curvature) return said;
    const auto [larger, smaller] = patch.principal;
    const double     radius      = patch.curvature->radius;
    constexpr double kBeside     = 2; // radii: in the middle of a facet its neighbours are farther than one [1]
    const double     facet       = facetWidth(object.mesh(), patch.contact.point, kBeside * radius);
    const bool       faceted     = facet > radius; // from facet to edge, it is these that change
    const double     bias        = fitBias(radius, larger, smaller) - (faceted ? 0 : changeBias(patch));
    if (bias > kMostFitBias) said.push_back(onSparse(patch.spacing, larger, bias));
    if (bias < -kMostFitBias) said.push_back(onChanging(radius, -bias));
    if (settings.windowOf != WindowOf::object && !patch.isCut && settings.foundation == 0 && smaller / larger > kOneWay)
        if (const double width = openWidth(usedOf(patch, object)); width > 0) said.push_back(openObject(width));
    if (faceted)
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
