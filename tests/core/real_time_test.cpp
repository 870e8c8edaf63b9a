#include <cstdlib>
#include <fstream>
#include <string>
#include <thread>

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include "engine/core/real_time.h"
#include "tests/support/sanitized.h"

namespace palp {
namespace {

constexpr uid_t kNobody = 65534;

/// Asks for real time as a user whose limit of locked memory is a little more than the program has.
void askBelowALimit()
{
    std::size_t pages = 0;
    std::ifstream("/proc/self/statm") >> pages;
    const rlim_t limit = pages * std::size_t(sysconf(_SC_PAGESIZE)) + (1U << 20U); // [byte] a thread's stack is 8 MiB
    const rlimit both{limit, limit};
    if (setrlimit(RLIMIT_MEMLOCK, &both) != 0) std::exit(3); // above the old limit only root may
    if (geteuid() == 0 && setresuid(kNobody, kNobody, kNobody) != 0) std::exit(2);
    const std::string refused = askForRealTime();
    std::thread([] {}).join();
    std::exit(refused.find("mlockall") == std::string::npos ? 4 : 0);
}

TEST(RealTime, AProgramThatFitsIntoItsLimitOfLockedMemoryStillStartsThreads)
{
    if (kSanitized) GTEST_SKIP() << "a sanitizer's shadow memory is beyond every limit";
    rlimit limit{};
    ASSERT_EQ(getrlimit(RLIMIT_MEMLOCK, &limit), 0);
    constexpr rlim_t kEnough = 64U << 20U; // [byte]
    if (limit.rlim_max < kEnough) {
        limit.rlim_max = kEnough;
        if (setrlimit(RLIMIT_MEMLOCK, &limit) != 0)
            GTEST_SKIP() << "this user may not set the limit so high"; // root in some containers neither
    }
    EXPECT_EXIT(askBelowALimit(), testing::ExitedWithCode(0), "");
}

} // namespace
} // namespace palp
