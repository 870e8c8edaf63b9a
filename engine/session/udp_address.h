#pragma once
#include <cstdint>
#include <string>

namespace palp {

/// A place to which datagrams are sent, or at which they are awaited.
struct UdpAddress {
    std::string   host; ///< a name or a number; IPv6 without brackets
    std::uint16_t port = 0;

    [[nodiscard]] std::string text() const; ///< as parseUdpAddress() reads it
};

/// Reads "udp:HOST:PORT"; an IPv6 number stands in brackets.
/// \param option    opens the complaint, such as "--stream"
/// \param hostless  the host for "udp:PORT"; empty: it must be stated
/// \throws Error naming the option
[[nodiscard]] UdpAddress parseUdpAddress(const std::string& text, const std::string& option,
                                         const std::string& hostless = "");

/// Which end of a socket an address is.
enum class UdpEnd {
    here, ///< datagrams arrive at it: the socket is bound
    there ///< they go to it: the socket is connected
};

/// A socket for datagrams that never waits.
/// \thread one
class UdpSocket {
public:
    /// \throws Error naming the option, the address and the reason: an unknown host, a port in use
    UdpSocket(const UdpAddress& address, UdpEnd end, const std::string& option);
    ~UdpSocket();
    UdpSocket(const UdpSocket&)            = delete;
    UdpSocket& operator=(const UdpSocket&) = delete;

    [[nodiscard]] int           handle() const noexcept { return handle_; }
    [[nodiscard]] std::uint16_t port() const noexcept { return port_; } ///< its own, also where 0 was asked for

private:
    int           handle_ = -1;
    std::uint16_t port_   = 0;
};

} // namespace palp
