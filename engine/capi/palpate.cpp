#include "engine/capi/palpate.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstring>
#include <exception>
#include <limits>
#include <memory>
#include <new>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <glm/geometric.hpp>

#include "engine/contact/contact.h"
#include "engine/core/contract.h"
#include "engine/core/parallel.h"
#include "engine/pipeline/deform.h"
#include "engine/session/force_state.h"
#include "engine/session/hand_path.h"
#include "engine/session/scripted_hand.h"
#include "engine/session/stepped_session.h"
#include "engine/session/virtual_session.h"

// The C interface over the library: it checks what crosses the border, and nothing else happens here.

struct palpate_object {
    palp::Scene      scene;
    palp::SoftObject object;
};

struct palpate_session {
    palp::SteppedSession session;
    palp::TickRecord     last{};  ///< of step()'s thread
    std::atomic<double>  force{}; ///< [N] its magnitude, for the renderer's thread
    std::uint64_t        shown = 0;
};

namespace {

using namespace palp;

thread_local std::string lastError;

/// Runs the body of a function of the interface.
template <class Body>
int guarded(const Body& body) noexcept
{
    try {
        lastError.clear();
        body();
        return PALPATE_OK;
    } catch (const std::bad_alloc&) {
        lastError = "no memory"; // short enough to need none
        return PALPATE_NO_MEMORY;
    } catch (const Error& error) {
        try {
            lastError = error.what();
        } catch (...) {
            return PALPATE_NO_MEMORY;
        }
        return PALPATE_REFUSED;
    } catch (const std::exception& error) {
        try {
            lastError = std::string("a mistake of the library's own: ") + error.what();
        } catch (...) {
            return PALPATE_NO_MEMORY;
        }
        return PALPATE_BROKEN;
    } catch (...) {
        return PALPATE_BROKEN;
    }
}

template <class T>
T& demand(T* pointer, const char* what)
{
    if (!pointer) throw Error(std::string(what) + ": expected a pointer, found NULL");
    return *pointer;
}

/// Returns a struct of the caller, of this or another version: what it lacks is 0, what it has beyond must be 0.
template <class T>
T taken(const T* given, const char* what)
{
    constexpr std::size_t kMost = 4096; // no struct here will ever be so large
    const std::size_t     size  = demand(given, what).size;
    if (size < 2 * sizeof(std::size_t) || size > kMost)
        throw Error(std::string(what) + ": expected its own size in its first field, " + std::to_string(sizeof(T)) +
                    " bytes, found " + std::to_string(size) + "; write PALPATE_INIT(" + what + ")");
    T own{};
    std::memcpy(&own, given, std::min(size, sizeof(T)));
    const auto* bytes = reinterpret_cast<const unsigned char*>(given);
    for (std::size_t n = sizeof(T); n < size; ++n)
        if (bytes[n] != 0)
            throw Error(std::string(what) + ": expected nothing beyond " + std::to_string(sizeof(T)) +
                        " bytes, which this version knows, found a value in byte " + std::to_string(n));
    own.size = sizeof(T);
    return own;
}

/// Writes a struct for the caller, as much of it as he knows.
template <class T>
void give(T* to, T own) noexcept
{
    const std::size_t size = to->size;
    own.size               = size;
    std::memcpy(to, &own, std::min(size, sizeof(T)));
}

glm::dvec3 vectorOf(const double* three)
{
    return {three[0], three[1], three[2]};
}

bool isFinite(const glm::dvec3& v)
{
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

void put(const glm::dvec3& v, double* three) noexcept
{
    for (int k = 0; k < 3; ++k) three[k] = v[k];
}

/// An array of the caller, of either type and any stride.
class Numbers {
public:
    Numbers(const void* data, int type, std::size_t stride, std::size_t perPoint, const char* what)
        : data_(static_cast<const char*>(data)), isFloat_(type == PALPATE_FLOAT32),
          stride_(stride == 0 ? perPoint * (isFloat_ ? sizeof(float) : sizeof(double)) : stride)
    {
        demand(data_, what);
        if (type != PALPATE_FLOAT32 && type != PALPATE_FLOAT64)
            throw Error(std::string(what) + ": expected the type PALPATE_FLOAT64 or PALPATE_FLOAT32, found " +
                        std::to_string(type));
    }

    [[nodiscard]] double at(std::size_t point, std::size_t part = 0) const noexcept
    {
        const char* from = data_ + point * stride_;
        if (isFloat_) {
            float value = 0;
            std::memcpy(&value, from + part * sizeof value, sizeof value);
            return double(value);
        }
        double value = 0;
        std::memcpy(&value, from + part * sizeof value, sizeof value);
        return value;
    }

private:
    const char* data_;
    bool        isFloat_;
    std::size_t stride_; ///< [bytes]
};

PointCloud cloudOf(const palpate_points& points)
{
    constexpr std::size_t kMost = std::numeric_limits<std::uint32_t>::max() / 2;
    if (points.count == 0 || points.count > kMost)
        throw Error("points: expected a count from 1 to " + std::to_string(kMost) + ", found " +
                    std::to_string(points.count));
    const Numbers           at(points.positions, points.position_type, points.position_stride, 3, "positions");
    std::vector<glm::dvec3> positions(points.count);
    for (std::size_t n = 0; n < points.count; ++n) positions[n] = {at.at(n, 0), at.at(n, 1), at.at(n, 2)};
    std::vector<double> stiffness(points.count, points.uniform_stiffness);
    if (points.stiffness) {
        const Numbers values(points.stiffness, points.stiffness_type, points.stiffness_stride, 1, "stiffness");
        for (std::size_t n = 0; n < points.count; ++n) stiffness[n] = values.at(n);
    }
    if (points.stiffness_kind != PALPATE_MODULUS && points.stiffness_kind != PALPATE_RIGIDITY)
        throw Error("stiffness_kind: expected PALPATE_MODULUS or PALPATE_RIGIDITY, found " +
                    std::to_string(points.stiffness_kind));
    return {std::move(positions), std::move(stiffness),
            points.stiffness_kind == PALPATE_MODULUS ? StiffnessKind::modulus : StiffnessKind::rigidity};
}

std::vector<glm::vec3> normalsOf(const palpate_points& points)
{
    if (!points.normals) return {};
    const Numbers          at(points.normals, points.normal_type, points.normal_stride, 3, "normals");
    std::vector<glm::vec3> normals(points.count);
    for (std::size_t n = 0; n < points.count; ++n) {
        const glm::dvec3 normal{at.at(n, 0), at.at(n, 1), at.at(n, 2)};
        if (!isFinite(normal))
            throw Error("normals: expected finite numbers, found another one at point " + std::to_string(n));
        const double length = glm::length(normal);
        if (length > 0 && std::isfinite(length)) normals[n] = glm::vec3(normal / length);
    }
    return normals;
}

std::vector<Triangle> facesOf(const palpate_points& points)
{
    std::vector<Triangle> faces;
    if (points.face_count == 0) return faces;
    const std::uint32_t* const corners = &demand(points.faces, "faces");
    faces.resize(points.face_count);
    for (std::size_t n = 0; n < points.face_count; ++n)
        for (std::size_t k = 0; k < 3; ++k) {
            faces[n][k] = corners[3 * n + k];
            if (faces[n][k] >= points.count)
                throw Error("faces: expected points below " + std::to_string(points.count) + ", found " +
                            std::to_string(faces[n][k]) + " in face " + std::to_string(n));
        }
    return faces;
}

void makeObject(palpate_object** out, palpate_object&& made)
{
    *out = new palpate_object(std::move(made));
}

void demandRoom(std::size_t found, std::size_t wanted)
{
    if (found < wanted)
        throw Error("count: expected room for " + std::to_string(wanted) + " points, found " + std::to_string(found));
}

Contact contactAt(const palpate_object& object, const double* place, const double* from)
{
    constexpr double          kReach = 0.25; // of the window, as the command line takes it
    const glm::dvec3          at     = vectorOf(&demand(place, "place"));
    std::optional<glm::dvec3> side;
    if (from) side = vectorOf(from);
    if (!isFinite(at)) throw Error("place: expected finite numbers, found another one");
    if (side && !(isFinite(*side) && glm::length(*side) > 0))
        throw Error("from: expected a direction that is finite and not zero, found another one");
    if (side) side = glm::normalize(*side);
    return touchAt(object.object, at, side, kReach * object.scene.patch.window);
}

Patch patchAt(const palpate_object& object, const double* place, const double* from, PlateSolver& solver)
{
    Patch patch = deform(object.object, contactAt(object, place, from), object.scene.patch, solver);
    demandDeformed(patch, "try a larger window");
    return patch;
}

/// Copies a text with its final zero.
void giveText(const std::string& from, char* to, std::size_t size)
{
    if (size <= from.size())
        throw Error("size: expected room for " + std::to_string(from.size() + 1) + " bytes, found " +
                    std::to_string(size));
    std::memcpy(&demand(to, "text"), from.c_str(), from.size() + 1);
}

Hand handOf(const palpate_hand& given)
{
    Hand hand;
    hand.position  = vectorOf(given.position);
    hand.velocity  = vectorOf(given.velocity);
    hand.answerAge = std::isfinite(given.age) ? std::max(0.0, given.age) : 0;
    hand.buttons   = given.buttons & 0xFFFFU;
    if (given.absent != 0) hand.device = DeviceFault::silent;
    return hand;
}

std::uint32_t flagsOf(const TickRecord& r, bool good)
{
    const auto    has      = [&](SessionFlag flag) { return (r.faults & std::uint32_t(flag)) != 0; };
    const bool    touching = r.normal != glm::dvec3(0);
    std::uint32_t flags    = touching ? PALPATE_TOUCHING : 0;
    switch (forceState(r)) {
    case ForceState::stopped:
    case ForceState::deviceLost:
        flags |= PALPATE_STOPPED;
        break;
    case ForceState::waits:
    case ForceState::comesOn:
        flags |= PALPATE_WAITING;
        break;
    default:
        break;
    }
    if (!good) flags |= PALPATE_BAD_INPUT;
    if (has(SessionFlag::noPatch) || has(SessionFlag::oldTable)) flags |= PALPATE_NO_PATCH;
    if (has(SessionFlag::beyondTheory)) flags |= PALPATE_TOO_DEEP;
    return flags;
}

Edge edgeOf(int edge)
{
    switch (edge) {
    case PALPATE_CLAMPED:
        return Edge::clamped;
    case PALPATE_SUPPORTED:
        return Edge::supported;
    case PALPATE_FREE:
        return Edge::free;
    default:
        throw Error("edges: expected PALPATE_CLAMPED, PALPATE_SUPPORTED or PALPATE_FREE, found " +
                    std::to_string(edge));
    }
}

Plate plateOf(const palpate_plate& given)
{
    constexpr int kMost = 4096;
    if (given.cells_x < kFewestPlateCells || given.cells_x > kMost || given.cells_z < kFewestPlateCells ||
        given.cells_z > kMost)
        throw Error("plate: expected 4 to 4096 cells along either side, found " + std::to_string(given.cells_x) +
                    " x " + std::to_string(given.cells_z));
    Plate plate;
    plate.grid  = {given.cells_x, given.cells_z, given.size_x / given.cells_x, given.size_z / given.cells_z};
    plate.edges = {edgeOf(given.edges[0]), edgeOf(given.edges[1]), edgeOf(given.edges[2]), edgeOf(given.edges[3])};
    plate.poissonRatio           = given.poisson;
    plate.foundation             = given.foundation;
    const double* const rigidity = &demand(given.rigidity, "rigidity");
    plate.rigidity = NodeField(plate.grid.nodesX(), plate.grid.nodesZ(), {rigidity, rigidity + plate.grid.nodes()});
    return plate;
}

} // namespace

const char* palpate_version(void)
{
    return PALPATE_VERSION_TEXT;
}

const char* palpate_error_text(void)
{
    return lastError.c_str();
}

int palpate_object_from_points(const palpate_points* points, const char* scene, palpate_object** out)
{
    return guarded([&] {
        demand(out, "out")         = nullptr;
        const palpate_points given = taken(points, "palpate_points");
        Scene                whole = parseScene(scene ? scene : "{}", "scene", ".", {.withoutCloud = true});
        SoftObject           object(cloudOf(given), whole.material, facesOf(given), normalsOf(given));
        object.survey().expectSurface();
        object = onTissue(object, whole);
        makeObject(out, {std::move(whole), std::move(object)});
    });
}

int palpate_object_from_scene(const char* scene, const char* folder, palpate_object** out)
{
    return guarded([&] {
        demand(out, "out") = nullptr;
        Scene      whole   = parseScene(&demand(scene, "scene"), "scene", folder ? folder : ".");
        SoftObject object  = loadObject(whole).object;
        makeObject(out, {std::move(whole), std::move(object)});
    });
}

int palpate_object_from_file(const char* path, palpate_object** out)
{
    return guarded([&] {
        demand(out, "out") = nullptr;
        Scene      whole   = readScene(&demand(path, "path"));
        SoftObject object  = loadObject(whole).object;
        makeObject(out, {std::move(whole), std::move(object)});
    });
}

void palpate_object_destroy(palpate_object* object)
{
    delete object;
}

size_t palpate_object_size(const palpate_object* object)
{
    return object ? object->object.size() : 0;
}

int palpate_object_positions(const palpate_object* object, double* xyz, size_t count)
{
    return guarded([&] {
        const SoftObject& of = demand(object, "object").object;
        demandRoom(count, of.size());
        demand(xyz, "xyz");
        for (std::size_t n = 0; n < of.size(); ++n) put(of.positions()[n], xyz + 3 * n);
    });
}

int palpate_object_stiffness(const palpate_object* object, double* values, size_t count)
{
    return guarded([&] {
        const auto of = demand(object, "object").object.cloud().stiffness();
        demandRoom(count, of.size());
        std::ranges::copy(of, &demand(values, "values"));
    });
}

int palpate_object_scene(const palpate_object* object, char* text, size_t size, size_t* needed)
{
    return guarded([&] {
        const std::string json = sceneJson(demand(object, "object").scene);
        if (needed) *needed = json.size() + 1;
        if (text || !needed) giveText(json, text, size);
    });
}

int palpate_touch(const palpate_object* object, const double place[3], const double from[3],
                  palpate_touch_result* result)
{
    return guarded([&] {
        static_cast<void>(taken(result, "palpate_touch_result"));
        const palpate_object& of = demand(object, "object");
        PlateSolver           solver(of.scene.solver);
        const Patch           patch  = patchAt(of, place, from, solver);
        const int             middle = of.scene.patch.cells / 2;
        constexpr double      kNone  = std::numeric_limits<double>::quiet_NaN();
        palpate_touch_result  own{};
        own.felt_stiffness       = patch.feltStiffness;
        own.compliance           = patch.compliance;
        own.contact_stiffness    = patch.contactStiffness;
        own.rigidity             = patch.plate.rigidity(middle, middle);
        own.solver_error         = patch.report.errorEstimate.value_or(kNone);
        own.discretisation_error = discretisationError(patch, of.scene.patch, solver).value_or(kNone);
        put(patch.contact.point, own.place);
        put(patch.chart.frame.normal, own.normal);
        give(result, own);
    });
}

int palpate_touch_displaced(const palpate_object* object, const double place[3], const double from[3], double force,
                            double* xyz, size_t count)
{
    return guarded([&] {
        const palpate_object& of = demand(object, "object");
        demandRoom(count, of.object.size());
        demand(xyz, "xyz");
        if (!std::isfinite(force)) throw Error("force: expected a finite number [N], found another one");
        PlateSolver solver(of.scene.solver);
        const auto  moved = displaced(of.object.cloud(), patchAt(of, place, from, solver), force);
        for (std::size_t n = 0; n < moved.size(); ++n) put(moved[n], xyz + 3 * n);
    });
}

int palpate_felt_map(const palpate_object* object, const double* places, const double* from, size_t count, double* felt,
                     size_t* failed)
{
    return guarded([&] {
        const palpate_object& of = demand(object, "object");
        if (count > 0) demand(places, "places"), demand(felt, "felt");
        prepareTouch(of.object, of.scene.patch);
        constexpr std::size_t    kFewest = 8; // touches that are worth a solver and a thread
        std::atomic<std::size_t> bad     = 0;
        inParallel(count, kFewest, [&](std::size_t begin, std::size_t end) {
            PlateSolver solver(of.scene.solver);
            for (std::size_t n = begin; n < end; ++n) {
                felt[n] = std::numeric_limits<double>::quiet_NaN();
                try {
                    felt[n] = patchAt(of, places + 3 * n, from ? from + 3 * n : nullptr, solver).feltStiffness;
                } catch (const Error&) { // nothing can be touched there, and NaN says so
                    ++bad;
                }
            }
        });
        if (failed) *failed = bad;
    });
}

int palpate_session_create(const palpate_object* object, const palpate_session_settings* settings,
                           palpate_session** out)
{
    return guarded([&] {
        demand(out, "out")       = nullptr;
        const palpate_object& of = demand(object, "object");
        HapticDeviceInfo      device;
        device.model = "a host's";
        if (settings) {
            const auto given = taken(settings, "palpate_session_settings");
            for (const double value :
                 {given.device_mass, given.device_damping, given.maximum_force, given.maximum_stiffness})
                if (!(std::isfinite(value) && value >= 0))
                    throw Error("palpate_session_settings: expected finite numbers that are not negative, found " +
                                std::to_string(value));
            device.mass             = given.device_mass;
            device.ownDamping       = given.device_damping;
            device.maximumForce     = given.maximum_force;
            device.maximumStiffness = given.maximum_stiffness;
        }
        *out = new palpate_session{SteppedSession(of.object, of.scene, device)};
    });
}

void palpate_session_destroy(palpate_session* session)
{
    delete session;
}

int palpate_session_step(palpate_session* session, double time, const palpate_hand* hand, palpate_answer* answer)
{
    // Nothing here throws once the structs are known to be good; a sentence is made only if one is not.
    if (session && hand && answer && hand->size == sizeof *hand && answer->size == sizeof *answer) [[likely]] {
        palpate_answer    own{};
        const TickRecord& r    = session->session.step(time, handOf(*hand));
        const bool        good = (r.device & 0xFFU) != std::uint32_t(DeviceFault::kinematics); // as step() calls it
        put(r.force, own.force);
        own.flags = flagsOf(r, good);
        own.fault = r.faults & 0xFFU;
        put(r.proxy, own.proxy);
        put(r.normal, own.normal);
        own.depth     = glm::dot(r.proxy - r.hip, r.normal);
        own.stiffness = r.stiffness;
        give(answer, own);
        session->force.store(glm::length(r.force), std::memory_order_relaxed);
        session->last = r;
        return PALPATE_OK;
    }
    return guarded([&] {
        if (answer && answer->size >= 2 * sizeof(std::size_t)) give(answer, palpate_answer{});
        demand(session, "session");
        const palpate_hand now = taken(hand, "palpate_hand");
        static_cast<void>(taken(answer, "palpate_answer"));
        palpate_answer whole = PALPATE_INIT(palpate_answer);
        static_cast<void>(palpate_session_step(session, time, &now, &whole));
        give(answer, whole);
    });
}

int palpate_session_words(const palpate_session* session, char* text, size_t size)
{
    return guarded([&] { giveText(describeForces(demand(session, "session").last), text, size); });
}

int palpate_session_deformed(palpate_session* session, double* xyz, size_t count, uint64_t* sequence)
{
    return guarded([&] {
        palpate_session& of = demand(session, "session");
        demandRoom(count, of.session.object().size());
        demand(xyz, "xyz");
        if (of.session.takePatch()) ++of.shown;
        const Patch* const patch = of.session.patch();
        if (!patch || demand(sequence, "sequence") == of.shown) return;
        *sequence        = of.shown;
        const auto moved = displaced(of.session.object().cloud(), *patch, of.force.load(std::memory_order_relaxed));
        for (std::size_t n = 0; n < moved.size(); ++n) put(moved[n], xyz + 3 * n);
    });
}

int palpate_session_record(palpate_session* session, const char* folder)
{
    return guarded([&] {
        demand(session, "session")
            .session.record(&demand(folder, "folder"), std::string("libpalpate ") + palpate_version());
    });
}

int palpate_session_stop_recording(palpate_session* session, uint64_t* ticks, uint64_t* lost)
{
    return guarded([&] {
        const RecordingReport report = demand(session, "session").session.stopRecording();
        if (ticks) *ticks = report.ticks;
        if (lost) *lost = report.lost;
        if (report.stopped) throw Error(*report.stopped);
    });
}

int palpate_run(const palpate_object* object, const double* times, const double* places, size_t count, size_t ticks,
                double* forces, double* proxies)
{
    return guarded([&] {
        const palpate_object& of = demand(object, "object");
        demand(times, "times"), demand(places, "places");
        if (ticks > 0) demand(forces, "forces");
        std::vector<HandPose> poses(count);
        for (std::size_t n = 0; n < count; ++n) poses[n] = {times[n] - times[0], vectorOf(places + 3 * n)};
        const HandPath path(std::move(poses), "places");
        ScriptedHand   hand(path);
        Deformation    deformation(of.object, of.scene);
        std::size_t    at = 0;
        runVirtual({of.scene, of.object, deformation.solver(), hand, {}, deformation.firstLaw()}, 1e-3 * double(ticks),
                   [&](const TickRecord& r) {
                       if (at == ticks) return;
                       put(r.force, forces + 3 * at);
                       if (proxies) put(r.proxy, proxies + 3 * at);
                       ++at;
                   });
    });
}

int palpate_plate_solve(const palpate_plate* plate, const double* forces, double tolerance, double* deflection,
                        double* error)
{
    return guarded([&] {
        const Plate   of   = plateOf(taken(plate, "palpate_plate"));
        const double* from = &demand(forces, "forces");
        demand(deflection, "deflection");
        const NodeField     load(of.grid.nodesX(), of.grid.nodesZ(), {from, from + of.grid.nodes()});
        PlateSolver         solver("host");
        const PlateSolution solution = solver.solve(of, load, tolerance);
        std::ranges::copy(solution.deflection.values(), deflection);
        if (error) *error = solution.report.errorEstimate.value_or(std::numeric_limits<double>::quiet_NaN());
    });
}
