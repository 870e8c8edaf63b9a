#include "engine/session/virtual_session.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <memory>
#include <numbers>
#include <set>

#include <glm/geometric.hpp>

#include "engine/core/latest_pair.h"
#include "engine/session/deformation.h"
#include "engine/session/recorded_session.h"
#include "engine/session/scripted_hand.h"
#include "tests/session/sheet_session.h"
#include "tests/support/allocations.h"
#include "tests/support/sanitized.h"

namespace palp {
namespace {

bool has(const TickRecord& record, SessionFlag flag)
{
    return (record.faults & static_cast<std::uint32_t>(flag)) != 0;
}

RecordedSession asRecorded(std::vector<TickRecord> records)
{
    RecordedSession session;
    session.records = std::move(records);
    return session;
}

TEST(VirtualSession, TheWartIsFeltWhereItIs)
{
    const SheetSession      session(sheetScene(kWart));
    std::vector<TickRecord> records = session.run(1.5);
    double                  on = 0, off = std::numeric_limits<double>::infinity();
    glm::dvec3              last{};
    for (const TickRecord& s : records) {
        ASSERT_TRUE(std::isfinite(s.force.x + s.force.y + s.force.z));
        EXPECT_LE(glm::length(s.force - last), 1 + 1e-9) << "the governor's slew: 1 N a tick; at " << s.time;
        EXPECT_LE(glm::length(s.force), session.scene.maxForce + 1e-9);
        EXPECT_FALSE(has(s, SessionFlag::stalePatch)) << s.time;
        last = s.force;
        if (s.compliance <= 0) continue;
        const double away = std::hypot(s.proxy.x, s.proxy.y);
        if (away < 2e-3) on = std::max(on, 1 / s.compliance);
        if (away > 9e-3) off = std::min(off, 1 / s.compliance);
    }
    EXPECT_GT(on, 1.3 * off) << "stiffer on the wart than 9 mm beside it, where three deviations of it are left behind";
}

TEST(VirtualSession, ARecordSaysWhatWasWantedAndWhyTheForceIsAnother)
{
    const SheetSession session(sheetScene(kWart), HandMotion::scan, 2.5);
    std::uint64_t      tick = 0, held = 0, passed = 0;
    for (const TickRecord& s : session.run(2.5)) {
        EXPECT_EQ(s.answers, ++tick);
        EXPECT_GE(s.tankEnergy, 0);
        EXPECT_LE(s.tankEnergy, EnergyTankSettings().limit);
        EXPECT_TRUE(std::isfinite(s.observerEnergy));
        const double missing = glm::length(s.wanted - s.force);
        EXPECT_LE(s.actions == 0 ? missing : 0, 1e-9) << "rounding; at " << s.time;
        if (glm::length(s.wanted) == 0) continue;
        EXPECT_GT(s.stiffness, 0);
        EXPECT_LE(s.stiffness, session.scene.stiffnessCap);
        ++(s.actions == 0 ? passed : held);
        const bool engaging = (s.actions & static_cast<std::uint32_t>(GovernorAction::engaging)) != 0;
        EXPECT_TRUE(engaging || s.time > 1) << s.time;
    }
    EXPECT_GT(held, 300U) << "while the force comes on";
    EXPECT_GT(passed, 300U) << "then";
}

TEST(VirtualSession, AHandIsTurnedIntoTheSceneWithItsOrientation)
{
    const double      half = std::sqrt(0.5);
    const DeviceFrame frame{{}, {half, 0, 0, half}}; // a quarter turn about z
    HapticState       state;
    state.orientation = {half, half, 0, 0}; // a quarter turn about x
    state.sequence    = (std::uint64_t(1) << 32U) + 7;

    const Hand hand = frame.handOf(state), again = DeviceFrame().handOf({.orientation = hand.orientation});

    const glm::dvec3 up = hand.orientation * glm::dvec3(0, 1, 0), right = hand.orientation * glm::dvec3(1, 0, 0);
    EXPECT_NEAR(up.z, 1, 1e-12) << "rounding";
    EXPECT_NEAR(right.y, 1, 1e-12) << "rounding";
    EXPECT_EQ(hand.sequence, state.sequence);
    EXPECT_EQ(std::memcmp(&hand.orientation, &again.orientation, sizeof hand.orientation), 0) << "a replay's bits";
    for (int k = 0; k < 4; ++k) EXPECT_FALSE(hand.orientation[k] == 0 && std::signbit(hand.orientation[k]));
}

TEST(VirtualSession, TheSameInputGivesTheSameBits)
{
    const SheetSession session(sheetScene(kWart));
    const auto         first = asRecorded(session.run(0.6)), second = asRecorded(session.run(0.6));
    EXPECT_FALSE(compareSessions(first, second).has_value());
}

TEST(VirtualSession, TheHostAndLavapipeGiveTheSameBits)
{
    const SheetSession here(sheetScene(kWart)), there(sheetScene(kWart, "lavapipe"));
    const auto         first = asRecorded(here.run(0.4)), second = asRecorded(there.run(0.4));
    const auto         difference = compareSessions(first, second);
    EXPECT_FALSE(difference.has_value()) << describe(*difference, first, second);
    EXPECT_GT(glm::length(first.records.back().force), 0) << "there is something to compare";
}

/// On a homogeneous object nothing that the points do may be felt: J below 0.5 for the best Weber fraction, 0.07.
TEST(VirtualSession, AHomogeneousSheetFeelsTheSameEverywhere)
{
    const SheetSession session(sheetScene(R"({"law": "constant", "value": 0.5e6})"));
    double             least = std::numeric_limits<double>::infinity(), most = 0;
    for (const TickRecord& s : session.run(1.5)) {
        if (s.compliance <= 0) continue;
        least = std::min(least, s.compliance);
        most  = std::max(most, s.compliance);
    }
    ASSERT_GT(most, 0);
    EXPECT_LT(std::log(most / least) / std::log(1.07), 1e-6) << "exact by construction but for rounding; 0.5 is asked";
}

/// The same on curved objects, through everything from the hand to the governed force: J below 0.5 for the best Weber
/// fraction, 0.07. Measured: 0.09, which is what the governor's damping of a hand that rides up and down does.
TEST(VirtualSession, AHomogeneousCurvedObjectFeelsTheSameAlongThePath)
{
    for (const char* const object : {R"("sample:ellipsoid", "place": [0.03, 0, 0.0303])",
                                     R"("sample:palm", "place": [0, 0, 0], "from": [0, 0, 1])"}) {
        SheetSession session(parseScene(R"({"thickness": "4 mm", "poisson": 0.45, "foundation": "1.74 MPa/m",
            "window": "70 mm", "cells": 32, "footprint_radius": "4.4 mm", "solver": "host",
            "stiffness": {"law": "constant", "value": 0.5e6}, "cloud": )" +
                                            std::string(object) + "}",
                                        "a test", "."));
        session.drape();
        double softest = std::numeric_limits<double>::infinity(), stiffest = 0, least = softest, most = 0;
        for (const TickRecord& s : session.run(3)) {
            if (s.compliance <= 0 || s.time < 1.7) continue; // [s] 1.5 to engage, after the way down
            const double felt = glm::length(s.force) / glm::length(s.proxy - s.hip);
            softest           = std::min(softest, felt);
            stiffest          = std::max(stiffest, felt);
            least             = std::min(least, s.compliance);
            most              = std::max(most, s.compliance);
        }
        ASSERT_GT(most, 0) << object;
        EXPECT_LT(std::log(stiffest / softest) / std::log(1.07), 0.5) << object << softest << " to " << stiffest;
        EXPECT_LT(std::log(most / least) / std::log(1.07), 1e-6) << object << ", the plate's part; rounding";
    }
}

/// A shell that a scene holds: each window is cut from it anew, and the hand meets no seam between them.
TEST(VirtualSession, WindowsThatAreCutFromABodyHaveNoSeam)
{
    SheetSession session(parseScene(R"({"cloud": "sample:ellipsoid", "place": [0.03, 0, 0.0303], "theory": "shell",
        "held": {"box": [[-1, -1, -1], [1, 1, -0.01]]}, "foundation": 0, "thickness": "2 mm", "poisson": 0.45,
        "footprint_radius": "4 mm", "solver": "host", "stiffness": {"law": "constant", "value": 0.5e6}})",
                                    "a test", "."),
                         HandMotion::scan, 4);
    ASSERT_TRUE(isCutFromBody(session.object, session.scene.patch));
    session.drape();
    double last = 0, most = 0, least = std::numeric_limits<double>::infinity(), largest = 0;
    for (const TickRecord& s : session.run(4)) {
        EXPECT_FALSE(has(s, SessionFlag::stalePatch)) << s.time;
        if (s.compliance <= 0 || s.time < 1.7) continue; // [s] 1.5 to engage, after the way down
        if (last > 0) most = std::max(most, std::abs(std::log(s.compliance / last)));
        last    = s.compliance;
        least   = std::min(least, s.compliance);
        largest = std::max(largest, s.compliance);
    }
    ASSERT_GT(last, 0);
    EXPECT_GT(largest / least, 1.02) << "a body that is held below is softer on one side";
    EXPECT_LT(most, 0.01) << "of a step from tick to tick: a seventh of the best Weber fraction; 0.0057 measured";
    PlateSolver   host("host");
    const auto    place = handPlace(session.scene, session.object);
    const Contact at{place.point, place.outward, true, false};
    const double  touch = deform(session.object, at, session.scene.patch, host).compliance;
    EXPECT_GT(touch, 0.9 * least);
    EXPECT_LT(touch, 1.1 * largest);
}

