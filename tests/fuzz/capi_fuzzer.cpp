#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

#include "engine/capi/palpate.h"
#include "tests/fuzz/fuzz_expect.h"

// What a program in another language hands over: the first byte says which of these things the others are. Arrays are as
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

/// Its object.
const palpate_object* theSheet()
{
    static palpate_object* const object = objectOf(sheet(), kScene);
    return object;
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

/// Numbers of either type, so many for each of some points, at a stride.
class Array {
public:
    Array(Bytes& bytes, std::size_t points, std::size_t perPoint)
    {
        const auto how  = bytes.next<std::uint8_t>();
        type            = how & 1 ? PALPATE_FLOAT32 : PALPATE_FLOAT64;
        isThere         = (how & 2) != 0;
        stride          = how & 4 ? perPoint * size() + (how >> 4) : 0;
        const auto step = stride == 0 ? perPoint * size() : stride;
        held_.resize(points * step);
        for (std::size_t n = 0; isThere && n < points; ++n)
            for (std::size_t k = 0; k < perPoint * size(); ++k) held_[n * step + k] = bytes.next<std::uint8_t>();
    }
    [[nodiscard]] const void* data() const { return isThere ? held_.data() : nullptr; }

    int         type    = PALPATE_FLOAT64;
    bool        isThere = false;
    std::size_t stride  = 0; ///< [bytes]

private:
    [[nodiscard]] std::size_t size() const { return type == PALPATE_FLOAT32 ? sizeof(float) : sizeof(double); }

    std::vector<std::uint8_t> held_;
};

/// Reads back what an object was made of.
void readBack(const palpate_object* object)
{
    const std::size_t   size = palpate_object_size(object);
    std::vector<double> xyz(3 * size), stiffness(size);
    palp::fuzzExpect(palpate_object_positions(object, xyz.data(), size) == PALPATE_OK);
    palp::fuzzExpect(palpate_object_stiffness(object, stiffness.data(), size) == PALPATE_OK);
    palp::fuzzExpect(palpate_object_positions(object, xyz.data(), size - 1) == PALPATE_REFUSED);
    for (const double value : xyz) palp::fuzzExpect(std::isfinite(value));
    for (const double value : stiffness) palp::fuzzExpect(std::isfinite(value) && value > 0);
    std::size_t needed = 0;
    palp::fuzzExpect(palpate_object_scene(object, nullptr, 0, &needed) == PALPATE_OK);
    std::string text(needed, '?');
    palp::fuzzExpect(palpate_object_scene(object, text.data(), needed - 1, &needed) == PALPATE_REFUSED);
    palp::fuzzExpect(palpate_object_scene(object, text.data(), needed, &needed) == PALPATE_OK && text.back() == '\0');
}

void readArrays(Bytes bytes)
{
    constexpr std::size_t kMost  = 64; // points
    auto                  points = PALPATE_INIT(palpate_points);
    points.count                 = bytes.next<std::uint8_t>() % kMost;
    points.stiffness_kind        = bytes.next<std::int8_t>();
    points.uniform_stiffness     = bytes.next<float>();
    points.face_count            = bytes.next<std::uint8_t>() % kMost;
    const Array positions(bytes, points.count, 3), stiffness(bytes, points.count, 1), normals(bytes, points.count, 3);
    const Array stiffening(bytes, points.count, 1), foundation(bytes, points.count, 1);
    std::vector<std::uint32_t> faces(3 * points.face_count);
    for (std::uint32_t& corner : faces) corner = bytes.next<std::uint8_t>();
    points.positions         = positions.data();
    points.position_type     = positions.type;
    points.position_stride   = positions.stride;
    points.stiffness         = stiffness.data();
    points.stiffness_type    = stiffness.type;
    points.stiffness_stride  = stiffness.stride;
    points.normals           = normals.data();
    points.normal_type       = normals.type;
    points.normal_stride     = normals.stride;
    points.stiffening        = stiffening.data();
    points.stiffening_type   = stiffening.type;
    points.stiffening_stride = stiffening.stride;
    points.foundation        = foundation.data();
    points.foundation_type   = foundation.type;
    points.foundation_stride = foundation.stride;
    points.faces             = faces.data();
    palpate_object* object   = nullptr;
    if (!isDone(palpate_object_from_points(&points, kScene, &object))) return;
    readBack(object);
    palpate_object_destroy(object);
}

void makeOfScene(const Bytes& bytes)
{
    palpate_object_destroy(objectOf(sheet(), bytes.text().c_str()));
}

void step(Bytes bytes)
{
    const palpate_object* const object  = theSheet();
    palpate_session*            session = nullptr;
    palp::fuzzExpect(palpate_session_create(object, nullptr, &session) == PALPATE_OK);
    double              time     = 0;
    std::uint64_t       sequence = 0;
    std::vector<double> xyz(3 * palpate_object_size(object));
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
        std::array<char, 4096> words{};
        palp::fuzzExpect(palpate_session_words(session, words.data(), words.size()) == PALPATE_OK);
        palp::fuzzExpectSentence(words.data());
        palp::fuzzExpect(palpate_session_takeover(session, words.data(), words.size()) == PALPATE_OK);
        palp::fuzzExpect(palpate_session_deformed(session, xyz.data(), xyz.size() / 3, &sequence) == PALPATE_OK);
        for (const double x : xyz) palp::fuzzExpect(std::isfinite(x));
    }
    palpate_session_destroy(session);
}

