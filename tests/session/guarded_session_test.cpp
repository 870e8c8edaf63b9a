// A whole session in a process of its own, which presses on a sheet through an emulated Falcon at a descriptor, is
// stopped and goes on. A program of its own, because it forks: no test before it may have started threads.
#include <algorithm>
#include <array>
#include <csignal>
#include <cstdlib>
#include <random>
#include <thread>

#include <gtest/gtest.h>
#include <sched.h>
#include <sys/resource.h>

#include "device/falcon/falcon_device.h"
#include "engine/core/real_time.h"
#include "engine/session/interrupt.h"
#include "engine/session/real_session.h"
#include "engine/session/scripted_hand.h"
#include "tests/device/descriptor_falcon.h"
#include "tests/device/zero_in_time.h"
#include "tests/session/sheet_session.h"

namespace palp {
namespace {

/// Stops of one session. Each takes 4 to 9 s, because a force comes on anew within 1.5 s of a lifted hand; the
/// guardian's own tests have 200. PALPATE_INSTANTS asks for more.
int instants()
{
    const char* const asked = std::getenv("PALPATE_INSTANTS");
    return asked ? std::max(1, std::atoi(asked)) : 3;
}

constexpr double kAway = 5e-3, kPressed = -7.5e-3; // [m] of the grip; the surface is at -6 mm

void touchSheet(int fd)
{
    static_cast<void>(catchInterrupts());
    const SheetSession session(sheetScene(kWart));
    Deformation        deformation(session.object, session.scene);
    FalconDevice       device([fd] { return std::make_unique<DescriptorLink>(fd); });
    device.open();
    std::string warning;
    static_cast<void>(
        runReal({session.scene, session.object, deformation.solver(), device, deviceFrame({0, 0, 6e-3}, {0, 0, 1})},
                {.seconds = 1e5}, warning));
}

class StoppedSession : public ::testing::TestWithParam<int> {};

INSTANTIATE_TEST_SUITE_P(By, StoppedSession, ::testing::Values(SIGTSTP, SIGSTOP),
                         [](const auto& which) { return which.param == SIGTSTP ? "CtrlZ" : "ADebugger"; });

TEST_P(StoppedSession, IsAtZeroAndEngagesAnewOnceTheHandWasLifted)
{
    static_cast<void>(askForRealTime());             // whoever measures must not be late
    double           target = kAway, height = kAway; // [m]
    DescriptorFalcon falcon([&](const glm::dvec3&, double dt) {
        height += std::clamp(target - height, -0.1 * dt, 0.1 * dt);
        return glm::dvec3(0, height, 0);
    });
    const pid_t      child = falcon.start(touchSheet);
    const auto       press = [&] {
        target = kAway;
        falcon.serve(steadyTime() + 2.2); // 10 calm ticks and 1.5 s to engage
        target = kPressed;
        falcon.serve(steadyTime() + 2, [&] { return falcon.pushes() && steadyTime() - falcon.pushesSince() > 0.1; });
        return falcon.pushes();
    };
    const auto reset = [&] { // a servo that stood still is a fault, which the operator resets
        falcon.press(1);
        falcon.serve(steadyTime() + 0.1);
        falcon.press(0);
    };
    int        unasked     = 0;
    const auto pressAtLast = [&] { // a machine that is busy with other things may make the servo stand still
        for (; !press(); ++unasked) {
            if (unasked == 2) return false;
            reset();
        }
        return true;
    };
    falcon.serve(steadyTime() + 10, [&] { return falcon.packets() > 100; });
    std::mt19937                           random{1};
    std::uniform_real_distribution<double> wait{0, 0.1}; // [s]
    double                                 slowest = 0;  // [s]
    ZeroInTime                             inTime{30e-3};
    for (int n = 0; n < instants(); ++n) {
        ASSERT_TRUE(pressAtLast());
        falcon.serve(steadyTime() + wait(random));
        const double asked = steadyTime();
        kill(child, GetParam());
        int status = 0;
        while (waitpid(child, &status, WNOHANG | WUNTRACED) == 0 && steadyTime() < asked + 1)
            falcon.serve(steadyTime() + 200e-6);
        ASSERT_TRUE(WIFSTOPPED(status)) << "it is stopped in the end";
        if (GetParam() == SIGTSTP) {
            falcon.serve(steadyTime() + 5e-3); // what was sent before
            ASSERT_FALSE(falcon.pushes()) << "and before that at zero";
        }
        falcon.serve(asked + 0.12); // longer than the tenth of a second after which the governor takes it for a fault
        ASSERT_FALSE(falcon.pushes());
        ASSERT_TRUE(inTime(falcon.zeroSince() - asked)) << n;
        slowest = std::max(slowest, falcon.zeroSince() - asked);

        kill(child, SIGCONT);
        falcon.serve(steadyTime() + 1, [&] { return falcon.pushes(); });
        ASSERT_FALSE(falcon.pushes()) << "the hand still presses: it must be lifted first";
        if (GetParam() == SIGSTOP) {
            ASSERT_FALSE(press());
            reset();
        }
    }
    std::printf("  zero after %.1f ms at most, %d instants\n", slowest * 1e3, instants());
    EXPECT_TRUE(pressAtLast()) << "it goes on";
    kill(child, SIGKILL);
    waitpid(child, nullptr, 0);
}

/// What a session without real-time rights tells of itself.
struct Ordinary {
    std::atomic<bool>   isDone{false};
    std::atomic<int>    fault{-1};    ///< of the governor
    std::atomic<int>    forceless{0}; ///< ticks that pressed without a force, once it was all on
    std::atomic<int>    late{0};      ///< ticks that came more than 5 ms after the one before
    std::atomic<double> latest{0};    ///< [s] from one tick to the next
    std::atomic<double> last{0};      ///< [N] in the end
};

/// Presses a sheet for some seconds as an ordinary user's program, while two threads keep two processors busy.
void pressAsAnOrdinaryUser(Ordinary& tells)
{
    constexpr uid_t kNobody = 65534;
    const rlimit    none{0, 0};
    setrlimit(RLIMIT_RTPRIO, &none);
    if (geteuid() == 0 && setresuid(kNobody, kNobody, kNobody) != 0) std::_Exit(2);
    const sched_param other{0};
    sched_setscheduler(0, SCHED_OTHER, &other);
    std::array<std::jthread, 2> busy;
    for (std::jthread& thread : busy)
        thread = std::jthread([](const std::stop_token& stop) {
            while (!stop.stop_requested()) {
            }
        });

    const SheetSession session(sheetScene(kWart));
    Deformation        deformation(session.object, session.scene);
    const HandPath     path({{0, {0, 0, 2e-3}}, {2, {0, 0, 2e-3}}, {2.5, {0, 0, -1.5e-3}}, {8, {0, 0, -1.5e-3}}});
    ScriptedHand       device(path);
    double             before = 0;
    std::string        warning;
    const auto         summary = runReal({session.scene, session.object, deformation.solver(), device, {}},
                                         {.seconds = 8,
                                          .onTick =
                                              [&](const TickRecord& s) {
                                          const double dt = s.time - std::exchange(before, s.time);
                                          tells.latest    = std::max<double>(tells.latest, dt);
                                          tells.late += dt > 5e-3;
                                          tells.forceless += s.time > 4 && glm::length(s.force) == 0;
                                          tells.last = glm::length(s.force);
                                      }},
                                         warning);
    tells.fault                = int(summary.fault);
    tells.isDone               = !warning.empty(); // it was refused the rights
    std::_Exit(0);
}

TEST(OrdinarySession, KeepsItsForceWhileOtherProgramsTakeEveryProcessor)
{
    SharedMemory<Ordinary> tells;
    const pid_t            child = fork();
    if (child == 0) pressAsAnOrdinaryUser(*tells);
    int status = 0;
    waitpid(child, &status, 0);
    ASSERT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0) << status;
    ASSERT_TRUE(tells->isDone) << "it has no real-time rights";
    std::printf("  %d ticks more than 5 ms late, at most %.1f ms\n", tells->late.load(), tells->latest * 1e3);
    constexpr double kStall = 90e-3; // [s] a tenth below what the governor takes for a program that stood still
    if (tells->latest > kStall) GTEST_SKIP() << "a tick was " << tells->latest * 1e3 << " ms late: too busy a machine";
    EXPECT_EQ(GovernorFault(tells->fault.load()), GovernorFault::none);
    EXPECT_EQ(tells->forceless, 0) << "a late tick scales its own force, and takes none away";
    EXPECT_GT(tells->last, 0.3) << "[N]";
}

} // namespace
} // namespace palp
