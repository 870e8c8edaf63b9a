// The drivers on makers' libraries, which this program loads as the drivers do: stand-ins of them, with the same
// symbols.
#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <cstdlib>
#include <memory>
#include <string>
#include <thread>
#include <tuple>

#include <dlfcn.h>
#include <glm/geometric.hpp>

#include "device/vendor/force_dimension.h"
#include "device/vendor/open_haptics.h"
#include "engine/core/contract.h"
#include "tests/device/fake_hid.h"
#include "tests/device/fake_sdk/fake_sdk.h"
#include "tests/device/governed.h"

namespace palp {
namespace {

constexpr double kTick = 1e-3;  // [s]
constexpr double kZero = 30e-3; // [s] by which a force has ended, whatever happens

double virtualTime = 0; // [s] of the lines' clock

/// Points the loader at a folder, and back at nothing.
struct Environment {
    Environment(const char* variable, const std::string& folder) : name(variable)
    {
        setenv(variable, folder.c_str(), 1);
    }
    ~Environment() { unsetenv(name); }
    const char* name;
};

/// Returns the registers of a stand-in, as they are at first.
FakeSdk& registersOf(const std::string& library)
{
    void* const handle = dlopen(library.c_str(), RTLD_NOW | RTLD_LOCAL);
    if (!handle) throw Error(dlerror());
    FakeSdk& sdk = *reinterpret_cast<FakeSdk* (*)()>(dlsym(handle, "fakeSdk"))();
    for (int axis = 0; axis < 3; ++axis) sdk.position[axis] = sdk.velocity[axis] = sdk.force[axis] = 0;
    sdk.isPresent = sdk.isReady = true;
    sdk.type                    = 33;
    sdk.hasPower = sdk.knowsDrd = true;
    sdk.isRobot = sdk.isBalanced = false;
    sdk.areBrakesOn              = true;
    sdk.isBroken = sdk.isLost = false;
    sdk.isForceOn = sdk.isSame = sdk.isOutOfNumbers = sdk.callsLate = false;
    sdk.error = sdk.status = sdk.opened = sdk.closed = sdk.enabled = sdk.calibrated = sdk.calls = sdk.lateCallbacks =
        sdk.openError = sdk.startError = sdk.nextError = 0;
    sdk.callbackThreads                                = 1;
    return sdk;
}

glm::dvec3 of(const std::atomic<double> (&v)[3])
{
    return {v[0].load(), v[1].load(), v[2].load()};
}

/// What both makers' devices have in common.
struct Maker {
    const char* name;
    const char* variable;
    const char* library;
    const char* lacks; ///< the function that the old library lacks
    std::unique_ptr<DeviceLine> (*line)();
    HapticDeviceInfo (*info)();
    glm::dvec3 (*ours)(const glm::dvec3&); ///< from the library's frame
    double              metre;             ///< [m] of its unit of length
    const DeviceRecord* record;
    int                 failing; ///< error of a device that no longer answers
    DeviceFault         lost;    ///< what that is
};

constexpr Maker kMakers[] = {
    {"ForceDimension", "FORCEDIM_SDK", PALPATE_FAKE_SDK "/libdrd.so.3", "dhdSetGravityCompensation",
     [] { return makeForceDimensionLine({.restToTry = 0.05, .clock = [] { return virtualTime; }}); },
     [] { return forceDimensionInfo(33); }, [](const glm::dvec3& v) { return glm::dvec3(v.y, v.z, v.x); }, 1,
     &kForceDimensionRecord, 1, DeviceFault::linkLost},
    {"OpenHaptics", "OPENHAPTICS", PALPATE_FAKE_SDK "/libHD.so", "hdUnschedule",
     [] {
         return makeOpenHapticsLine({.restToTry = 0.05, .secondsToLook = 0.02, .clock = [] { return virtualTime; }});
     },
     [] { return openHapticsInfo("Touch"); }, [](const glm::dvec3& v) { return v; }, 1e-3, &kOpenHapticsRecord, 0x302,
     DeviceFault::linkLost}};

class MakersLibraries : public ::testing::TestWithParam<Maker> {
protected:
    MakersLibraries()
        : environment_(GetParam().variable, PALPATE_FAKE_SDK), sdk(registersOf(GetParam().library)),
          device(GetParam().line(), GetParam().info(), {.pace = LinePace::caller})
    {
        virtualTime = 0;
    }
    void run(double seconds, const GovernedForce& force, int exchangesEachTick = 1)
    {
        const double step = kTick / exchangesEachTick;
        for (const double end = now + seconds - step / 2; now < end; now += step) {
            virtualTime = now;
            state       = device.exchange(force, now);
            if (force_() > 0) pushed = now;
        }
    }
    [[nodiscard]] double     force_() const { return glm::length(of(sdk.force)); } // [N]
    [[nodiscard]] glm::dvec3 felt() const { return GetParam().ours(of(sdk.force)); }

