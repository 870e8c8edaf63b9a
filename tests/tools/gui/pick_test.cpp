#include "engine/tools/gui/pick.h"

#include <cmath>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

namespace palp {
namespace {

/// Two sheets of 1 mm spacing, 3 mm apart, the upper one at z = 0.
struct Sheets {
    Sheets()
    {
        for (const double z : {0.0, -3e-3})
            for (int i = -30; i <= 30; ++i)
                for (int j = -30; j <= 30; ++j) {
                    positions.emplace_back(i * 1e-3, j * 1e-3, z);
                    normals.emplace_back(0, 0, (i + j) % 2 ? 1 : -1); // of either side
                }
        radii.assign(positions.size(), 1e-3);
    }
    [[nodiscard]] std::optional<Hit> hit(const Ray& ray, double blur = 2e-3) const
    {
        return pick(ray, positions, normals, radii, blur);
    }
    std::vector<glm::dvec3> positions, normals;
    std::vector<double>     radii;
};

TEST(RayThrough, GoesWhereACameraWithACentreSees)
{
    for (const Projection projection : {Projection::perspective, Projection::orthographic}) {
        Camera camera;
        camera.target     = {0.1, 0.2, 0.3};
        camera.distance   = 0.5;
        camera.projection = projection;
        camera.centre     = {0.3, -0.2};
        const glm::dvec2 size(800, 600), at = 0.5 * size + 300.0 * glm::dvec2(0.3, 0.2);
        const Ray        ray   = rayThrough(camera, at, size);
        const double     along = glm::dot(camera.target - ray.from, ray.along);
        EXPECT_NEAR(glm::distance(ray.from + along * ray.along, camera.target), 0, 1e-12) << "rounding [m]";
    }
}

TEST(Pick, MeetsTheNearerSheetWhereTheRayDoes)
{
    const Sheets     sheets;
    const glm::dvec3 from(5.3e-3, -2.1e-3, 0.1);
    const glm::dvec3 along = glm::normalize(glm::dvec3(0.1, 0.05, -1));
    const auto       hit   = sheets.hit({from, along});
    ASSERT_TRUE(hit);
    const glm::dvec3 expected = from + 0.1 / -along.z * along;
    EXPECT_NEAR(glm::distance(hit->point, expected), 0, 1e-12) << "on a plane the means lie in it, to rounding";
    EXPECT_NEAR(hit->outward.z, 1, 1e-12) << "towards the eye";
}

TEST(Pick, FromBelowItIsTheLowerSheetWithItsSideToTheEye)
{
    const auto hit = Sheets().hit({{0, 0, -0.1}, {0, 0, 1}});
    ASSERT_TRUE(hit);
    EXPECT_NEAR(hit->point.z, -3e-3, 1e-12);
    EXPECT_NEAR(hit->outward.z, -1, 1e-12);
}

TEST(Pick, MissesBesideTheObjectAndBehindTheEye)
{
    const Sheets sheets;
    EXPECT_FALSE(sheets.hit({{0.05, 0, 0.1}, {0, 0, -1}}));
    EXPECT_FALSE(sheets.hit({{0, 0, 0.1}, {0, 0, 1}}));
}

TEST(Pick, APointerThatGlidesMakesAHandThatGlides)
{
    Sheets sheets;
    for (std::size_t n = 0; n < sheets.positions.size(); ++n) sheets.positions[n].z += n % 3 ? 0 : 2e-4; // rough
    double last = 0, most = 0; // height, and largest step of it [m]
    for (int n = 0; n < 400; ++n) {
        const auto hit = sheets.hit({{n * 2e-5, 3e-4, 0.1}, {0, 0, -1}});
        ASSERT_TRUE(hit);
        if (n > 0) most = std::max(most, std::abs(hit->point.z - last));
        last = hit->point.z;
    }
    EXPECT_LT(most, 2e-5) << "a tenth of the roughness for each fiftieth of a spacing";
}

TEST(Ray, GoesThroughThePixelThatItWasAskedFor)
{
    Camera camera;
    camera.target   = {0.01, 0.02, 0.03};
    camera.distance = 0.4;
    for (const Projection projection : {Projection::perspective, Projection::orthographic}) {
        camera.projection      = projection;
        const CameraMatrices m = matricesOf(camera, {}, 1, 16.0 / 9);
        const glm::dvec2     size(1280, 720), pixel(1000, 100);
        const Ray            ray  = rayThrough(camera, pixel, size);
        const glm::dvec4     clip = m.clipFromView * (m.viewFromWorld * glm::dvec4(ray.from + 0.37 * ray.along, 1));
        EXPECT_NEAR((clip.x / clip.w + 1) / 2 * size.x, pixel.x, 1e-6);
        EXPECT_NEAR((clip.y / clip.w + 1) / 2 * size.y, pixel.y, 1e-6);
    }
}

} // namespace
} // namespace palp
