#include "engine/tools/render/mesh_skin.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "engine/cloud/mesh_points.h"
#include "engine/pipeline/deform.h"
#include "engine/tools/render/touch_view.h"
#include "tests/cloud/meshes.h"

namespace palp {
namespace {

constexpr double kDistance = 1e-3; // of the points [m]

/// An object whose points are scattered over the mesh, with a stiffness that a function gives to each place and side.
template <class Stiffness>
SoftObject objectOn(const test::Mesh& mesh, Stiffness&& stiffness)
{
    const MeshPoints    points = scatterOver(mesh.vertices, mesh.faces, {.distance = kDistance});
    std::vector<double> values;
    for (std::size_t n = 0; n < points.size(); ++n) values.push_back(stiffness(points.positions[n], points.normals[n]));
    const std::vector<glm::vec3> normals(points.normals.begin(), points.normals.end());
    return SoftObject(PointCloud(points.positions, values, StiffnessKind::modulus), {}, {}, normals)
        .standingFor({mesh.vertices, mesh.faces});
}

SoftObject objectOn(const test::Mesh& mesh)
{
    return objectOn(mesh, [](const glm::dvec3&, const glm::dvec3&) { return 1e5; });
}

/// What a force does to the points for which the function is not zero, along -z.
template <class Response>
PatchSurface pressed(const SoftObject& object, Response&& response)
{
    PatchSurface surface;
    surface.inward = {0, 0, -1};
    for (std::uint32_t n = 0; n < object.size(); ++n)
        if (const double r = response(object.positions()[n]); r != 0) {
            surface.moving.push_back(n);
            surface.responses.push_back(r);
            surface.hollows.push_back(0.5 * r);
        }
    surface.sloping = surface.moving.size();
    return surface;
}

double dent(const glm::dvec3& p)
{
    const double square = glm::dot(p - glm::dvec3(0.02, 0.02, 0), p - glm::dvec3(0.02, 0.02, 0));
    return square < 1e-4 ? 1e-3 * std::pow(1 - square / 1e-4, 2) : 0;
}

TEST(MeshSkin, ADentInTheMiddleOfTwoTrianglesIsSeen)
{
    const SoftObject object = objectOn(test::square(0.04));
    MeshSkin         skin(object);

    skin.take(pressed(object, dent));
    skin.bend(2, 3);

    double deepest = 0, worst = 0; // [m]
    for (std::size_t n = 0; n < skin.positions().size(); ++n) {
        const glm::dvec3& p = skin.positions()[n];
        deepest             = std::max(deepest, -p.z);
        worst               = std::max(worst, std::abs(-p.z - 6 * dent({p.x, p.y, 0})));
        EXPECT_NEAR(skin.deflections()[n], -p.z / 3, 1e-15);
    }
    EXPECT_NEAR(deepest, 6e-3, 0.05 * 6e-3) << "points and corners are not right in the middle";
    EXPECT_LT(worst, 0.05 * 6e-3) << "the dent is ten spacings wide, so planes fitted to it are off by some hundredths";
}

TEST(MeshSkin, CornersFollowAPlaneExactly)
{
    const SoftObject object = objectOn(test::square(0.04));
    MeshSkin         skin(object);
    const auto       slope = [](const glm::dvec3& p) { return 1e-3 * (1 + 20 * p.x - 7 * p.y); };

    skin.take(pressed(object, slope));
    skin.bend(1, 1);

    for (std::size_t n = 0; n < skin.positions().size(); ++n) {
        const glm::dvec3& p      = skin.positions()[n];
        const bool        inside = std::min({p.x, p.y, 0.04 - p.x, 0.04 - p.y}) > 3e-3;
        if (inside) {
            EXPECT_NEAR(-p.z, slope(p), 3e-6) << "a spacing's slope is 2e-5, the fit is softened by 1e-3";
        }
        EXPECT_NEAR(-p.z, slope(p), 3e-5) << "on the rim no corner leaves the range of the points around";
        const glm::dvec3 normal = glm::normalize(glm::dvec3(2e-2, -7e-3, 1));
        if (inside) {
            EXPECT_GT(std::abs(glm::dot(skin.normals()[n], normal)), std::cos(4e-3)) << n;
        }
    }
}

TEST(MeshSkin, NoGapOpensAtTheEdgeOfACube)
{
    using Place                                       = std::array<double, 3>;
    const auto                                placeOf = [](const glm::dvec3& p) { return Place{p.x, p.y, p.z}; };
    const SoftObject                          object  = objectOn(test::sharedCube(0.02));
    MeshSkin                                  skin(object);
    std::map<Place, std::vector<std::size_t>> corners;
    for (std::size_t n = 0; n < skin.positions().size(); ++n) corners[placeOf(skin.positions()[n])].push_back(n);

    skin.take(
        pressed(object, [](const glm::dvec3& p) { return p.z < 0 ? 0 : std::exp(-2e4 * (p.x * p.x + p.y * p.y)); }));
    skin.bend(1e-3, 1);

    std::size_t split = 0;
    for (const auto& [place, at] : corners) {
        split += at.size() > 1;
        for (const std::size_t n : at) EXPECT_EQ(placeOf(skin.positions()[n]), placeOf(skin.positions()[at.front()]));
    }
    EXPECT_GT(split, 50U) << "the edges of the cube";
}

TEST(MeshSkin, WithoutAForceEverythingIsAtRest)
{
    const SoftObject              object = objectOn(test::ball(0.02, 2));
    MeshSkin                      skin(object);
    const std::vector<glm::dvec3> rest(skin.positions().begin(), skin.positions().end());
    const std::vector<glm::dvec3> normals(skin.normals().begin(), skin.normals().end());

    skin.take(pressed(object, [](const glm::dvec3& p) { return std::max(0.0, p.z); }));
    skin.bend(1, 1);
    EXPECT_NE(rest, std::vector(skin.positions().begin(), skin.positions().end()));
    skin.take(PatchSurface());
    skin.bend(1, 1);

    EXPECT_EQ(rest, std::vector(skin.positions().begin(), skin.positions().end()));
    EXPECT_EQ(normals, std::vector(skin.normals().begin(), skin.normals().end()));
    EXPECT_EQ(std::ranges::count(skin.deflections(), 0.0), std::ptrdiff_t(rest.size()));
    EXPECT_EQ(std::ranges::count(skin.hollows(), 0.0), std::ptrdiff_t(rest.size()));
}

TEST(MeshSkin, AnotherPlaceForgetsTheOneBefore)
{
    const SoftObject object = objectOn(test::square(0.04));
    MeshSkin         twice(object), once(object);
    const auto       other = [](const glm::dvec3& p) { return dent(p + glm::dvec3(0.008, 0, 0)); };

    twice.take(pressed(object, dent));
    twice.bend(1, 1);
    twice.take(pressed(object, other));
    twice.bend(1, 1);
    once.take(pressed(object, other));
    once.bend(1, 1);

    EXPECT_TRUE(std::ranges::equal(twice.positions(), once.positions()));
    EXPECT_TRUE(std::ranges::equal(twice.normals(), once.normals()));
    EXPECT_TRUE(std::ranges::equal(twice.hollows(), once.hollows()));
}

TEST(MeshSkin, HollowsLieOnTheSideOfTheNormal)
{
    const SoftObject object = objectOn(test::square(0.04));
    test::Mesh       turned = test::square(0.04);
    for (Triangle& face : turned.faces) std::swap(face[0], face[1]);
    const SoftObject other = objectOn(turned);
    MeshSkin         skin(object), turnedSkin(other);
    // Humps of the object at rest, told from either side.
    const std::vector<double>     relief(object.size(), 0.25), otherRelief(other.size(), 0.25);
    const std::vector<glm::dvec3> up(object.size(), {0, 0, 1}), otherUp(other.size(), {0, 0, 1});

    skin.relieve(relief, up);
    turnedSkin.relieve(otherRelief, otherUp);

    for (const double hollow : skin.hollows()) EXPECT_NEAR(hollow, 0.25, 1e-6) << "weights are floats";
    for (const double hollow : turnedSkin.hollows()) EXPECT_NEAR(hollow, -0.25, 1e-6);
    skin.take(pressed(object, dent));
    skin.bend(100, 1);
    turnedSkin.take(pressed(other, dent));
    turnedSkin.bend(100, 1);
    EXPECT_GT(std::ranges::max(skin.hollows()), 0.29) << "0.25 and 100 times half of 1e-3";
    EXPECT_LT(std::ranges::min(turnedSkin.hollows()), -0.29);
}

TEST(MeshSkin, ColoursAreThoseOfTheSideOnWhichACornerLies)
{
    test::Mesh plate = test::square(0.03); // and its other side, one spacing below
    test::addSide(plate, {0, 0, -kDistance}, {0, 0.03, 0}, {0.03, 0, 0});
    const auto       byside = [](const glm::dvec3&, const glm::dvec3& normal) { return normal.z > 0 ? 1e4 : 1e6; };
    const SoftObject object = objectOn(plate, byside);
    MeshSkin         skin(object);

    skin.paint(object.cloud().stiffness());

    for (std::size_t n = 0; n < skin.painted().size(); ++n)
        EXPECT_NEAR(skin.painted()[n], skin.positions()[n].z < -0.5 * kDistance ? 1e6 : 1e4, 1e-2)
            << n << ": exp(log) of floats' weights";
}

TEST(MeshSkin, PaintOfAFewPointsIsThatOfAll)
{
    const SoftObject object =
        objectOn(test::square(0.03), [](const glm::dvec3& p, const glm::dvec3&) { return 1e5 * std::exp(50 * p.x); });
    MeshSkin            skin(object), fresh(object);
    std::vector<double> values(object.cloud().stiffness().begin(), object.cloud().stiffness().end());

    skin.paint(values);
    const std::vector<double> before(skin.painted().begin(), skin.painted().end());
    for (std::size_t n = 0; n < values.size(); ++n)
        if (object.positions()[n].x < 0.01) values[n] = 3e5;
    skin.paint(values);
    fresh.paint(values);

    EXPECT_NE(before, std::vector(skin.painted().begin(), skin.painted().end()));
    EXPECT_TRUE(std::ranges::equal(skin.painted(), fresh.painted()));
    for (std::size_t n = 0; n < before.size(); ++n) {
        const glm::dvec3& p = skin.positions()[n];
        if (p.x < 0.01 - 4 * kDistance) {
            EXPECT_NEAR(skin.painted()[n], 3e5, 1) << "weights are floats";
        }
        if (p.x > 0.01 + 4 * kDistance) {
            EXPECT_EQ(skin.painted()[n], before[n]);
        }
        if (p.x > 0.02 && p.x < 0.027) {
            EXPECT_NEAR(skin.painted()[n] / (1e5 * std::exp(50 * p.x)), 1, 1e-3) << "factors along a line are exact";
        }
        EXPECT_LE(skin.painted()[n], std::ranges::max(values) * (1 + 1e-6));
        EXPECT_GE(skin.painted()[n], std::ranges::min(values) * (1 - 1e-6));
    }
}

TEST(MeshSkin, AFewPointsAreEnough)
{
    const std::vector<glm::dvec3> few{{0, 0, 0},    {0.01, 0, 0}, {0.02, 0, 0}, {0.03, 0, 0}, {0.04, 0, 0},
                                      {0.05, 0, 0}, {0.06, 0, 0}, {0.07, 0, 0}}; // on a line: no plane through them
    const test::Mesh              mesh = test::square(0.07);
    const SoftObject object = SoftObject(PointCloud(few, std::vector<double>(few.size(), 1e5), StiffnessKind::modulus))
                                  .standingFor({mesh.vertices, mesh.faces});
    MeshSkin skin(object);

    skin.take(pressed(object, [](const glm::dvec3&) { return 1.0; }));
    skin.bend(0.01, 1);

    for (const glm::dvec3& p : skin.positions()) EXPECT_NEAR(p.z, -0.01, 1e-6) << "weights are 1 together";
}

TEST(MeshSkin, TheViewOfAMeshShowsItsFaces)
{
    const test::Mesh mesh = test::sharedCube(0.03);
    const SoftObject object =
        objectOn(mesh, [](const glm::dvec3& p, const glm::dvec3&) { return 1e5 * (2 + p.x / 0.015); });
    TouchView view(object, {});
    TouchLook look;
    look.paint = ViewPaint::stiffness;

    view.show(nullptr, 0, look);

    const ViewScene& scene = view.scene();
    ASSERT_GT(scene.faces.size(), mesh.faces.size());
    ASSERT_EQ(scene.values.size(), scene.positions.size());
    EXPECT_EQ(scene.normals.size(), scene.positions.size());
    EXPECT_NEAR(
        test::areaOf({{scene.positions.begin(), scene.positions.end()}, {scene.faces.begin(), scene.faces.end()}}),
        6 * 0.03 * 0.03, 1e-12);
    for (std::size_t n = 0; n < scene.positions.size(); ++n)
        EXPECT_NEAR(scene.values[n], 1e5 * (2 + scene.positions[n].x / 0.015), 1e4) << "within a spacing's change";
    std::vector<double> other(object.size(), 7e5);
    view.repaint(other);
    view.show(nullptr, 0, look);
    EXPECT_NEAR(view.scene().values[0], 7e5, 1);
}

TEST(MeshSkin, TheViewDentsTheMesh)
{
    const SoftObject object = objectOn(test::sharedCube(0.03));
    PatchSettings    settings;
    settings.window          = 0.02;
    settings.footprintRadius = 2e-3;
    settings.cells           = 16;
    settings.foundation      = 1e7;
    PlateSolver      solver("host");
    const glm::dvec3 top(0, 0, 0.015);
    const Patch      patch = deform(object, Contact{top, {0, 0, 1}}, settings, solver);
    ASSERT_TRUE(patch.deformed());
    const double most = std::ranges::max(patch.pointResponse); // [m/N]
    TouchView    view(object, settings);

    view.show(&patch, 1e-3 / most, {});

    const ViewScene& scene   = view.scene();
    std::size_t      nearest = 0, dented = 0;
    for (std::size_t n = 0; n < scene.positions.size(); ++n) {
        const glm::dvec3& p = scene.positions[n];
        if (glm::distance(p, top) < glm::distance(scene.positions[nearest], top)) nearest = n;
        dented += scene.values[n] > 0.5e-3;
    }
    EXPECT_GT(dented, 4U);
    EXPECT_NEAR(scene.positions[nearest].z, top.z - 1e-3, 0.3e-3) << "corners are two spacings apart";
    EXPECT_NEAR(scene.positions[nearest].z, top.z - scene.values[nearest], 1e-9);
    const double inDent = scene.hollows[nearest];
    view.show(nullptr, 0, {});
    EXPECT_EQ(view.scene().positions[nearest].z, top.z);
    EXPECT_GT(inDent, view.scene().hollows[nearest] + 0.01) << "the surroundings of a dent rise";
    std::size_t humps = 0; // at rest: its edges, from either of their sides
    for (const double hollow : view.scene().hollows) humps += hollow < -0.05;
    EXPECT_GT(humps, 20U);
}

} // namespace
} // namespace palp
