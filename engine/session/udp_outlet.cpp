#include "engine/session/udp_outlet.h"

#include <algorithm>
#include <cerrno>
#include <cstring>

#include <sys/socket.h>

namespace palp {
namespace {

template <class Number>
char* put(char* to, Number number) noexcept
{
    std::memcpy(to, &number, sizeof number);
    return to + sizeof number;
}

/// Returns the place after the header.
char* putHeader(char* to, UdpOutlet::Kind kind, std::uint64_t number, const SessionClocks& clocks) noexcept
{
    std::memcpy(to, "PALP", 4);
    to = put(to + 4, UdpOutlet::kVersion);
    to = put(to, kind);
    to = put(to, number);
    to = put(to, clocks.realtime);
    return put(to, clocks.monotonic);
}

} // namespace

UdpOutlet::UdpOutlet(const UdpAddress& address) : address_(address), socket_(address, UdpEnd::there, "--stream")
{
    datagram_.resize(kHeader + std::max(tickRowBytes(), sizeof(double) + kMostOfMarker));
}

bool UdpOutlet::send(const StreamedTick& tick) noexcept
{
    packTick(tick.record, putHeader(datagram_.data(), Kind::tick, tick.number, tick.clocks));
    return send(kHeader + tickRowBytes());
}

bool UdpOutlet::send(const StreamedMarker& marker) noexcept
{
    char*       to   = putHeader(datagram_.data(), Kind::marker, marker.number, marker.clocks);
    const auto  size = std::min(marker.marker.text.size(), kMostOfMarker);
    char* const text = put(to, marker.marker.time);
    std::memcpy(text, marker.marker.text.data(), size);
    return send(kHeader + sizeof(double) + size);
}

/// Returns false where the socket has no room. Where the receiver's machine says that nobody listened to the datagram
/// before, this one is sent all the same and that one is counted as dropped in its place.
bool UdpOutlet::send(std::size_t bytes) noexcept
{
    const auto once = [&] {
        ssize_t sent = -1;
        do sent = ::send(socket_.handle(), datagram_.data(), bytes, MSG_DONTWAIT | MSG_NOSIGNAL);
        while (sent < 0 && errno == EINTR);
        return sent == ssize_t(bytes);
    };
    if (once()) return true;
    if (errno == ECONNREFUSED) once();
    return false;
}

} // namespace palp
