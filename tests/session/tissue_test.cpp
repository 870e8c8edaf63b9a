#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>

#include <glm/geometric.hpp>

#include "engine/force/depth_law.h"
#include "tests/session/sheet_session.h"
#include "tests/support/errors.h"
#include "tests/support/temporary_folder.h"

// Sessions whose material stiffens with depth, and relaxes.

namespace palp {
namespace {

constexpr double kHover = 1.7, kDown = 0.3, kHeight = 2e-3; // [s] until the force is on, [s], [m]

Scene scene(const std::string& stiffness, double stiffening, const Relaxation& relaxation)
{
    Scene made               = sheetScene(stiffness);
    made.staticFriction      = 0;
    made.dynamicFriction     = 0;
    made.material.stiffening = stiffening;
    made.material.relaxation = relaxation;
    return made;
}

/// Down at one place, to and fro about it, `reach` to either side, and up again in the last 0.3 s if `lifts`.
HandPath handTo(double depth, double seconds, double reach = 0, double frequency = 1, bool lifts = false)
{
    std::vector<HandPose> path;
    const auto            smooth = [](double u) { return u * u * (3 - 2 * u); };
    for (int n = 0; n * 1e-3 <= seconds; ++n) {
        const double time = n * 1e-3, down = smooth(std::clamp((time - kHover) / kDown, 0.0, 1.0));
        const double up     = lifts ? smooth(std::clamp((time - seconds + kDown) / kDown, 0.0, 1.0)) : 0;
        const double last   = lifts ? seconds - kDown : seconds;
        const double stroke = std::clamp(time, kHover + kDown, last) - kHover - kDown;
        path.push_back({time,
                        {-reach * std::cos(stroke * 2 * std::numbers::pi * frequency), 0.7e-3,
                         kHeight - (kHeight + depth) * (down - up)}});
    }
    return HandPath(path);
}

/// Runs over points each of which stiffens as `b` says of its place [1/m].
template <class Law>
std::vector<TickRecord> runOver(const Scene& of, const HandPath& hand, const Law& b)
{
    SheetSession        session(of);
    std::vector<double> stiffening;
    for (const glm::dvec3& p : session.object.positions()) stiffening.push_back(b(p));
    session.object = session.object.withStiffening(std::move(stiffening));
    session.hand   = hand;
    return session.run(hand.waypoints().back().time);
}

std::vector<TickRecord> run(const Scene& of, const HandPath& hand)
{
    SheetSession session(of);
    session.hand = hand;
    return session.run(hand.waypoints().back().time);
}

const char* const kEven = R"({"law": "constant", "value": 2e5})";

double pullOf(const TickRecord& record)
{
    return glm::length(record.proxy - record.hip);
}

TEST(Tissue, TheForceFollowsTheExponentialToTheCapAndTheDentGoesWithTheDepth)
{
    constexpr double              kStiffening = 500;
    const std::vector<TickRecord> spring      = run(scene(kEven, 0, {}), handTo(3e-3, 2.1));
    const std::vector<TickRecord> tissue      = run(scene(kEven, kStiffening, {}), handTo(3e-3, 2.1));

    const DepthLaw law  = DepthLaw::capped(spring.back().stiffness, kStiffening, 1000);
    int            bent = 0;
    double         most = 0; // [N/m]
    for (std::size_t n = 0; n < tissue.size(); ++n) {
        const double depth = pullOf(tissue[n]);
        if (tissue[n].normal == glm::dvec3(0) || depth < 0.2e-3) continue;
        EXPECT_NEAR(glm::length(tissue[n].wanted) / law.force(depth), 1, 1e-3)
            << tissue[n].time << ": the table's error";
        EXPECT_NEAR(tissue[n].stiffness * depth, glm::length(tissue[n].wanted), 1e-12);
        most = std::max(most, law.tangent(depth));
        ++bent;
    }
    EXPECT_GT(bent, 100);
    EXPECT_GT(law.force(3e-3), 1.5 * law.stiffness * 3e-3) << "or nothing was tested";
    EXPECT_NEAR(tissue.back().maxDeflection / spring.back().maxDeflection, 1, 0.02)
        << "the same depth, the same dent; a table may round";
}

TEST(Tissue, WithEverythingOffEachTickIsThePlainSpringInSeries)
{
    // No digest of a session is the same on every processor: what a tick must be is computed here, from k_c and c.
    const HandPath   hand      = handTo(1.5e-3, 2.6);
    constexpr double kRounding = 1e-10; // relative; a stiffening of 1e-3 / m is 7e-7
    const auto       springs   = [&](double stiffening) {
        const Scene even = scene(kEven, stiffening, {});
        int         same = 0;
        for (const TickRecord& record : run(even, hand)) {
            if (pullOf(record) < 1.4e-3 || record.compliance == 0) continue;
            const double radius = even.patch.footprintRadius;
            const double own    = 2e5 * std::numbers::pi * radius * radius / even.material.thickness; // k_c
            const double felt   = 1 / (1 / own + record.compliance);
            same += std::abs(record.stiffness / felt - 1) < kRounding &&
                    glm::length(record.wanted - felt * (record.proxy - record.hip)) <
                        kRounding * glm::length(record.wanted);
        }
        return same;
    };
    EXPECT_GT(springs(0), 500);
    EXPECT_EQ(springs(1e-3), 0);
}

TEST(Tissue, AHeldFingerLosesForceAndNotItsDent)
{
    const Relaxation              meat{{{{0.26, 0.41}, {0.31, 4.3}}}, 2};
    const std::vector<TickRecord> spring = run(scene(kEven, 0, {}), handTo(2e-3, 4));
    const std::vector<TickRecord> tissue = run(scene(kEven, 0, meat), handTo(2e-3, 4));
    const auto                    at     = [](const std::vector<TickRecord>& records, double time) {
        return records[std::size_t(std::llround(time * 1e3)) - 1];
    };

    // The integral of G(t - s) dF_e(s), from the spring's session.
    for (const double end : {1.9, 2.1, 3.0, 3.9}) {
        double force = 0, last = 0;
        for (const TickRecord& record : spring) {
            if (record.time > end) break;
            const double now  = glm::length(record.wanted);
            double       left = 1;
            for (std::size_t n = 0; n < meat.count; ++n)
                left -= meat.terms[n].share * (1 - std::exp(-(end - record.time) / meat.terms[n].time));
            force += left * (now - last);
            last = now;
        }
        EXPECT_NEAR(glm::length(at(tissue, end).wanted) / force, 1, 3e-3) << end << ": half a tick of the press";
    }
    EXPECT_LT(glm::length(at(tissue, 3.9).force), 0.65 * glm::length(at(spring, 3.9).force));
    EXPECT_NEAR(at(tissue, 3.9).maxDeflection / at(spring, 3.9).maxDeflection, 1, 0.01);
    EXPECT_EQ(std::uint32_t(at(tissue, 3.9).faults & 0xFFU), 0u);
}

TEST(Tissue, ALumpPushesSidewaysByTheSlopeOfWhatIsStored)
{
    const char* const kSoft = R"({"law": "gaussian", "from": 1e5, "to": 5e5, "centre": [0, 0, 0], "sigma": 3e-3})";
    constexpr double  kStiffening = 400, kDepth = 1.5e-3, kCycle = 1.6; // [1/m], [m], [s]
    const HandPath    hand               = handTo(kDepth, 2 + kCycle, 10e-3, 1 / kCycle);
    const std::vector<TickRecord> spring = run(scene(kSoft, 0, {}), hand),
                                  tissue = run(scene(kSoft, kStiffening, {}), hand);
    const auto stored = [&](std::size_t n) { return DepthLaw{spring[n].stiffness, kStiffening, 1000}.energy(kDepth); };

    double alike = 0, size = 0, least = 1; // [N^2], [N^2], [N]
    for (std::size_t n = 2050; n + 10 < tissue.size(); ++n) {
        const double way = spring[n + 2].hip.x - spring[n - 2].hip.x; // [m]
        if (std::abs(way) < 0.1e-3) continue;                         // it turns
        const double wanted = -(stored(n + 2) - stored(n - 2)) / way;
        alike += tissue[n].wanted.x * wanted;
        size += wanted * wanted;
        least = std::min(least, wanted);
    }
    EXPECT_LT(least, -0.025) << "or there was no slope";
    EXPECT_NEAR(alike / size, 1, 0.05) << "a chord of four ticks loses 3 %; the lean of a spring is 7 % off";
}

TEST(Tissue, AClosedStrokeOverALumpGivesTheHandNothing)
{
    const Relaxation quick{{{{0.4, 0.1}}}, 1};
    for (const auto& [stiffening, relaxation] :
         {std::pair{300.0, Relaxation{}}, std::pair{0.0, quick}, std::pair{300.0, quick}}) {
        constexpr double              kCycle = 0.8; // [s]
        const std::vector<TickRecord> records =
            run(scene(kWart, stiffening, relaxation), handTo(1.5e-3, 2.3 + 2.5 * kCycle, 10e-3, 1 / kCycle, true));
        double work = 0, most = 0; // [J]
        for (std::size_t n = 1; n < records.size(); ++n) {
            work += glm::dot(records[n].force + records[n - 1].force, records[n].hip - records[n - 1].hip) / 2;
            most = std::max(most, glm::length(records[n].force) * 1.5e-3 / 2);
        }
        std::printf("  b %.0f, %zu terms: %.3f mJ to the hand, of %.2f mJ stored\n", stiffening, relaxation.count,
                    work * 1e3, most * 1e3);
        EXPECT_GT(most, 0.1e-3) << "or nothing was stored that it could give: 0.13 N, where skin alone has 0.4";
        EXPECT_LT(work, 0.01e-3) << stiffening << " " << relaxation.count << ": a force is a tick late";
        EXPECT_GT(work, relaxation.count == 0 ? -0.1e-3 : -most) << "a spring of any law takes as little";
    }
}

TEST(Tissue, PointsThatAllStiffenAlikeAreAMaterialThatDoes)
{
    const HandPath hand     = handTo(2e-3, 3, 6e-3, 1);
    const auto     material = run(scene(kWart, 500, {}), hand);
    const auto     points   = runOver(scene(kWart, 0, {}), hand, [](const glm::dvec3&) { return 500.0; });
    ASSERT_EQ(material.size(), points.size());
    double most = 0, force = 0; // [N]
    for (std::size_t n = 0; n < points.size(); ++n) {
        most  = worse(most, glm::length(points[n].wanted - material[n].wanted));
        force = std::max(force, glm::length(material[n].wanted));
        EXPECT_NEAR(points[n].maxDeflection, material[n].maxDeflection, 1e-7);
    }
    EXPECT_GT(force, 0.5);
    EXPECT_LT(most, 1e-6 * force) << "the points' logarithms are rounded on their way to the nodes";
}

TEST(Tissue, AFingerFeelsWhereTheObjectBeginsToStiffen)
{
    constexpr double              kMost = 700, kDepth = 2e-3; // [1/m], [m]
    const auto                    half   = [](const glm::dvec3& p) { return p.x > 0 ? kMost : 0.0; };
    const HandPath                hand   = handTo(kDepth, 4, 15e-3, 0.5);
    const std::vector<TickRecord> spring = run(scene(kEven, 0, {}), hand), stiff = run(scene(kEven, kMost, {}), hand),
                                  both = runOver(scene(kEven, 0, {}), hand, half);
    double left = 0, right = 0, step = 0;
    for (std::size_t n = 2050; n < both.size(); ++n) {
        const double x = both[n].hip.x, force = glm::length(both[n].wanted);
        step = worse(step, glm::length(both[n].wanted - both[n - 1].wanted));
        if (x < -12e-3) left = worse(left, force / glm::length(spring[n].wanted) - 1);
        if (x > 12e-3) right = worse(right, force / glm::length(stiff[n].wanted) - 1);
    }
    EXPECT_LT(left, 0.01) << "it is the spring where b is 0; the footprint is 4.4 mm wide";
    EXPECT_LT(right, 0.01);
    EXPECT_GT(glm::length(stiff.back().wanted), 1.5 * glm::length(spring.back().wanted)) << "or nothing was tested";
    const double rise = glm::length(stiff.back().wanted) - glm::length(spring.back().wanted); // [N]
    EXPECT_LT(step, 3 * rise * 47e-6 / 8.8e-3)
        << "a tick at 47 mm/s: it rises over the fingertip's width, not at a line";
}

TEST(Tissue, AClosedStrokeIntoWhatStiffensGivesTheHandNothing)
{
    constexpr double kCycle = 0.8;          // [s]
    for (const double sign : {1.0, -1.0}) { // pressed where it is a spring, and where it is not
        const auto                    half = [&](const glm::dvec3& p) { return sign * p.x > 0 ? 600.0 : 0.0; };
        const std::vector<TickRecord> records =
            runOver(scene(kWart, 0, {}), handTo(1.5e-3, 2.3 + 2.5 * kCycle, 10e-3, 1 / kCycle, true), half);
        double work = 0; // [J]
        for (std::size_t n = 1; n < records.size(); ++n)
            work += glm::dot(records[n].force + records[n - 1].force, records[n].hip - records[n - 1].hip) / 2;
        EXPECT_GT(largestForce(records), 0.3) << "or nothing is shown: 1.5 mm of 200 N/m, and it is stiffer everywhere";
        std::printf("  b to the %s: %.4f mJ to the hand\n", sign > 0 ? "right" : "left", work * 1e3);
        EXPECT_LT(work, 0.01e-3) << "a force is a tick late";
        EXPECT_GT(work, -0.3e-3) << "lateral forces give back most of what the depth took";
    }
}

TEST(Tissue, APropertyOfTheFileIsThePointsStiffeningUnlessTheSceneStatesOne)
{
    const TemporaryFolder folder;
    std::string           rows = "x,y,z,stiffness,stiffening\n";
    for (int i = 0; i < 40; ++i)
        for (int j = 0; j < 40; ++j)
            rows +=
                std::to_string(i * 1e-3) + "," + std::to_string(j * 1e-3) + ",0,3e5," + (i < 20 ? "0" : "800") + "\n";
    const std::string head = R"({"cloud": ")" + folder.write("half.csv", rows).string() + R"(", "length_unit": "m")";
    const auto        own  = loadObject(parseScene(head + "}", "a test", "."));
    ASSERT_EQ(own.object.stiffening().size(), 1600u);
    EXPECT_EQ(own.object.stiffening().front(), 0);
    EXPECT_EQ(own.object.stiffening().back(), 800);
    ASSERT_TRUE(own.report.stiffening);
    EXPECT_EQ(own.report.stiffening->largest, 800);
    EXPECT_TRUE(loadObject(parseScene(head + R"(, "stiffening": 100})", "a test", ".")).object.stiffening().empty());
    EXPECT_TRUE(loadObject(parseScene(head + R"(, "material": "liver"})", "a test", ".")).object.stiffening().empty());

    const auto bad = folder.write("bad.csv", "x,y,z,stiffening\n0,0,0,1\n1,0,0,-3\n");
    EXPECT_TRUE(holds(refusalOf([&] { static_cast<void>(readCloud(bad)); }),
                      {"line 3", "point 1", "stiffening from 0 to", "found \"stiffening\" -3"}));
}

/// A sheet of 2 mm that is pressed further than it is thick.
Scene thin(Large large)
{
    Scene made              = scene(kEven, 0, {});
    made.material.thickness = 2e-3;
    made.patch.foundation   = 0;
    made.patch.large        = large;
    return made;
}

TEST(LargeDeflection, AFingerFeelsAFlatSheetHarden)
{
    constexpr double              kDepth  = 2e-3;
    const std::vector<TickRecord> linear  = run(thin(Large::off), handTo(kDepth, 2.3));
    const std::vector<TickRecord> records = run(thin(Large::on), handTo(kDepth, 2.3));
    const double                  K       = linear.back().stiffness;
    EXPECT_NEAR(glm::length(linear.back().wanted) / (K * pullOf(linear.back())), 1, 1e-9);
    // At a depth of one thickness, of which contact and plate have their shares: 1.46 of a clamped plate alone.
    const double hardened = glm::length(records.back().wanted) / (K * pullOf(records.back()));
    EXPECT_GT(hardened, 1.2);
    EXPECT_LT(hardened, 1.5);
    EXPECT_NEAR(records.back().stiffness / K, hardened, 0.01);
    EXPECT_EQ(records.back().faults & static_cast<std::uint32_t>(SessionFlag::beyondTheory), 0U);
    EXPECT_NE(linear.back().faults & static_cast<std::uint32_t>(SessionFlag::beyondTheory), 0U);
    EXPECT_LE(records.back().maxDeflection, 1.1 * kDepth); // at its deepest, not the mean under the fingertip
    EXPECT_GT(records.back().maxDeflection, 0.8 * kDepth);
}

TEST(LargeDeflection, AClosedStrokeGivesTheHandNothing)
{
    constexpr double kCycle = 0.8; // [s]
    Scene            wart   = thin(Large::on);
    wart.stiffness          = scene(kWart, 0, {}).stiffness;
    const auto records      = run(wart, handTo(2e-3, 2.3 + 2.5 * kCycle, 10e-3, 1 / kCycle, true));
    double     work = 0, most = 0; // [J]
    for (std::size_t n = 1; n < records.size(); ++n) {
        work += glm::dot(records[n].force + records[n - 1].force, records[n].hip - records[n - 1].hip) / 2;
        most = std::max(most, glm::length(records[n].force) * 2e-3 / 2);
    }
    std::printf("  %.4f mJ to the hand, of %.3f mJ stored\n", work * 1e3, most * 1e3);
    EXPECT_GT(most, 0.005e-3) << "or nothing was stored: skin alone, held 35 mm off, has 9 N/m, which are 0.018 mJ";
    EXPECT_LT(work, 0.01e-3) << "a force is a tick late";
}

} // namespace
} // namespace palp
