#include <atomic>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <random>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "engine/capi/palpate.h"
#include "tests/support/allocations.h"

// What a C program cannot see of the C interface; the claims of one are in capi_program.c.

namespace {

const char* const kSheet = R"({"cloud": "sample:sheet", "points": 6000, "stiffness": {"law": "constant", "value": 3e5},
    "thickness": "4 mm", "poisson": 0.45, "foundation": "1.74 MPa/m", "window": "40 mm", "cells": 32,
    "footprint_radius": "3.6 mm", "place": [0, 0, 0], "solver": "host"})";

struct Object {
    palpate_object* handle = nullptr;

    Object() { EXPECT_EQ(palpate_object_from_scene(kSheet, nullptr, &handle), PALPATE_OK) << palpate_error_text(); }
    Object(const Object&)            = delete;
    Object& operator=(const Object&) = delete;
    ~Object() { palpate_object_destroy(handle); }
};

struct Session {
    palpate_session* handle = nullptr;

    explicit Session(const Object& object)
    {
        EXPECT_EQ(palpate_session_create(object.handle, nullptr, &handle), PALPATE_OK) << palpate_error_text();
    }
    Session(const Session&)            = delete;
    Session& operator=(const Session&) = delete;
    ~Session() { palpate_session_destroy(handle); }

    /// A tick with the hand at a height [m] above the sheet's middle.
    palpate_answer step(double time, double height) const
    {
        auto hand        = PALPATE_INIT(palpate_hand);
        auto answer      = PALPATE_INIT(palpate_answer);
        hand.position[2] = height;
        EXPECT_EQ(palpate_session_step(handle, time, &hand, &answer), PALPATE_OK);
        return answer;
    }
};

/// Where a hand is that goes down 4.5 mm in a second and stays there [m].
double heightAt(double time)
{
    return 3e-3 - 4.5e-3 * std::min(1.0, time);
}

TEST(CInterface, AStepAllocatesNothing)
{
    const Object  object;
    const Session session(object);
    for (int n = 0; n < 50; ++n) session.step(1e-3 * n, heightAt(1e-3 * n));
    const std::size_t before = palp::allocationsOfThisThread();
    for (int n = 50; n < 1500; ++n) {
        auto hand        = PALPATE_INIT(palpate_hand);
        auto answer      = PALPATE_INIT(palpate_answer);
        hand.position[2] = n % 400 == 399 ? NAN : heightAt(1e-3 * n);
        static_cast<void>(palpate_session_step(session.handle, 1e-3 * n, &hand, &answer));
    }
    EXPECT_EQ(palp::allocationsOfThisThread(), before);
}

TEST(CInterface, AHostsLoopFeelsWhatTouchSays)
{
    const Object object;
    auto         felt      = PALPATE_INIT(palpate_touch_result);
    const double middle[3] = {0, 0, 0}, side[3] = {0, 0, 1};
    ASSERT_EQ(palpate_touch(object.handle, middle, side, &felt), PALPATE_OK) << palpate_error_text();

    const Session       session(object);
    const std::size_t   count = palpate_object_size(object.handle);
    std::vector<double> xyz(3 * count);
    std::atomic<bool>   over = false;
    std::uint64_t       seen = 0;
    std::thread         renderer([&] { // beside the loop, as a game's
        while (!over) {
                    EXPECT_EQ(palpate_session_deformed(session.handle, xyz.data(), count, &seen), PALPATE_OK);
                    std::this_thread::sleep_for(std::chrono::milliseconds(5));
        }
    });
    palpate_answer      last{};
    const auto          begin = std::chrono::steady_clock::now();
    for (double time = 0; time < 3.5;) { // the force comes on within 1.5 s
        time = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
        last = session.step(time, heightAt(time));
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    over = true;
    renderer.join();

    EXPECT_TRUE(last.flags & PALPATE_TOUCHING);
    EXPECT_FALSE(last.flags & (PALPATE_STOPPED | PALPATE_WAITING | PALPATE_BAD_INPUT)) << last.fault;
    EXPECT_NEAR(last.depth, 1.5e-3, 5e-5) << "the sheet's points are 2 mm apart";
    EXPECT_NEAR(last.force[2], felt.felt_stiffness * last.depth, 0.03 * last.force[2])
        << "the place of the nearest point against that of the proxy";
    EXPECT_GT(seen, 0u);
    double deepest = 0;
    for (std::size_t n = 0; n < count; ++n) deepest = std::min(deepest, xyz[3 * n + 2]);
    EXPECT_LT(deepest, -0.3 * last.force[2] * felt.compliance);
}

/// Structs of random bytes and sizes give a code and a sentence, and never more.
TEST(CInterface, RandomStructsAreAnswered)
{
    const Object              object;
    const Session             session(object);
    std::mt19937              random(5);
    int                       refused = 0;
    alignas(16) unsigned char bytes[4096];
    for (int n = 0; n < 4000; ++n) {
        for (unsigned char& byte : bytes) byte = static_cast<unsigned char>(random());
        const std::size_t size = random() % 3 == 0 ? random() % 256 : 8 * (random() % 32);
        std::memcpy(bytes, &size, sizeof size);
        auto  answer = PALPATE_INIT(palpate_answer);
        void* any    = bytes;
        refused +=
            palpate_session_step(session.handle, double(n), static_cast<palpate_hand*>(any), &answer) != PALPATE_OK;
        for (const double part : answer.force) ASSERT_TRUE(std::isfinite(part));
        palpate_session* made = nullptr;
        if (n % 20 == 0) {
            const int code = palpate_session_create(object.handle, static_cast<palpate_session_settings*>(any), &made);
            EXPECT_EQ(code == PALPATE_OK, made != nullptr);
            palpate_session_destroy(made);
        }
        // Pointers in these two would be random: they are refused before, or given good ones.
        palpate_plate plate{};
        std::memcpy(&plate, bytes, sizeof plate);
        plate.rigidity = nullptr;
        double w       = 0;
        refused += palpate_plate_solve(&plate, &w, 1e-4, &w, nullptr) != PALPATE_OK;
        palpate_points points{};
        std::memcpy(&points, bytes, sizeof points);
        points.positions = nullptr;
        points.stiffness = points.normals = nullptr;
        points.faces                      = nullptr;
        palpate_object* none              = nullptr;
        refused += palpate_object_from_points(&points, "{}", &none) != PALPATE_OK;
        EXPECT_EQ(none, nullptr);
    }
    EXPECT_GT(refused, 8000) << "plates without rigidity and points without places";
}

TEST(CInterface, SentencesBelongToTheirThread)
{
    palpate_object* none = nullptr;
    EXPECT_EQ(palpate_object_from_scene("{}", nullptr, &none), PALPATE_REFUSED);
    const std::string here = palpate_error_text();
    std::thread([] { EXPECT_STREQ(palpate_error_text(), ""); }).join();
    EXPECT_EQ(palpate_error_text(), here);
    EXPECT_EQ(palpate_object_size(nullptr), 0u);
}

} // namespace