/// The paper's law on a hard sheet asks for 45 kN/m, far beyond what a sampled loop can render.
TEST(VirtualSession, NoStiffnessBeyondTheCapIsRendered)
{
    Scene scene          = sheetScene(R"({"law": "constant", "value": 3e6})");
    scene.patch.forceLaw = ForceLaw::paper;
    scene.maxForce       = 8;
    for (const double cap : {500.0, 1000.0}) {
        scene.stiffnessCap = cap;
        const SheetSession session(scene, HandMotion::press, 4);
        double             most = 0;
        for (const TickRecord& s : session.run(4)) {
            const double depth = glm::length(s.proxy - s.hip);
            if (s.time > 1.7 && depth > 0.5e-3) most = std::max(most, glm::length(s.force) / depth);
        }
        EXPECT_GT(most, 0.95 * cap) << "the force is on, and the cap binds";
        EXPECT_LT(most, 1.05 * cap) << "the passivity controller's damping takes, it does not give";
    }
}

/// Poked from the first moment on, while the force still comes on: whatever the governor does then, the surface never
/// pulls, and nothing is felt out of contact.
TEST(VirtualSession, TheSurfaceNeverPulls)
{
    SheetSession          session(sheetScene(kWart));
    std::vector<HandPose> pokes;
    for (int n = 0; n <= 4000; ++n) {
        const double s = std::sin(std::numbers::pi * n * 1e-3);
        pokes.push_back({n * 1e-3, {5e-3, 0, 3e-3 - 7e-3 * s * s}});
    }
    session.hand     = HandPath(pokes);
    double     least = 0, out = 0; // [N]
    const auto records = session.run(4);
    for (const TickRecord& s : records) {
        least = std::min(least, glm::dot(s.force, s.normal));
        if (s.normal == glm::dvec3(0)) out = std::max(out, glm::length(s.force));
    }
    EXPECT_GT(largestForce(records), 0.5) << "or nothing is shown: 4 mm into skin are some 2 N";
    EXPECT_GT(least, -1e-12) << "rounding";
    EXPECT_EQ(out, 0);
}

