#pragma once
#include <cstddef>
#include <string>

#include "engine/session/tick_stream.h"
#include "engine/session/udp_address.h"

namespace palp {

/// Sends a datagram for each tick and each marker, little endian:
///
/// | byte | type | is |
/// |---|---|---|
/// | 0 | char[4] | "PALP" |
/// | 4 | uint16 | version of this layout, 1 |
/// | 6 | uint16 | 0: a tick, 1: a marker |
/// | 8 | uint64 | number of the tick or marker, counted from 1; a gap was dropped |
/// | 16 | int64 | CLOCK_REALTIME of time 0 [ns] |
/// | 24 | int64 | CLOCK_MONOTONIC of time 0 [ns] |
/// | 32 | | of a tick: a row of ticks.npy; of a marker: its time [s], a double, and then its text, UTF-8 |
///
/// A later palpate may append to a tick; what is there then keeps its place, or the version rises.
class UdpOutlet : public TickOutlet {
public:
    static constexpr std::uint16_t kVersion = 1;
    static constexpr std::size_t   kHeader  = 32; ///< [bytes]
    enum class Kind : std::uint16_t { tick = 0, marker = 1 };

    /// \throws Error naming --stream, the address and the reason
    explicit UdpOutlet(const UdpAddress& address);

    [[nodiscard]] std::string name() const override { return address_.text(); }
    bool                      send(const StreamedTick& tick) noexcept override;
    bool                      send(const StreamedMarker& marker) noexcept override;

private:
    bool send(std::size_t bytes) noexcept;

    UdpAddress  address_;
    UdpSocket   socket_;
    std::string datagram_; ///< of the largest size
};

} // namespace palp
