#pragma once
#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include <glm/geometric.hpp>

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

/// A hundredfold step on a foundation, felt as 1 to 4; the stiff side is at the cap.
inline Scene stepOfAHundred()
{
    return parseScene(R"({"cloud": "sample:sheet", "points": 40000,
        "stiffness": {"law": "box", "from": 0.1e6, "to": 10e6, "low": [0, -1, -1], "high": [1, 1, 1]},
        "thickness": "4 mm", "poisson": 0.45, "foundation": "1 MPa/m", "window": "61 mm", "cells": 64,
        "footprint_radius": "4 mm", "solver": "host", "deformation_rate": 60, "stiffness_cap": 1000})",
                      "a test", ".");
}

/// A scene with its object, over which hands go in virtual time.
struct SceneSession {
    Scene      scene;
    SoftObject object;

    explicit SceneSession(Scene of) : scene(std::move(of)), object(loadObject(scene).object) {}

    /// \param guesses  the homogeneous law of the place answers until there is a table
    [[nodiscard]] std::vector<TickRecord> run(const HandPath& hand, double seconds, bool guesses = false) const
    {
        std::vector<TickRecord> records;
        Deformation             deformation(object, scene);
        ScriptedHand            device(hand);
        runVirtual({scene, object, deformation.solver(), device, {}, guesses ? deformation.firstLaw() : nullptr},
                   seconds, [&](const TickRecord& s) { records.push_back(s); });
        return records;
    }
};

/// Returns the largest force on the hand from a time on [N].
inline double largestForce(const std::vector<TickRecord>& records, double from = 0)
{
    double most = 0;
    for (const TickRecord& s : records)
        if (s.time > from) most = std::max(most, glm::length(s.force));
    return most;
}

struct SheetSession : SceneSession {
    HandPath hand;

    explicit SheetSession(const Scene& of, HandMotion motion = HandMotion::scan, double seconds = 1.5)
        : SceneSession(of),
          hand(makeHand(
              {.motion = motion, .speed = 0.1, .depth = 1.5e-3, .radius = 10e-3, .height = 2e-3, .duration = seconds},
              handPlace(of, object)))
    {
    }

    /// The hand keeps its depth over a curved object.
    void drape() { hand = draped(hand, handPlace(scene, object), object); }

    [[nodiscard]] std::vector<TickRecord> run(double seconds) const { return SceneSession::run(hand, seconds); }
};

} // namespace palp
