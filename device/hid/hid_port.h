#pragma once
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include "device/zero_rule.h"
#include "engine/core/contract.h"

namespace palp {

/// An HID device as the system lists it.
struct HidListing {
    std::string   path{}; ///< only for HidSystem::open()
    std::uint16_t vendor = 0, product = 0;
    std::uint16_t usagePage = 0, usage = 0;
    std::string   manufacturer{}, model{}, serial{}; ///< may be empty
};

/// A device that cannot be opened: the reason and one line that helps; what() has both.
class HidRefused : public Error {
public:
    HidRefused(const std::string& reason, const std::string& advice)
        : Error(reason + (advice.empty() ? "" : "; " + advice)), why(reason), help(advice)
    {
    }

    std::string why, help; ///< help may be empty
};

/// An open device that went away.
class HidLost : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

/// An open HID device; its destructor closes it.
/// \thread one at a time
class HidPort {
public:
    HidPort()                          = default;
    HidPort(const HidPort&)            = delete;
    HidPort& operator=(const HidPort&) = delete;
    virtual ~HidPort()                 = default;

    /// Reads one input report with its number in front; waits up to `timeout` [s].
    /// \return bytes filled; 0 if none came in time
    /// \throws HidLost if the device went away
    virtual std::size_t read(std::span<std::uint8_t> report, double timeout) = 0;

    /// Writes one output report with its number in front.
    /// \throws HidLost if the device went away
    virtual void write(std::span<const std::uint8_t> report) = 0;

    /// Starts a guardian process that takes the force from the device when this program cannot. A port that has no
    /// descriptor to pass on, such as a fake, does nothing.
    /// \throws Error saying why it cannot be started
    virtual void guard(const ZeroRule& /*rule*/) {}

    /// Returns whether, since the last call, that process took the force because nothing was written for 25 ms.
    [[nodiscard]] virtual bool wasSilenced() noexcept { return false; }
};

/// The reader of a driver's reports: a thread of its own that waits for them, or the caller of read(), which does
/// not wait. The second is for tests in virtual time and for fakes; with hardware it would cost system calls in
/// read().
enum class HidPace : std::uint8_t { thread, caller };

/// The interface that lists and opens HID devices: hidapi, or a fake.
class HidSystem {
public:
    HidSystem()                            = default;
    HidSystem(const HidSystem&)            = delete;
    HidSystem& operator=(const HidSystem&) = delete;
    virtual ~HidSystem()                   = default;

    [[nodiscard]] virtual std::vector<HidListing> list() = 0;

    /// \param path  path of a listing; any other is refused
    /// \throws HidRefused naming the device and what to do, such as a missing permission
    [[nodiscard]] virtual std::unique_ptr<HidPort> open(const std::string& path) = 0;
};

} // namespace palp
