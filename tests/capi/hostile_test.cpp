#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <limits>
#include <random>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "engine/capi/palpate.h"
#include "tests/capi/sheet.h"

// Values that no caller means, in structs and arrays that are whole: each gives an answer or a sentence, and no answer
// is a force that is not finite. PALPATE_HOSTILE_ROUNDS in the environment is how many objects are tried [200].

namespace {

int roundsOfThisRun()
{
    const char* const wanted = std::getenv("PALPATE_HOSTILE_ROUNDS");
    return wanted ? std::max(1, std::atoi(wanted)) : 200;
}

class Hostility {
public:
    explicit Hostility(unsigned seed) : random_(seed) {}

    [[nodiscard]] std::size_t below(std::size_t end) { return random_() % end; }
    [[nodiscard]] bool        oneIn(std::size_t count) { return below(count) == 0; }

    /// Returns a number that may be anything.
    [[nodiscard]] double wild()
    {
        constexpr double kInfinite = std::numeric_limits<double>::infinity();
        constexpr auto   kWild =
            std::to_array({0.0, -0.0, 1.0, -1.0, std::numeric_limits<double>::quiet_NaN(), kInfinite, -kInfinite, 1e308,
                           -1e308, 5e-324, 1e-300, 1e-9, 1e9, -1e9, 1e18, 0.5, 3e-3, -3e-3});
        return kWild[below(kWild.size())];
    }
    /// Returns a number up to `size`, seldom a wild one.
    [[nodiscard]] double mostly(double size)
    {
        return oneIn(rarity) ? wild() : size * (2.0 * double(random_()) / double(random_.max()) - 1);
    }
    /// Returns a number from size/2 to 3/2 size, seldom a wild one.
    [[nodiscard]] double about(double size)
    {
        return oneIn(rarity) ? wild() : size * (0.5 + double(random_()) / double(random_.max()));
    }

    std::size_t rarity = 400; ///< one number in as many is wild

private:
    std::mt19937 random_;
};

constexpr double kPlace = 4e-3;                // [m] along x and y, where a hand presses
constexpr double kAbove = 1e-3, kBelow = 5e-4; // [m] how far it goes up and down

void expectAnswer(int code, const char* what)
{
    if (code == PALPATE_OK) return;
    EXPECT_NE(code, PALPATE_BROKEN) << what << ": " << palpate_error_text();
    EXPECT_STRNE(palpate_error_text(), "") << what;
}

constexpr auto kScenes = std::to_array<const char*>(
    {R"({"window": "6 mm", "cells": 8, "footprint_radius": "1 mm", "solver": "host"})",
     R"({"window": "6 mm", "cells": 8, "footprint_radius": "1 mm", "solver": "host", "foundation": "1 MPa/m"})",
     R"({"window": "6 mm", "cells": 8, "footprint_radius": "1 mm", "solver": "host", "foundation": 1e6, "below": "own"})",
     R"({"window": "9 mm", "cells": 16, "footprint_radius": "2 mm", "solver": "host", "foundation": 1e15})",
     R"({"window": "6 mm", "cells": 8, "footprint_radius": "1 mm", "solver": "host", "preset": "paper"})",
     R"({"window": 1e-6, "cells": 8, "footprint_radius": 4e-7, "solver": "host"})",
     R"({"window": 100, "cells": 8, "footprint_radius": 10, "solver": "host", "scatter": "off"})",
     R"({"window": "6 mm", "cells": 8, "footprint_radius": "1 mm", "solver": "host", "thickness": 1, "poisson": -0.9})",
     R"({"window": "6 mm", "cells": 8, "footprint_radius": "1 mm", "solver": "host", "material": "liver"})",
     R"({"window": "6 mm", "cells": 8, "footprint_radius": "1 mm", "solver": "host", "stiffening": 1e5,
         "foundation": "1 MPa/m"})",
     R"({"window": "6 mm", "cells": 8, "footprint_radius": "1 mm", "solver": "host", "edges": "free"})", R"({"wind)",
     R"({"thickness": "a lot"})"});

