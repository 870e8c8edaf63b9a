// Real processes that push and come to grief, and how long an emulated Falcon then goes on pushing.
#include "device/detail/guardian.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <functional>
#include <iterator>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <linux/filter.h>
#include <linux/seccomp.h>
#include <sched.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include "device/falcon/falcon_device.h"
#include "engine/core/contract.h"
#include "engine/core/real_time.h"
#include "tests/device/descriptor_falcon.h"
#include "tests/device/falcon_bench.h"
#include "tests/device/guardian_of.h"
#include "tests/device/zero_in_time.h"
#include "tests/support/sanitized.h"

namespace palp {
namespace {

constexpr int kInstants = kSanitized ? 50 : 200; // what a sanitizer looks for is found at fewer, in its slow starts
// 25 ms of silence, a packet, and what the guardian may have to wait; a sanitizer takes a signal and tells of it first.
constexpr double kZeroBy = kSanitized ? 0.5 : 30e-3; // [s]

enum class End { killed, writesToNowhere, aborts, runsOutOfMemory };
constexpr std::array kNames{"IsKilled", "Crashes", "Aborts", "RunsOutOfMemory"}; ///< in the same order

/// What parent and child know of each other.
struct Fate {
    std::atomic<double> at{1e18};        ///< [s] when the child comes to grief; it does so by itself
    std::atomic<bool>   hangs{false};    ///< its driver's thread hangs in a write
    std::atomic<bool>   pushes{false};   ///< the last packet of its driver does, which the guardian may have taken
    std::atomic<bool>   silenced{false}; ///< its servo saw DeviceFault::silenced
};

[[noreturn]] void comeToGrief(End end, Fate& fate) noexcept
{
    fate.at = steadyTime();
    switch (end) {
    case End::killed:
        kill(getpid(), SIGKILL);
        break;
    case End::writesToNowhere:
        *reinterpret_cast<volatile int*>(std::uintptr_t(64)) = 1;
        break;
    case End::aborts:
        std::abort();
    case End::runsOutOfMemory: {
        const rlimit little{1U << 20U, 1U << 20U}; // less than it has: the next allocation fails
        setrlimit(RLIMIT_AS, &little);
        try {
            for (;;) std::fill_n(new char[1U << 20U], 1U << 20U, 'x');
        } catch (const std::bad_alloc&) {
            fate.at = steadyTime();
            std::terminate(); // as where nobody catches it
        }
    }
    }
    std::_Exit(9);
}

/// The child: a servo that pushes with 2 N, the Falcon's driver and its thread, and one that waits for its fate.
void drive(int fd, Fate& fate, End end, const GovernedForce& force)
{
    const rlimit none{0, 0};
    setrlimit(RLIMIT_CORE, &none);
    FalconDevice device([&] { return std::make_unique<DescriptorLink>(fd, &fate.hangs, &fate.pushes); });
    device.open();
    if (!std::freopen("/dev/null", "w", stderr)) return; // what std::terminate() says
    std::thread grief([&] {
        while (steadyTime() < fate.at) std::this_thread::sleep_for(std::chrono::microseconds(50));
        comeToGrief(end, fate);
    });
    Metronome   metronome{std::chrono::milliseconds(1)};
    for (;;) {
        metronome.wait();
        if (device.exchange(force, steadyTime()).fault == DeviceFault::silenced) fate.silenced = true;
    }
}

class GuardianTest : public ::testing::Test {
protected:
    GuardianTest() { static_cast<void>(askForRealTime()); } // whoever measures must not be late

    pid_t start(DescriptorFalcon& falcon, Fate& fate, End end = End::killed)
    {
        return falcon.start([&](int fd) { drive(fd, fate, end, force_); });
    }

    /// Waits until the child pushes with all of its force, and a random time more.
    bool waitForForce(DescriptorFalcon& falcon)
    {
        for (const double end = steadyTime() + 5; steadyTime() < end;) { // a busy machine makes the driver let go
            falcon.serve(end, [&] { return falcon.pushes() && steadyTime() - falcon.pushesSince() > 22e-3; });
            falcon.serve(steadyTime() + wait_(random_));
            if (falcon.pushes()) return true;
        }
        return false;
    }

