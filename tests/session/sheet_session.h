#pragma once
#include <string>
#include <vector>

#include "engine/session/deformation.h"
#include "engine/session/scripted_hand.h"
#include "engine/session/virtual_session.h"

namespace palp {

/// A flat, soft sheet on tissue, half as large as the sample scenes' and with a coarser grid: a test is not a
/// benchmark.
inline Scene sheetScene(const std::string& stiffness, const std::string& device = "host")
{
    const std::string text = R"({"cloud": "sample:sheet", "points": 4000, "thickness": "4 mm", "poisson": 0.45,
        "foundation": "1.74 MPa/m", "window": "70 mm", "cells": 32, "footprint_radius": "4.4 mm", "stiffness": )" +
                             stiffness + R"(, "solver": ")" + device + "\"}";
    return parseScene(text, "a test", ".");
}

inline const char* const kWart = R"({"law": "gaussian", "from": 0.3e6, "to": 3e6, "centre": [0, 0, 0], "sigma": 3e-3})";

struct SheetSession {
    Scene      scene;
    SoftObject object;
    HandPath   hand;

    explicit SheetSession(const Scene& of, HandMotion motion = HandMotion::scan, double seconds = 1.5)
        : scene(of), object(loadObject(of).object),
          hand(makeHand(
              {.motion = motion, .speed = 0.1, .depth = 1.5e-3, .radius = 10e-3, .height = 2e-3, .duration = seconds},
              handPlace(of, object)))
    {
    }

    /// The hand keeps its depth over a curved object.
    void drape() { hand = draped(hand, handPlace(scene, object), object); }

    std::vector<TickRecord> run(double seconds) const
    {
        std::vector<TickRecord> records;
        Deformation             deformation(object, scene);
        ScriptedHand            device(hand);
        runVirtual({scene, object, deformation.solver(), device, {}}, seconds,
                   [&](const TickRecord& s) { records.push_back(s); });
        return records;
    }
};

} // namespace palp
