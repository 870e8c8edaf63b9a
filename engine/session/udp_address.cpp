#include "engine/session/udp_address.h"

#include <cerrno>
#include <charconv>
#include <cstring>
#include <memory>
#include <string_view>

#include <netdb.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include "engine/core/contract.h"

namespace palp {
namespace {

constexpr std::string_view kScheme = "udp:";

std::uint16_t portOf(const sockaddr_storage& address)
{
    if (address.ss_family == AF_INET6) return ntohs(reinterpret_cast<const sockaddr_in6&>(address).sin6_port);
    return ntohs(reinterpret_cast<const sockaddr_in&>(address).sin_port);
}

} // namespace

std::string UdpAddress::text() const
{
    const bool bracketed = host.find(':') != std::string::npos;
    return std::string(kScheme) + (bracketed ? "[" : "") + host + (bracketed ? "]:" : ":") + std::to_string(port);
}

UdpAddress parseUdpAddress(const std::string& text, const std::string& option, const std::string& hostless)
{
    const auto refuse = [&] {
        throw Error(option + ": expected " + (hostless.empty() ? "" : "udp:PORT or ") +
                    "udp:HOST:PORT, such as udp:" + "127.0.0.1:9870, found \"" + text + "\"");
    };
    UdpAddress       address{hostless};
    std::string_view rest = text;
    if (!rest.starts_with(kScheme)) refuse();
    rest.remove_prefix(kScheme.size());
    if (const std::size_t colon = rest.rfind(':'); colon != std::string_view::npos) {
        std::string_view host = rest.substr(0, colon);
        if (host.starts_with('[') && host.ends_with(']'))
            host = host.substr(1, host.size() - 2);
        else if (host.find(':') != std::string_view::npos)
            refuse(); // 1::2:80 may mean two things
        if (host.find_first_of("[]") != std::string_view::npos) refuse();
        address.host = host;
        rest.remove_prefix(colon + 1);
    }
    const char* const end = std::from_chars(rest.data(), rest.data() + rest.size(), address.port).ptr;
    if (end != rest.data() + rest.size() || address.port == 0 || address.host.empty()) refuse();
    return address;
}

UdpSocket::UdpSocket(const UdpAddress& address, UdpEnd end, const std::string& option)
{
    const std::string where = option + " " + address.text() + ": ";
    addrinfo          wanted{};
    wanted.ai_socktype = SOCK_DGRAM;
    wanted.ai_flags    = AI_ADDRCONFIG;
    addrinfo* found    = nullptr;
    if (const int failure = ::getaddrinfo(address.host.c_str(), std::to_string(address.port).c_str(), &wanted, &found))
        throw Error(where + "the host cannot be found: " + ::gai_strerror(failure));
    const std::unique_ptr<addrinfo, decltype(&::freeaddrinfo)> all(found, ::freeaddrinfo);
    std::string                                                reason = "no address";
    for (const addrinfo* at = found; at; at = at->ai_next) {
        handle_ = ::socket(at->ai_family, SOCK_DGRAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
        if (handle_ >= 0 && (end == UdpEnd::here ? ::bind(handle_, at->ai_addr, at->ai_addrlen)
                                                 : ::connect(handle_, at->ai_addr, at->ai_addrlen)) == 0) {
            sockaddr_storage own{};
            socklen_t        size = sizeof own;
            if (::getsockname(handle_, reinterpret_cast<sockaddr*>(&own), &size) == 0) port_ = portOf(own);
            return;
        }
        reason = std::strerror(errno);
        if (handle_ >= 0) ::close(handle_);
    }
    throw Error(where + (end == UdpEnd::here ? "cannot be listened at: " : "cannot be sent to: ") + reason);
}

UdpSocket::~UdpSocket()
{
    ::close(handle_);
}

} // namespace palp
