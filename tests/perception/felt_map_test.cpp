#include "engine/perception/felt_map.h"

#include <cmath>

#include <gtest/gtest.h>

#include "engine/perception/perception.h"
#include "engine/session/scene.h"
#include "tests/perception/thin_slab.h"
#include "tests/session/sheet_session.h"

namespace palp {
namespace {

TEST(FeltMap, ShowsAWartAndNothingElse)
{
    const Scene      scene  = sheetScene(kWart);
    const SoftObject object = loadObject(scene).object;
    PlateSolver      solver("host");

    const FeltMap map   = feltMap(object, scene.patch, 400, solver);
    const auto    share = detectability(map, kWeberFractions[1]);

    EXPECT_GT(map.places.size(), 200u);
    EXPECT_LT(map.places.size(), 800u);
    EXPECT_EQ(map.atPoints.size(), object.size());
    double on = 0, off = 0;
    for (std::size_t n = 0; n < object.size(); ++n) {
        const glm::dvec3 p    = object.positions()[n];
        const double     away = std::hypot(p.x, p.y);
        if (away < 3e-3) on = std::max(on, share[n]);
        if (away > 25e-3) off = std::max(off, share[n]);
    }
    EXPECT_GT(on, 0.95) << "more than four steps";
    EXPECT_LT(off, 0.55) << "guessing, but for the foundation's far and slight upward bow";
}

/// A touch feels the face that it touches, and so does its map, though the other face is nearer than the next place.
TEST(FeltMap, EachFaceOfAThinBodyHasItsOwn)
{
    const SoftObject object = ThinSlab::object();
    PlateSolver      solver("host");
    for (const std::size_t wanted : {60, 1500}) { // cubes that hold both faces, and one each
        const FeltMap map   = feltMap(object, ThinSlab().settings, wanted, solver);
        double        least = 1e9, most = 0, lower = 1e9; // [N/m]
        for (std::size_t n = 0; n < object.size(); ++n) {
            const glm::dvec3 p = object.positions()[n];
            if (!ThinSlab::isInside(p)) continue;
            if (p.z > 0)
                least = std::min(least, map.atPoints[n]), most = std::max(most, map.atPoints[n]);
            else
                lower = std::min(lower, map.atPoints[n]);
        }
        EXPECT_LT(most / least, 1.05) << wanted << ": a face is even";
        EXPECT_GT(lower / most, 1.5) << wanted << ": sqrt(4) on a foundation, less what the contact gives";
    }
}

TEST(FeltMap, WhatCannotBeTouchedIsCountedAndNoPlaceAtAllIsRefused)
{
    std::vector<glm::dvec3> line;
    for (int n = 0; n < 100; ++n) line.push_back({n * 1e-4, 0, 0});
    const SoftObject wire(PointCloud(line, std::vector<double>(100, 1e6), StiffnessKind::modulus));
    PlateSolver      solver("host");
    EXPECT_THROW((void)feltMap(wire, {.window = 5e-3, .cells = 16, .footprintRadius = 1e-3}, 8, solver), Error);
}

} // namespace
} // namespace palp