    /// Notes how long the Falcon pushed from `failed` on [s].
    /// \param late  [s] by which this process came late since then
    /// \return the same, less the longest time for which this process was late: it has the emulated Falcon, and on a
    ///         busy machine a packet may wait for it, or all of the machine stands still and the guardian with it. A
    ///         guardian that is late by itself is so while this process is not.
    double zeroAfter(DescriptorFalcon& falcon, double failed, double late = 0)
    {
        for (const double end = failed + 0.5; falcon.pushes() && steadyTime() < end;)
            late = std::max(late, served(falcon));
        const double took = falcon.pushes() ? 1 : falcon.zeroSince() - failed;
        took_.push_back(took);
        return took - late;
    }

    /// Returns whether the guardian took the force of a program that sends nothing now. On a busy machine an answer may
    /// have come so late that the driver itself had let go just before: it then pushes again at once, as it may.
    bool wasTaken(const Fate& fate)
    {
        taken_ += fate.pushes;
        return fate.pushes;
    }

    /// Serves for 0.2 ms or until the force ends.
    /// \return for how much longer than a millisecond it took [s]
    static double served(DescriptorFalcon& falcon)
    {
        const double began = steadyTime();
        falcon.serve(began + 200e-6, [&] { return !falcon.pushes(); });
        return std::max(0.0, steadyTime() - began - 1e-3);
    }

    ~GuardianTest() override
    {
        if (took_.empty()) return;
        std::ranges::sort(took_);
        std::printf("  zero after %.1f ms at the median, %.1f ms at most, %zu instants\n",
                    1e3 * took_[took_.size() / 2], 1e3 * took_.back(), took_.size());
    }