    Environment         environment_;
    FakeSdk&            sdk;
    LineDevice          device;
    HapticState         state;
    double              now = 0, pushed = -1; // [s]
    const GovernedForce push = governed({1, -0.5, 0.25});
};

const auto named = [](const auto& which) { return which.param.name; };
INSTANTIATE_TEST_SUITE_P(Of, MakersLibraries, ::testing::ValuesIn(kMakers), named);

TEST_P(MakersLibraries, TheForceThatArrivesIsTheGovernorsInTheirFrame)
{
    device.open();
    run(0.1, push);
    EXPECT_EQ(state.fault, DeviceFault::none) << name(state.fault);
    EXPECT_LT(glm::length(felt() - push.newtons()), 1e-12);
    EXPECT_TRUE(sdk.isForceOn);
    device.close();
    EXPECT_EQ(force_(), 0);
    EXPECT_FALSE(sdk.isForceOn);
}

TEST_P(MakersLibraries, TheHandComesInOurFrameAndInMetres)
{
    for (int axis = 0; axis < 3; ++axis) {
        sdk.position[axis] = 0.01 * (axis + 1) / GetParam().metre;
        sdk.velocity[axis] = 0.1 * (axis + 1) / GetParam().metre;
    }
    device.open();
    run(0.01, {});
    EXPECT_LT(glm::length(state.position - GetParam().ours({0.01, 0.02, 0.03})), 1e-12);
    EXPECT_LT(glm::length(state.velocity - GetParam().ours({0.1, 0.2, 0.3})), 1e-12);
    EXPECT_TRUE(state.homed && state.inBox);
    EXPECT_NE(state.buttons, 0U);
    const double half = std::sqrt(0.5); // both stand-ins turn a quarter about the axis that points up
    EXPECT_GT(std::abs(glm::dot(state.orientation, glm::dquat(half, 0, half, 0))), 1 - 1e-9);
}

TEST_P(MakersLibraries, ADeviceThatIsNotResetHasNoForceUntilItIs)
{
    sdk.isReady = false;
    device.open();
    run(5e-3, push);
    EXPECT_FALSE(state.homed);
    EXPECT_EQ(force_(), 0);
    EXPECT_FALSE(device.info().homing.empty());
    sdk.isReady = true;
    run(0.1, push);
    EXPECT_TRUE(state.homed);
    EXPECT_GT(force_(), 1);
}

TEST_P(MakersLibraries, WithoutADeviceItSaysSo)
{
    sdk.isPresent = false;
    EXPECT_THROW(device.open(), Error);
    EXPECT_EQ(device.read(0).fault, DeviceFault::closed);
    sdk.isPresent = true;
    sdk.error     = 0;
    device.open();
    run(0.01, {});
    EXPECT_EQ(state.fault, DeviceFault::none) << "plugged in, it opens";
}

TEST_P(MakersLibraries, AnOldLibraryIsRefusedByWhatItLacks)
{
    const Environment old(GetParam().variable, PALPATE_FAKE_OLD_SDK);
    LineDevice        other(GetParam().line(), GetParam().info(), {.pace = LinePace::caller});
    try {
        other.open();
        FAIL() << "it is too old";
    } catch (const Error& error) {
        EXPECT_NE(std::string(error.what()).find(std::string("lacks ") + GetParam().lacks), std::string::npos)
            << error.what();
        EXPECT_EQ(std::string(error.what()).find("dhdSetMaxForce"), std::string::npos)
            << "version 3.7 works without it: " << error.what();
    }
}

TEST_P(MakersLibraries, WithoutALibraryItSaysWhereItLookedAndWhatToInstall)
{
    const Environment none(GetParam().variable, "/nowhere");
    LineDevice        other(GetParam().line(), GetParam().info(), {.pace = LinePace::caller});
    try {
        other.open();
        GTEST_SKIP() << "this machine has the true library";
    } catch (const Error& error) {
        EXPECT_NE(std::string(error.what()).find("install"), std::string::npos) << error.what();
    }
    EXPECT_NE(GetParam().record->support().library.find("(not found; see " + std::string(GetParam().variable)),
              std::string::npos)
        << "and so does the list of devices: " << GetParam().record->support().library;
}

/// Errors of every call, for ever: zero force, the link is lost, and the same device opens again.
TEST_P(MakersLibraries, CallsThatFailEndAtZeroForceWithAReason)
{
    device.open();
    run(0.1, push);
    ASSERT_GT(force_(), 1);
    const double since = now;
    for (int n = 0; n < 100; ++n) { // OpenHaptics reports an error once
        sdk.error = GetParam().failing;
        run(kTick, push);
    }
    EXPECT_EQ(state.fault, GetParam().lost);
    EXPECT_STRNE(device.faultWords(), "");
    EXPECT_LE(pushed - since, kZero);
    EXPECT_EQ(force_(), 0);
    sdk.error = 0;
    device.close();
    device.open();
    run(0.1, push);
    EXPECT_EQ(state.fault, DeviceFault::none);
    EXPECT_GT(force_(), 1);
}

/// Places and speeds that no hand has, in any field: no sample, zero force, and the hand stays where it was.
TEST_P(MakersLibraries, NumbersThatNoHandHasAreZeroForceAndNoPlace)
{
    for (const double number : {std::nan(""), 1e308, -1e308, double(INFINITY)})
        for (int field = 0; field < 6; ++field) {
            device.open();
            run(0.1, push);
            ASSERT_GT(force_(), 1);
            const double since = now;
            auto&        wrong = field < 3 ? sdk.position[field] : sdk.velocity[field - 3];
            wrong              = number;
            run(0.2, push);
            EXPECT_NE(state.fault, DeviceFault::none) << number << " in " << field;
            EXPECT_LE(pushed - since, kZero) << number << " in " << field;
            EXPECT_EQ(force_(), 0);
            EXPECT_LT(glm::length(state.position), 1e-12) << number << " in " << field;
            EXPECT_LT(glm::length(state.velocity), 1e-12) << number << " in " << field;
            wrong = 0;
            run(0.2, push);
            EXPECT_EQ(state.fault, DeviceFault::none) << "it is borne";
            EXPECT_GT(force_(), 1);
            device.close();
        }
}

TEST_P(MakersLibraries, NumbersThatAreNoneAreGarbledAndZeroForce)
{
    device.open();
    run(0.1, push);
    const double since = now;
    sdk.isOutOfNumbers = true;
    run(0.2, push);
    EXPECT_EQ(state.fault, DeviceFault::garbled);
    EXPECT_LE(pushed - since, kZero);
    EXPECT_LT(glm::length(state.position), 1e-12);
    sdk.isOutOfNumbers = false;
    run(0.2, push);
    EXPECT_EQ(state.fault, DeviceFault::none);
}

TEST_P(MakersLibraries, ClosingTwiceClosesOnce)
{
    device.open();
    run(0.01, push);
    device.close();
    device.close();
    EXPECT_EQ(sdk.closed, sdk.opened);
    EXPECT_EQ(sdk.opened, 1);
}

// --- one maker's own

class ForceDimension : public MakersLibraries {};
INSTANTIATE_TEST_SUITE_P(Library, ForceDimension, ::testing::Values(kMakers[0]), named);

TEST_P(ForceDimension, TheSameSampleAgainIsNoNewOne)
{
    device.open();
    run(0.1, push);
    const std::uint64_t sequence = state.sequence;
    sdk.isSame                   = true;
    run(5e-3, push);
    EXPECT_EQ(state.sequence, sequence);
    EXPECT_EQ(state.missed, 1) << "of 20, which are 100 ms";
    EXPECT_EQ(state.fault, DeviceFault::none) << "it is no error";
    EXPECT_GT(force_(), 1) << "a force lasts over a few";
    const double since = now;
    run(0.1, push);
    EXPECT_EQ(state.fault, DeviceFault::silent) << "but not over twenty";
    EXPECT_EQ(force_(), 0);
    EXPECT_LE(pushed - since, kZero);
}

TEST_P(ForceDimension, WhatStopsTheForceIsSaidAndItComesBackByItself)
{
    for (const auto& [cause, words] : {std::pair{2, "too fast"}, {3, "watchdog"}, {5, "USB"}}) {
        device.open();
        run(0.1, push);
        const double since = now;
        sdk.status         = cause;
        run(0.03, push);
        EXPECT_EQ(state.fault, DeviceFault::ownWatchdog);
        EXPECT_NE(std::string(device.faultWords()).find(words), std::string::npos) << device.faultWords();
        EXPECT_LE(pushed - since, kZero);
        run(0.3, push);
        EXPECT_EQ(state.fault, DeviceFault::none) << "switched on again, at zero force";
        EXPECT_GT(force_(), 1);
        device.close();
    }
}

/// As older firmware has it, which tells no cause.
TEST_P(ForceDimension, AForceThatIsOffWithoutACauseIsAFaultAndComesBack)
{
    device.open();
    run(0.1, push);
    const double since = now;
    sdk.isForceOn      = false;
    run(0.03, push);
    EXPECT_EQ(state.fault, DeviceFault::ownWatchdog);
    EXPECT_NE(std::string(device.faultWords()).find("force is off"), std::string::npos) << device.faultWords();
    EXPECT_LE(pushed - since, kZero);
    run(0.3, push);
    EXPECT_EQ(state.fault, DeviceFault::none) << "switched on again, at zero force";
    EXPECT_TRUE(sdk.isForceOn);
    EXPECT_GT(force_(), 1);
}

/// However many exchanges are made in that time: a library may make 1000 or 4000 a second.
TEST_P(ForceDimension, ItsPatienceIsOneInSeconds)
{
    for (const int eachTick : {1, 4}) {
        device.open();
        run(0.1, push);
        sdk.status = 3;
        run(0.045, push, eachTick);
        EXPECT_EQ(state.fault, DeviceFault::ownWatchdog) << eachTick;
        EXPECT_EQ(sdk.status, 3) << "it rests for 50 ms in this test";
        run(0.020, push, eachTick);
        EXPECT_EQ(sdk.status, 0) << eachTick;
        run(0.1, push);
        sdk.error = 1;
        run(0.050, push, eachTick);
        EXPECT_NE(state.fault, DeviceFault::linkLost) << eachTick;
        run(0.050, push, eachTick);
        EXPECT_EQ(state.fault, DeviceFault::linkLost) << eachTick;
        sdk.error = 0;
        device.close();
    }
}

TEST_P(ForceDimension, AForceThatSomebodySwitchedOffStaysOff)
{
    for (const auto& [cause, words] : {std::pair{1, "button"}, {4, "another program"}, {6, "dead man"}}) {
        device.open();
        run(0.1, push);
        const double since = now;
        sdk.status         = cause;
        run(3, push);
        EXPECT_EQ(state.fault, DeviceFault::ownWatchdog) << "it is theirs to switch on again";
        EXPECT_NE(std::string(device.faultWords()).find(words), std::string::npos) << device.faultWords();
        EXPECT_LE(pushed - since, kZero);
        sdk.status = 0; // there
        run(0.3, push);
        EXPECT_EQ(state.fault, DeviceFault::none);
        device.close();
    }
}

TEST_P(ForceDimension, WithoutPowerOrWithAnErrorItMakesNoForceAndSaysWhy)
{
    device.open();
    run(0.1, push);
    const auto isSaid = [&](const char* words) {
        const double since = now;
        run(3, push);
        EXPECT_EQ(state.fault, DeviceFault::ownWatchdog);
        EXPECT_NE(std::string(device.faultWords()).find(words), std::string::npos) << device.faultWords();
        EXPECT_LE(pushed - since, kZero);
    };
    sdk.hasPower = false;
    isSaid("no power");
    sdk.hasPower = true;
    run(0.3, push);
    EXPECT_EQ(state.fault, DeviceFault::none);
    sdk.isBroken = true;
    isSaid("error");
}

TEST_P(ForceDimension, ATypeThatIsUnknownIsLimitedAsTheWeakest)
{
    device.open();
    EXPECT_EQ(device.info().note, "");
    EXPECT_EQ(device.info().maximumForce, 12);
    device.close();
    sdk.type = 999;
    device.open();
    EXPECT_NE(device.info().note.find("999"), std::string::npos) << device.info().note;
    for (const int type : {33, 34, 35, 36, 37, 60, 63, 104, 105, 108, 109, 131, 132, 203, 206}) {
        const HapticDeviceInfo known = forceDimensionInfo(type), unknown = device.info();
        EXPECT_LE(unknown.maximumForce, known.maximumForce) << type;
        EXPECT_LE(unknown.maximumStiffness, known.maximumStiffness) << type;
        EXPECT_LE(unknown.maximumDamping, known.maximumDamping) << type;
        EXPECT_LE(unknown.workspaceRadius, known.workspaceRadius) << type;
    }
}

TEST_P(ForceDimension, ADeviceThatIsUnpluggedIsGone)
{
    device.open();
    run(0.1, push);
    sdk.isPresent = false;
    run(5e-3, push);
    EXPECT_EQ(state.fault, DeviceFault::unplugged);
}

TEST_P(ForceDimension, TheArmMovesByItselfOnlyIfTheUserLetsIt)
{
    sdk.isReady = false;
    device.open();
    EXPECT_EQ(sdk.calibrated, 0);
    device.close();
    LineDevice free(makeForceDimensionLine({.mayInitialise = true}), forceDimensionInfo(33),
                    {.pace = LinePace::caller});
    free.open();
    EXPECT_EQ(sdk.calibrated, 1);
}

/// It has no RESET button, and the library cannot move it.
TEST_P(ForceDimension, AFalconIsHomedByHand)
{
    sdk.type    = 60;
    sdk.isReady = false;
    FakeHidSystem     hid;
    const std::string help = kForceDimensionRecord.list(hid).at(0).help;
    EXPECT_EQ(help.find("RESET"), std::string::npos) << help;
    EXPECT_NE(help.find("grip all the way out"), std::string::npos) << help;
    LineDevice falcon(makeForceDimensionLine({.mayInitialise = true}), forceDimensionInfo(60),
                      {.pace = LinePace::caller});
    falcon.open();
    EXPECT_EQ(sdk.calibrated, 0);
    EXPECT_TRUE(falcon.info().needsHoming);
    EXPECT_EQ(falcon.info().homing, "") << "said as of a Falcon";
}

TEST_P(ForceDimension, ADeviceThatTheirRobotsLibraryRefusesIsOpenedWithoutIt)
{
    device.open();
    EXPECT_TRUE(sdk.isRobot) << "the functions drd* serve no other";
    device.close();
    sdk.knowsDrd = false;
    device.open();
    run(0.1, push);
    EXPECT_EQ(sdk.opened, 2);
    EXPECT_TRUE(state.homed) << "its status alone says so";
    EXPECT_GT(force_(), 1);
    device.close();
    EXPECT_EQ(sdk.closed, 2) << "as it was opened";
}

/// What its encoders say means nothing before: the compensation of gravity alone would push.
TEST_P(ForceDimension, AnArmThatDoesNotKnowWhereItIsHasNoPower)
{
    const auto hasPower = [&] { return sdk.isForceOn || sdk.isBalanced || !sdk.areBrakesOn; };
    sdk.isReady         = false;
    device.open();
    run(3, push);
    EXPECT_FALSE(state.homed);
    EXPECT_EQ(state.fault, DeviceFault::none) << "brakes and all: it waits for its reset";
    EXPECT_FALSE(hasPower());
    FakeHidSystem hid;
    const auto    listed = kForceDimensionRecord.list(hid);
    EXPECT_FALSE(listed.at(0).answers) << "so no rate is measured of it";
    EXPECT_FALSE(listed.at(0).help.empty());
    sdk.isReady = true;
    run(0.1, push);
    EXPECT_TRUE(sdk.isForceOn && sdk.isBalanced && !sdk.areBrakesOn);
    EXPECT_GT(force_(), 1);
    EXPECT_TRUE(kForceDimensionRecord.list(hid).at(0).answers);
    sdk.isReady = false; // somebody presses its button once more
    run(1, push);
    EXPECT_FALSE(sdk.isForceOn || sdk.isBalanced);
    EXPECT_EQ(force_(), 0);
}

TEST_P(ForceDimension, IsListedWithItsName)
{
    FakeHidSystem hid;
    const auto    listed = kForceDimensionRecord.list(hid);
    ASSERT_EQ(listed.size(), 1U);
    EXPECT_EQ(listed[0].model, "Force Dimension omega.3");
    EXPECT_TRUE(listed[0].usable);
    EXPECT_EQ(sdk.opened, sdk.closed) << "let go again";
    EXPECT_THROW((void)kForceDimensionRecord.make({.hid = hid, .path = "first"}), Error);
}

class OpenHaptics : public MakersLibraries {
protected:
    /// Ticks in real time until it is so; false after 10 s, for a busy machine.
    template <class So>
    bool until(LineDevice& real, const GovernedForce& force, const So& so)
    {
        const auto start = std::chrono::steady_clock::now();
        for (double time = 0; time < 10;) {
            time  = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
            state = real.exchange(force, time);
            if (so()) return true;
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
        }
        return false;
    }
};
INSTANTIATE_TEST_SUITE_P(Library, OpenHaptics, ::testing::Values(kMakers[1]), named);

TEST_P(OpenHaptics, ErrorsOfAForceAreSaidAndTheForceComesBack)
{
    for (const auto& [code, words] : {std::pair{0x200, "warm"},
                                      {0x201, "too strong"},
                                      {0x202, "rose too fast"},
                                      {0x203, "moved too fast"},
                                      {0x304, "scheduler"}}) {
        device.open();
        run(0.1, push);
        const double since = now;
        sdk.error          = code;
        run(0.03, push);
        EXPECT_EQ(state.fault, DeviceFault::ownWatchdog);
        EXPECT_NE(std::string(device.faultWords()).find(words), std::string::npos) << device.faultWords();
        EXPECT_LE(pushed - since, kZero);
        run(0.3, push);
        EXPECT_EQ(state.fault, DeviceFault::none);
        EXPECT_GT(force_(), 1);
        device.close();
    }
}

/// However many exchanges are made in that time: a user may set the scheduler's rate.
TEST_P(OpenHaptics, ItsPatienceIsOneInSeconds)
{
    for (const int eachTick : {1, 4}) {
        device.open();
        run(0.1, push);
        sdk.error = 0x200;
        run(0.045, push, eachTick);
        EXPECT_EQ(state.fault, DeviceFault::ownWatchdog) << eachTick << ": it rests for 50 ms in this test";
        run(0.020, push, eachTick);
        EXPECT_EQ(state.fault, DeviceFault::none) << eachTick;
        device.close();
    }
}

/// The library keeps several and gives one at each call.
TEST_P(OpenHaptics, OfSeveralErrorsTheWorstCounts)
{
    for (const auto& [first, second, fault] : {std::tuple{0x101, 0x203, DeviceFault::ownWatchdog},
                                               {0x203, 0x302, DeviceFault::linkLost},
                                               {0x302, 0x203, DeviceFault::linkLost}}) {
        device.open();
        run(0.1, push);
        sdk.nextError = second;
        sdk.error     = first;
        run(kTick, push);
        EXPECT_EQ(state.fault, fault) << first << ", " << second;
        EXPECT_EQ(sdk.error, 0) << "none is kept for later";
        device.close();
    }
}

TEST_P(OpenHaptics, ASchedulerThatDoesNotStartIsASentence)
{
    LineDevice real(makeOpenHapticsLine(), openHapticsInfo("Touch"));
    sdk.startError = 0x304; // late at first: an error of forces, which the exchanges judge
    real.open();
    real.close();
    sdk.startError = 0x103;
    try {
        real.open();
        ADD_FAILURE() << "nobody makes exchanges";
    } catch (const Error& error) {
        EXPECT_NE(std::string(error.what()).find("scheduler"), std::string::npos) << error.what();
    }
    EXPECT_EQ(sdk.opened, sdk.closed);
    EXPECT_EQ(real.read(0).fault, DeviceFault::closed);
    sdk.startError = 0;
    EXPECT_TRUE((real.open(), until(real, push, [&] { return state.fault == DeviceFault::none; })));
}

TEST_P(OpenHaptics, ACalibrationThatIsLostEndsTheForceAndABetterOneWaits)
{
    device.open();
    run(0.1, push);
    ASSERT_GT(force_(), 1);
    sdk.isReady = false; // it could be calibrated better
    run(0.1, push);
    EXPECT_TRUE(state.homed) << "not while it is in use: the hand would jump";
    EXPECT_EQ(sdk.calibrated, 0);
    sdk.isReady        = true;
    sdk.isLost         = true;
    const double since = now;
    run(0.05, push, 5);
    EXPECT_FALSE(state.homed);
    EXPECT_EQ(force_(), 0);
    EXPECT_LE(pushed - since, kZero + 20 * kTick) << "it is looked at every 20 ms, however many exchanges that are";
}

TEST_P(OpenHaptics, ALicenceThatIsNoneIsASentence)
{
    sdk.openError = 0x600;
    try {
        device.open();
        FAIL() << "there is no licence";
    } catch (const Error& error) {
        EXPECT_NE(std::string(error.what()).find("no valid licence"), std::string::npos) << error.what();
    }
    sdk.openError = 0;
    device.open();
    sdk.error = 0x600;
    run(5e-3, push);
    EXPECT_EQ(state.fault, DeviceFault::linkLost);
    EXPECT_NE(std::string(device.faultWords()).find("licence"), std::string::npos);
}

TEST_P(OpenHaptics, ItsSchedulersThreadMakesTheExchanges)
{
    for (const int threads : {1, 2}) { // two: callbacks are doubled
        sdk.callbackThreads = threads;
        LineDevice real(makeOpenHapticsLine(), openHapticsInfo("Touch"));
        real.open();
        EXPECT_TRUE(until(real, push, [&] { return state.fault == DeviceFault::none && force_() > 1; }));
        EXPECT_TRUE(until(real, {}, [&] { return force_() == 0; }));
        real.close();
        EXPECT_FALSE(sdk.isForceOn);
        EXPECT_EQ(sdk.opened, sdk.closed);
    }
}

TEST_P(OpenHaptics, ACallbackThatComesAfterTheEndDoesNothing)
{
    sdk.callsLate = true;
    auto real     = std::make_unique<LineDevice>(makeOpenHapticsLine(), openHapticsInfo("Touch"));
    real->open();
    EXPECT_TRUE(until(*real, push, [&] { return force_() > 1; }));
    real.reset(); // unscheduled while it runs
    EXPECT_EQ(sdk.lateCallbacks, 1);
    EXPECT_EQ(force_(), 0);
}

TEST_P(OpenHaptics, AServoThatStopsLosesItsForce)
{
    LineDevice real(makeOpenHapticsLine(), openHapticsInfo("Touch"));
    real.open();
    ASSERT_TRUE(until(real, push, [&] { return force_() > 1; }));
    std::this_thread::sleep_for(std::chrono::milliseconds(200));
    EXPECT_EQ(force_(), 0) << "held for 5 ms, then let fall in 20 ms";
}

TEST_P(OpenHaptics, AnotherDeviceIsOpenedByItsName)
{
    LineDevice left(makeOpenHapticsLine({.name = "left"}), openHapticsInfo(""), {.pace = LinePace::caller});
    left.open();
    EXPECT_EQ(left.info().model, "3D Systems Touch");
    LineDevice right(makeOpenHapticsLine({.name = "right"}), openHapticsInfo(""), {.pace = LinePace::caller});
    EXPECT_THROW(right.open(), Error);
    FakeHidSystem hid;
    sdk.error = 0;
    EXPECT_EQ(kOpenHapticsRecord.list(hid).at(0).model, "3D Systems Touch");
}

} // namespace
} // namespace palp