/// What the table reaches is what a hand of 0.2 m/s can do, at either rate.
TEST(VirtualSession, TheTableReachesAsFarAsAFastHandGoes)
{
    for (const double rate : {30.0, 60.0}) {
        Scene scene           = sheetScene(kWart);
        scene.deformationRate = rate;
        SheetSession session(scene);
        session.hand = makeHand(
            {.motion = HandMotion::scan, .speed = 0.2, .depth = 1.5e-3, .radius = 14e-3, .height = 2e-3, .duration = 3},
            handPlace(scene, session.object));
        std::size_t beyond = 0, touching = 0;
        for (const TickRecord& s : session.run(3)) {
            beyond += has(s, SessionFlag::beyondTable);
            touching += s.compliance > 0;
        }
        EXPECT_GT(touching, 1000U);
        EXPECT_LE(beyond, touching / 1000) << rate << " Hz; where it turns, the proxy sticks and then jumps";
    }
}

TEST(Servo, TheFirstButtonHeldDownResetsAFault)
{
    const SheetSession session(sheetScene(kWart));
    Servo              servo(session.object, session.scene);
    Hand               hand{session.hand.position(0), {}};
    (void)servo.tick({0, 1e-3}, hand, nullptr);
    hand.velocity = {std::nan(""), 0, 0};
    (void)servo.tick({1e-3, 1e-3}, hand, nullptr);
    hand.velocity = {};
    (void)servo.tick({2e-3, 1e-3}, hand, nullptr);
    EXPECT_EQ(servo.governor().fault(), GovernorFault::velocityNotFinite) << "it stays";
    hand.buttons = ForceHalf::kOperatorsButton;
    for (int n = 0; n < ForceHalf::kPressTicks; ++n) {
        EXPECT_EQ(servo.governor().fault(), GovernorFault::velocityNotFinite) << "a glitch is no press: " << n;
        (void)servo.tick({3e-3 + 1e-3 * n, 1e-3}, hand, nullptr);
    }
    EXPECT_EQ(servo.governor().fault(), GovernorFault::none);
}