    const GovernedForce                    force_ = governed({1, 1, 1});
    std::mt19937                           random_{1};
    std::uniform_real_distribution<double> wait_{0, 5e-3}; ///< [s]
    ZeroInTime                             inTime_{kZeroBy};
    std::vector<double>                    took_;      ///< [s]
    int                                    taken_ = 0; ///< times that wasTaken()
};

class Ends : public GuardianTest, public ::testing::WithParamInterface<End> {};

INSTANTIATE_TEST_SUITE_P(Program, Ends,
                         ::testing::Values(End::killed, End::writesToNowhere, End::aborts, End::runsOutOfMemory),
                         [](const auto& which) { return kNames[std::size_t(which.param)]; });

TEST_P(Ends, AndTheMotorsAreAtZeroWithin30Milliseconds)
{
    for (int n = 0; n < kInstants; ++n) {
        DescriptorFalcon   falcon;
        SharedMemory<Fate> fate;
        const pid_t        child = start(falcon, *fate, GetParam());
        ASSERT_TRUE(waitForForce(falcon)) << n;
        fate->at      = steadyTime() + wait_(random_);
        int    status = 0;
        double late   = 0; // [s]
        while (waitpid(child, &status, WNOHANG) == 0) {
            const double by = served(falcon);
            late            = steadyTime() < fate->at ? 0 : std::max(late, by);
        }
        ASSERT_TRUE(WIFSIGNALED(status) || (kSanitized && status != 0)) << n << ": it came to grief";
        ASSERT_TRUE(inTime_(zeroAfter(falcon, fate->at, late))) << n;
        falcon.serve(steadyTime() + 5e-3);
        ASSERT_FALSE(falcon.pushes()) << n << ": and so they stay";
    }
}

/// SIGSTOP, as a debugger and Ctrl-Z in some programs do.
TEST_F(GuardianTest, AStoppedProgramLosesTheForceAndGoesOnWithZero)
{
    DescriptorFalcon   falcon;
    SharedMemory<Fate> fate;
    const pid_t        child = start(falcon, *fate);
    for (int n = 0; n < kInstants; ++n) {
        ASSERT_TRUE(waitForForce(falcon)) << n;
        fate->silenced       = false;
        const double stopped = steadyTime();
        kill(child, SIGSTOP);
        ASSERT_TRUE(inTime_(zeroAfter(falcon, stopped))) << n;
        falcon.serve(steadyTime() + wait_(random_) * 5);
        ASSERT_FALSE(falcon.pushes()) << n << ": and so they stay";
        const bool isTaken = wasTaken(*fate);

        const std::uint64_t packets = falcon.packets(), zeros = falcon.zeros();
        kill(child, SIGCONT);
        if (!isTaken) continue;
        falcon.serve(steadyTime() + 1, [&] { return falcon.pushes() || falcon.packets() >= packets + 10; });
        ASSERT_EQ(falcon.zeros() - zeros, falcon.packets() - packets) << n << ": zero comes first";
        falcon.serve(steadyTime() + 1, [&] { return falcon.pushes(); });
        ASSERT_TRUE(fate->silenced) << n << ": the governor was told, and engages anew";
    }
    EXPECT_GT(taken_, kInstants / 2);
    kill(child, SIGKILL);
    waitpid(child, nullptr, 0);
}

TEST_F(GuardianTest, ADriverThatHangsLosesTheForceAndGoesOnWithZero)
{
    DescriptorFalcon   falcon;
    SharedMemory<Fate> fate;
    const pid_t        child = start(falcon, *fate);
    for (int n = 0; n < kInstants; ++n) {
        ASSERT_TRUE(waitForForce(falcon)) << n;
        const double hung = steadyTime();
        fate->hangs       = true;
        ASSERT_TRUE(inTime_(zeroAfter(falcon, hung))) << n;
        const bool          isTaken = wasTaken(*fate);
        const std::uint64_t packets = falcon.packets(), zeros = falcon.zeros();
        fate->hangs = false;
        if (!isTaken) continue;
        falcon.serve(steadyTime() + 1, [&] { return falcon.pushes() || falcon.packets() >= packets + 10; });
        ASSERT_EQ(falcon.zeros() - zeros, falcon.packets() - packets) << n << ": zero comes first";
    }
    EXPECT_GT(taken_, kInstants / 2);
    kill(child, SIGKILL);
    waitpid(child, nullptr, 0);
}

/// Threads of one processor, as those of a program are on a machine with as many busy programs.
class OneProcessor {
public:
    /// \return false if there is but one, or this user may not say who goes first
    bool begin()
    {
        cpu_set_t all;
        sched_getaffinity(0, sizeof all, &all);
        if (CPU_COUNT(&all) < 2) return false;
        for (int n = 0; n < CPU_SETSIZE; ++n)
            if (CPU_ISSET(n, &all)) last_ = n;
        hog_ = fork();
        if (hog_ == 0) hog();
        while (busy_->ready == 0) std::this_thread::sleep_for(std::chrono::milliseconds(1));
        return busy_->ready == 1;
    }
    ~OneProcessor()
    {
        if (hog_ <= 0) return;
        kill(hog_, SIGKILL);
        waitpid(hog_, nullptr, 0);
    }

    /// Puts the calling thread, and those that it will start, onto that processor.
    void join() const
    {
        cpu_set_t one;
        CPU_ZERO(&one);
        CPU_SET(last_, &one);
        sched_setaffinity(0, sizeof one, &one);
    }

    /// Nobody else runs there until that time, but for what has a higher priority than a program's threads [s].
    void occupyUntil(double time) { busy_->until = time; }

private:
    struct Busy {
        std::atomic<double> until{0}; ///< [s]
        std::atomic<int>    ready{0}; ///< 1: it has its priority, 2: it may not
    };

    [[noreturn]] void hog() const
    {
        prctl(PR_SET_PDEATHSIG, SIGKILL);
        join();
        const sched_param as{80}; // as the servo and the driver have; who runs, runs on
        busy_->ready = sched_setscheduler(0, SCHED_FIFO, &as) == 0 ? 1 : 2;
        for (;;)
            if (steadyTime() > busy_->until) std::this_thread::sleep_for(std::chrono::microseconds(200));
    }

