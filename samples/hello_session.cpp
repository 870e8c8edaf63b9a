// A hand presses a soft sheet 1000 times a second, and the largest force on it is printed.
#include <cstdio>
#include <exception>

#include "engine/session/deformation.h"
#include "engine/session/scripted_hand.h"
#include "engine/session/virtual_session.h"

constexpr const char* kScene = R"({
    "cloud": "sample:sheet", "points": 4000, "window": "70 mm", "cells": 32, "foundation": "1.74 MPa/m"
})";

int main()
try {
    // What is touched. readScene() reads the same from a file.
    const palp::Scene      scene  = palp::parseScene(kScene, "hello_session", ".");
    const palp::SoftObject object = palp::loadObject(scene).object;

    // The slow half of a session solves a plate 60 times a second and hands the servo a table of compliances.
    palp::Deformation deformation(object, scene);

    // The hand: 1.5 mm deep and up again, from 2 mm above the surface. Any HapticDevice can stand here.
    const palp::HandScript script{.motion = palp::HandMotion::press, .depth = 1.5e-3, .height = 2e-3, .duration = 3};
    const palp::HandPath   path = palp::makeHand(script, palp::handPlace(scene, object));
    palp::ScriptedHand     hand(path);

    // The same ticks on a virtual clock, as fast as they go; runReal() takes the same parts in real time.
    const palp::SessionSummary summary =
        palp::runVirtual({scene, object, deformation.solver(), hand, {}}, script.duration);

    std::printf("at most %.3g N in %llu ticks\n", summary.mostForce, static_cast<unsigned long long>(summary.ticks));
    return summary.fault == palp::GovernorFault::none && summary.mostForce > 0 ? 0 : 1;
} catch (const std::exception& error) {
    std::fprintf(stderr, "hello_session: %s\n", error.what());
    return 1;
}