/// A hand that begins inside a closed body, as that of an arm which hangs down: taken to have come from before its skin
/// it touches that, without a force until it was lifted off however long it rests, during which the tank would pay for
/// one, and then with all of it. Taken to begin in free space it would be held inside.
TEST(VirtualSession, AHandThatBeginsInsideIsNotHeldThere)
{
    const Scene scene =
        parseScene(R"({"cloud": "sample:ellipsoid", "points": 8000, "foundation": "1 MPa/m"})", "s", ".");
    const SoftObject object = loadObject(scene).object;
    const HandPlace  place  = handPlace(scene, object);
    const auto       at     = [&](double height) { return place.point + height * place.outward; };
    constexpr double kRest  = kSanitized ? 3 : 20; // [s] the same code again
    // A rest in the middle, up through the skin, a rest above, and down on it again.
    std::vector<HandPose> way{{0, at(-30e-3)}};
    for (const auto& [time, height] : {std::pair(0.0, -30e-3), {1.0, 20e-3}, {2.5, 20e-3}, {3.5, -2e-3}, {4.5, -2e-3}})
        way.push_back({kRest + time, at(height)});
    const HandPath path(way, "test");
    struct Felt {
        double most = 0, inward = 0, last = 0; ///< [N] before the hand was off, of that towards the middle, at the end
    };
    /// At first it does not know where it is, and says that it is above.
    class Unsure : public ScriptedHand {
    public:
        Unsure(const HandPath& way, double until, const glm::dvec3& above)
            : ScriptedHand(way), until_(until), above_(above)
        {
        }
        HapticState read(double now) noexcept override
        {
            HapticState state = ScriptedHand::read(now);
            if (now >= until_) return state;
            state.homed    = false;
            state.position = above_;
            return state;
        }

    private:
        double     until_;
        glm::dvec3 above_;
    };
    const auto feltFrom = [&](const std::optional<glm::dvec3>& from, double unsureUntil = 0) {
        Felt        felt;
        Unsure      device(path, unsureUntil, at(10e-3));
        Deformation deformation(object, scene);
        runVirtual({scene, object, deformation.solver(), device, {}, deformation.firstLaw(), from}, kRest + 4.5,
                   [&](const TickRecord& s) {
                       const double out = glm::dot(s.force, place.outward);
                       if (s.time < kRest + 1) felt.most = std::max(felt.most, glm::length(s.force));
                       felt.inward = std::max(felt.inward, -out);
                       felt.last   = out;
                   });
        return felt;
    };
    EXPECT_GT(feltFrom({}).inward, 1) << "or the fixture shows nothing";
    for (const double unsureUntil : {0.0, 0.2}) {
        const Felt free = feltFrom(at(10e-3), unsureUntil);
        EXPECT_EQ(free.most, 0) << unsureUntil;
        EXPECT_EQ(free.inward, 0) << unsureUntil;
        EXPECT_GT(free.last, 0.5) << unsureUntil;
    }
}

