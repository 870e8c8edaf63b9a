#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

#include "engine/capi/palpate.h"
#include "tests/fuzz/fuzz_expect.h"

// What a program in another language hands over: the first byte says which of four things the others are. Arrays are as
// long as they claim to be, because nothing else can be checked in C.

namespace {

constexpr const char* kScene = R"({"window": "6 mm", "cells": 8, "footprint_radius": "1 mm", "solver": "host"})";

/// Numbers of an input, one after the other; 0 behind its end.
class Bytes {
public:
    Bytes(const std::uint8_t* data, std::size_t size) : data_(data), size_(size) {}

    template <class Number>
    Number next()
    {
        Number number{};
        if (left() >= sizeof number) std::memcpy(&number, data_ + at_, sizeof number);
        at_ = std::min(size_, at_ + sizeof number);
        return number;
    }
    [[nodiscard]] std::size_t left() const { return size_ - at_; }
    [[nodiscard]] std::string text() const { return {reinterpret_cast<const char*>(data_ + at_), left()}; }

private:
    const std::uint8_t* data_;
    std::size_t         size_, at_ = 0;
};

/// Returns whether it was done; what was refused has a sentence, and nothing is a mistake of the library's own.
bool isDone(int code)
{
    ++(code == PALPATE_OK ? palp::fuzzVerdicts.accepted : palp::fuzzVerdicts.refused);
    if (code == PALPATE_OK) return true;
    palp::fuzzExpect(code != PALPATE_BROKEN && *palpate_error_text() != '\0');
    palp::fuzzExpectSentence(palpate_error_text());
    return false;
}

/// Makes an object of rows of x, y, z and a stiffness.
palpate_object* objectOf(const std::vector<double>& rows, const char* scene)
{
    auto points             = PALPATE_INIT(palpate_points);
    points.count            = rows.size() / 4;
    points.positions        = rows.data();
    points.position_stride  = 4 * sizeof(double);
    points.stiffness        = rows.empty() ? nullptr : rows.data() + 3;
    points.stiffness_stride = 4 * sizeof(double);
    palpate_object* object  = nullptr;
    palp::fuzzExpect(isDone(palpate_object_from_points(&points, scene, &object)) == (object != nullptr));
    return object;
}

/// A sheet of 9 x 9 points, 8 mm a side.
std::vector<double> sheet()
{
    std::vector<double> rows;
    for (int n = 0; n < 81; ++n) rows.insert(rows.end(), {1e-3 * (n / 9), 1e-3 * (n % 9), 0, 3e5});
    return rows;
}

void touchPoints(Bytes bytes)
{
    std::vector<double> rows;
    while (bytes.left() >= 4 * sizeof(double))
        for (int n = 0; n < 4; ++n) rows.push_back(bytes.next<double>());
    palpate_object* const object = objectOf(rows, kScene);
    if (!object) return;
    const std::array place{rows[0], rows[1], rows[2]};
    auto             result = PALPATE_INIT(palpate_touch_result);
    if (isDone(palpate_touch(object, place.data(), nullptr, &result)))
        palp::fuzzExpect(std::isfinite(result.felt_stiffness) && result.felt_stiffness >= 0 &&
                         std::isfinite(result.compliance) && result.compliance >= 0);
    palpate_object_destroy(object);
}

void makeOfScene(const Bytes& bytes)
{
    palpate_object_destroy(objectOf(sheet(), bytes.text().c_str()));
}

void step(Bytes bytes)
{
    static palpate_object* const object  = objectOf(sheet(), kScene);
    palpate_session*             session = nullptr;
    palp::fuzzExpect(palpate_session_create(object, nullptr, &session) == PALPATE_OK);
    double time = 0;
    while (bytes.left() > 0) {
        auto hand   = PALPATE_INIT(palpate_hand);
        auto answer = PALPATE_INIT(palpate_answer);
        time += bytes.next<double>();
        for (double& part : hand.position) part = bytes.next<double>();
        for (double& part : hand.velocity) part = bytes.next<float>();
        hand.age     = bytes.next<float>();
        hand.buttons = bytes.next<std::uint8_t>();
        hand.absent  = bytes.next<std::uint8_t>();
        palp::fuzzExpect(palpate_session_step(session, time, &hand, &answer) == PALPATE_OK);
        const double force = std::hypot(answer.force[0], answer.force[1], answer.force[2]);
        palp::fuzzExpect(force <= 6.0 + 1e-9 &&
                         (force == 0 || !(answer.flags & PALPATE_BAD_INPUT))); // NaN is not below
    }
    palpate_session_destroy(session);
}

void solvePlate(Bytes bytes)
{
    auto plate       = PALPATE_INIT(palpate_plate);
    plate.cells_x    = 4 + bytes.next<std::uint8_t>() % 8;
    plate.cells_z    = 4 + bytes.next<std::uint8_t>() % 8;
    plate.size_x     = bytes.next<double>();
    plate.size_z     = bytes.next<double>();
    plate.poisson    = bytes.next<double>();
    plate.foundation = bytes.next<double>();
    for (int& edge : plate.edges) edge = bytes.next<std::int8_t>();
    const std::size_t   nodes = std::size_t(plate.cells_x + 1) * std::size_t(plate.cells_z + 1);
    std::vector<double> rigidity(nodes, bytes.next<double>()), forces(nodes), deflection(nodes);
    const double        tolerance = bytes.next<double>();
    forces[nodes / 2]             = bytes.next<double>();
    for (std::size_t n = 0; bytes.left() > 0; ++n) rigidity[n % nodes] = bytes.next<double>();
    plate.rigidity = rigidity.data();
    double error   = 0;
    if (!isDone(palpate_plate_solve(&plate, forces.data(), tolerance, deflection.data(), &error))) return;
    for (const double w : deflection) palp::fuzzExpect(std::isfinite(w));
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
    Bytes bytes(data, size);
    switch (bytes.next<std::uint8_t>()) {
    case 't':
        touchPoints(bytes);
        break;
    case 'j':
        makeOfScene(bytes);
        break;
    case 's':
        step(bytes);
        break;
    case 'p':
        solvePlate(bytes);
        break;
    default:
        break;
    }
    return 0;
}
