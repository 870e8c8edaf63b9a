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
#include "engine/picture/patch_pictures.h"
#include "engine/pipeline/pipeline.h"
#include "engine/report/parts.h"

namespace palp::report {
namespace {

constexpr double     kDiagonal = 0.2502; ///< of the original's bounds [m]
constexpr double     kSameSize = 0.02;   ///< off from it, relative, is still the original: copies have fewer points [1]
constexpr double     kEar      = 22e-3;  ///< from the tip of the ear to where it ends [m]
constexpr double     kForce    = 0.05;   ///< [N]
constexpr PlateEdges kFromItsRoot{Edge::free, Edge::free, Edge::free, Edge::clamped};

/// The cloud in the original's size, and the factor that took.
struct Bunny {
    PointCloud cloud;
    double     factor = 1;
};

Bunny readBunny(const std::filesystem::path& file)
{
    constexpr std::size_t kFewest = 5000; // the ear of fewer points is a handful of them [1]
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

/// Where the ear is pressed, and which way it hangs.
struct Ear {
    glm::dvec3 place{}; ///< [m]
    Frame      frame;   ///< normal out of its flat side, north towards its root
};

/// Direction in which the points spread least [1].
glm::dvec3 thinDirection(const std::vector<glm::dvec3>& points, const glm::dvec3& middle)
{
    glm::dmat3 spread(0);
    for (const glm::dvec3& p : points) spread += glm::outerProduct(p - middle, p - middle);
    const double trace = spread[0][0] + spread[1][1] + spread[2][2];
    glm::dvec3   d     = glm::normalize(glm::dvec3(0.36, 0.48, 0.80));        // any that is not an axis of the ear
    for (int n = 0; n < 500; ++n) d = glm::normalize(trace * d - spread * d); // the least becomes the largest
    return d;
}

/// The ear that reaches highest; y is up, as in the original.
Ear earOf(const PointCloud& cloud, const NeighbourIndex& index)
{
    const auto       positions = cloud.positions();
    const glm::dvec3 tip =
        *std::max_element(positions.begin(), positions.end(), [](const auto& a, const auto& b) { return a.y < b.y; });
    std::vector<glm::dvec3> points;
    glm::dvec3              middle(0);
    for (const std::uint32_t n : index.gather(tip, kEar)) points.push_back(positions[n]);
    for (const glm::dvec3& p : points) middle += p / double(points.size());
    const glm::dvec3 normal = thinDirection(points, middle);
    // The side that bulges: farthest out near the middle.
    glm::dvec3 place = tip;
    double     most  = -1;
    for (const glm::dvec3& p : points) {
        const double height = glm::dot(p - middle, normal);
        if (glm::length(p - middle - height * normal) < 3e-3 && std::abs(height) > most) {
            most  = std::abs(height);
            place = p;
        }
    }
    const glm::dvec3 out   = glm::dot(place - middle, normal) > 0 ? normal : -normal;
    const glm::dvec3 root  = middle - tip;
    const glm::dvec3 north = glm::normalize(root - glm::dot(root, out) * out);
    return {place, {out, glm::cross(north, out), north}};
}

} // namespace

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
    const Bunny          bunny = readBunny(file);
    const NeighbourIndex index(bunny.cloud.positions());
    const Ear            ear = earOf(bunny.cloud, index);
    PatchSettings        settings{.material        = {4e-3, 0.45},
                                  .window          = 16e-3,
                                  .cells           = run.quick ? 32 : 64,
                                  .footprintRadius = 2e-3,
                                  .frame           = ear.frame};
    Table table{"An ear of the bunny under " + formatQuantity(kForce, "N") + ", 300 kPa throughout, window 16 mm.",
                {"edges", "under the finger", "at the ear's tip", "felt stiffness"},
                {}};
    for (const auto& [name, edges] :
         {std::pair("clamped all around", PlateEdges{}), std::pair("free but for its root", kFromItsRoot)}) {
        settings.edges    = edges;
        const Patch patch = deform(bunny.cloud, index, {ear.place, ear.frame.normal}, settings, run.device);
        if (!patch.deformed())
            throw Error(file.string() + ": the points of its highest ear determine no surface; is y up, as in the "
                                        "original?");
        const int    middle = settings.cells / 2;
        const double here = kForce * patch.response(middle, middle), tip = kForce * patch.response(middle, 0);
        table.rows.push_back(
            {name, formatQuantity(here, "m"), formatQuantity(tip, "m"), formatQuantity(patch.feltStiffness, "N/m")});
        const std::string stem = std::string("bunny/") + (edges == PlateEdges{} ? "clamped/" : "free/");
        lobe.numbers.push_back({stem + "compliance", "m/N", {patch.compliance}});
        lobe.numbers.push_back({stem + "deflection", "m", {here}});
        lobe.numbers.push_back({stem + "deflection_of_tip", "m", {tip}});
        const PressedPatch pressed{&patch, kForce, ""};
        lobe.figures.push_back(
            {std::string("An ear of the bunny, ") + name + ", displacements twice as large.",
             surfaceSvg(bunny.cloud, {&pressed, 1}, {std::string("The bunny's ear, ") + name, 2, {0, 0, 0}, true})});
    }
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
