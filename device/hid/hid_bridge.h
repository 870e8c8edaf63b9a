#pragma once
#include <array>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <memory>
#include <thread>

#include "device/haptic_device.h"
#include "device/hid/bridge_report.h"
#include "device/hid/hid_port.h"
#include "engine/core/latest.h"

namespace palp {

/// Returns whether a listing can be a bridge; only its reports prove it.
[[nodiscard]] bool isBridge(const HidListing& listing) noexcept;

struct HidBridgeSettings {
    double  watchdog        = 25e-3; ///< [s] from the last command to the device's zero force; 2 ms to 0.255 s
    double  openWait        = 1;     ///< [s] for the first report
    double  readWait        = 1e-3;  ///< [s] for which the thread waits for a report before it looks for a command
    HidPace pace            = HidPace::thread;
    bool    asksForRealTime = true; ///< for its thread, if it may; without, commands may be late
};

/// A device that speaks the bridge's report: position in, force out, at up to 1 kHz.
///
/// render() leaves a command in one three-slot hand-off, read() takes the newest answer from another; the driver's
/// thread does the reading and writing. Force flows only while the device is homed and there is no fault: every other
/// command has zero force and motors off. Where the driver has a thread, a force that render() does not renew is held
/// for 5 ms and falls to zero in 20 ms more; then, and on close, several zero commands are sent. The last safeguard is
/// the device's own watchdog.
///
/// A fault is shown while its cause lasts; only "unplugged" stays until close().
/// \thread see HapticDevice
class HidBridgeDevice : public HapticDevice {
public:
    /// \param system  must outlive this object
    /// \throws Error naming a setting out of its range
    HidBridgeDevice(HidSystem& system, const HidListing& listing, const HidBridgeSettings& settings = {});
    ~HidBridgeDevice() override;

    [[nodiscard]] const HapticDeviceInfo& info() const noexcept override { return info_; }

    void        open() override;
    void        close() noexcept override;
    HapticState read(double now) noexcept override;
    void        render(const GovernedForce& force) noexcept override;
    /// \return of a device that renders other commands than the newest; else empty
    [[nodiscard]] const char* faultWords() const noexcept override
    {
        return isBehind_ ? "it takes no commands of this program, or takes them late; does another program drive it?"
                         : "";
    }
    void home() noexcept override { homing_ = true; }
    void light(std::uint8_t lights) noexcept override { lights_ = lights; }

private:
    using Clock = std::chrono::steady_clock;

    struct Inbox {
        BridgeAnswer      answer;       ///< the last good one
        Clock::time_point time;         ///< when that came
        std::uint64_t     good     = 0; ///< answers with a new sequence number
        std::uint64_t     garbled  = 0; ///< invalid reports
        std::uint64_t     silenced = 0; ///< times that the guardian took the force
        bool              lost     = false;
        double behind = 0; ///< [s] by which the command that the device renders is older than the newest that was sent
    };

    struct TimedCommand {
        BridgeCommand     command;
        Clock::time_point time;
    };

    // Used by the thread, or by read() where that sets the pace.
    void                 receive(double wait);
    void                 takeAnswer(const BridgeAnswer& answer) noexcept;
    [[nodiscard]] double behind(std::uint16_t command) noexcept;
    void                 send(BridgeCommand command);
    void                 sendNewest();
    void                 letFall();
    void                 sendShare(double most);
    bool                 readAndWrite(double wait) noexcept;
    void                 run(const std::stop_token& stop) noexcept;
    void                 sayZero() noexcept;

    // Used by read() and render().
    void                      followClock(double now) noexcept;
    void                      readInbox(double now) noexcept;
    void                      command() noexcept;
    [[nodiscard]] DeviceFault faultAt(double now) const noexcept;
    [[nodiscard]] glm::dvec3  renderable(const glm::dvec3& force) const noexcept;

    void describe(const BridgeAnswer& answer);

    HidSystem&                system_;
    HidListing                listing_;
    HidBridgeSettings         settings_;
    HapticDeviceInfo          info_;
    std::atomic<bool>         homing_{false};
    std::atomic<std::uint8_t> lights_{0};
    Latest<TimedCommand>      outbox_;
    Latest<Inbox>             inbox_;

    // Used by the thread, or by read() where that sets the pace.
    std::unique_ptr<HidPort>          port_;
    Inbox                             seen_;
    bool                              wrongVersion_ = false;
    std::uint16_t                     lastRefused_  = 0; ///< sequence of the last answer that was too old
    int                               goesOn_       = 0; ///< old answers with consecutive numbers
    std::uint16_t                     sent_         = 0; ///< sequence of the last command
    std::array<Clock::time_point, 64> sentAt_{};         ///< by sequence, modulo their number
    std::size_t                       written_  = 0;     ///< commands so far
    bool                              isEchoed_ = false; ///< the device has told the number of one of those commands
    bool                              hot_      = false; ///< the last command may have had the motors on
    double                            share_    = 1;     ///< [1] share of the requested force that is sent
    Clock::time_point                 lastAsked_, lastSent_;

    // Used by read() and render().
    HapticState   state_;
    glm::dvec3    wanted_{}; ///< [N] of the last render()
    bool          open_     = false;
    bool          started_  = false; ///< read() has been called since open()
    std::uint64_t seenGood_ = 0, seenGarbled_ = 0, seenSilenced_ = 0;
    int           readsWithout_  = 0;     ///< an answer, in a row
    double        silencedUntil_ = 0;     ///< [s]
    bool          stopped_       = false; ///< the device reports it
    bool          impossible_    = false; ///< the last position was impossible
    bool          isBehind_      = false; ///< it renders commands that are old, or another program's
    double        offAt_         = 0;     ///< [s] when a command last had the motors off
    double        lastAnswer_    = 0;     ///< [s]
    double        lastRead_      = 0;     ///< [s]

    std::jthread thread_; ///< last member: it ends before what it uses
};

} // namespace palp
