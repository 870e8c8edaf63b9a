#include "engine/pipeline/detail/shell_patch.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>

#include "engine/chart/compatible_curvature.h"
#include "engine/core/extremes.h"
#include "engine/pipeline/dent_length.h"
#include "engine/pipeline/detail/whole_object.h"

namespace palp {
namespace {

/// Returns the principal curvatures of a tensor [1/m], the larger by size first.
std::pair<double, double> principalOf(double x, double z, double xz)
{
    const double mean = (x + z) / 2, apart = std::hypot((x - z) / 2, xz);
    return {mean + std::copysign(apart, mean), mean - std::copysign(apart, mean)};
}

double meanOf(const NodeField& field, const NodeField& covered)
{
    double sum = 0, all = 0;
    for (std::size_t n = 0; n < field.values().size(); ++n) {
        const double share = covered.values().empty() ? 1 : covered.values()[n];
        sum += share * field.values()[n];
        all += share;
    }
    return all > 0 ? sum / all : 0;
}

/// Returns the depth below the plane at the contact that nearly all of the touched surface in the window stays within
/// [m].
double depthOf(const Patch& patch, const SoftObject& object, const LaidPoints& points)
{
    constexpr double      kNearly = 0.98; // stray points do not count [1]
    constexpr std::size_t kEnough = 4000; // points
    const double          reach   = bentSize(patch) / 2;
    std::vector<double>   depths;
    const std::size_t     step = points.ranks.size() / kEnough + 1;
    for (std::size_t k = 0; k < points.ranks.size(); k += step) {
        if (std::hypot(points.positions[k].x, points.positions[k].z) > reach) continue;
        const glm::dvec3 place = object.index().positionsByRank()[points.ranks[k]];
        depths.push_back(std::abs(glm::dot(place - patch.chart.origin, patch.chart.frame.normal)));
    }
    if (depths.empty()) return 0;
    const auto nearly = depths.begin() + std::ptrdiff_t(kNearly * double(depths.size() - 1));
    std::ranges::nth_element(depths, nearly);
    return *nearly;
}

/// Returns how deep the surface is across the window, over its width [1]: by its mean curvature there, which also says
/// how far a tube wraps round, or by how far it reaches, where it turns back on the way.
double sagOf(const Patch& patch, const SoftObject& object, const LaidPoints& points)
{
    const CurvatureField& field = *patch.curvature;
    const double          width = bentSize(patch);
    const auto            mean  = [&](const NodeField& one) { return meanOf(one, patch.covered); };
    const double          most  = std::abs(principalOf(mean(field.x), mean(field.z), mean(field.xz)).first);
    return std::max(most * width / 8, depthOf(patch, object, points) / width);
}

double meanOfSquares(const NodeField& field)
{
    double sum = 0;
    for (const double value : field.values()) sum += value * value;
    return sum / double(field.values().size());
}

/// Returns the length over which a dent at the contact dies away [m]; where neither the curvature nor a foundation ends
/// it, that of the larger curvature.
double lengthOf(const Patch& patch, const Material& material, double foundation)
{
    const auto [most, least] = patch.principal;
    const double length      = dentReach(most, least, material, foundation / rigidityAtContact(patch)).length;
    return std::isfinite(length) ? length : shellLengthRoot(material) / std::sqrt(std::abs(most));
}

/// Returns the noise of the points [m], the root of its mean square: one that changes little as points come and go.
double noiseOf(const SoftObject& object, const LaidPoints& points)
{
    double sum = 0;
    for (const std::uint32_t rank : points.ranks)
        sum += object.survey().noiseOfRank(rank) * object.survey().noiseOfRank(rank);
    return std::sqrt(sum / double(std::max<std::size_t>(1, points.ranks.size())));
}

/// Finds how the touched surface is curved.
std::optional<CurvatureField> findCurvature(const Patch& patch, const SoftObject& object, const LaidPoints& points,
                                            const PatchSettings& settings)
{
    return curvatureField(patch.window, patch.chart.frame,
                          [&](int rung, FitsFor what) { return curvatureSites(object, points, rung, what); },
                          {.spacing    = patch.spacing,
                           .noise      = noiseOf(object, points),
                           .mostRadius = settings.window / 2,
                           .lengthRoot = shellLengthRoot(object.material()),
                           .isWide     = settings.windowOf == WindowOf::object});
}

/// Fills in what the membrane gives way by.
void fillMembrane(Patch& patch, const Material& material)
{
    const NodeField sheet    = sheetRigidity(patch);
    patch.membraneCompliance = NodeField(patch.plate.grid);
    for (std::size_t n = 0; n < sheet.values().size(); ++n)
        patch.membraneCompliance.values()[n] = 1 / (material.modulus(sheet.values()[n]) * material.thickness);
    cutOutMembrane(patch);
}

/// Returns whether the membrane adds nothing that a solver's tolerance would show: the plate's own path is taken then.
///
/// Of the slowest wave of what bends, bending resists by 4 pi^4 D / a^4 and the membrane of a sphere by k^2 / C.
/// \param foundation  what lies below [Pa/m], without what holds an object
bool isAsGoodAsFlat(const Patch& patch, const CurvatureField& field, double foundation)
{
    constexpr double kNothing = 1e-6; // of the stiffness [1]
    const double     k2       = std::max({meanOfSquares(field.x), meanOfSquares(field.z), meanOfSquares(field.xz)});
    const double     wave     = 4 * std::pow(std::numbers::pi / bentSize(patch), 4);
    return k2 / extremesOf(patch.membraneCompliance.values()).least <
           kNothing * (wave * geometricMean(sheetRigidity(patch).values()) + foundation);
}

/// Returns the surface's own normal at the contact, or the chart's where none is known. The chart's is that of a
/// sphere, and leans on the flank of a ridge, whose points then lie behind each other along it.
glm::dvec3 ownNormal(const Patch& patch, const SoftObject& object, std::span<const std::uint32_t> near)
{
    const glm::dvec3 chart = patch.chart.frame.normal;
    const auto       next  = std::ranges::min_element(near, {}, [&](std::uint32_t point) {
        const glm::dvec3 d = object.positions()[point] - patch.chart.origin;
        return glm::dot(d, d);
    });
    if (next == near.end()) return chart;
    const glm::dvec3 own = object.survey().normal(*next);
    if (!(glm::dot(own, own) > 0)) return chart;
    return glm::dot(own, chart) < 0 ? -own : own;
}

/// Returns the place of the object's other face behind the contact, if it is so near that both are one sheet: 0.3 to
/// 2.5 thicknesses.
std::optional<glm::dvec3> otherFaceBehind(const Patch& patch, const SoftObject& object)
{
    constexpr double kLeast = 0.3, kMost = 2.5, kSpacings = 2; // thicknesses; radius of the tube [1]
    const double     h      = object.material().thickness;
    const glm::dvec3 origin = patch.chart.origin;
    const double     radius = kSpacings * patch.spacing;
    const auto       near   = object.index().gather(origin, std::hypot(kMost * h, radius));
    const glm::dvec3 normal = ownNormal(patch, object, near);
    glm::dvec3       sum{};
    double           count = 0;
    for (const std::uint32_t point : near) {
        const glm::dvec3 d     = object.positions()[point] - origin;
        const double     depth = -glm::dot(d, normal);
        if (depth < std::max(kLeast * h, patch.spacing) || depth > kMost * h) continue;
        if (glm::length(d + depth * normal) > radius) continue;
        sum += object.positions()[point];
        ++count;
    }
    if (count == 0) return {};
    return sum / count;
}

/// Returns whether the faces of one sheet bulge apart, or towards each other, so that its middle surface is less than
/// half as curved as the one that is touched. Two fits say so, before those of a field are made.
/// \param bent  width of what bends [m]
bool isLensAtContact(const Patch& patch, const SoftObject& object, double bent)
{
    // Radius of the fits: over what bends, half the length of a shell that fills it [1]; [spacings]
    constexpr double kHalf = 0.5, kShare = 0.0625, kSpacings = 5;
    constexpr double kThick = 0.5; // over the radius of curvature: that is no sheet, whatever lies behind [1]
    const auto       behind = otherFaceBehind(patch, object);
    if (!behind) return false;
    const double     quiet  = quietFitRadius(patch.noise, patch.spacing);
    const double     radius = std::max(kSpacings * patch.spacing, std::clamp(quiet, kShare * bent, bent / 2));
    const glm::dvec3 normal = patch.chart.frame.normal;
    const auto       front  = faceCurvature(object, patch.chart.origin, normal, radius);
    const auto       back   = faceCurvature(object, *behind, -normal, radius);
    if (!front || !back || std::abs(principalOf(*front).first) * object.material().thickness > kThick) return false;
    double own = 0, both = 0;
    for (int i = 0; i < 3; ++i) { // towards its own outside the back of a sheet bends the other way
        own += glm::dot(front->tensor[i], front->tensor[i]);
        both += glm::dot(front->tensor[i], front->tensor[i] - back->tensor[i]) / 2;
    }
    return both < kHalf * own;
}

/// Returns where slopes stretch a sheet, or would beyond its border: not at the ground of what is held, which carries
/// no bed, while the deflection beside it may be anything.
NodeField stretchedOf(const Patch& patch)
{
    if (patch.covered.values().empty() || patch.isCut) return {}; // of a body what is beyond the window says the rest
    if (patch.heldInPlane.values().empty()) return NodeField(patch.plate.grid, 1);
    constexpr double kGround = 1e-2; // share that is held [1]
    NodeField        stretched(patch.plate.grid);
    for (std::size_t n = 0; n < stretched.values().size(); ++n)
        stretched.values()[n] = patch.covered.values()[n] > 0 || patch.heldInPlane.values()[n] < kGround;
    return stretched;
}

} // namespace

PlateEdges stressEdgesFor(const PlateEdges& edges) noexcept
{
    const auto of = [](Edge edge) {
        if (edge == Edge::guided) return Edge::guided; // the stresses are symmetric too
        return edge == Edge::free ? Edge::clamped : edge == Edge::clamped ? Edge::free : Edge::supported;
    };
    PlateEdges stress{of(edges.x0), of(edges.x1), of(edges.z0), of(edges.z1)};
    // A stress function that one side alone holds, and not its slope, may turn about it.
    const std::array sides{&stress.x0, &stress.x1, &stress.z0, &stress.z1};
    const auto       one = std::ranges::find(sides, Edge::supported, [](const Edge* side) { return *side; });
    if (one != sides.end() && std::ranges::count(sides, Edge::free, [](const Edge* side) { return *side; }) == 3)
        **one = Edge::free;
    return stress;
}

Shell shellOf(const Patch& patch)
{
    const auto curvature = [&](const NodeField CurvatureField::*which) {
        return patch.curvature ? (*patch.curvature).*which : NodeField(patch.plate.grid);
    };
    return {patch.plate,
            patch.membraneCompliance,
            stressEdgesFor(patch.plate.edges),
            curvature(&CurvatureField::x),
            curvature(&CurvatureField::z),
            curvature(&CurvatureField::xz),
            patch.stressBed,
            patch.thrusts,
            patch.sheared,
            stretchedOf(patch)};
}

std::string whyFlat(const Patch& patch, const SoftObject& object, const PatchSettings& settings)
{
    if (settings.theory == Theory::plate) return {};
    if (settings.neighbourhood == Neighbourhood::ball)
        return "the points of a ball are no surface with a curvature; set neighbourhood surface";
    if (patch.normalFelt) return "the points around determine no curvature, as at a rim";
    if (isLensAtContact(patch, object, bentSize(object, settings)))
        return "the object is one thin sheet whose two faces bulge to either side, so that its middle is flatter than "
               "the face that is touched; give the points of one face, laid on the middle, if it is curved";
    return {};
}

void fillCurvatureAtContact(Patch& patch, const Material& material, double foundation)
{
    if (!patch.curvature) return;
    const auto [i, j] = nodeAtContact(patch);
    patch.principal   = principalOf(patch.curvature->x(i, j), patch.curvature->z(i, j), patch.curvature->xz(i, j));
    patch.shellLength = lengthOf(patch, material, foundation);
}

void curvePatch(Patch& patch, const SoftObject& object, const LaidPoints& points, const PatchSettings& settings)
{
    if (settings.large == Large::on || settings.theory == Theory::shell) fillMembrane(patch, object.material());
    if (settings.theory == Theory::plate || !patch.flatBecause.empty()) return;
    patch.curvature = findCurvature(patch, object, points, settings);
    if (!patch.curvature) {
        patch.flatBecause = "the points in the patch window determine no curvature";
        return;
    }
    if (!patch.covered.values().empty()) makeCompatible(*patch.curvature, patch.plate.grid, patch.covered);
    fillCurvatureAtContact(patch, object.material(), settings.foundation);
    patch.sag = sagOf(patch, object, points);
    if (const auto why = whyUnsolvable(shellOf(patch))) {
        patch.flatBecause = *why;
        patch.curvature.reset();
    } else if (isAsGoodAsFlat(patch, *patch.curvature, settings.foundation)) {
        patch.curvature.reset();
    }
}

} // namespace palp
