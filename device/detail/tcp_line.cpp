#include "device/detail/tcp_line.h"

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <optional>
#include <utility>

#include <fcntl.h>
#include <netdb.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include "device/detail/guardian.h"
#include "device/machine_time.h"

namespace palp {
namespace {

constexpr double kWrite = 20e-3; ///< [s] for the other side to make room; a service that reads has some

timespec timeOf(double seconds)
{
    const double rest = std::isfinite(seconds) ? std::clamp(seconds, 0.0, 60.0) : 0;
    return {time_t(rest), long((rest - std::floor(rest)) * 1e9)};
}

class TcpLine : public ByteLine {
public:
    TcpLine(int socket, std::string name) : socket_(socket), name_(std::move(name)) {}
    ~TcpLine() override
    {
        guardian_.reset(); // it may still write zeros
        close(socket_);
    }

    std::size_t read(std::span<std::uint8_t> bytes, double timeout) override
    {
        ssize_t got = recv(socket_, bytes.data(), bytes.size(), MSG_DONTWAIT);
        if (got < 0 && (errno == EAGAIN || errno == EINTR) && timeout > 0) {
            pollfd         ready{socket_, POLLIN, 0};
            const timespec time = timeOf(timeout);
            if (ppoll(&ready, 1, &time, nullptr) <= 0) return 0;
            got = recv(socket_, bytes.data(), bytes.size(), MSG_DONTWAIT);
        }
        if (got < 0 && (errno == EAGAIN || errno == EINTR)) return 0;
        if (got < 0) throw LineEnded(name_ + ": reading failed: " + std::strerror(errno));
        if (got == 0 && !bytes.empty()) throw LineEnded(name_ + " has closed the connection");
        return std::size_t(got);
    }

    void write(std::span<const std::uint8_t> bytes) override
    {
        for (bool waited = false; !bytes.empty();) {
            const ssize_t done = send(socket_, bytes.data(), bytes.size(), MSG_DONTWAIT | MSG_NOSIGNAL);
            if (done >= 0) {
                bytes = bytes.subspan(std::size_t(done));
                continue;
            }
            if (errno != EAGAIN && errno != EINTR) throw LineEnded(name_ + ": writing failed: " + std::strerror(errno));
            pollfd         room{socket_, POLLOUT, 0};
            const timespec time = timeOf(kWrite);
            if (std::exchange(waited, true) || ppoll(&room, 1, &time, nullptr) <= 0)
                throw LineEnded(name_ + " takes no more bytes");
        }
    }

    [[nodiscard]] double now() const noexcept override { return machineTime(); }

    void guard(const ZeroRule& rule) override { guardian_.emplace(Guardian::Line{.fd = socket_}, rule, name_); }

    void writeForce(std::span<const std::uint8_t> packet) override
    {
        // Told once; the zeros that end a session still pass.
        if (guardian_ && !guardian_->isWatching() && !std::exchange(unguarded_, true))
            throw GuardianEnded(name_ + ": its guardian process has ended");
        write(guardian_ ? guardian_->pass(packet) : packet);
        if (guardian_) guardian_->passed();
    }

    [[nodiscard]] bool wasSilenced() noexcept override { return guardian_ && guardian_->hasSilenced(); }

private:
    int                     socket_;
    std::string             name_;
    bool                    unguarded_ = false; ///< the guardian has ended, and that was told
    std::optional<Guardian> guardian_;
};

/// Connects within a time [s].
/// \return the error's number; 0 if it is connected
int connectWithin(int socket, const addrinfo& to, double timeout)
{
    if (connect(socket, to.ai_addr, to.ai_addrlen) == 0) return 0;
    if (errno != EINPROGRESS) return errno;
    pollfd         done{socket, POLLOUT, 0};
    const timespec time = timeOf(timeout);
    if (ppoll(&done, 1, &time, nullptr) <= 0) return ETIMEDOUT;
    int       error = 0;
    socklen_t size  = sizeof error;
    return getsockopt(socket, SOL_SOCKET, SO_ERROR, &error, &size) == 0 ? error : errno;
}

} // namespace

std::unique_ptr<ByteLine> connectTcp(const TcpAddress& address, double timeout)
{
    addrinfo hints{}, *found = nullptr;
    hints.ai_socktype      = SOCK_STREAM;
    const std::string port = std::to_string(address.port);
    if (const int error = getaddrinfo(address.host.c_str(), port.c_str(), &hints, &found); error != 0)
        throw LineEnded(address.text() + ": " + gai_strerror(error));
    const std::unique_ptr<addrinfo, void (*)(addrinfo*)> all(found, freeaddrinfo);
    int                                                  error = 0;
    for (const addrinfo* to = all.get(); to; to = to->ai_next) {
        const int line = socket(to->ai_family, to->ai_socktype | SOCK_CLOEXEC | SOCK_NONBLOCK, to->ai_protocol);
        if (line < 0) {
            error = errno;
            continue;
        }
        error = connectWithin(line, *to, timeout);
        if (error == 0) {
            const int yes = 1;
            setsockopt(line, IPPROTO_TCP, TCP_NODELAY, &yes, sizeof yes);
            return std::make_unique<TcpLine>(line, address.text());
        }
        close(line);
    }
    throw LineEnded(address.text() + ": " + std::strerror(error));
}

} // namespace palp
