#pragma once
#include <atomic>
#include <cstdint>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "engine/session/marker.h"
#include "engine/session/session_clocks.h"
#include "engine/session/tick_record.h"
#include "engine/session/tick_ring.h"

namespace palp {

/// A record on its way to another program.
struct StreamedTick {
    TickRecord    record;
    SessionClocks clocks;     ///< of time 0 of its session
    std::uint64_t number = 0; ///< counts the stream's ticks from 1, also those that are dropped
};

/// A marker on its way to another program.
struct StreamedMarker {
    Marker        marker;
    SessionClocks clocks;     ///< of time 0 of its session
    std::uint64_t number = 0; ///< counts the stream's markers from 1, also those that are dropped
};

/// A way out of the program for the ticks of a session while it runs.
/// \thread the stream's, but for construction and destruction
class TickOutlet {
public:
    TickOutlet()                             = default;
    TickOutlet(const TickOutlet&)            = delete;
    TickOutlet& operator=(const TickOutlet&) = delete;
    virtual ~TickOutlet()                    = default;

    [[nodiscard]] virtual std::string name() const = 0; ///< as the user names it: "udp:127.0.0.1:9870"

    /// Return false if it could not be sent. They must not throw.
    virtual bool send(const StreamedTick& tick) noexcept     = 0;
    virtual bool send(const StreamedMarker& marker) noexcept = 0;
};

/// Opens the outlet that a user names: "udp:HOST:PORT", or "lsl" or "lsl:NAME" for a Lab Streaming Layer.
/// \throws Error naming --stream and the reason
[[nodiscard]] std::unique_ptr<TickOutlet> openOutlet(const std::string& name);

/// What became of a stream.
struct StreamReport {
    std::string   to;              ///< TickOutlet::name()
    std::uint64_t sent        = 0; ///< ticks
    std::uint64_t dropped     = 0; ///< ticks for which the ring, the socket or the receiver had no room
    std::uint64_t markers     = 0; ///< sent
    std::uint64_t markersLost = 0; ///< found no room, or did not reach the stream
};

/// Sends the ticks of sessions to another program while they run, about a millisecond later.
///
///     servo ---push()---> ring of 4096 records (4 s) ---own thread, every millisecond---> outlet
///
/// What finds no room is dropped and counted: neither the servo nor a recording waits for a network.
/// \thread  begin(), push(), pushWaiting(): one thread; wait-free but for the last, no allocation, lock or throw;
///          mark(), lose(): any other; all else: the thread that made it
class TickStream {
public:
    explicit TickStream(std::unique_ptr<TickOutlet> outlet);
    ~TickStream(); ///< as finish()
    TickStream(const TickStream&)            = delete;
    TickStream& operator=(const TickStream&) = delete;

    /// Takes the clocks of a session's time 0, for the ticks that follow; again after a pause that is no time of it.
    void begin(const SessionClocks& clocks) noexcept { clocks_ = clocks; }
    void push(const TickRecord& record) noexcept;
    /// Waits for room in the ring: for the virtual clock, which is faster than any network.
    void pushWaiting(const TickRecord& record) noexcept;
    /// \param clocks  of time 0 of the marker's session
    void mark(const Marker& marker, const SessionClocks& clocks);
    /// Counts markers as dropped that did not reach this.
    void lose(std::uint64_t markers);

    /// Sends what is left and ends the thread. Later calls return the same.
    StreamReport finish();

private:
    void work();
    void sendTicks();
    void sendMarkers();

    std::unique_ptr<TickOutlet> outlet_;
    TickRing<StreamedTick>      ring_;
    SessionClocks               clocks_;     ///< of the producer, as is the next
    std::uint64_t               pushed_ = 0; ///< read after finish() only
    std::mutex                  mutex_;      ///< of the next two; the producer never takes it
    std::vector<StreamedMarker> markers_;    ///< that wait
    std::uint64_t               markersSeen_ = 0;
    std::uint64_t               sent_ = 0, markersSent_ = 0; ///< of the stream's thread
    std::atomic<bool>           finishing_{false};
    std::thread                 thread_;
};

} // namespace palp
