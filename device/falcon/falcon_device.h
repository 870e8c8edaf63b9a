#pragma once
#include <atomic>
#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "device/falcon/falcon_constants.h"
#include "device/falcon/falcon_driver.h"
#include "device/falcon/falcon_loop.h"
#include "device/haptic_device.h"
#include "engine/core/latest.h"

namespace palp {

/// The thread that carries the packets.
enum class FalconPace : std::uint8_t {
    thread, ///< a thread of its own, as fast as the line: for real time; nobody waits for it
    stepped ///< the caller of read(), which takes a round trip: for virtual time and programs of one thread
};

struct FalconDeviceSettings {
    std::vector<std::uint8_t> firmware; ///< see readFirmware(), uploaded if none runs; empty: it must run
    FalconPace                pace = FalconPace::thread;
    std::string               path;                   ///< for HapticDeviceInfo
    std::string               serial;                 ///< for HapticDeviceInfo
    bool                      asksForRealTime = true; ///< for its thread, if it may; without, packets may be late
    FalconStartSettings       start{};
    double armMass = 0; ///< [kg] that weighs on the grip, see FalconCalibration; 0: unknown, and nothing carries it
    FalconLoopSettings loop{};
    /// Returns the values for the Falcon that was opened, in place of loop.countsPerTorque and armMass; may throw an
    /// Error. Empty: those hold.
    std::function<FalconTuning(const std::string& serial)> tune{};
};

/// A Novint Falcon behind any FalconLink. FalconLoop decides when forces flow. In addition, a force that render()
/// does not renew is held for 5 ms and falls to zero in 20 ms more, and close() ends with packets of zero force.
///
/// Forces come from the governor only. Positions are in the device's frame: the kinematics' less (0, 0, 125 mm).
/// Buttons: bit 0 plus, 1 forward, 2 centre, 3 minus. The light is red until the device is homed: the user pulls the
/// grip out, then pushes it in. In the pace `stepped` a force leaves with the packet of the next
/// read(); if that is not called, the last force acts until the Falcon's own firmware lets go.
/// \thread as HapticDevice; the pace `thread` hands over by Latest
class FalconDevice final : public HapticDevice {
public:
    /// \param open  opens the bridge; open() calls it, several times if an upload fails
    explicit FalconDevice(FalconLinkOpener open, const FalconDeviceSettings& settings = {});
    ~FalconDevice() override { close(); }

    [[nodiscard]] const HapticDeviceInfo& info() const noexcept override { return info_; }
    void                                  open() override;
    void                                  close() noexcept override;
    HapticState                           read(double now) noexcept override;
    void                                  render(const GovernedForce& force) noexcept override;
    /// Sends nothing from the next exchange on, for a time [s] of 0.5 s at most, so that the motors keep the last force
    /// until the firmware lets go: FalconHold measures when. The guardian waits, and no other check is weakened.
    void stopSending(double time) noexcept;

    /// Sets the counts per torque with which forces become motor numbers, from the next exchange on; see
    /// FalconCalibration.
    /// \param counts  [counts/(N m)] moved into the bounds of FalconMotors
    void useCounts(double counts) noexcept;

    /// Returns the counts per torque in use [counts/(N m)]; 0 before open().
    [[nodiscard]] double countsInUse() const noexcept { return counts_; }

    /// Shows green only where its own state lets forces flow, see falconLight().
    void light(std::uint8_t lights) noexcept override { lights_ = lights; }

private:
    using Clock = std::chrono::steady_clock;

    struct TimedRequest {
        FalconRequest     request{};
        Clock::time_point time{};
    };
    struct Answer {
        HapticState       state{};
        Clock::time_point time{};  ///< when the exchange ended
        double            age = 0; ///< [s] of the answer at that time
    };
    /// The thread and its hand-offs, which open() makes and close() destroys.
    struct Line {
        explicit Line(std::unique_ptr<FalconLoop> newLoop) : loop(std::move(newLoop)) {}
        std::unique_ptr<FalconLoop> loop;
        Latest<TimedRequest>        requests;
        Latest<Answer>              answers;
        std::atomic<bool>           isOver = false;
        std::thread                 thread;
        FalconRequest               asked{};        ///< by the last render()
        double                      offset  = 0;    ///< [s] from the link's clock to the servo's; stepped
        double                      last    = 0;    ///< [s] of the servo's clock at the last read(); stepped
        bool                        isFirst = true; ///< read() was not called yet; stepped
    };

    static void converse(Line& line, bool asksForRealTime) noexcept;
    HapticState newest(double now) noexcept;
    HapticState step(FalconRequest request, double now) noexcept;

    FalconLinkOpener      open_;
    FalconDeviceSettings  settings_;
    HapticDeviceInfo      info_;
    std::uint8_t          lights_   = 0;
    double                counts_   = 0; ///< [counts/(N m)] in use since open()
    double                stopsFor_ = 0; ///< [s] that is asked of the next read()
    std::optional<double> silentUntil_;  ///< [s] by the clock of read()
    std::unique_ptr<Line> line_;         ///< null: closed
};

} // namespace palp