/// A device that renders little is never asked for more, whatever the scene allows.
TEST(VirtualSession, TheDevicesLimitsBoundTheForce)
{
    class Weak : public ScriptedHand {
    public:
        explicit Weak(const HandPath& hand) : ScriptedHand(hand), weak_(ScriptedHand::info())
        {
            weak_.maximumForce     = 0.4;
            weak_.maximumStiffness = 300;
        }
        [[nodiscard]] const HapticDeviceInfo& info() const noexcept override { return weak_; }

    private:
        HapticDeviceInfo weak_;
    };
    const SheetSession session(sheetScene(R"({"law": "constant", "value": 3e6})"), HandMotion::press, 3);
    Weak               device(session.hand);
    Deformation        deformation(session.object, session.scene);
    double             most = 0, stiffest = 0; // [N], [N/m]
    runVirtual({session.scene, session.object, deformation.solver(), device, {}}, 3, [&](const TickRecord& s) {
        const double depth = glm::length(s.proxy - s.hip), force = glm::length(s.force);
        most = std::max(most, force);
        if (s.time > 1.7 && depth > 0.3e-3) stiffest = std::max(stiffest, force / depth);
    });
    EXPECT_NEAR(most, 0.4, 1e-9) << "it would be 450 mN by the stiffness alone";
    EXPECT_LE(stiffest, 300 * 1.05);
    EXPECT_GT(stiffest, 250);
}

TEST(Servo, TheLagIsMeasuredFromTheDevicesAnswers)
{
    const SheetSession session(sheetScene(kWart));
    Servo              servo(session.object, session.scene);
    Hand               hand{session.hand.position(0), {}};
    hand.answerAge = 1.5e-3;
    for (int n = 0; n < 200; ++n) { // two answers in five ticks, of which none is seen at once
        hand.sequence   = std::uint64_t(n * 2 / 5) + 1;
        hand.answerTime = 2.5e-3 * double(hand.sequence - 1) - 0.3e-3;
        (void)servo.tick({1e-3 * n, 1e-3}, hand, nullptr);
    }
    EXPECT_NEAR(servo.governor().lag(), 1.5e-3 + 2.5e-3 * 1.5, 1e-9) << "age, period, half of it";
    EXPECT_NEAR(servo.governor().stiffnessCap(), 0.8 * 3.2 / 5.25e-3, 1e-6);
}

TEST(Servo, OnlyADeviceThatStatesItsDampingIsCreditedWithIt)
{
    const SheetSession session(sheetScene(kWart));
    HapticDeviceInfo   unknown;
    unknown.maximumForce     = 5;
    unknown.maximumStiffness = 600;
    HapticDeviceInfo known   = unknown;
    known.mass               = 0.1;
    known.ownDamping         = 0.2;
    const ForceHalf first(session.scene, unknown), second(session.scene, known), none(session.scene);
    EXPECT_EQ(first.governor().settings().ownDamping, 0);
    EXPECT_EQ(first.governor().stiffnessCap(), 600) << "what its maker states";
    EXPECT_NEAR(second.governor().stiffnessCap(), 0.8 * 0.2 / 1.5e-3, 1e-9) << "less than it states";
    EXPECT_EQ(none.governor().settings().ownDamping, 3.2) << "without motors: the simulated arm's";
}

