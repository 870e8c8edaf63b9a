#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "engine/force/force_law.h"

namespace palp {
namespace {

constexpr double kMass = 0.46, kDamping = 3.2; // of a Falcon's arm, as our own prototype has it [kg], [N s/m]
constexpr double kTick = 1e-3;                 // the force is held so long, and one sample late [s]
constexpr double kCap  = 1000;                 // what the governor lets through at this damping [N/m]

/// A mass that is let go 2 mm deep, or pressed there by `hand` [N/m] without damping: largest depth [m] in the last
/// half second of two. The spring pushes both ways: there is no lifting off that would hide an oscillation.
template <class Force>
double leftAfterTwoSeconds(Force force, double hand)
{
    constexpr int kParts = 20;                                           // of a tick, for the mass [1]
    double        depth = 2e-3, speed = 0, held = 0, next = 0, left = 0; // [m], [m/s], [N], [m]
    for (int n = 0; n < 2000; ++n) {
        held = next;
        next = force(depth);
        if (!std::isfinite(next) || std::abs(depth) > 1) return HUGE_VAL;
        for (int part = 0; part < kParts; ++part) { // half-implicit Euler: keeps the energy of an oscillation
            speed += (-held - kDamping * speed - hand * depth) / kMass * kTick / kParts;
            depth += speed * kTick / kParts;
        }
        if (n >= 1500) left = std::max(left, std::abs(depth));
    }
    return left;
}

TEST(SeriesLaw, IsStableForPlatesFromAHundredthToAThousandTimesAsSoftAsTheContact)
{
    for (double contact : {300.0, 3e3, 3e4, 1e6})
        for (double ratio : {0.01, 0.1, 1.0, 10.0, 100.0, 1000.0})
            for (double hand : {0.0, 150.0, 500.0}) {
                const double stiffness = std::min(kCap, feltStiffness(ForceLaw::series, contact, ratio / contact));
                const double left      = leftAfterTwoSeconds([&](double depth) { return stiffness * depth; }, hand);
                // An oscillation decays with (damping - 1.5 ticks of stiffness) / (2 mass) >= 1.8 /s, to 6 % after
                // 1.5 s; a mass that nothing much pulls back creeps home.
                EXPECT_LT(left, (stiffness + hand > 10 ? 0.1 : 0.9) * 2e-3)
                    << "k_c " << contact << ", k_c c " << ratio << ", hand " << hand;
            }
}

/// Where the law of one thread waits for the other's answer, the deflection under the last force is what counts:
/// F_n = k_c (depth - c F_(n-1)), whose factor is -k_c c.
TEST(SeriesLaw, TheIterationBetweenTwoThreadsDivergesWhereThePlateIsTheSofterSpring)
{
    const auto iterate = [](double ratio) {
        return [ratio, force = 0.0](double depth) mutable {
            constexpr double kContact = 3e3; // [N/m]
            force                     = kContact * (depth - ratio / kContact * force);
            return force;
        };
    };
    for (double ratio : {1.1, 3.0, 10.0, 100.0})
        for (double hand : {0.0, 500.0}) EXPECT_EQ(leftAfterTwoSeconds(iterate(ratio), hand), HUGE_VAL) << ratio;

    // Even with the hand nailed down; in series it is there at once.
    auto         naive = iterate(3);
    double       worst = 0;
    const double exact = feltStiffness(ForceLaw::series, 3e3, 3 / 3e3) * 1e-3;
    for (int n = 0; n < 20; ++n) worst = std::max(worst, std::abs(naive(1e-3) - exact));
    EXPECT_GT(worst, 1e6 * exact);
    EXPECT_NEAR(exact, 0.75, 1e-12) << "3 kN/m and three times as soft a plate, 1 mm deep";
}

} // namespace
} // namespace palp
