#pragma once
#include <array>
#include <cstring>
#include <memory>
#include <vector>

#include <arpa/inet.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include "device/detail/tcp_line.h"
#include "device/haply/emulated_haply.h"
#include "tests/device/descriptor_falcon.h"

namespace palp {

/// An emulated Inverse Service behind real sockets, on ports that the system chooses, by the steady clock.
/// \thread one
class HaplyServer {
public:
    explicit HaplyServer(EmulatedHaplySettings settings = {}) : service(startedNow(std::move(settings)))
    {
        for (Listener& listener : listeners_) {
            listener.fd = socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
            sockaddr_in address{};
            address.sin_family      = AF_INET;
            address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
            socklen_t size          = sizeof address;
            auto*     any           = reinterpret_cast<sockaddr*>(&address);
            if (bind(listener.fd, any, size) != 0 || listen(listener.fd, 8) != 0 ||
                getsockname(listener.fd, any, &size) != 0)
                throw Error(std::strerror(errno));
            listener.port = ntohs(address.sin_port);
        }
    }
    ~HaplyServer()
    {
        for (const Listener& listener : listeners_) close(listener.fd);
        for (const Client& client : clients_) close(client.fd);
    }
    HaplyServer(const HaplyServer&)            = delete;
    HaplyServer& operator=(const HaplyServer&) = delete;

    /// Returns what connects to it; it keeps no reference to this object.
    [[nodiscard]] HaplyOpener opener() const
    {
        const std::array<std::uint16_t, 2> ports{listeners_[0].port, listeners_[1].port};
        return [ports](HaplyPort port) {
            return connectTcp({"127.0.0.1", ports[port == HaplyPort::service ? 0 : 1]}, 1);
        };
    }

    /// Serves until a time [s], or until `done`.
    template <class Done>
    void serve(double until, const Done& done)
    {
        while (!done() && steadyTime() < until) serveOnce();
    }
    void serve(double until)
    {
        serve(until, [] { return false; });
    }

    EmulatedHaply service;

private:
    static EmulatedHaplySettings startedNow(EmulatedHaplySettings settings)
    {
        settings.start = steadyTime();
        return settings;
    }

    struct Listener {
        int           fd   = -1;
        std::uint16_t port = 0;
    };
    struct Client {
        int                                  fd = -1;
        std::shared_ptr<EmulatedHaply::Peer> peer;
    };

    void serveOnce()
    {
        std::vector<pollfd> all;
        for (const Listener& listener : listeners_) all.push_back({listener.fd, POLLIN, 0});
        for (const Client& client : clients_) all.push_back({client.fd, POLLIN, 0});
        const timespec wait{0, 200'000};
        ppoll(all.data(), all.size(), &wait, nullptr);
        service.moveTo(steadyTime());
        for (Client& client : clients_) receive(client);
        std::erase_if(clients_, [](const Client& client) { return client.fd < 0; });
        for (int n = 0; n < 2; ++n)
            for (int fd;
                 (fd = accept4(listeners_[std::size_t(n)].fd, nullptr, nullptr, SOCK_CLOEXEC | SOCK_NONBLOCK)) >= 0;)
                clients_.push_back({fd, service.accept(n == 0 ? HaplyPort::service : HaplyPort::events)});
    }

    static void receive(Client& client)
    {
        std::array<std::uint8_t, 4096> bytes{};
        ssize_t                        got = 0;
        while ((got = recv(client.fd, bytes.data(), bytes.size(), 0)) > 0)
            client.peer->receive(std::span(bytes).first(std::size_t(got)));
        const bool  isOver = got == 0 || (got < 0 && errno != EAGAIN);
        std::string out    = std::exchange(client.peer->out, {});
        if (!out.empty()) static_cast<void>(!send(client.fd, out.data(), out.size(), MSG_NOSIGNAL));
        if (!isOver && !client.peer->isClosed) return;
        client.peer->isClosed = true;
        close(std::exchange(client.fd, -1));
    }

    std::array<Listener, 2> listeners_; ///< of the service and of its events
    std::vector<Client>     clients_;
};

} // namespace palp
