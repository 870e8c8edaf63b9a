#pragma once
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string_view>

#include "engine/session/udp_address.h"

namespace palp {

/// Where markers come from while a session runs.
struct MarkerSources {
    std::optional<UdpAddress> address{};    ///< at which datagrams of text are awaited, one marker each
    bool                      keys = false; ///< keys pressed in the program's terminal; without effect if it has none

    /// Is told each key first, on the thread of MarkerInput, and returns true if the key has another meaning than a
    /// marker; may be empty.
    std::function<bool(std::string_view key)> onKey{};
};

/// Hears markers on a thread of its own, so that they are heard within a millisecond or two of their arrival.
///
/// A key is a marker with its character as the text, or "space" or "enter"; keys that are more than a character
/// (arrows) are none. While it listens, the terminal shows no keys and waits for no Enter; Ctrl-C and Ctrl-Z work as
/// ever. A program in the background leaves the terminal alone.
/// \thread the one that made it
class MarkerInput {
public:
    using Hear = std::function<void(std::string_view text)>;
    using Lose = std::function<void(std::uint64_t markers)>;

    /// Opens the address.
    /// \throws Error naming --markers if it cannot be used
    explicit MarkerInput(const MarkerSources& sources);
    ~MarkerInput(); ///< hears first what has arrived until then
    MarkerInput(const MarkerInput&)            = delete;
    MarkerInput& operator=(const MarkerInput&) = delete;

    /// Begins to listen; what came before is a marker of this moment.
    /// \param hear  is called on the thread of this, with any bytes that somebody sent: SessionTap::mark()
    /// \param lose  is called on that thread with the number of datagrams that the system has dropped since the last
    ///              call, because they came faster than they could be kept: SessionTap::lose(). May be empty; is not
    ///              called where the system does not count them (Linux before 4.12)
    /// \pre it does not listen yet
    /// \throws Error if the system has no handle left
    void listen(Hear hear, Lose lose = {});

    [[nodiscard]] std::uint16_t port() const noexcept; ///< at which it listens; 0: at none
    [[nodiscard]] bool          hearsKeys() const noexcept;

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

} // namespace palp