TEST(VirtualSession, AForceLeavesInTheTickThatComputesIt)
{
    class Listening : public ScriptedHand {
    public:
        using ScriptedHand::ScriptedHand;
        void   render(const GovernedForce& force) noexcept override { newest = glm::length(force.newtons()); }
        double newest = 0; // [N]
    };
    const SheetSession session(sheetScene(kWart), HandMotion::press);
    Listening          device(session.hand);
    Deformation        deformation(session.object, session.scene);
    double             most = 0;
    runVirtual({session.scene, session.object, deformation.solver(), device, {}}, 2, [&](const TickRecord& s) {
        EXPECT_EQ(device.newest, glm::length(s.force)) << s.time;
        most = std::max(most, device.newest);
    });
    EXPECT_GT(most, 0.1) << "or it says nothing";
}

TEST(Servo, ATickAllocatesNothing)
{
    const SheetSession                 session(sheetScene(kWart));
    Servo                              servo(session.object, session.scene);
    Deformation                        deformation(session.object, session.scene);
    std::shared_ptr<const PatchUpdate> news;
    std::size_t                        allocated = 0;
    for (int n = 0; n < 900; ++n) {
        const double     time   = 1e-3 * n;
        const glm::dvec3 hip    = session.hand.position(time);
        const auto       before = allocationsOfThisThread();
        (void)servo.tick({time, 1e-3}, {hip, {}}, news.get());
        if (n > 0) allocated += allocationsOfThisThread() - before;
        if (n % 100 == 99 && servo.touch().touching) news = deformation.solve(servo.touch(), 0.1).update;
    }
    EXPECT_TRUE(news != nullptr) << "the hand came to touch";
    EXPECT_EQ(allocated, 0U);
}

TEST(Servo, ReadsTablesWhereTheSolverWroteThemAndAsLongAsItUsesThem)
{
    const SheetSession session(sheetScene(kWart));
    Servo              servo(session.object, session.scene);
    auto               deformation = std::make_unique<Deformation>(session.object, session.scene);
    LatestPair<std::shared_ptr<const PatchUpdate>> updates;
    std::set<const ComplianceTable*>               written;
    int                                            solved = 0;
    for (int n = 0; n < 900; ++n) {
        const double time = 1e-3 * n;
        updates.take([&](const auto& update) { return update && &update->table == servo.tableInUse(); });
        const auto* const newest = updates.newest();
        (void)servo.tick({time, 1e-3}, {session.hand.position(time), {}}, newest ? newest->get() : nullptr);
        if (newest) {
            EXPECT_EQ(servo.tableInUse(), &(*newest)->table) << "a copy lies between";
        }
        if (n % 10 != 9 || !servo.touch().touching) continue;
        const ComplianceTable* const       inUse  = servo.tableInUse();
        const std::uint64_t                before = inUse ? inUse->sequence : 0;
        std::shared_ptr<const PatchUpdate> update = deformation->solve(servo.touch(), 0.01).update;
        ASSERT_NE(update, nullptr) << n;
        EXPECT_NE(&update->table, inUse) << "the solver writes what the servo reads";
        EXPECT_EQ(inUse ? inUse->sequence : 0, before);
        written.insert(&update->table);
        updates.draft() = std::move(update);
        updates.publish();
        if (++solved == 20) break;
    }
    EXPECT_EQ(solved, 20);
    EXPECT_LE(written.size(), 5U) << "slots are used again: four in the hand-off, one being filled";

    deformation.reset(); // with its solver, as when a processor is lost and another one takes over
    const std::uint64_t last = servo.tableInUse()->sequence;
    (void)servo.tick({0.9, 1e-3}, {session.hand.position(0.9), {}}, updates.newest()->get());
    EXPECT_EQ(servo.tableInUse()->sequence, last) << "it outlives the deformation";
    EXPECT_TRUE(servo.tableInUse()->usable());
}

