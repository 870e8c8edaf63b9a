// An arm with a law's force held for a tick and a tick late, in virtual time.
#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "engine/force/compliance_tracker.h"
#include "engine/force/force_law.h"
#include "tests/support/published_tables.h"

namespace palp {
namespace {

constexpr double kMass = 0.46, kDamping = 3.2; // of a Falcon's arm, as our own prototype has it [kg], [N s/m]
constexpr double kTick = 1e-3;                 // the force is held so long, and is as late [s]
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

/// Without the governor it is the law that keeps the stiffness down. An oscillation grows where the force's delay, 1.5
/// ticks in the mean, feeds more in than the arm takes out: above damping / (1.5 ticks), 2.1 kN/m.
TEST(SeriesLaw, UncappedIsStableBelowWhatTheArmBearsAndNotAbove)
{
    constexpr double kBorder = kDamping / (1.5 * kTick); // [N/m]
    int              stable = 0, unstable = 0;
    for (double contact : {300.0, 3e3, 3e4, 1e6})
        for (double ratio : {0.01, 0.1, 1.0, 3.0, 10.0, 30.0, 100.0, 1000.0}) {
            const double felt = contact / (1 + ratio); // springs in series, not asked from the law that is tested
            if (felt > 0.8 * kBorder && felt < 1.25 * kBorder) continue;
            const double stiffness = feltStiffness(ForceLaw::series, contact, ratio / contact);
            const double left      = leftAfterTwoSeconds([&](double depth) { return stiffness * depth; }, 0);
            EXPECT_EQ(left < 2e-3, felt < kBorder) << "k_c " << contact << ", k_c c " << ratio << ": " << left << " m";
            (felt < kBorder ? stable : unstable) += 1;
        }
    EXPECT_GT(stable, 10);
    EXPECT_GT(unstable, 5) << "where k_c alone would be felt, 1 MN/m, nothing bears it";
}

/// c as the deformation thread might send it at its worst: wrong by a random factor of 1/4 to 4 in every patch, a patch
/// every 8 to 67 ms and one patch late. Largest depth [m] in the last half second of two.
double leftWithWrongCompliance(double contact, double ratio, ComplianceLaw law, double cap, std::uint64_t seed)
{
    std::mt19937_64                  random(seed);
    std::uniform_real_distribution<> factor(-std::log(4.0), std::log(4.0)), period(8e-3, 67e-3);
    ComplianceTracker                handOver(law);
    PublishedTables                  places;
    ComplianceTable                  coming, newest;
    const auto                       draw = [&](double now) {
        coming.sequence += 1;
        coming.time    = now;
        coming.side    = 3;
        coming.spacing = 4e-3;
        const double c = std::log(ratio / contact) + factor(random);
        for (std::size_t n = 0; n < 9; ++n) {
            coming.compliance[n]       = {c, 0, 0};
            coming.contactStiffness[n] = {std::log(contact), 0, 0};
        }
    };
    double now = 0, next = 0;
    draw(now);
    return leftAfterTwoSeconds(
        [&](double depth) {
            if (now >= next) {
                newest = coming;
                draw(now);
                next = now + period(random);
            }
            const auto handed = handOver.tick({{}, now, kTick, places.place(newest, handOver)});
            now += kTick;
            if (!handed) return HUGE_VAL;
            return std::min(cap, feltStiffness(ForceLaw::series, handed->contactStiffness, handed->compliance)) * depth;
        },
        0);
}

/// The stiffness changes, the depth it acts on does not: what a jump can feed in is bounded, and the damping takes it
/// out between jumps.
TEST(SeriesLaw, AComplianceThatIsLateAndWrongByAFactorOfFourDoesNotFeedAnOscillation)
{
    for (const ComplianceLaw law : {ComplianceLaw::table, ComplianceLaw::hold, ComplianceLaw::blend})
        for (double contact : {3e3, 3e4, 1e6})
            for (double ratio : {1.0, 10.0, 100.0, 1000.0})
                for (std::uint64_t seed = 1; seed <= 10; ++seed)
                    EXPECT_LT(leftWithWrongCompliance(contact, ratio, law, kCap, seed), 2e-3)
                        << name(law) << ", k_c " << contact << ", k_c c " << ratio << ", seed " << seed;
    // The same hand-over, of a plate that is too stiff for the arm even when c is right: the cap is what held it.
    for (std::uint64_t seed = 1; seed <= 10; ++seed)
        EXPECT_GT(leftWithWrongCompliance(1e6, 30, ComplianceLaw::table, HUGE_VAL, seed), 0.1) << seed;
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
