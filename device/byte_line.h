#pragma once
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <stdexcept>
#include <string>

#include "device/zero_rule.h"

namespace palp {

/// A line that has ended: closed by the other side, or broken.
class LineEnded : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

/// The line is there, and its guardian process is not: no force goes out any more, but zero does.
class GuardianEnded : public LineEnded {
public:
    using LineEnded::LineEnded;
};

/// A line of bytes to a program or a device: a socket, or an emulator in this process.
/// \thread one at a time
class ByteLine {
public:
    ByteLine()                           = default;
    ByteLine(const ByteLine&)            = delete;
    ByteLine& operator=(const ByteLine&) = delete;
    virtual ~ByteLine()                  = default;

    /// Reads what has come; waits up to `timeout` [s] for the first byte.
    /// \return bytes filled; 0 if none came in time
    /// \throws LineEnded
    virtual std::size_t read(std::span<std::uint8_t> bytes, double timeout) = 0;

    /// Writes all bytes, or ends the line.
    /// \throws LineEnded
    virtual void write(std::span<const std::uint8_t> bytes) = 0;

    /// Returns the line's clock [s].
    [[nodiscard]] virtual double now() const noexcept = 0;

    /// Starts a guardian process that takes the force from the device when this program cannot. An emulator needs none.
    /// \throws Error saying why it cannot be started
    virtual void guard(const ZeroRule& /*rule*/) {}

    /// Writes a packet that may push, by way of the guardian if there is one.
    /// \throws LineEnded; GuardianEnded once, after which packets of zero pass
    virtual void writeForce(std::span<const std::uint8_t> packet) { write(packet); }

    /// Returns whether, since the last call, the guardian took the force because nothing was written for 25 ms.
    [[nodiscard]] virtual bool wasSilenced() noexcept { return false; }
};

} // namespace palp
