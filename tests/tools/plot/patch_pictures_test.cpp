#include "engine/tools/plot/patch_pictures.h"

#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "engine/pipeline/deform.h"
#include "tests/tools/plot/svg_reader.h"

namespace palp {
namespace {

using test::hasText;

/// A sheet of 40 x 20 mm, held at one end.
SoftObject strip()
{
    std::vector<glm::dvec3> points;
    std::vector<double>     held;
    for (int i = 0; i < 40; ++i)
        for (int j = 0; j < 20; ++j) {
            points.emplace_back(1e-3 * i, 1e-3 * j, 0);
            held.push_back(i < 8);
        }
    std::vector<double> moduli(points.size(), 1e6);
    return SoftObject(PointCloud(std::move(points), std::move(moduli), StiffnessKind::modulus),
                      {.thickness = 1e-3, .poissonRatio = 0.45})
        .withHeld(std::move(held));
}

TEST(PatchPictures, OfAnObjectThatTheWindowSpansTheyShowTheSheetAlone)
{
    PlateSolver         host("host");
    const PatchSettings settings{.windowOf = WindowOf::object};
    const Patch         patch     = deform(strip(), {{24e-3, 10e-3, 0}, {0, 0, 1}}, settings, host);
    const std::string   rigidity  = rigidityChartSvg(patch, settings, "rigidity"),
                      deflections = deflectionChartSvg(patch, settings, 1, "deflection", 0);
    for (const std::string* picture : {&rigidity, &deflections}) EXPECT_TRUE(hasText(*picture, "beyond the border"));
    EXPECT_TRUE(hasText(rigidity, "constant 104 \u00b5N m")) << "next to nothing beyond the border is no rigidity";

    const Patch cut = deform(strip(), {{24e-3, 10e-3, 0}, {0, 0, 1}}, {.window = 12e-3}, host);
    EXPECT_FALSE(hasText(rigidityChartSvg(cut, {.window = 12e-3}, "rigidity"), "beyond the border"));
}

} // namespace
} // namespace palp
