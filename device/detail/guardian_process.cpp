// The guardian: a process of its own that writes zero force to a haptic device when the program that drives it has
// ended, was stopped, or hangs. It is compiled into the library as an executable, see guardian.h.
//
//     palpate-guardian write            the descriptor takes packets by write(): hidraw, a terminal, a socket
//     palpate-guardian bulk ENDPOINT    it is a node of usbfs
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <cstring>

#include <fcntl.h>
#include <linux/usbdevice_fs.h>
#include <poll.h>
#include <sched.h>
#include <sys/ioctl.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/syscall.h>
#include <unistd.h>

#include "device/detail/guardian_page.h"

namespace {

using namespace palp;

constexpr int          kZeros = 3;  // one packet may be lost, hardly three
constexpr unsigned int kBulk  = 10; // [ms] for a transfer
constexpr int          kRoom  = 5;  // [ms] for a descriptor that is full
constexpr int          kAbove = 81; // [1] priority: the program's threads have 80

unsigned int endpoint = 0; // of usbfs; 0: write()

void writePacket(std::uint8_t* packet, std::uint32_t size)
{
    if (endpoint == 0) {
        pollfd room{kGuardianDeviceFd, POLLOUT, 0};
        if (poll(&room, 1, kRoom) > 0) static_cast<void>(!write(kGuardianDeviceFd, packet, size));
        return;
    }
    usbdevfs_bulktransfer transfer{endpoint, size, kBulk, packet};
    if (ioctl(kGuardianDeviceFd, USBDEVFS_BULK, &transfer) < 0 && errno == EPIPE)
        ioctl(kGuardianDeviceFd, USBDEVFS_CLEAR_HALT, &endpoint);
}

void sayZero(const GuardianPage& page)
{
    const std::uint32_t size = page.size <= GuardianPage::kPacket ? page.size : std::uint32_t(GuardianPage::kPacket);
    auto                zero = page.zeros[page.zero & 1U]; // a copy of the guardian's own
    for (int n = 0; n < kZeros; ++n) writePacket(zero.data(), size);
}

/// Takes the force of a program that is silent. A packet that it was about to send becomes zero before it goes out,
/// whenever that is: the program looks at `silenced` after it has written the packet, and before it sends it.
void silence(GuardianPage& page)
{
    if (page.silenced == page.noticed) ++page.silenced;
    std::memcpy(page.packet.data(), page.zeros[page.zero & 1U].data(), GuardianPage::kPacket);
    sayZero(page);
}

/// Makes this process hard to delay and to end. What is refused is not missed on an idle machine.
void settle()
{
    prctl(PR_SET_NAME, "palpate-guardian");                                     // in lists of processes
    for (int signal = 1; signal < NSIG; ++signal) std::signal(signal, SIG_IGN); // Ctrl-C is for the program
    syscall(SYS_close_range, kGuardianDeviceFd + 1, ~0U, 0U); // a pipe of the program must end with it
    for (int standard = 0; standard < 3; ++standard) close(standard);
    const sched_param priority{kAbove};
    static_cast<void>(sched_setscheduler(0, SCHED_FIFO, &priority));
    static_cast<void>(mlockall(MCL_CURRENT | MCL_FUTURE));
}

} // namespace

int main(int count, char** words)
{
    if (count == 3 && std::strcmp(words[1], "bulk") == 0) endpoint = unsigned(std::atoi(words[2]));
    void* const memory = mmap(nullptr, sizeof(GuardianPage), PROT_READ | PROT_WRITE, MAP_SHARED, kGuardianPageFd, 0);
    if (memory == MAP_FAILED) return 1;
    auto& page = *static_cast<GuardianPage*>(memory);
    settle();
    for (;;) {
        const std::int64_t now = guardianClock();
        page.watching          = now;
        // A sign of life that lies ahead is none: something has written over the page.
        const std::int64_t left    = page.alive + kGuardianPatience - now;
        const bool         isAlive = left > 0 && left <= kGuardianPatience;
        if (page.pushing != 0 && !isAlive) silence(page);
        const std::int64_t wait = page.pushing != 0 && isAlive ? left : kGuardianPatience;
        pollfd             life{kGuardianLifeFd, 0, 0};
        const timespec     time{0, long(wait)};
        if (ppoll(&life, 1, &time, nullptr) > 0) { // the program has ended
            if (page.pushing != 0) sayZero(page);
            return 0;
        }
    }
}