TEST(Servo, AForceWhoseTableIsTooOldFadesAndEngagesAnewOnceThereAreTables)
{
    const SheetSession                 session(sheetScene(kWart), HandMotion::press, 2);
    Servo                              servo(session.object, session.scene);
    Deformation                        deformation(session.object, session.scene);
    std::shared_ptr<const PatchUpdate> news;
    glm::dvec3                         last{};
    double                             most = 0, again = 0, step = 0; // [N]
    // Pressing, the hand is deepest after pi (h + d) / (2 speed) = 0.055 s, and stays there, but for a moment at 3.2 s.
    for (int n = 0; n < 6000; ++n) {
        const double     time    = 1e-3 * n;
        const bool       isDead  = time > 2 && time < 3;
        const bool       isAway  = time > 3.2 && time < 3.3;
        const glm::dvec3 hip     = session.hand.position(isAway ? 0 : std::min(time < 3.2 ? time : time - 3.3, 0.055));
        const auto       record  = servo.tick({time, 1e-3}, {hip, {}}, news.get());
        const double     force   = glm::length(record.force);
        const double     without = time - 2; // [s] a table
        if (!isDead && n % 16 == 0 && servo.touch().touching) news = deformation.solve(servo.touch(), 1.0 / 60).update;
        if (time > 1.9 && time < 2) most = std::max(most, force);
        if (isDead && without < 0.22) {
            EXPECT_GT(force, 0.9 * most) << time;
        }
        if (isDead && without > 0.25 + 0.02 + 2e-3) {
            EXPECT_EQ(force, 0) << time;
        }
        if (isDead && without > 0.25 + 2e-3) {
            EXPECT_TRUE(has(record, SessionFlag::oldTable)) << time;
        }
        if (time < 2 || time > 3.02) {
            EXPECT_FALSE(has(record, SessionFlag::oldTable)) << time;
        }
        if (time > 3 && time < 3.3) {
            EXPECT_EQ(force, 0) << time << ": the hand has not been lifted";
        }
        if (time > 3.36 && time < 4.5) step = std::max(step, glm::length(record.force - last));
        if (time > 5.5) again = std::max(again, force);
        last = record.force;
    }
    EXPECT_GT(most, 0.3) << "the hand rests in the sheet and feels it";
    EXPECT_LT(step, 2e-3 * most) << "it comes on within 1.5 s, 0.7 thousandths a tick, and kicks nobody";
    EXPECT_NEAR(again, most, 0.02 * most);
}

/// A table of an object is as good as one of now where it reaches, so that a solve of half a second ends no force. What
/// says for two seconds nothing may be dead.
TEST(Servo, ATableThatLastsIsNotTooOldWhereItReaches)
{
    const SheetSession session(sheetScene(kWart), HandMotion::press, 2);
    struct Case {
        bool   lasts;
        double away, until; ///< [m] that the hand has gone; [s] after the last table that the force lives
    };
    for (const auto& [lasts, away, until] :
         {Case{false, 0, 0.27}, Case{true, 0, 2.27}, Case{true, 1e-3, 2.27}, Case{true, 20e-3, 0.27}}) {
        Servo                              servo(session.object, session.scene);
        Deformation                        deformation(session.object, session.scene);
        std::shared_ptr<const PatchUpdate> news;
        double                             last = 0; // [s] with a force
        for (int n = 0; n < 4500; ++n) {
            const double time = 1e-3 * n;
            glm::dvec3   hip  = session.hand.position(std::min(time, 0.055));
            hip.x += std::clamp(time - 2, 0.0, 0.1) * away / 0.1;
            const auto record = servo.tick({time, 1e-3}, {hip, {}}, news.get());
            if (record.force != glm::dvec3(0)) last = time;
            if (time >= 2 || n % 16 != 0 || !servo.touch().touching) continue;
            const auto update   = deformation.solve(servo.touch(), 1.0 / 60).update; // its memory is the deformation's
            update->table.lasts = lasts;
            news                = update;
        }
        EXPECT_NEAR(last, 2 + until, 0.1) << lasts << " " << away << ": it fades, and is asked in a while";
    }
}

