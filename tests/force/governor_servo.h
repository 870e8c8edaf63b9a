#pragma once
#include <limits>
#include <string>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "engine/force/governor.h"

namespace palp {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kRounding = 1e-12;

/// A governor and the input of a healthy tick, which a test then spoils.
struct Servo {
    ForceGovernor governor;
    GovernorInput in;

    explicit Servo(const GovernorSettings& settings = {}) : governor(settings)
    {
        in.homed = in.inBox = true;
        in.dt               = 1e-3;
    }

    GovernorOutput tick() { return governor.step(in); }

    GovernorOutput ticks(int count)
    {
        GovernorOutput out;
        for (int n = 0; n < count; ++n) out = tick();
        return out;
    }

    Servo& engaged()
    {
        EXPECT_EQ(ticks(6 + 10 + 1500).gain, 1) << "6 ms of slew, 10 calm ticks, 1.5 s";
        return *this;
    }

    /// Engaged, and pushing with a force that has been there for long.
    Servo& pushing(const glm::dvec3& force)
    {
        engaged();
        in.force = force;
        EXPECT_EQ(ticks(20).force, force);
        return *this;
    }
};

/// From the next tick on: never larger, no step above 1 N beside the first one, exactly zero after 20 ticks.
inline void expectGoneIn20Ticks(Servo& servo, const std::string& what)
{
    double last = 6;
    for (int n = 0; n < 20; ++n) {
        const double force = glm::length(servo.tick().force);
        EXPECT_LE(force, last + kRounding) << what << ", tick " << n;
        last = force;
    }
    EXPECT_EQ(last, 0) << what;
}

/// Without the terms that a test does not look at.
inline GovernorSettings strictObserver()
{
    GovernorSettings settings;
    settings.ownDamping = 0;
    return settings;
}

} // namespace palp
