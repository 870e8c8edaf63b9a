#include "device/detail/guardian.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <new>
#include <utility>

#include <fcntl.h>
#include <poll.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include "device/detail/guardian_image.h"
#include "device/detail/guardian_page.h"
#include "engine/core/contract.h"

namespace palp {
namespace {

constexpr std::int64_t kStart  = 1'000'000'000; ///< [ns] for the guardian's first look; it takes 2 ms
constexpr std::int64_t kEnd    = 500'000'000;   ///< [ns] for its last packets, which take 30 ms at most
constexpr std::int64_t kAbsent = 250'000'000;   ///< [ns] without a look, if it is frozen; it looks every 25 ms
constexpr int          kAside  = 16;            ///< descriptors from here on are not those of GuardianDescriptor

/// A descriptor that closes itself, and is not passed on to other programs.
class Descriptor {
public:
    explicit Descriptor(int fd) : fd_(fd < 0 ? fd : fcntl(fd, F_DUPFD_CLOEXEC, kAside))
    {
        if (fd >= 0) close(fd);
    }
    ~Descriptor()
    {
        if (fd_ >= 0) close(fd_);
    }
    Descriptor(const Descriptor&)            = delete;
    Descriptor& operator=(const Descriptor&) = delete;

    [[nodiscard]] int  get() const noexcept { return fd_; }
    [[nodiscard]] int  release() noexcept { return std::exchange(fd_, -1); }
    [[nodiscard]] bool isOpen() const noexcept { return fd_ >= 0; }

private:
    int fd_;
};

[[noreturn]] void refuse(const std::string& device, const char* what, int error)
{
    throw Error(device +
                " is not driven: the guardian process, which takes the force away if this program crashes, "
                "cannot be started: " +
                what + ": " + std::strerror(error) +
                "; it is an executable in memory (memfd_create): see that a sandbox allows it, and that the setting "
                "vm.memfd_noexec is below 2");
}

/// Returns the guardian's executable as a file in memory.
int executable()
{
    const int file = memfd_create("palpate-guardian", MFD_CLOEXEC);
    for (std::size_t at = 0; file >= 0 && at < sizeof kGuardianImage;) {
        const ssize_t done = write(file, kGuardianImage + at, sizeof kGuardianImage - at);
        if (done <= 0) return close(file), -1;
        at += std::size_t(done);
    }
    return file;
}

/// Starts it with its three descriptors, in a session of its own: no key of a terminal reaches it.
int start(int file, const std::array<int, 3>& descriptors, int endpoint, int& error)
{
    posix_spawn_file_actions_t actions;
    posix_spawnattr_t          attributes;
    posix_spawn_file_actions_init(&actions);
    posix_spawnattr_init(&attributes);
    for (int n = 0; n < 3; ++n)
        posix_spawn_file_actions_adddup2(&actions, descriptors[std::size_t(n)], kGuardianPageFd + n);
    posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSID);

    const std::string path        = "/proc/self/fd/" + std::to_string(file);
    std::string       words[]     = {"palpate-guardian", endpoint > 0 ? "bulk" : "write", std::to_string(endpoint)};
    char*             arguments[] = {words[0].data(), words[1].data(), words[2].data(), nullptr};
    char*             nothing[]   = {nullptr};
    pid_t             process     = -1;
    error                         = posix_spawn(&process, path.c_str(), &actions, &attributes, arguments, nothing);
    posix_spawn_file_actions_destroy(&actions);
    posix_spawnattr_destroy(&attributes);
    return error == 0 ? int(process) : -1;
}

/// Waits until it is done, for a time [ns].
template <class Done>
bool waitFor(const Done& done, std::int64_t time)
{
    for (const std::int64_t end = guardianClock() + time; !done();) {
        if (guardianClock() > end) return false;
        poll(nullptr, 0, 1);
    }
    return true;
}

} // namespace

Guardian::Guardian(const Line& line, const ZeroRule& rule, const std::string& device) : rule_(rule)
{
    int ends[2] = {-1, -1};
    if (pipe2(ends, O_CLOEXEC) != 0) refuse(device, "a pipe", errno);
    Descriptor its(ends[0]), ours(ends[1]), program(executable()),
        memory(memfd_create("palpate-guardian-page", MFD_CLOEXEC)), shared(fcntl(line.fd, F_DUPFD_CLOEXEC, 0));
    if (!program.isOpen() || !memory.isOpen()) refuse(device, "a file in memory", errno);
    if (!shared.isOpen()) refuse(device, "the device's descriptor", errno);
    if (ftruncate(memory.get(), sizeof(GuardianPage)) != 0) refuse(device, "its memory", errno);
    void* const page = mmap(nullptr, sizeof(GuardianPage), PROT_READ | PROT_WRITE, MAP_SHARED, memory.get(), 0);
    if (page == MAP_FAILED) refuse(device, "its memory", errno);
    page_ = new (page) GuardianPage;

    int error = 0;
    process_  = start(program.get(), {memory.get(), its.get(), shared.get()}, line.endpoint, error);
    life_     = ours.release();
    if (process_ < 0 || !waitFor([this] { return page_->watching != 0; }, kStart)) {
        const bool isStarted = process_ >= 0;
        end();
        refuse(device, isStarted ? "it does not begin" : "starting it", isStarted ? ETIMEDOUT : error);
    }
}

void Guardian::end() noexcept
{
    close(life_);
    // Whoever waits for all children of the program may have had it already.
    if (process_ >= 0) waitFor([this] { return waitpid(process_, nullptr, WNOHANG) != 0; }, kEnd);
    munmap(page_, sizeof(GuardianPage));
}

std::span<const std::uint8_t> Guardian::pass(std::span<const std::uint8_t> packet) noexcept
{
    keepAlive();
    isPush_ = false;
    known_  = page_->silenced;
    if (packet.empty() || packet.size() > GuardianPage::kPacket) return packet;

    const std::uint32_t next = 1 - (page_->zero & 1U);
    std::span           zero = std::span(page_->zeros[next]).first(packet.size());
    std::ranges::copy(packet, zero.begin());
    rule_.silence(zero);
    page_->size = std::uint32_t(packet.size()); // the same for all packets that push
    page_->zero = next;

    isPush_ = rule_.pushes(packet);
    if (isPush_) page_->pushing = 1;
    const std::span out = std::span(page_->packet).first(packet.size());
    std::ranges::copy(packet, out.begin());
    known_ = page_->silenced.fetch_add(0); // and so a barrier: the packet is there before the look
    if (isPush_ && known_ != page_->noticed) {
        std::ranges::copy(zero, out.begin());
        isPush_ = false;
    }
    return out;
}

void Guardian::passed() noexcept
{
    keepAlive();
    if (isPush_) return;
    if (known_ != page_->noticed) hasTaken_ = true;
    page_->noticed = known_;
    page_->pushing = 0;
}

void Guardian::keepAlive() noexcept
{
    page_->alive = guardianClock();
}

bool Guardian::hasSilenced() noexcept
{
    return std::exchange(hasTaken_, false);
}

bool Guardian::isWatching() const noexcept
{
    pollfd its{life_, 0, 0}; // an end that has no other: nobody is there
    return poll(&its, 1, 0) == 0 && guardianClock() - page_->watching < kAbsent;
}

} // namespace palp