/// One that lasted until now is as good as new then, however long ago its place was solved for.
TEST(Servo, ATableThatEndsIsFeltForAQuarterOfASecondMore)
{
    const SheetSession                 session(sheetScene(kWart), HandMotion::press, 2);
    Servo                              servo(session.object, session.scene);
    Deformation                        deformation(session.object, session.scene);
    std::shared_ptr<const PatchUpdate> news;
    double                             last = 0; // [s] with a force
    for (int n = 0; n < 3000; ++n) {
        const double time = 1e-3 * n;
        const auto   hip  = session.hand.position(std::min(time, 0.055));
        if (servo.tick({time, 1e-3}, {hip, {}}, news.get()).force != glm::dvec3(0)) last = time;
        if (time < 1 && n % 16 == 0 && servo.touch().touching) {
            const auto update   = deformation.solve(servo.touch(), 1.0 / 60).update;
            update->table.lasts = true;
            news                = update;
        }
        if (n != 2000) continue;
        auto ended            = std::make_shared<PatchUpdate>(*news);
        ended->table.sequence = servo.touch().sequence;
        ended->table.lasts    = false;
        ended->table.ended    = true;
        news                  = std::move(ended);
    }
    EXPECT_NEAR(last, 2.27, 0.01);
}

/// A deformation at 2 Hz has three of its periods for its first table.
TEST(Servo, TheHomogeneousLawAnswersAsLongAsASlowDeformationMayTake)
{
    const SheetSession   session(sheetScene(kWart), HandMotion::press, 2);
    const HomogeneousLaw first({{{0, 0, 0}, std::log(2e-3), std::log(3000.0), 0}}, 0.02);
    Scene                slow = session.scene;
    slow.deformationRate      = 2;
    Servo  servo(session.object, slow, {}, &first);
    double most = 0, least = 1e9, late = 0; // [N]
    for (int n = 0; n < 3000; ++n) {
        const double time = 1e-3 * n, since = time - 0.055; // [s]
        const double force =
            glm::length(servo.tick({time, 1e-3}, {session.hand.position(std::min(time, 0.055)), {}}, nullptr).force);
        most = std::max(most, force);
        if (since > 0.2 && since < 1.4) least = std::min(least, force); // it comes on within that time
        if (since > 1.55) late = std::max(late, force);
    }
    EXPECT_GT(most, 0.1);
    EXPECT_GT(least, 0.1 * most);
    EXPECT_EQ(late, 0);
}

/// The homogeneous law answers a contact for a quarter of a second, also the contact after one that waited in vain.
TEST(Servo, EveryContactWithoutATableHasItsOwnQuarterOfASecond)
{
    const SheetSession   session(sheetScene(kWart));
    const HomogeneousLaw first({{{0, 0, 0}, std::log(2e-3), std::log(3000.0), 0}}, 0.02);
    Servo                servo(session.object, session.scene, {}, &first);
    double               time = 0, height = 10e-3; // [s], [m]
    const auto           mostForce = [&](double goal, int ticks) {
        double most = 0;
        for (int tick = 0; tick < ticks; ++tick) {
            height += std::clamp(goal - height, -1e-3, 1e-3);
            most = std::max(most, glm::length(servo.tick({time += 1e-3, 1e-3}, {{0, 0, height}, {}}, nullptr).force));
        }
        return most;
    };
    (void)mostForce(10e-3, 2500);
    const double once = mostForce(-1e-3, 200);
    EXPECT_GT(once, 0.1);
    EXPECT_GT(mostForce(-1e-3, 200), 0) << "for some 50 ms more";
    EXPECT_EQ(mostForce(-1e-3, 100), 0) << "it waits in vain";
    EXPECT_EQ(mostForce(10e-3, 2500), 0);
    EXPECT_NEAR(mostForce(-1e-3, 200), once, 0.01 * once);
}

TEST(Servo, AHandThatIsNotANumberEndsAtZeroForceWithAReason)
{
    const SheetSession session(sheetScene(kWart));
    Servo              servo(session.object, session.scene);
    (void)servo.tick({0, 1e-3}, {session.hand.position(0), {}}, nullptr);
    TickRecord record;
    for (int n = 1; n <= 20; ++n) record = servo.tick({1e-3 * n, 1e-3}, {glm::dvec3(std::nan("")), {}}, nullptr);
    EXPECT_EQ(record.force, glm::dvec3(0));
    EXPECT_EQ(record.faults & 0xFFU, static_cast<std::uint32_t>(GovernorFault::positionNotFinite));
}

} // namespace
} // namespace palp
