#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

#include "device/zero_rule.h"

namespace palp {

struct GuardianPage;

/// A process beside this one that takes the force from a device when this program cannot: it writes packets of zero
/// force to the device's descriptor when the program has ended in whatever way (kill, crash, out of memory), or when
/// the device may push and nothing was sent for 25 ms (stopped, a thread that hangs or gets no processor).
///
///     program                               one page of memory                 guardian
///     pass(): packet, its zero, "alive" ->  packet  zeros  alive  pushing  ->  looks every 25 ms, writes zeros
///     passed(): pushing or not              silenced                       <-  and overwrites the packet
///     a pipe that ends with the program ---------------------------------->    writes zeros, ends
///
/// A packet goes out from the page, so that a program that was stopped between making a force and sending it sends zero
/// when it goes on. The guardian is a small executable inside the library, which is started from memory: no file has to
/// be found. It ends with the program.
/// \thread one at a time
class Guardian {
public:
    /// The descriptor of the open device, as the guardian writes to it. It stays the caller's.
    struct Line {
        int fd       = -1;
        int endpoint = 0; ///< of a node of usbfs, which takes bulk transfers; 0: the descriptor takes write()
    };

    /// Starts the process and waits until it watches.
    /// \param device  for messages: "Novint Falcon at USB 1-2"
    /// \throws Error saying why it cannot be started: without a guardian no device is driven
    Guardian(const Line& line, const ZeroRule& rule, const std::string& device);
    ~Guardian() { end(); } ///< ends the process, which writes zeros if the last packet pushed
    Guardian(const Guardian&)            = delete;
    Guardian& operator=(const Guardian&) = delete;

    /// Takes a packet that is about to be sent.
    /// \return what is to be sent in its place, from this memory, before the next pass(): the packet, or zero force if
    ///         the program was silent for too long. Bytes that are too many for a packet are returned as they are.
    [[nodiscard]] std::span<const std::uint8_t> pass(std::span<const std::uint8_t> packet) noexcept;
    void                                        passed() noexcept; ///< says that it was sent

    /// Says that the program lives though it sends nothing.
    void keepAlive() noexcept;

    /// Returns whether the guardian has taken a force since the last call, and zero was sent since.
    [[nodiscard]] bool hasSilenced() noexcept;

    /// Returns whether the guardian is there and looked at the page within the last quarter of a second. If not, push
    /// no more. It is a system call that does not wait.
    [[nodiscard]] bool isWatching() const noexcept;

private:
    void end() noexcept;

    GuardianPage* page_ = nullptr;
    ZeroRule      rule_;
    int           life_     = -1;
    int           process_  = -1;
    bool          isPush_   = false; ///< the packet between pass() and passed()
    bool          hasTaken_ = false; ///< for hasSilenced()
    std::uint32_t known_    = 0;     ///< GuardianPage::silenced when that packet was checked
};

} // namespace palp
