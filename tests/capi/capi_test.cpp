#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <random>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "engine/capi/palpate.h"
#include "tests/capi/sheet.h"
#include "tests/support/allocations.h"

// What a C program cannot see of the C interface; the claims of one are in capi_program.c.

namespace {

struct Object {
    palpate_object* handle = nullptr;

    explicit Object(const std::string& scene = kSheet)
    {
        EXPECT_EQ(palpate_object_from_scene(scene.c_str(), nullptr, &handle), PALPATE_OK) << palpate_error_text();
    }
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

/// How deep the deepest of points is [m].
double deepestOf(const std::vector<double>& xyz)
{
    double deepest = 0;
    for (std::size_t n = 2; n < xyz.size(); n += 3) deepest = std::max(deepest, -xyz[n]);
    return deepest;
}

TEST(CInterface, AStepAllocatesNothing)
{
    const Object  object;
    const Session session(object);
    for (int n = 0; n < 50; ++n) session.step(1e-3 * n, heightAt(1e-3 * n));
    const std::size_t before = palp::allocationsOfThisThread();
    double            felt   = 0;     // [N] long after the contact has begun
    for (int n = 50; n < 3000; ++n) { // the force comes on within 1.5 s, and a bad tick takes it
        auto hand        = PALPATE_INIT(palpate_hand);
        auto answer      = PALPATE_INIT(palpate_answer);
        hand.position[2] = n > 2000 && n % 400 == 399 ? NAN : heightAt(1e-3 * n);
        static_cast<void>(palpate_session_step(session.handle, 1e-3 * n, &hand, &answer));
        if (n > 1500 && !(answer.flags & PALPATE_NO_PATCH)) felt = std::max(felt, answer.force[2]);
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    EXPECT_EQ(palp::allocationsOfThisThread(), before);
    EXPECT_GT(felt, 0.2) << "or nothing is shown: 1.5 mm into the sheet are 0.7 N, by a plate's answer";
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
    double              time = 0;    // the hand's clock is slower than ours, so that a busy machine keeps up
    for (int n = 0; n < 3000; ++n) { // the force comes on within 1.5 s
        time = 1e-3 * n;
        last = session.step(time, heightAt(time));
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    over = true;
    renderer.join();
    const std::uint64_t dented = seen;
    std::vector<double> after  = xyz;
    session.step(time + 1e-3, 0.1); // the hand is gone at once: no patch follows
    EXPECT_EQ(palpate_session_deformed(session.handle, after.data(), count, &seen), PALPATE_OK);
    EXPECT_GT(seen, dented) << "a renderer hears that the force has ended";
    double left = 0;
    for (std::size_t n = 0; n < count; ++n) left = std::max(left, std::abs(after[3 * n + 2]));
    EXPECT_LT(left, 1e-12) << "the sheet is flat again";

    EXPECT_TRUE(last.flags & PALPATE_TOUCHING);
    EXPECT_FALSE(last.flags & (PALPATE_STOPPED | PALPATE_WAITING | PALPATE_BAD_INPUT)) << last.fault;
    EXPECT_NEAR(last.depth, 1.5e-3, 5e-5) << "the sheet's points are 2 mm apart";
    EXPECT_NEAR(last.force[2], felt.felt_stiffness * last.depth, 0.03 * last.force[2])
        << "the place of the nearest point against that of the proxy";
    EXPECT_GT(dented, 0u);
    EXPECT_GT(deepestOf(xyz), 0.3 * last.force[2] * felt.compliance);
}

/// A force that stiffens with depth dents as deep as the hand is, not as deep as a spring would let that force go.
TEST(CInterface, ADentIsAsDeepAsTheHandWhereTheSheetStiffens)
{
    const std::string sheet(kSheet, std::strlen(kSheet) - 1);
    const double      middle[3] = {0, 0, 0}, side[3] = {0, 0, 1};
    const Object      object(sheet + R"(, "stiffening": 800})"), large(sheet + R"(, "large": "on"})");
    const std::size_t count  = palpate_object_size(object.handle);
    const auto        dentOf = [&](const Object& of, double force) {
        std::vector<double> xyz(3 * count);
        EXPECT_EQ(palpate_touch_displaced(of.handle, middle, side, force, xyz.data(), count), PALPATE_OK)
            << palpate_error_text();
        return deepestOf(xyz);
    };
    auto felt = PALPATE_INIT(palpate_touch_result);
    ASSERT_EQ(palpate_touch(object.handle, middle, side, &felt), PALPATE_OK) << palpate_error_text();
    const double unit = dentOf(object, 1e-6) / 1e-6; // [m/N]
    for (const double force : {0.1, 1.0, 3.0}) {
        const double depth = std::log1p(800 * force / felt.felt_stiffness) / 800;
        EXPECT_NEAR(dentOf(object, force) / (felt.felt_stiffness * depth * unit), 1, 1e-4) << force << " N";
    }
    EXPECT_LT(dentOf(large, 20), 0.9 * 20 * dentOf(large, 1e-6) / 1e-6);

    const Session session(object);
    for (int n = 0; n < 3000; ++n) {
        session.step(1e-3 * n, heightAt(1e-3 * n));
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    std::vector<double> xyz(3 * count);
    std::uint64_t       seen = 0;
    ASSERT_EQ(palpate_session_deformed(session.handle, xyz.data(), count, &seen), PALPATE_OK);
    EXPECT_NEAR(deepestOf(xyz) / (felt.felt_stiffness * 1.5e-3 * unit), 1, 0.08)
        << "the sheet's points are 2 mm apart; with the force in place of the load it is 1.9";
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

TEST(CInterface, AFirstStepAgainAtItsTimeIsBadInput)
{
    const Object  object;
    const Session session(object);
    EXPECT_FALSE(session.step(0, 5e-3).flags & PALPATE_BAD_INPUT);
    EXPECT_TRUE(session.step(0, 5e-3).flags & PALPATE_BAD_INPUT);
    EXPECT_FALSE(session.step(1e-3, 5e-3).flags & PALPATE_BAD_INPUT);
}

/// A tracker that loses the hand, or a host that moves its frame: from above the sheet into it within a tick, by a host
/// that has no velocities. Then a bad tick while a force flows.
TEST(CInterface, AHandThatJumpsIsNotPushed)
{
    const Object  object;
    const Session session(object);
    double        time = 0;
    const auto    go   = [&](int ticks, double height) {
        double most = 0;
        for (int n = 0; n < ticks; ++n) {
            most = std::max(most, std::abs(session.step(time += 1e-3, height).force[2]));
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
        }
        return most;
    };
    go(2000, 1e-3); // a plate is solved, and the force may come
    double height = 1e-3;
    for (; height > -1.5e-3; height -= 1e-5) go(1, height);
    ASSERT_GT(go(100, height), 0.2) << "a hand that presses feels the sheet";
    go(2000, 5e-3);
    EXPECT_EQ(go(300, -10e-3), 0);
}

/// By tests/faults/machine.sh, whose clocks say some seconds after the start that the machine slept.
TEST(CInterfaceChild, DISABLED_AHostWhoseMachineSleepsLosesTheForce)
{
    const Object   object;
    const Session  session(object);
    double         felt = 0;
    palpate_answer last{};
    for (int n = 0; n < 12'000 && !(last.flags & PALPATE_STOPPED); ++n) {
        felt = std::max(felt, last.force[2]);
        last = session.step(1e-3 * n, heightAt(1e-3 * n));
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    EXPECT_GT(felt, 0.1) << "or it shows nothing [N]";
    EXPECT_EQ(last.fault, 6U) << "the loop has stalled";
    for (int n = 0; n < 20; ++n) last = session.step(20 + 1e-3 * n, heightAt(20));
    EXPECT_EQ(last.force[2], 0);
}

TEST(CInterface, AfterABadTickTheForceDoesNotComeBackAtOnce)
{
    const Object  object;
    const Session session(object);
    double        time  = 0;
    double        force = 0;
    for (double height = 3e-3; time < 4; height = std::max(-8e-3, height - 4e-6)) {
        force = session.step(time += 1e-3, height).force[2];
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    ASSERT_GT(force, 1.5) << "the governor takes longer than a tick to let go [N]";
    EXPECT_TRUE(session.step(time, -8e-3).flags & PALPATE_BAD_INPUT);
    double before = 0;
    for (int n = 0; n < 100; ++n) {
        const double now = session.step(time += 1e-3, -8e-3).force[2];
        EXPECT_LE(now, before + 1e-9) << n;
        before = now;
    }
}

/// A step that another thread's step finds at work has no force. A busy machine may give the other thread no time at
/// first.
TEST(CInterface, TwoThreadsThatStepGiveNoForceThatIsNotTheGovernors)
{
    const Object      object;
    const Session     session(object);
    std::atomic<int>  refused = 0;
    std::atomic<bool> over    = false;
    std::thread       other([&] {
        while (!over) {
            auto hand        = PALPATE_INIT(palpate_hand);
            auto answer      = PALPATE_INIT(palpate_answer);
            hand.position[2] = 0.01;
            static_cast<void>(palpate_session_step(session.handle, 1e6, &hand, &answer));
        }
    });
    const auto        start = std::chrono::steady_clock::now();
    const auto        waits = [&] {
        return refused == 0 && std::chrono::steady_clock::now() - start < std::chrono::minutes(1);
    };
    for (int n = 0; n < 20'000 || waits(); ++n) {
        auto hand        = PALPATE_INIT(palpate_hand);
        auto answer      = PALPATE_INIT(palpate_answer);
        hand.position[2] = 0.01;
        EXPECT_EQ(palpate_session_step(session.handle, 1e-3 * n, &hand, &answer), PALPATE_OK);
        refused += (answer.flags & PALPATE_BAD_INPUT) != 0;
        for (const double part : answer.force) ASSERT_TRUE(part == 0);
    }
    over = true;
    other.join();
    EXPECT_GT(refused, 0);
}

TEST(CInterface, AnObjectIsForSeveralThreadsAtOnce)
{
    const Object             object;
    const double             side[3] = {0, 0, 1};
    std::vector<double>      felt(4);
    std::vector<std::thread> threads;
    for (std::size_t n = 0; n < felt.size(); ++n)
        threads.emplace_back([&, n] {
            const double place[3] = {0, 0, 0};
            auto         result   = PALPATE_INIT(palpate_touch_result);
            EXPECT_EQ(palpate_touch(object.handle, place, side, &result), PALPATE_OK) << palpate_error_text();
            felt[n] = result.felt_stiffness;
        });
    for (std::thread& thread : threads) thread.join();
    for (const double value : felt) EXPECT_EQ(value, felt[0]);
}

/// A sheet of eight triangles, 60 mm a side: a finger between its nine corners must feel it.
TEST(CInterface, FacesAreTouchedBetweenTheirCorners)
{
    std::vector<double>        xyz;
    std::vector<std::uint32_t> faces;
    for (std::uint32_t i = 0; i < 3; ++i)
        for (std::uint32_t j = 0; j < 3; ++j) {
            xyz.insert(xyz.end(), {30e-3 * i - 30e-3, 30e-3 * j - 30e-3, 0});
            const std::uint32_t a = 3 * i + j;
            if (i < 2 && j < 2) faces.insert(faces.end(), {a, a + 3, a + 4, a, a + 4, a + 1});
        }
    auto points              = PALPATE_INIT(palpate_points);
    points.count             = xyz.size() / 3;
    points.positions         = xyz.data();
    points.uniform_stiffness = 3e5;
    points.faces             = faces.data();
    points.face_count        = faces.size() / 3;
    const char* const scene  = R"({"window": "20 mm", "cells": 16, "footprint_radius": "3 mm", "solver": "host"})";
    palpate_object*   object = nullptr;
    ASSERT_EQ(palpate_object_from_points(&points, scene, &object), PALPATE_OK) << palpate_error_text();

    EXPECT_GT(palpate_object_size(object), 1000u);
    const double place[3] = {14e-3, 16e-3, 0};
    auto         result   = PALPATE_INIT(palpate_touch_result);
    EXPECT_EQ(palpate_touch(object, place, nullptr, &result), PALPATE_OK) << palpate_error_text();
    palpate_object_destroy(object);

    palpate_object* vertices = nullptr;
    EXPECT_EQ(palpate_object_from_points(&points, R"({"scatter": "off"})", &vertices), PALPATE_OK)
        << palpate_error_text();
    EXPECT_EQ(palpate_object_size(vertices), points.count);
    palpate_object_destroy(vertices);
}

TEST(CInterface, AStiffnessIsTheCallersOrTheScenes)
{
    std::vector<double> xyz;
    for (int n = 0; n < 400; ++n) xyz.insert(xyz.end(), {1e-3 * (n % 20), 1e-3 * (n / 20), 0});
    auto points               = PALPATE_INIT(palpate_points);
    points.count              = xyz.size() / 3;
    points.positions          = xyz.data();
    const auto firstStiffness = [&](const char* scene) -> double {
        palpate_object* object = nullptr;
        if (palpate_object_from_points(&points, scene, &object) != PALPATE_OK) return -1;
        std::vector<double> values(points.count);
        EXPECT_EQ(palpate_object_stiffness(object, values.data(), values.size()), PALPATE_OK);
        palpate_object_destroy(object);
        return values[0];
    };

    EXPECT_EQ(firstStiffness("{}"), -1);
    EXPECT_NE(std::string(palpate_error_text()).find("material"), std::string::npos) << palpate_error_text();
    EXPECT_EQ(firstStiffness(R"({"stiffness": "constant:value=5e4"})"), 5e4);
    const double ofMaterial = firstStiffness(R"({"material": "ecoflex-0030"})");
    EXPECT_GT(ofMaterial, 0) << palpate_error_text();
    points.uniform_stiffness = 7e4;
    EXPECT_EQ(firstStiffness(R"({"material": "ecoflex-0030"})"), 7e4) << "the material's other values are wanted";
    EXPECT_NE(ofMaterial, 7e4);
    EXPECT_EQ(firstStiffness(R"({"stiffness": "constant:value=5e4"})"), -1);
    EXPECT_EQ(firstStiffness(R"({"length_unit": "mm"})"), -1) << "a key of files";
    EXPECT_EQ(firstStiffness(R"({"points": 500})"), -1) << "a key of samples";
    points.stiffness_kind = PALPATE_FELT;
    EXPECT_EQ(firstStiffness("{}"), -1);
    EXPECT_NE(std::string(palpate_error_text()).find("palpate fit"), std::string::npos) << palpate_error_text();
}

/// A soft disc in a shell so stiff that multigrid does not converge there: the reference takes over.
const char* const kHardShell = R"({"cloud": "sample:ellipsoid", "points": 6000, "thickness": "1 mm",
    "foundation": "1.74 MPa/m", "window": "60 mm", "cells": 24, "footprint_radius": "4 mm", "theory": "shell",
    "place": [0, 0, 0.03], "deformation_rate": 10, "solver": "host",
    "stiffness": {"law": "disc", "from": 1e12, "to": 1e3, "centre": [0, 0, 0.03], "radius": 0.014}})";

/// Who took over, without the error that multigrid stopped at.
const std::string kReferenceTookOver = "the reference solver took over: ";

bool referenceTookOver()
{
    return std::string(palpate_takeover_text()).starts_with(kReferenceTookOver);
}

TEST(CInterface, EachCallSaysWhoTookOver)
{
    const Object        object(kHardShell);
    const double        place[] = {0, 0, 0.03}, times[] = {0, 0.2}, hand[] = {0, 0, 0.031, 0, 0, 0.029};
    auto                touched = PALPATE_INIT(palpate_touch_result);
    std::vector<double> many(3 * palpate_object_size(object.handle));
    const std::size_t   points = palpate_object_size(object.handle);
    EXPECT_EQ(palpate_touch(object.handle, place, nullptr, &touched), PALPATE_OK) << palpate_error_text();
    EXPECT_TRUE(referenceTookOver()) << palpate_takeover_text();
    std::thread([] { EXPECT_STREQ(palpate_takeover_text(), ""); }).join();
    EXPECT_TRUE(referenceTookOver()) << "it is this thread's";
    EXPECT_EQ(palpate_object_positions(object.handle, many.data(), points), PALPATE_OK);
    EXPECT_STREQ(palpate_takeover_text(), "") << "the last call solved nothing";
    EXPECT_EQ(palpate_touch_displaced(object.handle, place, nullptr, 0.1, many.data(), points), PALPATE_OK);
    EXPECT_TRUE(referenceTookOver()) << "displaced";
    EXPECT_EQ(palpate_felt_map(object.handle, place, nullptr, 1, many.data(), nullptr), PALPATE_OK);
    EXPECT_TRUE(referenceTookOver()) << "map";
    EXPECT_EQ(palpate_felt_map_every(object.handle, 0.02, many.data(), points, nullptr), PALPATE_OK);
    EXPECT_TRUE(referenceTookOver()) << "map of cubes";
    EXPECT_EQ(palpate_run(object.handle, times, hand, 2, 200, many.data(), nullptr), PALPATE_OK);
    EXPECT_TRUE(referenceTookOver()) << "run";
    auto path   = PALPATE_INIT(palpate_path);
    auto noted  = PALPATE_INIT(palpate_perception);
    path.reach  = 3e-3;
    path.places = 3;
    EXPECT_EQ(palpate_perceive(object.handle, &path, &noted, nullptr, nullptr, 0), PALPATE_OK) << palpate_error_text();
    EXPECT_TRUE(referenceTookOver()) << "perceive";
    const Object sheet;
    const double middle[] = {0, 0, 0};
    EXPECT_EQ(palpate_touch(sheet.handle, middle, nullptr, &touched), PALPATE_OK) << palpate_error_text();
    EXPECT_STREQ(palpate_takeover_text(), "") << "nothing went wrong on the sheet";
}

/// The stiffest disc of plate_solver_test.cpp.
TEST(CInterface, APlateSaysWhoTookOver)
{
    constexpr int       kCells = 64, kNodes = kCells + 1;
    std::vector<double> rigidity(kNodes * kNodes, 1.0), forces(kNodes * kNodes), deflection(kNodes * kNodes);
    const auto          plateOf = [&](double contrast) {
        for (int i = 0; i < kNodes; ++i)
            for (int j = 0; j < kNodes; ++j)
                if (std::hypot(double(i) / kCells - 0.45, double(j) / kCells - 0.55) < 0.2)
                    rigidity[std::size_t(i * kNodes + j)] = contrast;
        auto plate    = PALPATE_INIT(palpate_plate);
        plate.cells_x = plate.cells_z = kCells;
        plate.size_x = plate.size_z = 1;
        plate.poisson               = 0.3;
        plate.rigidity              = rigidity.data();
        return plate;
    };
    forces[std::size_t(kCells / 2 * kNodes + kCells / 2)] = 1;
    for (const double contrast : {1e9, 10.0}) {
        const palpate_plate plate = plateOf(contrast);
        EXPECT_EQ(palpate_plate_solve(&plate, forces.data(), 1e-4, deflection.data(), nullptr), PALPATE_OK);
        EXPECT_EQ(referenceTookOver(), contrast > 10) << palpate_takeover_text();
    }
}

TEST(CInterface, ASessionSaysWhoTookOver)
{
    const Object  object(kHardShell);
    const Session session(object);
    const auto    told = [&session] {
        std::array<char, 1024> text{};
        EXPECT_EQ(palpate_session_takeover(session.handle, text.data(), text.size()), PALPATE_OK);
        return std::string(text.data());
    };
    EXPECT_EQ(told(), "");
    for (int n = 0; n < 10'000 && told().empty(); ++n) { // until its thread has solved where the hand touches
        session.step(1e-3 * n, 0.03 + heightAt(1e-3 * n));
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    EXPECT_TRUE(told().starts_with(kReferenceTookOver)) << told();
    char none = 'x';
    EXPECT_EQ(palpate_session_takeover(session.handle, &none, 1), PALPATE_REFUSED) << "there is no room";
    EXPECT_EQ(palpate_session_takeover(nullptr, &none, 1), PALPATE_REFUSED);
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
