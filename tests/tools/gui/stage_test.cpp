#include "engine/tools/gui/stage.h"

#include <gtest/gtest.h>

#include "engine/core/contract.h"

namespace palp {
namespace {

Scene sceneOf(const std::string& more = "")
{
    return parseScene(R"({"cloud": "sample:sheet", "points": 4000, "cells": 32, "solver": "host")" + more + "}",
                      "a test", ".");
}

Touch touchOf(const Stage& stage)
{
    Touch touch;
    touch.sequence = 1;
    touch.touching = true;
    touch.point    = stage.place().point;
    touch.outward  = stage.place().outward;
    return touch;
}

double complianceAt(Stage& stage)
{
    const DeformationAnswer answer = stage.solver()(touchOf(stage), 1.0 / 60);
    return answer.patch ? answer.patch->compliance : 0;
}

TEST(Stage, PaintIsFeltWithTheNextPatchAndSoIsTakingItBack)
{
    Stage        stage(sceneOf());
    const double before = complianceAt(stage);
    ASSERT_GT(before, 0);
    const Brush brush{stage.place().point, 20e-3, 1};
    stage.paint([&](StiffnessPainting& painting) { painting.paint(brush, 30e6); });
    EXPECT_LT(complianceAt(stage), 0.5 * before) << "far stiffer around the finger";
    stage.paint([](StiffnessPainting& painting) { painting.undo(); });
    EXPECT_EQ(complianceAt(stage), before) << "to the bit";
}

/// What answers until a session's first table.
TEST(Stage, TheFirstTouchOfASessionFeelsThePaintToo)
{
    Stage        stage(sceneOf());
    const auto   lnCompliance = [&] { return stage.firstLaw()->at(stage.place().point)->lnCompliance; };
    const double before       = lnCompliance();
    const Brush  brush{stage.place().point, 20e-3, 1};
    stage.paint([&](StiffnessPainting& painting) { painting.paint(brush, 30e6); });
    EXPECT_LT(lnCompliance(), before - 0.7) << "less than half, painted between two sessions";
    stage.paint([](StiffnessPainting& painting) { painting.undo(); });
    static_cast<void>(complianceAt(stage)); // taken by the deformation's thread, in a session
    EXPECT_EQ(lnCompliance(), before) << "to the bit";
}

TEST(Stage, OtherValuesChangeThePlateAndKeepThePaint)
{
    Stage       stage(sceneOf());
    const Brush brush{stage.place().point, 20e-3, 1};
    stage.paint([&](StiffnessPainting& painting) { painting.paint(brush, 30e6); });
    const double thin = complianceAt(stage);
    stage.change(sceneOf(R"(, "thickness": "8 mm")"));
    EXPECT_LT(complianceAt(stage), thin);
    EXPECT_TRUE(stage.painting().changed());
}

TEST(Stage, ValuesThatCannotBeSolvedChangeNothing)
{
    Stage        stage(sceneOf());
    const double before = complianceAt(stage);
    Scene        broken = stage.scene();
    broken.solver       = "no such processor";
    EXPECT_THROW(stage.change(broken), Error);
    EXPECT_EQ(complianceAt(stage), before);
    EXPECT_EQ(stage.scene().solver, "host");
}

TEST(Stage, APlaceOffTheObjectBecomesItsUppermostPoint)
{
    Stage stage(sceneOf(R"(, "place": [9, 9, 9])"));
    for (const glm::dvec3& point : stage.object().positions()) EXPECT_LE(point.z, stage.place().point.z);
}

} // namespace
} // namespace palp