    SharedMemory<Busy> busy_;
    pid_t              hog_  = -1;
    int                last_ = 0;
};

TEST_F(GuardianTest, AProgramThatGetsNoProcessorLosesTheForceAndGoesOnWithZero)
{
    OneProcessor one;
    if (!one.begin()) GTEST_SKIP() << "there is but one processor, or this user may not ask for SCHED_FIFO";
    DescriptorFalcon   falcon;
    SharedMemory<Fate> fate;
    const pid_t        child    = falcon.start([&](int fd) {
        one.join();
        drive(fd, *fate, End::killed, force_);
    });
    constexpr double   kStarved = 50e-3; // [s]
    for (int n = 0; n < kInstants; ++n) {
        ASSERT_TRUE(waitForForce(falcon)) << n;
        const double starved = steadyTime();
        one.occupyUntil(starved + kStarved);
        falcon.serve(steadyTime() + 1e-3); // what was on its way
        ASSERT_TRUE(inTime_(zeroAfter(falcon, starved))) << n;
        falcon.serve(starved + kStarved - 2e-3);
        ASSERT_FALSE(falcon.pushes()) << n << ": and so they stay";
    }
    kill(child, SIGKILL);
    waitpid(child, nullptr, 0);
}

TEST_F(GuardianTest, AProgramThatEndsInOrderLeavesNoGuardianBehind)
{
    int ends[2];
    ASSERT_EQ(socketpair(AF_UNIX, SOCK_STREAM, 0, ends), 0);
    {
        Guardian guardian({.fd = ends[0]}, kFalconZero, "");
        static_cast<void>(guardian.pass(encode(FalconCommand{.motors = {1, 2, 3}})));
        guardian.passed();
        static_cast<void>(guardian.pass(encode(FalconCommand{})));
        guardian.passed();
        EXPECT_TRUE(guardian.isWatching());
        EXPECT_FALSE(guardian.hasSilenced());
    }
    close(ends[0]);
    std::array<std::uint8_t, 16> bytes;
    EXPECT_EQ(read(ends[1], bytes.data(), bytes.size()), 0) << "it wrote nothing, and its end is closed";
    close(ends[1]);
    EXPECT_EQ(waitpid(-1, nullptr, WNOHANG), -1) << "no child is left";
}

/// Runs in a child, because what it takes away cannot be given back.
/// \return what it returned, or -1 if it crashed
int inChild(const std::function<int()>& act)
{
    const pid_t child = fork();
    if (child == 0) std::_Exit(act());
    int status = 0;
    waitpid(child, &status, 0);
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

/// Takes all handles that are left.
std::vector<int> takeHandles()
{
    std::vector<int> taken;
    for (int fd = dup(0); fd >= 0; fd = dup(0)) taken.push_back(fd);
    return taken;
}

TEST_F(GuardianTest, AProgramOutOfHandlesIsToldSoAndLosesNone)
{
    enum Verdict { good, wrongWord, leak, neverStarted, neverRefused };
    const auto act = [] {
        const rlimit few{64, 64};
        int          ends[2];
        if (socketpair(AF_UNIX, SOCK_STREAM, 0, ends) != 0 || setrlimit(RLIMIT_NOFILE, &few) != 0) return -1;
        std::vector<int> taken   = takeHandles();
        int              refused = 0, started = 0;
        for (std::size_t free = 0; free < 12; ++free) { // it needs some six
            for (std::size_t n = 0; n < free; ++n) {
                close(taken.back());
                taken.pop_back();
            }
            try {
                const Guardian guardian({.fd = ends[0]}, kFalconZero, "a Falcon");
                ++started;
            } catch (const Error& error) {
                const std::string said = error.what();
                if (said.find("a Falcon is not driven") == std::string::npos ||
                    said.find(std::strerror(EMFILE)) == std::string::npos)
                    return int(wrongWord);
                ++refused;
            }
            const std::vector<int> again = takeHandles();
            if (again.size() != free) return int(leak);
            taken.insert(taken.end(), again.begin(), again.end());
        }
        return int(started == 0 ? neverStarted : refused == 0 ? neverRefused : good);
    };
    EXPECT_EQ(inChild(act), good);
}

TEST_F(GuardianTest, AProgramThatMayStartNoProcessIsToldSo)
{
    const auto act = [] {
        constexpr uid_t kNobody = 65534; // the limit is not for root
        if (geteuid() == 0 && setuid(kNobody) != 0) return 2;
        const rlimit none{0, 0};
        int          ends[2];
        if (setrlimit(RLIMIT_NPROC, &none) != 0 || socketpair(AF_UNIX, SOCK_STREAM, 0, ends) != 0) return 3;
        try {
            const Guardian guardian({.fd = ends[0]}, kFalconZero, "a Falcon");
        } catch (const Error& error) {
            const std::string said = error.what();
            return said.find(std::string("starting it: ") + std::strerror(EAGAIN)) != std::string::npos ? 0 : 4;
        }
        return 5;
    };
    EXPECT_EQ(inChild(act), 0);
}

/// Keeps this process and its children from a call of the system, as a sandbox does.
/// \return whether that worked
bool forbid(long call, int error)
{
    sock_filter      rules[] = {BPF_STMT(BPF_LD | BPF_W | BPF_ABS, offsetof(seccomp_data, nr)),
                                BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, unsigned(call), 0, 1),
                                BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_ERRNO | unsigned(error)),
                                BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_ALLOW)};
    const sock_fprog program{std::size(rules), rules};
    return prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) == 0 && prctl(PR_SET_SECCOMP, SECCOMP_MODE_FILTER, &program) == 0;
}

