#pragma once
#include <array>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <thread>
#include <utility>
#include <vector>

#include <poll.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include "device/detail/guardian.h"
#include "device/falcon/emulated_falcon.h"
#include "device/falcon/falcon_link.h"
#include "engine/core/contract.h"

// An emulated Falcon in this process, which a child process drives through a descriptor: what the motors do when that
// process comes to grief.
namespace palp {

inline double steadyTime() // [s]
{
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

/// Memory of both processes.
template <class Content>
class SharedMemory {
public:
    SharedMemory()
        : content_(new (mmap(nullptr, sizeof(Content), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0))
                       Content)
    {
    }
    SharedMemory(const SharedMemory&)            = delete;
    SharedMemory& operator=(const SharedMemory&) = delete;
    ~SharedMemory() { munmap(content_, sizeof(Content)); }

    Content* operator->() const { return content_; }
    Content& operator*() const { return *content_; }

private:
    Content* content_;
};

/// The child's link: a Falcon whose firmware runs, at the other end of a descriptor, under a guardian.
class DescriptorLink final : public FalconLink {
public:
    /// \param hangs   writing waits while it is true; may be null
    /// \param pushes  becomes whether the driver's last packet carries a force; may be null
    explicit DescriptorLink(int fd, const std::atomic<bool>* hangs = nullptr, std::atomic<bool>* pushes = nullptr)
        : fd_(fd), hangs_(hangs), pushes_(pushes), guardian_({.fd = fd}, kFalconZero, "the Falcon of this test")
    {
    }

    [[nodiscard]] double now() const noexcept override { return steadyTime(); }
    void                 control(FtdiRequest, std::uint16_t) override {}
    [[nodiscard]] bool   wasSilenced() noexcept override { return guardian_.hasSilenced(); }
    void                 keepAlive() noexcept override { guardian_.keepAlive(); }

    void write(std::span<const std::uint8_t> bytes) override
    {
        // Once, as the driver's own link does: the zeros of its end still pass.
        if (!guardian_.isWatching() && !std::exchange(isLost_, true)) throw LinkLost("its guardian has ended");
        if (pushes_) *pushes_ = kFalconZero.pushes(bytes);
        const std::span out = guardian_.pass(bytes);
        while (hangs_ && *hangs_) std::this_thread::sleep_for(std::chrono::microseconds(100));
        if (send(fd_, out.data(), out.size(), MSG_NOSIGNAL) != ssize_t(out.size()))
            throw LinkGone(std::strerror(errno));
        guardian_.passed();
    }

    std::size_t read(std::span<std::uint8_t> bytes, double timeout) override
    {
        pollfd         answer{fd_, POLLIN, 0};
        const timespec wait{0, long(timeout * 1e9)};
        if (ppoll(&answer, 1, &wait, nullptr) <= 0) return 0;
        const ssize_t count = ::read(fd_, bytes.data(), bytes.size());
        if (count <= 0) throw LinkGone("the other end is closed");
        return std::size_t(count);
    }

private:
    int                      fd_;
    const std::atomic<bool>* hangs_;
    std::atomic<bool>*       pushes_;
    bool                     isLost_ = false;
    Guardian                 guardian_;
};

/// The emulated Falcon at this process's end. Its motors never let go by themselves: what acts is the guardian.
class DescriptorFalcon {
public:
    explicit DescriptorFalcon(EmulatedFalcon::Arm arm = {}) : falcon_(settings(), std::move(arm))
    {
        if (socketpair(AF_UNIX, SOCK_STREAM, 0, ends_.data()) != 0) throw Error(std::strerror(errno));
    }
    ~DescriptorFalcon()
    {
        close(ends_[0]);
        closeTheirs();
    }
    DescriptorFalcon(const DescriptorFalcon&)            = delete;
    DescriptorFalcon& operator=(const DescriptorFalcon&) = delete;

    /// Runs `work` in a child process, which gets its end of the descriptor.
    template <class Work>
    pid_t start(const Work& work)
    {
        const pid_t child = fork();
        if (child != 0) {
            closeTheirs();
            return child;
        }
        prctl(PR_SET_PDEATHSIG, SIGKILL); // a test that is ended leaves nothing behind
        close(ends_[0]);
        try {
            work(ends_[1]);
        } catch (const std::exception& error) {
            std::fprintf(stderr, "child: %s\n", error.what());
            _exit(3);
        }
        _exit(0);
    }

    /// Receives and answers packets until a time [s], or until `done`.
    template <class Done>
    void serve(double until, const Done& done)
    {
        while (!done()) {
            const double left = until - steadyTime();
            if (left <= 0) return;
            pollfd         packet{ends_[0], POLLIN, 0};
            const timespec wait{time_t(left), long((left - double(time_t(left))) * 1e9)};
            if (ppoll(&packet, 1, &wait, nullptr) > 0 && !receive()) return;
        }
    }
    void serve(double until)
    {
        serve(until, [] { return false; });
    }

    void press(std::uint8_t buttons) { falcon_.press(buttons); }

    [[nodiscard]] bool          pushes() const { return falcon_.motors() != std::array<std::int16_t, 3>{}; }
    [[nodiscard]] double        zeroSince() const { return zeroSince_; }      ///< [s] while it does not push
    [[nodiscard]] double        pushesSince() const { return pushesSince_; }  ///< [s] while it does
    [[nodiscard]] std::uint64_t packets() const { return falcon_.packets(); } ///< received so far
    [[nodiscard]] std::uint64_t zeros() const { return zeros_; }              ///< of these, in a row until now

private:
    static EmulatedFalconSettings settings()
    {
        EmulatedFalconSettings falcon;
        falcon.running = falcon.homed = true;
        falcon.holdTime               = 1e9;
        return falcon;
    }

    void closeTheirs()
    {
        if (ends_[1] >= 0) close(ends_[1]);
        ends_[1] = -1;
    }

    bool receive()
    {
        std::array<std::uint8_t, 256> bytes;
        const ssize_t                 count = ::read(ends_[0], bytes.data(), bytes.size());
        const double                  now   = steadyTime();
        if (count <= 0) return false;
        for (ssize_t n = 0; n < count; ++n) {
            const bool          before = pushes();
            const std::uint64_t last   = falcon_.packets();
            const auto answer = falcon_.receive(bytes[std::size_t(n)], std::uint16_t(FalconDivisor::run), now - start_);
            if (falcon_.packets() != last) zeros_ = pushes() ? 0 : zeros_ + 1;
            if (before && !pushes()) zeroSince_ = now;
            if (!before && pushes()) pushesSince_ = now;
            if (answer.empty()) continue;
            std::this_thread::sleep_for(std::chrono::microseconds(250)); // as long as both take on the wire
            static_cast<void>(!send(ends_[0], answer.data(), answer.size(), MSG_NOSIGNAL));
        }
        return true;
    }

    std::array<int, 2> ends_{-1, -1};
    EmulatedFalcon     falcon_;
    double             start_     = steadyTime();        ///< [s] when its clock was 0
    double             zeroSince_ = 0, pushesSince_ = 0; ///< [s]
    std::uint64_t      zeros_ = 0;
};

} // namespace palp
