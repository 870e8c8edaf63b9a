// An ear of the Stanford bunny, from the user's own copy: the thin lobe of the paper on a real scan.
#include <algorithm>
#include <cmath>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>

#include "engine/cloud/point_cloud_io.h"
#include "engine/contact/contact.h"
#include "engine/core/contract.h"
#include "engine/core/quantity.h"
#include "engine/pipeline/deform.h"
#include "engine/tools/paper/bunny.h"
#include "engine/tools/paper/parts.h"
#include "engine/tools/render/cloud_figure.h"

namespace palp::report {
namespace {

constexpr double     kDiagonal = 0.2502; ///< of the original's bounds [m]
constexpr double     kSameSize = 0.02;   ///< relative difference at which a copy, with fewer points, has its size [1]
constexpr double     kEar      = 40e-3;  ///< length of an ear [m]
constexpr double     kWindow   = 18e-3;  ///< lies on the flat side of an ear [m]
constexpr double     kForce    = 0.03;   ///< [N]
constexpr PlateEdges kFromItsRoot{Edge::free, Edge::free, Edge::free, Edge::clamped};

/// The place where the ear is pressed, and the ear's orientation.
struct Ear {
    glm::dvec3 place{};  ///< [m]
    Frame      frame;    ///< normal out of its flat side, north towards its root
    glm::dvec3 middle{}; ///< of the ear's thickness, below the place [m]
};

/// Returns the spread of points about their middle: the sum of the outer products [m^2].
glm::dmat3 spreadOf(const std::vector<glm::dvec3>& points, const glm::dvec3& middle)
{
    glm::dmat3 spread(0);
    for (const glm::dvec3& p : points) spread += glm::outerProduct(p - middle, p - middle);
    return spread;
}

/// Returns the eigenvector of the largest eigenvalue, by the power method [1].
glm::dvec3 longest(const glm::dmat3& spread)
{
    glm::dvec3 d = glm::normalize(glm::dvec3(0.36, 0.48, 0.80)); // any direction that is perpendicular to no ear
    for (int n = 0; n < 1000; ++n) d = glm::normalize(spread * d);
    return d;
}

/// Returns the eigenvector of the least eigenvalue: the longest one of the trace less the matrix.
glm::dvec3 shortest(const glm::dmat3& spread)
{
    return longest(glm::dmat3(spread[0][0] + spread[1][1] + spread[2][2]) - spread);
}

glm::dvec3 middleOf(const std::vector<glm::dvec3>& points)
{
    glm::dvec3 sum(0);
    for (const glm::dvec3& p : points) sum += p / double(points.size());
    return sum;
}

/// Finds the ear that reaches highest; y is up, as in the original.
Ear earOf(const SoftObject& object)
{
    const auto       positions = object.positions();
    const glm::dvec3 top =
        *std::max_element(positions.begin(), positions.end(), [](const auto& a, const auto& b) { return a.y < b.y; });
    std::vector<glm::dvec3> ear, slice;
    for (const std::uint32_t n : object.index().gather(top, kEar)) ear.push_back(positions[n]);
    const glm::dvec3 middle = middleOf(ear);
    glm::dvec3       along  = longest(spreadOf(ear, middle)); // from the root to the tip
    if (glm::dot(top - middle, along) < 0) along = -along;
    double tip = 0; // beyond the middle [m]
    for (const glm::dvec3& p : ear) tip = std::max(tip, glm::dot(p - middle, along));

    // The place lies nearly half a window from the tip (half a window along the surface, which bends), in the middle of
    // the width, on the side that lies farther out there.
    for (const glm::dvec3& p : ear)
        if (std::abs(glm::dot(p - middle, along) - (tip - 0.36 * kWindow)) < kWindow / 10) slice.push_back(p);
    const glm::dvec3 here = middleOf(slice);
    // The slice is thin along the ear too. That direction must not count, so the slice is made long there.
    const glm::dvec3 flat  = shortest(spreadOf(slice, here) + spreadOf(ear, middle) * glm::outerProduct(along, along));
    glm::dvec3       place = here;
    double           most  = -1;
    for (const glm::dvec3& p : slice) {
        const double height = glm::dot(p - here, flat);
        if (glm::length(p - here - height * flat) < kWindow / 10 && std::abs(height) > most) {
            most  = std::abs(height);
            place = p;
        }
    }
    const glm::dvec3 out   = glm::dot(place - here, flat) > 0 ? flat : -flat;
    const glm::dvec3 north = glm::normalize(glm::dot(along, out) * out - along);
    return {place, {out, glm::cross(north, out), north}, here};
}

/// Returns the ear's skin on the side of the finger. The other skin is 5 mm behind: a sphere through both would have
/// the ear's thickness and not its shape.
SoftObject skinOf(const SoftObject& object, const Ear& ear)
{
    std::vector<glm::dvec3> positions;
    std::vector<double>     stiffness;
    for (const std::uint32_t n : object.index().gather(ear.place, kEar / 2)) {
        const glm::dvec3& p = object.positions()[n];
        if (glm::dot(p - ear.middle, ear.frame.normal) < 0) continue;
        positions.push_back(p);
        stiffness.push_back(object.cloud().stiffness()[n]);
    }
    return SoftObject({positions, stiffness, object.cloud().kind()}, object.material());
}

} // namespace

Bunny readBunny(const std::filesystem::path& file)
{
    constexpr std::size_t kFewest = 5000; // with fewer points an ear has too few
    const PointCloud      read    = readCloud(file).cloud;
    if (read.size() < kFewest)
        throw Error(file.string() + ": expected a bunny of at least " + std::to_string(kFewest) + " points, found " +
                    std::to_string(read.size()) + "; try bun_zipper.ply of the Stanford repository");
    const double factor = kDiagonal / read.bounds().diagonal();
    if (std::abs(factor - 1) < kSameSize) return {read, 1};
    std::vector<glm::dvec3> positions;
    for (const glm::dvec3& p : read.positions()) positions.push_back(factor * p);
    return {PointCloud(positions, {read.stiffness().begin(), read.stiffness().end()}, read.kind()), factor};
}

const std::string& bunnyTerms()
{
    static const std::string kTerms =
        "The Stanford bunny is a scan by the Stanford Computer Graphics Laboratory (graphics.stanford.edu/data/"
        "3Dscanrep). It is free for research and may be passed on with credit; not for commercial use without "
        "permission. Palpate does not come with it.";
    return kTerms;
}

void addBunny(Section& lobe, const std::filesystem::path& file, const ReportRun& run)
{
    const Bunny      bunny = readBunny(file);
    const SoftObject all(bunny.cloud, {4e-3, 0.45});
    const Ear        ear  = earOf(all);
    const SoftObject skin = skinOf(all, ear);
    PatchSettings    settings{.window = kWindow, .cells = run.quick ? 32 : 64, .footprintRadius = 2e-3};
    Table            table{"The outer skin of an ear of the bunny under " + formatQuantity(kForce, "N") +
                    ", 300 kPa throughout, patch window 18 mm.",
                {"edges", "under the finger", "at the ear's tip", "felt stiffness"},
                {}};
    for (const auto& [name, edges] :
         {std::pair("clamped all around", PlateEdges{}), std::pair("free but for its root", kFromItsRoot)}) {
        settings.edges    = edges;
        const Patch patch = deform(skin, {ear.place, ear.frame.normal}, settings, run.solver, ear.frame);
        if (!patch.deformed())
            throw Error(file.string() + ": the points of its highest ear determine no surface; is y up, as in the "
                                        "original?");
        const int    middle = settings.cells / 2;
        const double here = kForce * patch.response(middle, middle), tip = kForce * patch.response(middle, 0);
        table.rows.push_back(
            {name, formatQuantity(here, "m"), formatQuantity(tip, "m"), formatQuantity(patch.feltStiffness, "N/m")});
        const std::string stem = std::string("bunny/") + (edges == PlateEdges{} ? "clamped/" : "free/");
        lobe.numbers.push_back({stem + "compliance", "m/N", {patch.compliance}});
        lobe.numbers.push_back({stem + "sphere_misfit", "m", {patch.sphere.fit.misfit}});
        lobe.numbers.push_back({stem + "deflection", "m", {here}});
        lobe.numbers.push_back({stem + "deflection_of_tip", "m", {tip}});
        const PressedPatch pressed{&patch, kForce, ""};
        lobe.figures.push_back(
            {std::string("The outer skin of an ear, its root above: ") + name + ", displacements twice as large.",
             surfaceSvg(skin.cloud(), {&pressed, 1}, {std::string("The bunny's ear, ") + name, 2, {0, 0, 0}, true},
                        run.renderer)});
    }
    lobe.numbers.push_back({"bunny/place", "m", {ear.place.x, ear.place.y, ear.place.z}});
    lobe.numbers.push_back({"bunny/normal", "1", {ear.frame.normal.x, ear.frame.normal.y, ear.frame.normal.z}});
    lobe.numbers.push_back({"bunny/factor", "1", {bunny.factor}});
    lobe.numbers.push_back({"bunny/points", "1", {double(bunny.cloud.size())}});
    lobe.text.push_back(bunnyTerms() +
                        (bunny.factor == 1
                             ? " It has the size of the original."
                             : " The copy was scaled by " + formatNumber(bunny.factor) + ", to the original's " +
                                   formatQuantity(kDiagonal, "m") + " from corner to corner."));
    lobe.tables.push_back(std::move(table));
}

} // namespace palp::report
