#include "engine/tools/render/curvature_crosses.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "engine/cloud/samples.h"
#include "engine/pipeline/deform.h"

// Crosses of shapes whose principal directions are known.

namespace palp {
namespace {

struct Crossed {
    Patch            patch;
    CurvatureCrosses crosses;
};

Crossed crossed(std::string_view name, Theory theory = Theory::shell)
{
    const Sample&    sample = sampleNamed(name);
    const SoftObject object(makeSample(sample, sample.points / 2, 1), {.thickness = 1e-3, .poissonRatio = 0.45});
    PatchSettings    settings{.window = 30e-3, .cells = 32, .theory = theory};
    settings.edges = {Edge::supported, Edge::supported, Edge::supported, Edge::supported};
    PlateSolver host("host");
    Crossed     made{deform(object, touchAt(object, sample.place, glm::dvec3(0, 0, 1), 5e-3), settings, host), {}};
    const std::vector<glm::dvec3> normals(object.size(), {0, 0, -1}); // of the other side, which must not matter
    made.crosses = curvatureCrosses(made.patch, object.positions(), object.positions(), normals);
    return made;
}

double lengthOf(const ViewSegment& stroke)
{
    return glm::distance(stroke.from, stroke.to);
}

TEST(CurvatureCrosses, ADomeBulgesBothWays)
{
    const auto [patch, crosses] = crossed("hemisphere");
    EXPECT_TRUE(crosses.hollow.empty());
    ASSERT_EQ(crosses.bulging.size(), 2u * 81) << "two strokes at every place of the lattice";
    const auto [least, most] =
        std::minmax_element(crosses.bulging.begin(), crosses.bulging.end(),
                            [](const auto& a, const auto& b) { return lengthOf(a) < lengthOf(b); });
    EXPECT_NEAR(lengthOf(*most), 0.9 * 30e-3 / 9, 1e-9) << "the strongest nearly touches its neighbour";
    EXPECT_GT(lengthOf(*least), 0.85 * lengthOf(*most))
        << "a sphere is curved alike everywhere, fits are right to some per cent";
}

TEST(CurvatureCrosses, ASaddleBulgesOneWayAndIsHollowAcross)
{
    const auto [patch, crosses] = crossed("saddle");
    ASSERT_EQ(crosses.bulging.size(), 81u);
    ASSERT_EQ(crosses.hollow.size(), 81u);
    for (std::size_t n = 0; n < 81; ++n) {
        const glm::dvec3 one = glm::normalize(crosses.bulging[n].to - crosses.bulging[n].from),
                         two = glm::normalize(crosses.hollow[n].to - crosses.hollow[n].from);
        EXPECT_NEAR(glm::dot(one, two), 0, 1e-9) << "principal directions are perpendicular";
        const auto over = [](const glm::dvec3& p) { return p.z - (p.x * p.x - p.y * p.y) / (2 * 80e-3); };
        EXPECT_NEAR((over(crosses.hollow[n].from) + over(crosses.hollow[n].to)) / 2, 0, 3e-6)
            << "the surface, which rises by 14 um, would hide the ends; the fits are right to 10 %";
    }
}

TEST(CurvatureCrosses, AStrokeLiesAlongTheBendOfTheSurface)
{
    // Half axes 60, 45 and 35 mm: at the top 35/45^2 along y is a larger curvature than 35/60^2 along x.
    const auto [patch, crosses] = crossed("ellipsoid");
    const glm::dvec3 top        = patch.contact.point;
    const auto       nearest =
        std::min_element(crosses.bulging.begin(), crosses.bulging.end(), [&](const auto& a, const auto& b) {
            const auto key = [&](const ViewSegment& s) {
                return glm::distance((s.from + s.to) * 0.5, top) - 0.1 * lengthOf(s); // the longer one of two
            };
            return key(a) < key(b);
        });
    const glm::dvec3 along = glm::normalize(nearest->to - nearest->from);
    EXPECT_GT(std::abs(along.y), 0.98) << "within 10 degrees";
}

TEST(CurvatureCrosses, APlateHasNone)
{
    const auto [patch, crosses] = crossed("hemisphere", Theory::plate);
    EXPECT_TRUE(crosses.bulging.empty() && crosses.hollow.empty());
}

} // namespace
} // namespace palp