/// Displaced points under a force, and felt maps of places with and without directions.
void touchSheet(Bytes bytes)
{
    const std::size_t   size = palpate_object_size(theSheet());
    std::vector<double> xyz(3 * size);
    const auto          force = bytes.next<double>();
    std::vector<double> places, from;
    while (bytes.left() >= 6 * sizeof(double)) {
        for (int n = 0; n < 3; ++n) places.push_back(bytes.next<double>());
        for (int n = 0; n < 3; ++n) from.push_back(bytes.next<double>());
    }
    if (places.empty()) return;
    if (isDone(palpate_touch_displaced(theSheet(), places.data(), from.data(), force, xyz.data(), size)))
        for (const double x : xyz) palp::fuzzExpect(std::isfinite(x));
    for (const double* const side : {static_cast<const double*>(nullptr), static_cast<const double*>(from.data())}) {
        std::vector<double> felt(places.size() / 3);
        std::size_t         failed = 0, none = 0;
        if (!isDone(palpate_felt_map(theSheet(), places.data(), side, felt.size(), felt.data(), &failed))) continue;
        for (const double value : felt) none += std::isnan(value);
        palp::fuzzExpect(none == failed);
    }
}

void mapEvery(Bytes bytes)
{
    std::vector<double> felt(palpate_object_size(theSheet()));
    std::size_t         touched = 0;
    const auto          spacing = bytes.next<double>();
    if (!isDone(palpate_felt_map_every(theSheet(), spacing, felt.data(), felt.size(), &touched))) return;
    palp::fuzzExpect(touched <= felt.size());
    for (const double value : felt) palp::fuzzExpect(value > 0);
}

/// A prediction along a path: of three places, as it takes longest.
void perceive(Bytes bytes)
{
    constexpr int kPlaces = 3;
    auto          path    = PALPATE_INIT(palpate_path);
    double        three[3][3];
    const auto    which = bytes.next<std::uint8_t>();
    path.places         = bytes.next<std::int8_t>();
    if (path.places == 0 || path.places > kPlaces) path.places = kPlaces;
    path.reach = bytes.next<double>();
    for (auto& vector : three)
        for (double& part : vector) part = bytes.next<double>();
    path.place     = which & 1 ? three[0] : nullptr;
    path.from      = which & 2 ? three[1] : nullptr;
    path.direction = which & 4 ? three[2] : nullptr;
    std::array<double, kPlaces> along{}, felt{};
    auto                        result = PALPATE_INIT(palpate_perception);
    if (!isDone(palpate_perceive(theSheet(), &path, &result, along.data(), felt.data(), kPlaces))) return;
    palp::fuzzExpect(result.softest > 0 && result.hardest >= result.softest);
}

void run(Bytes bytes)
{
    constexpr std::size_t kMost = 200; // ticks
    const std::size_t     ticks = bytes.next<std::uint8_t>() % kMost;
    std::vector<double>   times, places;
    while (bytes.left() >= 4 * sizeof(double)) {
        times.push_back(bytes.next<double>());
        for (int n = 0; n < 3; ++n) places.push_back(bytes.next<double>());
    }
    std::vector<double> forces(3 * ticks), proxies(3 * ticks);
    if (!isDone(
            palpate_run(theSheet(), times.data(), places.data(), times.size(), ticks, forces.data(), proxies.data())))
        return;
    for (std::size_t n = 0; n < ticks; ++n)
        palp::fuzzExpect(std::hypot(forces[3 * n], forces[3 * n + 1], forces[3 * n + 2]) <= 6.0 + 1e-9);
    for (const double x : proxies) palp::fuzzExpect(std::isfinite(x));
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
    case 'a':
        readArrays(bytes);
        break;
    case 'f':
        touchSheet(bytes);
        break;
    case 'e':
        mapEvery(bytes);
        break;
    case 'q':
        perceive(bytes);
        break;
    case 'r':
        run(bytes);
        break;
    default:
        break;
    }
    return 0;
}
