#pragma once
#include <atomic>
#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <thread>

#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>

#include "device/haptic_device.h"
#include "engine/core/latest.h"

namespace palp {

/// What a line renders from one exchange to the next.
struct LineOrder {
    glm::dvec3   force{};        ///< [N] on the hand, in the frame of HapticState; zero unless enabled
    bool         enable = false; ///< the motors may be on
    std::uint8_t lights = 0;     ///< a sum of DeviceLight
};

enum class LineNews : std::uint8_t {
    none,   ///< nothing came, or the same sample again
    sample, ///< a new sample of the hand
    garbled ///< something that cannot be understood
};

/// What an exchange brought, in the frame of HapticState.
struct LineSample {
    LineNews      news = LineNews::none;
    glm::dvec3    position{}; ///< [m]
    glm::dvec3    velocity{}; ///< [m/s]
    glm::dquat    orientation{1, 0, 0, 0};
    glm::dvec3    angularVelocity{}; ///< [rad/s]
    double        gripperAngle = 0;  ///< [rad]
    double        age          = 0;  ///< [s] of the position when it came
    std::uint32_t buttons      = 0;
    bool          homed        = false;

    /// What the device itself reports, or the line has found out: none, ownWatchdog, unplugged, linkLost.
    DeviceFault fault = DeviceFault::none;
    const char* words = ""; ///< about that fault, for a person; of static storage

    std::uint64_t silenced = 0; ///< times that a guardian process took the force
};

/// A conversation with one haptic device, in its own language. A LineDevice makes a HapticDevice of it.
/// \thread one at a time; exchange() is called by the LineDevice's thread, or by the line's own, see drive()
class DeviceLine {
public:
    DeviceLine()                             = default;
    DeviceLine(const DeviceLine&)            = delete;
    DeviceLine& operator=(const DeviceLine&) = delete;
    virtual ~DeviceLine()                    = default;

    /// Opens the device with zero force, and adds to `info` what only the open device knows.
    /// \throws Error saying in one sentence what is missing and what helps; the line is closed then
    virtual void open(HapticDeviceInfo& info) = 0;

    /// Renders an order and brings the newest sample; `sample` holds the one before. It waits for some milliseconds at
    /// most, and may allocate.
    virtual void exchange(const LineOrder& order, LineSample& sample) noexcept = 0;

    /// Sends zero force and closes. Nothing happens if it is closed.
    virtual void close() noexcept = 0;

    /// Has a thread of the line's library call `turn` about every millisecond until close().
    /// \return false if the line has no such thread: the LineDevice then makes one
    /// \throws Error if the library has one that does not start; the line is closed then
    virtual bool drive(const std::function<void()>& /*turn*/) { return false; }
};

/// Who makes the exchanges: a thread, or the caller of read(), for tests in virtual time.
enum class LinePace : std::uint8_t { thread, caller };

struct LineSettings {
    LinePace pace            = LinePace::thread;
    double   leastPeriod     = 250e-6; ///< [s] from exchange to exchange of the thread; else it could starve the servo
    bool     asksForRealTime = true;   ///< for its thread, if it may
};

/// A device behind a line: position in, force out.
///
/// render() leaves an order in one three-slot hand-off, read() takes the newest sample from another; a thread makes the
/// exchanges. Force flows only while the device is homed, its sample is younger than 10 ms and there is no fault; it
/// rises in 20 ms after each of these. A force that render() does not renew is held for 5 ms and falls to zero in 20 ms
/// more.
/// \thread see HapticDevice
class LineDevice : public HapticDevice {
public:
    /// \param info  what is known before open()
    LineDevice(std::unique_ptr<DeviceLine> line, HapticDeviceInfo info, const LineSettings& settings = {});
    ~LineDevice() override;

    [[nodiscard]] const HapticDeviceInfo& info() const noexcept override { return info_; }

    void                      open() override;
    void                      close() noexcept override;
    HapticState               read(double now) noexcept override;
    void                      render(const GovernedForce& force) noexcept override;
    void                      light(std::uint8_t lights) noexcept override { lights_ = lights; }
    [[nodiscard]] const char* faultWords() const noexcept override { return words_; }

private:
    using Clock = std::chrono::steady_clock;

    struct Inbox {
        LineSample        sample;
        Clock::time_point time;        ///< when the last good one came
        std::uint64_t     good    = 0; ///< samples
        std::uint64_t     garbled = 0;
    };
    struct TimedOrder {
        LineOrder         order;
        Clock::time_point time;
    };

    // Used by whoever makes the exchanges.
    void                    turn(bool holds) noexcept;
    [[nodiscard]] LineOrder allowed(bool holds) noexcept;
    void                    run(const std::stop_token& stop) noexcept;

    // Used by read() and render().
    void                      followClock(double now) noexcept;
    void                      readInbox(double now) noexcept;
    void                      order() noexcept;
    [[nodiscard]] DeviceFault faultAt(double now) const noexcept;
    [[nodiscard]] bool        mayPush() const noexcept;

    std::unique_ptr<DeviceLine> line_;
    LineSettings                settings_;
    const HapticDeviceInfo      known_; ///< before open()
    HapticDeviceInfo            info_;
    std::atomic<std::uint8_t>   lights_{0};
    Latest<TimedOrder>          outbox_;
    Latest<Inbox>               inbox_;

    // Used by whoever makes the exchanges.
    Inbox             seen_;
    double            share_ = 0;  ///< [1] share of the requested force that is sent
    Clock::time_point lastTurn_{}; ///< of the last exchange
    int               empty_ = 0;  ///< exchanges in a row that brought no sample

    // Used by read() and render().
    HapticState   state_;
    glm::dvec3    wanted_{}; ///< [N] of the last render()
    const char*   words_      = "";
    bool          open_       = false;
    bool          started_    = false; ///< read() has been called since open()
    bool          impossible_ = false; ///< the last position was impossible
    std::uint64_t seenGood_ = 0, seenGarbled_ = 0, seenSilenced_ = 0;
    int           readsWithout_  = 0; ///< a sample, in a row
    double        silencedUntil_ = 0; ///< [s]
    double        lastSample_    = 0; ///< [s]
    double        lastRead_      = 0; ///< [s]

    std::jthread thread_; ///< last member: it ends before what it uses
};

} // namespace palp