/// An object of some 80 points, 8 mm a side, or what hostility makes of it; null if it is refused.
palpate_object* anObject(Hostility& h)
{
    h.rarity = h.oneIn(3) ? 100 : 100'000;
    std::vector<double> xyz, stiffness, normals, growth, below;
    const std::size_t   side  = h.oneIn(10) ? h.below(4) : 9;
    const double        scale = h.oneIn(20) ? h.wild() : 1e-3;
    for (std::size_t i = 0; i < side; ++i)
        for (std::size_t j = 0; j < side; ++j) {
            const double x = scale * (double(i) + h.mostly(0.2)), y = scale * (double(j) + h.mostly(0.2));
            xyz.insert(xyz.end(), {x, y, h.mostly(1e-4)});
            stiffness.push_back(h.about(h.oneIn(100) ? 1e30 : 3e5));
            growth.push_back(std::abs(h.about(500)));
            below.push_back(std::abs(h.about(1e6)));
            normals.insert(normals.end(), {h.mostly(0.2), h.mostly(0.2), h.about(1)});
        }
    std::vector<std::uint32_t> faces(3 * h.below(40));
    for (std::uint32_t& corner : faces) corner = std::uint32_t(h.below(side * side + (h.oneIn(5) ? 2 : 0) + 1));
    auto points              = PALPATE_INIT(palpate_points);
    points.count             = xyz.size() / 3;
    points.positions         = xyz.data();
    points.stiffness         = h.oneIn(8) ? nullptr : stiffness.data();
    points.uniform_stiffness = points.stiffness ? 0 : h.wild();
    points.stiffness_kind    = h.oneIn(10) ? int(h.below(5)) - 1 : PALPATE_MODULUS;
    points.normals           = h.oneIn(4) ? normals.data() : nullptr;
    points.faces             = h.oneIn(3) ? faces.data() : nullptr;
    points.face_count        = points.faces || h.oneIn(20) ? faces.size() / 3 : 0;
    points.stiffening        = h.oneIn(3) ? growth.data() : nullptr;
    points.foundation        = h.oneIn(3) ? below.data() : nullptr;
    palpate_object* object   = nullptr;
    const int       code     = palpate_object_from_points(&points, kScenes[h.below(kScenes.size())], &object);
    expectAnswer(code, "from_points");
    EXPECT_EQ(code == PALPATE_OK, object != nullptr);
    return object;
}

void touch(Hostility& h, const palpate_object* object)
{
    h.rarity = 20;
    for (int n = 0; n < 4; ++n) {
        const std::array place{h.about(4e-3), h.about(4e-3), h.mostly(1e-4)},
            side{h.mostly(1), h.mostly(1), h.about(1)};
        auto      result = PALPATE_INIT(palpate_touch_result);
        const int code   = palpate_touch(object, place.data(), h.oneIn(2) ? side.data() : nullptr, &result);
        expectAnswer(code, "touch");
        if (code != PALPATE_OK) continue;
        EXPECT_TRUE(std::isfinite(result.felt_stiffness) && result.felt_stiffness >= 0) << result.felt_stiffness;
        EXPECT_TRUE(std::isfinite(result.compliance) && result.compliance >= 0) << result.compliance;
        std::vector<double> xyz(3 * palpate_object_size(object));
        expectAnswer(
            palpate_touch_displaced(object, place.data(), side.data(), h.mostly(1), xyz.data(), xyz.size() / 3),
            "displaced");
    }
    std::vector<double> felt(palpate_object_size(object));
    if (h.oneIn(10))
        expectAnswer(palpate_felt_map_every(object, h.about(4e-3), felt.data(), felt.size(), nullptr), "map");
}

