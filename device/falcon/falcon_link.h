#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <stdexcept>

namespace palp {

/// Vendor requests of the FT232R serial bridge in front of the Falcon (bmRequestType 0x40, wIndex 0, no data).
/// \source libnifalcon (BSD-3), src/comm/FalconCommLibUSB.cpp; Linux drivers/usb/serial/ftdi_sio.h
enum class FtdiRequest : std::uint8_t {
    reset          = 0x00, ///< 0 all, 1 purge what the device sent, 2 purge what we sent
    modemLines     = 0x01, ///< 0x0100 DTR low, 0x0101 DTR high, 0x0200 RTS low, 0x0202 RTS high
    flowControl    = 0x02, ///< 0 none
    divisor        = 0x03, ///< of 3 MHz: see FalconDivisor
    lineFormat     = 0x04, ///< 0x0008 is 8N1
    eventCharacter = 0x06, ///< 0x0100 | character: what came so far is sent on at once when it comes
    latencyTimer   = 0x09  ///< [ms] 1 to 255: how long the chip waits before it sends a short packet
};

/// Divisors of 3 MHz that a Falcon listens at: FtdiRequest::divisor.
enum class FalconDivisor : std::uint16_t {
    hello  = 0x4138, ///< 9600 baud: asks for the boot loader
    loader = 0x0015, ///< 142 857 baud: the firmware goes up
    run    = 0x0002  ///< 1 500 000 baud: the firmware runs
};

/// The link is broken for good: another one must be opened. The device may be there, and push.
class LinkLost : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

/// The device went away.
class LinkGone : public LinkLost {
public:
    using LinkLost::LinkLost;
};

/// The FT232R bridge of one Falcon, open: control requests and two pipes. Implemented by LibusbLink and Ft232Emulator.
/// \thread one at a time
class FalconLink {
public:
    FalconLink()                             = default;
    FalconLink(const FalconLink&)            = delete;
    FalconLink& operator=(const FalconLink&) = delete;
    virtual ~FalconLink()                    = default;

    /// [s] of the link's clock, on which its timeouts run: steady time, or the emulator's virtual time.
    [[nodiscard]] virtual double now() const noexcept = 0;

    /// \throws LinkLost
    virtual void control(FtdiRequest request, std::uint16_t value) = 0;

    /// All of it, or LinkLost; waits 0.1 s at most. On a link that is lost but not gone it tries all the same before it
    /// throws, so that zero force gets through to a device that still listens.
    virtual void write(std::span<const std::uint8_t> bytes) = 0;

    /// What came in, without the chip's status bytes; waits up to `timeout` [s] for the first byte.
    /// \return how many bytes of `bytes` were filled; 0: nothing came in time
    /// \throws LinkLost
    virtual std::size_t read(std::span<std::uint8_t> bytes, double timeout) = 0;
};

} // namespace palp
