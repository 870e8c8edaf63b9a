// Noise as scans have it: a plane of random points, pressed 2 spacings deep and slid over at 0.1 spacings per tick, as
// a hand does at 50 mm/s and 1 mm deep where points are 0.5 mm apart. Lengths are in spacings.
#include <algorithm>
#include <cmath>
#include <numeric>

#include <gtest/gtest.h>

#include "tests/contact/proxy_scenes.h"

namespace palp {
namespace {

using namespace proxytest;

constexpr double kDepth = 2;
constexpr double kSpeed = 0.1;

/// What a hand feels on three tracks.
struct Felt {
    int    lost    = 0; ///< ticks without contact
    double error   = 0; ///< [1] of the mean pull of a track, the worst
    double bias    = 0; ///< [1] error of the mean pull of all tracks
    double ripple  = 0; ///< [1] standard deviation of the pull about its track's mean, over the depth
    double step    = 0; ///< [spacings] largest change of the depth that is felt, in a tick
    double lateral = 0; ///< [spacings] largest pull along the plane
};

void PrintTo(const Felt& felt, std::ostream* out)
{
    *out << "lost " << felt.lost << ", error " << 100 * felt.error << " %, bias " << 100 * felt.bias << " %, ripple "
         << 100 * felt.ripple << " %, step " << felt.step << ", lateral " << felt.lateral;
}

enum class Scatter { across, everyWay };

/// \param thickness  of a body whose other face lies below [spacings]; 0: there is none
Points noisyPlane(double deviation, Scatter scatter, std::uint64_t seed, double thickness)
{
    // The largest fit reaches 45 spacings; a border must not count.
    const double margin = 10 + 25 * deviation;
    Sheet        sheet(Layout::random, seed);
    Points       points = sheet.over(-40 - margin, 40 + margin, -margin, margin);
    if (thickness > 0) append(points, sheet.over(-40 - margin, 40 + margin, -margin, margin), {0, 0, -thickness});
    std::normal_distribution<> normal(0, deviation);
    for (glm::dvec3& p : points) {
        if (scatter == Scatter::everyWay) p += glm::dvec3(normal(sheet.random()), normal(sheet.random()), 0);
        p.z += normal(sheet.random());
    }
    return points;
}

Felt feel(double deviation, Scatter scatter = Scatter::across, double thickness = 0)
{
    constexpr int kTracks = 3;
    Felt          felt;
    double        square = 0;
    for (int track = 0; track < kTracks; ++track) {
        Touch touch(noisyPlane(deviation, scatter, kFirstSeed + std::uint64_t(track), thickness), {},
                    {3.7, -2.9, 13.3});
        touch.start({-40, 0.3, 5 + 4 * deviation});
        touch.move({-40, 0.3, -kDepth}, 0.04);
        touch.move({-35, 0.3, -kDepth}, kSpeed); // the way in is not part of the track
        std::vector<double> pulls;
        double              before = touch.pull().z;
        touch.move({35, 0.3, -kDepth}, kSpeed, [&] {
            const glm::dvec3 pull = touch.pull();
            felt.lost += !touch.touching();
            felt.step    = std::max(felt.step, std::abs(pull.z - before));
            felt.lateral = std::max(felt.lateral, std::hypot(pull.x, pull.y));
            before       = pull.z;
            pulls.push_back(pull.z);
        });
        const double mean = std::accumulate(pulls.begin(), pulls.end(), 0.0) / double(pulls.size());
        for (const double pull : pulls) square += (pull - mean) * (pull - mean) / double(kTracks * pulls.size());
        felt.error = std::max(felt.error, std::abs(mean / kDepth - 1));
        felt.bias += (mean / kDepth - 1) / kTracks;
    }
    felt.ripple = std::sqrt(square) / kDepth;
    return felt;
}

/// 5 mN per millisecond where 1 mm is felt as 0.485 N and points are 0.5 mm apart: what a finger does not notice.
constexpr double kSmoothStep = 0.0206;

TEST(ProxyNoise, NoPhantomCeilingSinksTheFloor)
{
    // Points that noise lifts by more than a plane's fit counts fully were taken for another surface, from below: at
    // 0.3 the floor sank by 16 %, and a wall held the hand.
    const Felt some = feel(0.2), more = feel(0.3);
    SCOPED_TRACE(record(testing::PrintToString(some), "0.2") + "; " + record(testing::PrintToString(more), "0.3"));
    EXPECT_EQ(some.lost + more.lost, 0);
    for (const Felt& felt : {some, more}) {
        EXPECT_LT(felt.error, 0.01);
        EXPECT_LT(felt.ripple, 0.01) << "recorded: 0.7 and 0.95 %; a touch scale of eight times the noise has 1.3 %";
        EXPECT_LT(felt.step, 0.25 * kSmoothStep) << "recorded: 0.0024; without the touch scale 0.019";
    }
}

TEST(ProxyNoise, NoiseIsAveragedOverATouchScale)
{
    for (const Scatter scatter : {Scatter::across, Scatter::everyWay})
        for (const double deviation : {0.3, 0.5, 1.0, 2.0}) {
            const Felt        felt = feel(deviation, scatter);
            const std::string name =
                std::to_string(deviation) + (scatter == Scatter::across ? " across" : " every way");
            SCOPED_TRACE(record(testing::PrintToString(felt), name));
            EXPECT_EQ(felt.lost, 0);
            EXPECT_LT(felt.error, 0.03) << "0.029 spacings are 1.5 % of the depth, twice that is the worst of eight";
            EXPECT_LT(felt.ripple, 0.02);
            EXPECT_LT(felt.step, kSmoothStep);
            EXPECT_LT(felt.lateral, 0.2) << "0.1 mm where points are 0.5 mm apart: no sideways grab";
        }
}

TEST(ProxyNoise, TheOtherFaceOfAThinBodyIsNoNoise)
{
    // The other face was taken for noise, or for a sign that there is none: at 4 spacings and noise of 0.5 the ripple
    // was 5.1 %, with steps of 0.038.
    struct Body {
        double thickness, noise; ///< [spacings]
        double error, ripple;    ///< [1] allowed
    };
    constexpr double kError = 0.03, kRipple = 0.02;
    for (const Body& body : {Body{2, 0.3, kError, kRipple},
                             {2, 0.5, kError, kRipple},
                             {4, 0.3, kError, kRipple},
                             {4, 0.5, kError, kRipple},
                             {8, 0.5, kError, kRipple},
                             // The touch scale spans the body; of twelve tracks one is 4 % low, the others 1 %.
                             {8, 1.0, 0.05, 0.04}}) {
        const Felt felt = feel(body.noise, Scatter::across, body.thickness);
        SCOPED_TRACE(record(testing::PrintToString(felt),
                            std::to_string(body.thickness) + " thick, " + std::to_string(body.noise)));
        EXPECT_EQ(felt.lost, 0);
        EXPECT_LT(felt.error, body.error);
        EXPECT_LT(felt.ripple, body.ripple);
        EXPECT_LT(felt.step, kSmoothStep);
        EXPECT_LT(felt.lateral, 0.2);
    }
}

/// Height of the proxy over a ball of radius 60, mean over a slide of 20.
double heightOnBall(double deviation, std::uint64_t seed)
{
    constexpr double           kRadius = 60;
    Points                     points  = ball(Layout::random, kRadius, 1.3, seed);
    std::mt19937_64            random(seed);
    std::normal_distribution<> normal(0, deviation);
    for (glm::dvec3& p : points) p += glm::dvec3(normal(random), normal(random), normal(random));
    Touch            touch(points);
    const glm::dvec3 middle(0, 0, -kRadius);
    const auto       at = [&](double angle, double r) {
        return middle + r * glm::dvec3(std::sin(angle), 0, std::cos(angle));
    };
    touch.start(at(-10 / kRadius, kRadius + 5 + 4 * deviation));
    touch.move(at(-10 / kRadius, kRadius - kDepth), 0.1);
    double sum = 0;
    for (int tick = 1; tick <= 200; ++tick) {
        touch.step(at((0.1 * tick - 10) / kRadius, kRadius - kDepth));
        sum += touch.touching() ? glm::length(touch.at() - middle) - kRadius : HUGE_VAL;
    }
    return sum / 200;
}

TEST(ProxyNoise, ANoisyBallIsNotFlattened)
{
    for (const auto& [deviation, most] : {std::pair(0.5, 0.1), {1.0, 0.1}, {2.0, 0.3}}) {
        double sum = 0;
        for (std::uint64_t seed = kFirstSeed; seed < kFirstSeed + 4; ++seed) sum += heightOnBall(deviation, seed) / 4;
        SCOPED_TRACE(record(std::to_string(sum), "height at " + std::to_string(deviation)));
        EXPECT_LT(std::abs(sum), most);
    }
}

TEST(ProxyNoise, CleanPointsStayAsTheyAre)
{
    // Beside noise of 0.6 a clean half keeps its points, and the border between them is not felt as one.
    Sheet  sheet(Layout::random, 2);
    Points points = sheet.over(-40, 0, -20, 20), noisy = sheet.over(0, 40, -20, 20);
    addNoise(noisy, 0.6, sheet.random());
    append(points, noisy);
    Touch       touch(points, {}, {3.7, -2.9, 13.3});
    const Slide clean = slideFlat(touch, {-30, 0.3, 0}, {20, 0, 0}, 2, 0.1);
    EXPECT_LT(clean.ripple(), 1e-9);
    for (const double way : {-30.0, 30.0}) {
        const Slide slide = slideFlat(touch, {-0.5 * way, 0.3, 0}, {way, 0, 0}, 2, 0.1);
        SCOPED_TRACE(record("ripple " + std::to_string(slide.ripple()) + ", step " + std::to_string(slide.forceStep),
                            "way " + std::to_string(way)));
        EXPECT_TRUE(slide.held());
        EXPECT_LT(slide.forceStep, 0.2) << "a tenth of the depth";
    }
}

} // namespace
} // namespace palp
