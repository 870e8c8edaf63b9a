#include "engine/session/marker_input.h"

#include <array>
#include <string>
#include <thread>
#include <utility>

#include <poll.h>
#include <sys/eventfd.h>
#include <sys/socket.h>
#include <unistd.h>

#include "engine/core/contract.h"
#include "engine/session/detail/key_terminal.h"
#include "engine/session/detail/quiet_thread.h"

namespace palp {
struct MarkerInput::Impl {
    explicit Impl(const MarkerSources& sources) : wantsKeys(sources.keys), onKey(sources.onKey)
    {
        if (sources.address) socket.emplace(*sources.address, UdpEnd::here, "--markers");
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

    void listen(Hear to)
    {
        hear = std::move(to);
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
            if (from[0].revents != 0) return;
            if (from[1].revents != 0) readDatagrams();
            if (from[2].revents != 0 && !readKeys()) from[2].fd = -1;
        }
    }

    void readDatagrams()
    {
        constexpr int          kAtOnce = 256; // then the end is looked at again: a flood cannot hold it up
        std::array<char, 1024> text;          // what is longer is cut by the system
        for (int n = 0; n < kAtOnce; ++n) {
            const ssize_t size = ::recv(socket->handle(), text.data(), text.size(), MSG_DONTWAIT);
            if (size < 0) return;
            hear({text.data(), std::size_t(size)});
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
    std::optional<KeyTerminal>     terminal;
    std::optional<UdpSocket>       socket;
    int                            wake = -1;
    std::thread                    thread;
};

MarkerInput::MarkerInput(const MarkerSources& sources) : impl_(std::make_unique<Impl>(sources)) {}

MarkerInput::~MarkerInput() = default;

void MarkerInput::listen(Hear hear)
{
    impl_->listen(std::move(hear));
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
