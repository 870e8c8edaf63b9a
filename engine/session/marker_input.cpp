#include "engine/session/marker_input.h"

#include <array>
#include <string>
#include <thread>
#include <utility>

#include <linux/sock_diag.h>
#include <poll.h>
#include <sys/eventfd.h>
#include <sys/socket.h>
#include <unistd.h>

#include "engine/core/contract.h"
#include "engine/session/detail/key_terminal.h"
#include "engine/session/detail/quiet_thread.h"

namespace palp {
namespace {

/// Asks for room for some 2500 short datagrams, which come while the thread that reads is kept from running; the usual
/// room is for 250. Where the system grants less, more are dropped, and counted.
void askForRoom(int socket) noexcept
{
    constexpr int kRoom = 1 << 20; // [bytes] Linux grants twice as much, and takes some 800 for a short datagram
    static_cast<void>(::setsockopt(socket, SOL_SOCKET, SO_RCVBUF, &kRoom, sizeof kRoom));
}

/// Returns how many datagrams of a socket the system has dropped so far, modulo 2^32. We ask for it, because the count
/// that comes with each datagram (SO_RXQ_OVFL) says nothing of those that were dropped after the last one.
/// \return 0 if the system does not say
std::uint32_t droppedOf(int socket) noexcept
{
#ifdef SO_MEMINFO
    std::array<std::uint32_t, SK_MEMINFO_VARS> counts{};
    socklen_t                                  size = sizeof counts;
    if (::getsockopt(socket, SOL_SOCKET, SO_MEMINFO, counts.data(), &size) == 0) return counts[SK_MEMINFO_DROPS];
#endif
    static_cast<void>(socket);
    return 0;
}

} // namespace

struct MarkerInput::Impl {
    explicit Impl(const MarkerSources& sources) : wantsKeys(sources.keys), onKey(sources.onKey)
    {
        if (!sources.address) return;
        socket.emplace(*sources.address, UdpEnd::here, "--markers");
        askForRoom(socket->handle());
    }

    ~Impl()
    {
        if (thread.joinable()) {
            const std::uint64_t one     = 1;
            const ssize_t       written = ::write(wake, &one, sizeof one); // into an empty counter: it cannot fail
            static_cast<void>(written);
            thread.join();
        }
        if (wake >= 0) ::close(wake);
    }

    void listen(Hear to, Lose ofLost)
    {
        hear = std::move(to);
        lose = std::move(ofLost);
        wake = ::eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK);
        if (wake < 0) throw Error("--markers: the system has no handle left");
        terminal.emplace(wantsKeys);
        thread = quietThread([this] { work(); });
    }

    Impl(const Impl&)            = delete;
    Impl& operator=(const Impl&) = delete;

    void work()
    {
        // A negative handle is one that poll() passes over.
        std::array<pollfd, 3> from = {{{wake, POLLIN, 0},
                                       {socket ? socket->handle() : -1, POLLIN, 0},
                                       {terminal->isOpen() ? STDIN_FILENO : -1, POLLIN, 0}}};
        for (;;) {
            if (::poll(from.data(), from.size(), -1) < 0) continue; // interrupted
            if (from[0].revents != 0) return readLast();
            if (from[1].revents != 0) static_cast<void>(readDatagrams());
            if (from[2].revents != 0 && !readKeys()) from[2].fd = -1;
        }
    }

    /// Returns false if all have been read.
    bool readDatagrams()
    {
        constexpr int          kAtOnce = 256; // then the end is looked at again: a flood cannot hold it up
        std::array<char, 1024> text;          // what is longer is cut by the system
        bool                   more = true;
        for (int n = 0; more && n < kAtOnce; ++n) {
            const ssize_t size = ::recv(socket->handle(), text.data(), text.size(), MSG_DONTWAIT);
            more               = size >= 0;
            if (more) hear({text.data(), std::size_t(size)});
        }
        const std::uint32_t now = droppedOf(socket->handle());
        if (const std::uint32_t since = now - dropped; since > 0 && lose) lose(since);
        dropped = now;
        return more;
    }

    /// Reads what waits at the end, at most so much that a flood cannot hold it up.
    void readLast()
    {
        constexpr int kMost = 64;
        if (!socket) return;
        for (int n = 0; n < kMost && readDatagrams(); ++n) {
        }
    }

    /// Returns false if no more keys will come.
    bool readKeys()
    {
        if (!KeyTerminal::ours()) return false; // in the background by now
        std::array<char, 64> keys;
        const ssize_t        size = ::read(STDIN_FILENO, keys.data(), keys.size());
        if (size <= 0) return false;
        std::string_view pressed(keys.data(), std::size_t(size));
        if (pressed.front() == '\x1b') return true; // an arrow, a function key
        while (!pressed.empty()) {
            std::size_t bytes = 1; // of a character of UTF-8: those that follow begin with the bits 10
            while (bytes < pressed.size() && (static_cast<unsigned char>(pressed[bytes]) & 0xC0U) == 0x80) ++bytes;
            const std::string_view key = pressed.substr(0, bytes);
            if (!onKey || !onKey(key)) hear(key == " " ? "space" : key == "\n" || key == "\r" ? "enter" : key);
            pressed.remove_prefix(bytes);
        }
        return true;
    }

    bool                           wantsKeys;
    decltype(MarkerSources::onKey) onKey;
    Hear                           hear;
    Lose                           lose;
    std::optional<KeyTerminal>     terminal;
    std::optional<UdpSocket>       socket;
    std::uint32_t                  dropped = 0; ///< as droppedOf() said last
    int                            wake    = -1;
    std::thread                    thread;
};

MarkerInput::MarkerInput(const MarkerSources& sources) : impl_(std::make_unique<Impl>(sources)) {}

MarkerInput::~MarkerInput() = default;

void MarkerInput::listen(Hear hear, Lose lose)
{
    impl_->listen(std::move(hear), std::move(lose));
}

std::uint16_t MarkerInput::port() const noexcept
{
    return impl_->socket ? impl_->socket->port() : std::uint16_t(0);
}

bool MarkerInput::hearsKeys() const noexcept
{
    return impl_->terminal && impl_->terminal->isOpen();
}

} // namespace palp