TEST_F(GuardianTest, AProgramWhoseSystemExecutesNothingOrGivesNoFileInMemoryIsToldSo)
{
    struct Case {
        long        call;
        int         error;
        const char* part;
    };
    for (const Case& one :
         {Case{SYS_execve, EACCES, "starting it: "}, Case{SYS_execve, ENOEXEC, "starting it: "},
          Case{SYS_memfd_create, EPERM, "a file in memory: "}, Case{SYS_ftruncate, EPERM, "its memory: "}}) {
        const auto act = [&] {
            int ends[2];
            if (socketpair(AF_UNIX, SOCK_STREAM, 0, ends) != 0 || !forbid(one.call, one.error)) return 3;
            try {
                const Guardian guardian({.fd = ends[0]}, kFalconZero, "a Falcon");
            } catch (const Error& refused) {
                const std::string said = refused.what();
                return said.find(std::string(one.part) + std::strerror(one.error)) != std::string::npos ? 0 : 4;
            }
            return 5;
        };
        EXPECT_EQ(inChild(act), 0) << one.part << std::strerror(one.error);
    }
}

TEST_F(GuardianTest, AProgramWhoseGuardianIsFrozenPushesNoMore)
{
    DescriptorFalcon   falcon;
    SharedMemory<Fate> fate;
    const pid_t        child = start(falcon, *fate);
    ASSERT_TRUE(waitForForce(falcon));
    const pid_t guardian = guardianOf(child);
    ASSERT_GT(guardian, 0);
    kill(guardian, SIGSTOP);
    const double from = steadyTime();
    falcon.serve(from + 1, [&] { return !falcon.pushes() && steadyTime() - from > 0.2; });
    std::printf("  zero %.0f ms after the guardian was frozen\n", (falcon.zeroSince() - from) * 1e3);
    EXPECT_FALSE(falcon.pushes());
    EXPECT_LT(falcon.zeroSince() - from, 0.35) << "0.25 s, and a tenth for a busy machine";
    kill(guardian, SIGKILL);
    kill(child, SIGKILL);
    waitpid(child, nullptr, 0);
}

TEST_F(GuardianTest, AProgramWhoseGuardianHasEndedPushesNoMore)
{
    DescriptorFalcon   falcon;
    SharedMemory<Fate> fate;
    const pid_t        child = start(falcon, *fate);
    ASSERT_TRUE(waitForForce(falcon));
    const pid_t guardian = guardianOf(child);
    ASSERT_GT(guardian, 0);
    kill(guardian, SIGKILL);
    const double from = steadyTime();
    falcon.serve(from + 1, [&] { return !falcon.pushes(); });
    std::printf("  zero %.1f ms after the guardian was killed\n", (steadyTime() - from) * 1e3);
    EXPECT_FALSE(falcon.pushes());
    EXPECT_LT(steadyTime() - from, 0.2) << "at the next exchange; a frozen one is missed after 0.25 s";
    kill(child, SIGKILL);
    waitpid(child, nullptr, 0);
}

} // namespace
} // namespace palp
