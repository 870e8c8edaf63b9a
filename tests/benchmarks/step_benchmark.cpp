// What the C interface adds to a tick: the servo's own tick, SteppedSession::step() and palpate_session_step(), each
// with a deformation of its own, by turns in one loop at 1 kHz with one hand that slides over a sheet. Medians in
// microseconds, which other programs on the machine hardly move; `above_us` is the last less the first.
#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cmath>
#include <thread>
#include <vector>

#include <benchmark/benchmark.h>

#include "engine/capi/palpate.h"
#include "engine/core/contract.h"
#include "engine/session/detail/deformation_loop.h"
#include "engine/session/scene.h"
#include "engine/session/stepped_session.h"

namespace {

using Clock = std::chrono::steady_clock;

// Three deformations share the machine's cores with the loop, so each has a tenth of the usual rate.
const char* const kScene =
    R"({"cloud": "sample:sheet", "points": 40000, "stiffness": {"law": "constant", "value": 3e5}, "thickness": "4 mm",
        "foundation": "1.74 MPa/m", "window": "40 mm", "cells": 32, "footprint_radius": "3.6 mm", "place": [0, 0, 0],
        "deformation_rate": 10, "solver": "host"})";

void demand(int code)
{
    if (code != PALPATE_OK) throw palp::Error(palpate_error_text());
}

/// A servo with a deformation's thread, so that the servo's tick can be timed alone.
struct BareServo {
    palp::Deformation     deformation;
    palp::Servo           servo;
    palp::DeformationLoop loop;
    std::atomic<bool>     over = false;
    std::thread           thread;

    BareServo(const palp::SoftObject& object, const palp::Scene& scene)
        : deformation(object, scene), servo(object, scene, {}, deformation.firstLaw()),
          loop(deformation.solver(), scene.deformationRate), thread([this] { loop.run(over); })
    {
    }
    ~BareServo()
    {
        over = true;
        thread.join();
    }

    /// \return [us] of the servo's tick
    double tick(double time, double dt, palp::Hand hand)
    {
        hand.answerTime                       = time;
        const palp::PatchUpdate* const newest = loop.newest(servo.tableInUse());
        const auto                     start  = Clock::now();
        benchmark::DoNotOptimize(servo.tick({time, dt}, hand, newest));
        const std::chrono::duration<double, std::micro> took = Clock::now() - start;
        loop.touch.draft()                                   = servo.touch();
        loop.touch.publish();
        return took.count();
    }
};

/// One session of each kind, each over an object of its own: on a shared one two would find it in the caches of the
/// other.
struct Sessions {
    palp::Scene          scene  = palp::parseScene(kScene, "step_benchmark", ".");
    palp::SoftObject     object = palp::loadObject(scene).object;
    BareServo            bare{object, scene};
    palp::SteppedSession stepped{palp::loadObject(scene).object, scene};
    palpate_object*      made    = nullptr;
    palpate_session*     session = nullptr;

    Sessions()
    {
        demand(palpate_object_from_scene(kScene, nullptr, &made));
        demand(palpate_session_create(made, nullptr, &session));
    }
    ~Sessions()
    {
        palpate_session_destroy(session);
        palpate_object_destroy(made);
    }
};

/// \return [us]
template <class Work>
double timeOf(const Work& work)
{
    const auto start = Clock::now();
    work();
    return std::chrono::duration<double, std::micro>(Clock::now() - start).count();
}

double median(std::vector<double> values)
{
    const auto middle = values.begin() + std::ptrdiff_t(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

void steps(benchmark::State& state)
{
    constexpr std::size_t kBlock = 250; // ticks of one kind in a row, so that each finds its own code in the caches
    Sessions              of;
    std::array<std::vector<double>, 3> took;
    std::size_t                        tick = 0, touching = 0;
    for (auto _ : state) {
        std::this_thread::sleep_for(std::chrono::microseconds(900));
        const std::size_t who = tick++ / kBlock % 3;
        const double      now = 1e-3 * double(took[who].size() + 1); // of this kind's own session
        palp::Hand        hand;
        hand.position = {8e-3 * std::cos(3 * now), 8e-3 * std::sin(3 * now), std::max(-1e-3, 3e-3 - 4e-3 * now)};
        auto theirs   = PALPATE_INIT(palpate_hand);
        auto answer   = PALPATE_INIT(palpate_answer);
        for (int k = 0; k < 3; ++k) theirs.position[k] = hand.position[k];
        if (who == 0) {
            took[0].push_back(of.bare.tick(now, 1e-3, hand));
        } else if (who == 1) {
            took[1].push_back(timeOf([&] { benchmark::DoNotOptimize(of.stepped.step(now, hand)); }));
        } else {
            took[2].push_back(timeOf([&] { demand(palpate_session_step(of.session, now, &theirs, &answer)); }));
            touching += (answer.flags & PALPATE_TOUCHING) != 0;
        }
        state.SetIterationTime(1e-6 * took[who].back());
    }
    state.counters["servo_us"]   = median(took[0]);
    state.counters["stepped_us"] = median(took[1]);
    state.counters["c_us"]       = median(took[2]);
    state.counters["above_us"]   = median(took[2]) - median(took[0]);
    state.counters["touching"]   = double(touching) / double(took[2].size());
}
BENCHMARK(steps)->Name("step/1 kHz")->UseManualTime()->Unit(benchmark::kMicrosecond)->Iterations(15000);

} // namespace

BENCHMARK_MAIN();