void run(Hostility& h, const palpate_object* object)
{
    h.rarity                              = 200;
    constexpr std::size_t          kTicks = 60;
    std::array<double, 3 * kTicks> forces{};
    std::array<double, 3>          times{}, heights{1e-3, 1e-3 * h.mostly(1), -3e-4};
    std::array<double, 9>          places{};
    for (std::size_t n = 0; n < 3; ++n) {
        times[n] = 0.03 * double(n) + h.mostly(1e-3);
        for (std::size_t k = 0; k < 2; ++k) places[3 * n + k] = h.about(4e-3);
        places[3 * n + 2] = heights[n] + h.mostly(1e-5);
    }
    const int code = palpate_run(object, times.data(), places.data(), h.below(4), kTicks, forces.data(), nullptr);
    expectAnswer(code, "run");
    for (const double part : forces) EXPECT_TRUE(std::isfinite(part));
}

/// Steps a session whose hand goes down, stays and is up again, with what no hand does in between.
/// \param time  [s] of the last step
/// \param lead  ticks by which it goes down earlier: from 500 on it begins below
/// \return ticks with a force
int stepOn(Hostility& h, palpate_session* session, std::size_t points, double time, int lead)
{
    std::vector<double> xyz(3 * points);
    std::uint64_t       sequence = 0;
    int                 felt     = 0;
    for (int n = 0; n < 3000; ++n) {
        h.rarity = n % 1000 < 500 ? 100'000 : 30;
        time += h.about(1e-3);
        auto hand        = PALPATE_INIT(palpate_hand);
        auto answer      = PALPATE_INIT(palpate_answer);
        hand.position[0] = kPlace + h.mostly(1e-5); // further is a jump, which takes the force
        hand.position[1] = kPlace + h.mostly(1e-5);
        hand.position[2] = kAbove - (kAbove + kBelow) * std::min(1.0, ((n + lead) % 1000) / 500.0) + h.mostly(1e-6);
        for (double& part : hand.velocity) part = h.mostly(0.01);
        hand.age     = h.oneIn(3) ? h.about(1e-3) : 0;
        hand.buttons = h.oneIn(50) ? std::uint32_t(h.below(1U << 20U)) : 0;
        hand.absent  = h.oneIn(100);
        EXPECT_EQ(palpate_session_step(session, h.oneIn(100) ? h.wild() : time, &hand, &answer), PALPATE_OK);
        const double force = std::hypot(answer.force[0], answer.force[1], answer.force[2]);
        EXPECT_LE(force, answer.flags & PALPATE_BAD_INPUT ? 0 : 6.0 + 1e-9) << "max_force, tick " << n; // nor is it NaN
        felt += force > 1e-3;
        if (n % 200 == 0)
            expectAnswer(palpate_session_deformed(session, xyz.data(), xyz.size() / 3, &sequence), "deformed");
        std::array<char, 600> words{};
        if (n % 200 == 0) expectAnswer(palpate_session_words(session, words.data(), words.size()), "words");
        if (n % 200 == 1) expectAnswer(palpate_session_takeover(session, words.data(), words.size()), "takeover");
        if (testing::Test::HasFailure()) break;
    }
    return felt;
}

void step(Hostility& h, const palpate_object* object)
{
    h.rarity      = 10;
    auto settings = PALPATE_INIT(palpate_session_settings);
    if (h.oneIn(2)) settings.device_mass = h.about(0.1);
    if (h.oneIn(2)) settings.device_damping = h.about(1);
    if (h.oneIn(2)) settings.maximum_force = h.about(4);
    if (h.oneIn(2)) settings.maximum_stiffness = h.about(1000);
    palpate_session* session = nullptr;
    expectAnswer(palpate_session_create(object, &settings, &session), "session");
    if (!session) return;
    stepOn(h, session, palpate_object_size(object), 0, 0);
    palpate_session_destroy(session);
}

TEST(Hostile, ObjectsTouchesAndSessionsAnswerOrRefuse)
{
    Hostility h(7);
    int       made = 0;
    for (int n = 0; n < roundsOfThisRun(); ++n) {
        SCOPED_TRACE("round " + std::to_string(n));
        palpate_object* const object = anObject(h);
        if (!object) continue;
        ++made;
        touch(h, object);
        run(h, object);
        if (n % 20 == 0) step(h, object);
        palpate_object_destroy(object);
        if (HasFailure()) return;
    }
    EXPECT_GT(made, roundsOfThisRun() / 4) << "most are meant to be taken";
}

