#include "samples/sofa/palpate_force_feedback.h"

#include <chrono>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <thread>

#include <gtest/gtest.h>

#include "tests/support/allocations.h"

// On a stand-in of SOFA: see tests/samples/sofa_stub.

namespace {

std::string sheetScene()
{
    const auto path = std::filesystem::path(testing::TempDir()) / "palpate_sofa_sheet.json";
    std::ofstream(path) << R"({"cloud": "sample:sheet", "points": 6000, "stiffness": {"law": "constant", "value": 3e5},
        "thickness": "4 mm", "foundation": "1.74 MPa/m", "window": "40 mm", "cells": 32, "footprint_radius": "3.6 mm",
        "place": [0, 0, 0], "solver": "host"})";
    return path.string();
}

double forceAt(PalpateForceFeedback& feedback, double centimetres)
{
    double x = 7, y = 7, z = 7;
    feedback.computeForce(0, 0, centimetres, 0, 0, 0, 1, x, y, z);
    EXPECT_TRUE(std::isfinite(x) && std::isfinite(y) && std::isfinite(z));
    return z;
}

TEST(SofaForceFeedback, ADriversThreadIsGivenForces)
{
    PalpateForceFeedback feedback;
    EXPECT_EQ(forceAt(feedback, -0.1), 0) << "before init()";
    feedback.d_scene.setValue(sheetScene());
    feedback.d_metres.setValue(0.01);
    feedback.init();
    const auto        begin  = std::chrono::steady_clock::now();
    const std::size_t before = palp::allocationsOfThisThread();
    double            most = 0, now = 0;
    while (now < 4) {
        now  = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
        most = std::max(most, forceAt(feedback, std::max(-0.1, 0.3 - 0.4 * now)));
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    EXPECT_EQ(palp::allocationsOfThisThread(), before);
    EXPECT_GT(most, 0.05) << "1 mm deep; less than 0.47 where a busy machine makes ticks rare";
    EXPECT_LT(most, 0.6);
    EXPECT_EQ(forceAt(feedback, NAN), 0);
}

TEST(SofaForceFeedback, AFaultIsSaidAndTheFirstButtonClearsIt)
{
    PalpateForceFeedback feedback;
    feedback.d_scene.setValue(sheetScene());
    feedback.init();
    const auto ticks = [&](int count) {
        for (int n = 0; n < count; ++n) {
            forceAt(feedback, 5);
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
        }
    };
    ticks(50);
    std::this_thread::sleep_for(std::chrono::milliseconds(500)); // the driver's thread stalls
    ticks(50);
    ASSERT_TRUE(feedback.isStopped());
    EXPECT_NE(feedback.words().find("first button"), std::string::npos) << feedback.words();
    for (int n = 0; n < 20 && feedback.isStopped(); ++n) { // a busy machine may stall anew
        feedback.setButtons(1);
        ticks(200);
        feedback.setButtons(0);
        ticks(10);
    }
    EXPECT_FALSE(feedback.isStopped());
    EXPECT_EQ(feedback.words(), "");
}

TEST(SofaForceFeedback, ASceneThatIsMissingIsASentence)
{
    PalpateForceFeedback feedback;
    feedback.d_scene.setValue("/nowhere.json");
    try {
        feedback.init();
        FAIL() << "nothing was thrown";
    } catch (const std::runtime_error& error) {
        EXPECT_NE(std::string(error.what()).find("nowhere.json"), std::string::npos) << error.what();
    }
}

} // namespace
