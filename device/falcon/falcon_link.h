#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <stdexcept>
#include <string>

namespace palp {

/// Vendor requests of the FT232R serial bridge in front of the Falcon (bmRequestType 0x40, wIndex 0, no data).
/// \source libnifalcon (BSD-3), src/comm/FalconCommLibUSB.cpp; Linux drivers/usb/serial/ftdi_sio.h
enum class FtdiRequest : std::uint8_t {
    reset          = 0x00, ///< 0 all, 1 purge the device's bytes, 2 purge the host's
    modemLines     = 0x01, ///< 0x0100 DTR low, 0x0101 DTR high, 0x0200 RTS low, 0x0202 RTS high
    flowControl    = 0x02, ///< 0 none
    divisor        = 0x03, ///< of 3 MHz: see FalconDivisor
    lineFormat     = 0x04, ///< 0x0008 is 8N1
    eventCharacter = 0x06, ///< 0x0100 | character: its arrival makes the chip send at once
    latencyTimer   = 0x09  ///< [ms] 1 to 255: wait of the chip before it sends a short packet
};

/// Divisors of 3 MHz at which a Falcon listens, see FtdiRequest::divisor.
enum class FalconDivisor : std::uint16_t {
    hello  = 0x4138, ///< 9600 baud: asks for the boot loader
    loader = 0x0015, ///< 142 857 baud: the firmware is uploaded
    run    = 0x0002  ///< 1 500 000 baud: the firmware runs
};

/// A link that is permanently broken: another one must be opened. The device may be there, and push.
class LinkLost : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

/// A device that went away.
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

    /// Returns the link's clock [s], by which its timeouts run: steady time, or the emulator's virtual time.
    [[nodiscard]] virtual double now() const noexcept = 0;

    /// \throws LinkLost if the link fails
    virtual void control(FtdiRequest request, std::uint16_t value) = 0;

    /// Writes all bytes or throws LinkLost; waits 0.1 s at most. On a link that is lost but not gone it still tries
    /// before it throws, so that zero force reaches a device that still listens.
    virtual void write(std::span<const std::uint8_t> bytes) = 0;

    /// Returns whether, since the last call, a guardian process took the force because nothing was written for 25 ms.
    [[nodiscard]] virtual bool wasSilenced() noexcept { return false; }

    /// Returns the serial number of the bridge: letters, digits and signs that need no quoting, 64 at most. Empty: it
    /// has none.
    [[nodiscard]] virtual std::string serial() const { return {}; }

    /// Says to that process that the program lives, though it writes nothing on purpose.
    virtual void keepAlive() noexcept {}

    /// Reads bytes that came in, without the chip's status bytes; waits up to `timeout` [s] for the first.
    /// \return how many of `bytes` were filled; 0 if nothing came in time
    /// \throws LinkLost if the link fails
    virtual std::size_t read(std::span<std::uint8_t> bytes, double timeout) = 0;
};

} // namespace palp