/// Presses in the pace of the thread that solves, until there is a force and a patch.
/// \return when [s]; 0 if that never was
double timeOfPress(palpate_session* session, std::size_t points)
{
    std::vector<double> xyz(3 * points);
    std::uint64_t       patches = 0;
    for (int n = 1; n < 10'000; ++n) {
        auto hand        = PALPATE_INIT(palpate_hand);
        auto answer      = PALPATE_INIT(palpate_answer);
        hand.position[0] = hand.position[1] = kPlace;
        hand.position[2]                    = std::max(-kBelow, kAbove - 1e-5 * n);
        EXPECT_EQ(palpate_session_step(session, 1e-3 * n, &hand, &answer), PALPATE_OK);
        expectAnswer(palpate_session_deformed(session, xyz.data(), points, &patches), "deformed");
        if (patches > 0 && answer.force[2] > 0.01) return 1e-3 * n;
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    return 0;
}

/// Hostile objects hardly ever push, and a force that never flows is always finite.
TEST(Hostile, AHandThatPressesMaySayAnythingNext)
{
    Hostility       h(13);
    palpate_object* object = nullptr;
    ASSERT_EQ(palpate_object_from_scene(kSheet, nullptr, &object), PALPATE_OK) << palpate_error_text();
    const std::size_t points = palpate_object_size(object);
    int               felt   = 0;
    for (int n = 0; n < 5; ++n) {
        palpate_session* session = nullptr;
        ASSERT_EQ(palpate_session_create(object, nullptr, &session), PALPATE_OK) << palpate_error_text();
        const double pressed = timeOfPress(session, points);
        EXPECT_GT(pressed, 0) << "it was never felt";
        felt += stepOn(h, session, points, pressed, 500);
        palpate_session_destroy(session);
    }
    palpate_object_destroy(object);
    EXPECT_GT(felt, 20) << "in each until the first bad tick, of which one in fifty is";
}

TEST(Hostile, PlatesAreSolvedOrRefused)
{
    Hostility h(11);
    int       solved = 0;
    for (int n = 0; n < 5 * roundsOfThisRun(); ++n) {
        SCOPED_TRACE("round " + std::to_string(n));
        h.rarity      = h.oneIn(2) ? 1'000'000 : 60;
        auto plate    = PALPATE_INIT(palpate_plate);
        plate.cells_x = int(4 + h.below(12));
        plate.cells_z = int(4 + h.below(12));
        std::vector<double> D(std::size_t(plate.cells_x + 1) * std::size_t(plate.cells_z + 1)), f(D.size()),
            w(D.size());
        for (double& value : D) value = h.about(1);
        for (double& value : f) value = h.mostly(1);
        plate.size_x     = h.oneIn(20) ? h.wild() : 1;
        plate.size_z     = h.oneIn(20) ? h.wild() : 1;
        plate.poisson    = h.oneIn(20) ? h.wild() : 0.3;
        plate.foundation = h.oneIn(3) ? h.wild() : 0;
        for (int& edge : plate.edges) edge = h.oneIn(30) ? -1 : int(h.below(4));
        plate.rigidity = D.data();
        if (h.oneIn(30)) plate.cells_x = h.oneIn(2) ? -5 : 3; // fewer than the arrays have
        double    error = 0;
        const int code  = palpate_plate_solve(&plate, f.data(), h.oneIn(20) ? h.wild() : 1e-4, w.data(), &error);
        expectAnswer(code, "plate");
        if (code != PALPATE_OK) continue;
        ++solved;
        for (const double value : w) EXPECT_TRUE(std::isfinite(value));
        if (HasFailure()) return;
    }
    EXPECT_GT(solved, roundsOfThisRun() / 2);
}

} // namespace
