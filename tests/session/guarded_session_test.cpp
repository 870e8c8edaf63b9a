// A whole session in a process of its own, which presses on a sheet through an emulated Falcon at a descriptor, is
// stopped and goes on. A program of its own, because it forks: no test before it may have started threads.
#include <csignal>

#include <gtest/gtest.h>

#include "device/falcon/falcon_device.h"
#include "engine/core/real_time.h"
#include "engine/session/interrupt.h"
#include "engine/session/real_session.h"
#include "tests/device/descriptor_falcon.h"
#include "tests/session/sheet_session.h"

namespace palp {
namespace {

constexpr double kAway = 5e-3, kPressed = -7.5e-3; // [m] of the grip; the surface is at -6 mm

void touchSheet(int fd)
{
    static_cast<void>(catchInterrupts());
    const SheetSession session(sheetScene(kWart));
    Deformation        deformation(session.object, session.scene);
    FalconDevice       device([fd] { return std::make_unique<DescriptorLink>(fd, nullptr); });
    device.open();
    std::string warning;
    static_cast<void>(
        runReal({session.scene, session.object, deformation.solver(), device, deviceFrame({0, 0, 6e-3}, {0, 0, 1})},
                {.seconds = 60}, warning));
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
    falcon.serve(steadyTime() + 10, [&] { return falcon.packets() > 100; });
    for (int n = 0; n < 2; ++n) {
        ASSERT_TRUE(press());
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
        falcon.serve(asked + 0.1);
        ASSERT_FALSE(falcon.pushes());
        EXPECT_LT(falcon.zeroSince() - asked, 30e-3);

        kill(child, SIGCONT);
        falcon.serve(steadyTime() + 1, [&] { return falcon.pushes(); });
        ASSERT_FALSE(falcon.pushes()) << "the hand still presses: it must be lifted first";
        if (GetParam() == SIGSTOP) { // a servo that stood still is a fault, which the operator resets
            ASSERT_FALSE(press());
            falcon.press(1);
            falcon.serve(steadyTime() + 0.1);
            falcon.press(0);
        }
    }
    EXPECT_TRUE(press()) << "it goes on";
    kill(child, SIGKILL);
    waitpid(child, nullptr, 0);
}

} // namespace
} // namespace palp
