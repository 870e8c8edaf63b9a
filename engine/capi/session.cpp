#include <algorithm>
#include <atomic>
#include <utility>
#include <vector>

#include <glm/geometric.hpp>

#include "device/haptic_device.h"
#include "engine/capi/detail/border.h"
#include "engine/session/drawn_load.h"
#include "engine/session/force_state.h"
#include "engine/session/hand_path.h"
#include "engine/session/scripted_hand.h"
#include "engine/session/stepped_session.h"
#include "engine/session/virtual_session.h"

// Sessions: in a host's loop, and in virtual time.

struct palpate_session {
    palp::SteppedSession session;
    palp::TickRecord     last{};         ///< of step()'s thread
    std::atomic<double>  force{};        ///< [N] its magnitude, for the renderer's thread
    std::atomic<double>  deflection{};   ///< [m] the plate's largest, likewise
    std::atomic_flag     isStepping{};   ///< by one thread; a second one gets no force
    double               shownForce = 0; ///< [N] of the renderer's thread
    std::uint64_t        shown      = 0; ///< counts what the renderer's thread was given
};

namespace palp::capi {
namespace {

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
    const auto has = [&](SessionFlag flag) { return (r.faults & std::uint32_t(flag)) != 0; };
    Hand       hand;
    hand.setBits(r.device);
    const bool    touching = hand.hasPlace() && r.normal != glm::dvec3(0);
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

/// Returns what is known of the device that holds the hand.
HapticDeviceInfo deviceOf(const palpate_session_settings* settings)
{
    HapticDeviceInfo device;
    device.model = "a host's";
    if (!settings) return device;
    const auto given = taken(settings, "palpate_session_settings");
    for (const double value : {given.device_mass, given.device_damping, given.maximum_force, given.maximum_stiffness})
        if (!(std::isfinite(value) && value >= 0))
            throw Error("palpate_session_settings: expected finite numbers that are not negative, found " +
                        std::to_string(value));
    device.mass             = given.device_mass;
    device.ownDamping       = given.device_damping;
    device.maximumForce     = given.maximum_force;
    device.maximumStiffness = given.maximum_stiffness;
    return device;
}

/// Runs a tick. Nothing here throws or allocates.
palpate_answer answerOf(palpate_session& session, double time, const palpate_hand& hand) noexcept
{
    palpate_answer own{};
    own.flags = PALPATE_BAD_INPUT;
    if (session.isStepping.test_and_set(std::memory_order_acquire)) return own; // another thread's step has the force
    const TickRecord& r = session.session.step(time, handOf(hand));
    put(r.force, own.force);
    own.flags = flagsOf(r, (r.device & 0xFFU) != std::uint32_t(DeviceFault::kinematics)); // as step() calls it;
    own.fault = r.faults & 0xFFU;
    put(r.proxy, own.proxy);
    put(r.normal, own.normal);
    own.depth     = glm::dot(r.proxy - r.hip, r.normal);
    own.stiffness = r.stiffness;
    session.force.store(glm::length(r.force), std::memory_order_relaxed);
    session.deflection.store(r.maxDeflection, std::memory_order_relaxed);
    session.last = r;
    session.isStepping.clear(std::memory_order_release);
    return own;
}

/// Returns true if there is something else to draw than last time: another patch, or the one from before without its
/// force.
bool takeDent(palpate_session& session, double force)
{
    const bool isNew = session.session.takePatch(), letGo = force == 0 && session.shownForce != 0;
    if (isNew || letGo) ++session.shown;
    return session.session.patch() != nullptr;
}

} // namespace
} // namespace palp::capi

using namespace palp;
using namespace palp::capi;

int palpate_session_create(const palpate_object* object, const palpate_session_settings* settings,
                           palpate_session** out)
{
    return guarded([&] {
        demand(out, "out")            = nullptr;
        const palpate_object& of      = demand(object, "object");
        auto                  session = std::unique_ptr<palpate_session>(
            new palpate_session{SteppedSession(of.object, of.scene, deviceOf(settings), of.own)});
        keepTakeover(session->session.takeover());
        *out = session.release();
    });
}

void palpate_session_destroy(palpate_session* session)
{
    delete session;
}

int palpate_session_step(palpate_session* session, double time, const palpate_hand* hand, palpate_answer* answer)
{
    // A sentence is made only if a struct is not as this version has it.
    if (session && hand && answer && hand->size == sizeof *hand && answer->size == sizeof *answer) [[likely]] {
        give(answer, answerOf(*session, time, *hand));
        return PALPATE_OK;
    }
    return guarded([&] {
        if (answer && answer->size >= 2 * sizeof(std::size_t)) give(answer, palpate_answer{});
        demand(session, "session");
        const palpate_hand now = taken(hand, "palpate_hand");
        static_cast<void>(taken(answer, "palpate_answer"));
        give(answer, answerOf(*session, time, now));
    });
}

int palpate_session_words(const palpate_session* session, char* text, size_t size)
{
    return guarded([&] { giveText(describeForces(demand(session, "session").last), text, size); });
}

int palpate_session_takeover(const palpate_session* session, char* text, size_t size)
{
    return guarded([&] { giveText(demand(session, "session").session.takeover(), text, size); });
}

int palpate_session_deformed(palpate_session* session, double* xyz, size_t count, uint64_t* sequence)
{
    return guarded([&] {
        palpate_session& of = demand(session, "session");
        demandRoom(count, of.session.object().size());
        demand(xyz, "xyz"), demand(sequence, "sequence");
        const double force = of.force.load(std::memory_order_relaxed);
        if (!takeDent(of, force) || *sequence == of.shown) return;
        *sequence          = of.shown;
        of.shownForce      = force;
        const double load  = drawnLoad(force, of.deflection.load(std::memory_order_relaxed), of.session.patch(),
                                       of.session.object().material());
        const auto   moved = displaced(of.session.object().cloud(), *of.session.patch(), load);
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
        if (count == 0 || count > kMostInArray)
            throw Error("count: expected 1 to " + std::to_string(kMostInArray) + " places, found " +
                        std::to_string(count));
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
        keepTakeover(deformation.plateSolver().takeoverSince(0));
    });
}
