#pragma once
#include <atomic>
#include <chrono>
#include <cstdint>
#include <memory>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "device/falcon/falcon_driver.h"
#include "device/falcon/falcon_loop.h"
#include "device/haptic_device.h"
#include "engine/core/latest.h"

namespace palp {

/// Who carries the packets.
enum class FalconPace : std::uint8_t {
    thread, ///< a thread of its own, as fast as the line goes: for real time. exchange() waits for nothing
    stepped ///< exchange() itself: for virtual time and for programs of one thread. It takes a round trip
};

struct FalconDeviceSettings {
    std::vector<std::uint8_t> firmware; ///< to upload where none runs: readFirmware(); empty: it must run
    FalconPace                pace = FalconPace::thread;
    std::string               path;                   ///< for HapticDeviceInfo
    std::string               serial;                 ///< the same
    bool                      asksForRealTime = true; ///< for its thread, if it may; without, packets may be late
    FalconStartSettings       start{};
    FalconLoopSettings        loop{};
};

/// A Novint Falcon behind any FalconLink. FalconLoop says when forces flow. Beyond that, a force that exchange() does
/// not renew is held for 5 ms and falls to zero in 20 ms more, and close() ends with packets of zero force.
///
/// Forces come by the governor only, positions are those of the device's frame: the kinematics' less (0, 0, 125 mm).
/// Buttons: bit 0 plus, 1 forward, 2 centre, 3 minus. Until it is homed its light is red: the user pulls the grip out,
/// then pushes it in. In the pace `stepped`, exchange() takes a round trip, and the last force stays until the Falcon's
/// own firmware lets go if it is not called.
/// \thread as HapticDevice; the pace `thread` hands over by Latest
class FalconDevice final : public HapticDevice {
public:
    /// \param open  opens the bridge; called by open(), several times if an upload fails
    explicit FalconDevice(FalconLinkOpener open, const FalconDeviceSettings& settings = {});
    ~FalconDevice() override { close(); }

    [[nodiscard]] const HapticDeviceInfo& info() const noexcept override { return info_; }
    void                                  open() override; ///< \throws Error also after cancelOpen()
    void                                  close() noexcept override;
    HapticState                           exchange(const GovernedForce& force, double now) noexcept override;
    void light(std::uint8_t lights) noexcept override { lights_ = lights; } ///< if settings.loop.showsState is off

    /// Makes an open() that runs give up, or the next one. While the device is open it does nothing.
    /// \thread any
    void cancelOpen() noexcept { cancel_ = true; }

private:
    using Clock = std::chrono::steady_clock;

    struct TimedRequest {
        FalconRequest     request{};
        Clock::time_point time{};
    };
    struct Answer {
        HapticState       state{};
        Clock::time_point time{};  ///< when the exchange ended
        double            age = 0; ///< [s] of the answer then
    };
    /// What open() makes and close() destroys: the thread and its hand-offs.
    struct Line {
        explicit Line(std::unique_ptr<FalconLoop> newLoop) : loop(std::move(newLoop)) {}
        std::unique_ptr<FalconLoop> loop;
        Latest<TimedRequest>        requests;
        Latest<Answer>              answers;
        std::atomic<bool>           isOver = false;
        std::thread                 thread;
        double                      offset  = 0;    ///< [s] from the link's clock to the servo's; stepped
        double                      last    = 0;    ///< [s] servo's clock at the last exchange; stepped
        bool                        isFirst = true; ///< exchange() was not called yet; stepped
    };

    static void converse(Line& line, bool asksForRealTime) noexcept;
    HapticState newest(double now) noexcept;
    HapticState step(FalconRequest request, double now) noexcept;

    FalconLinkOpener      open_;
    FalconDeviceSettings  settings_;
    HapticDeviceInfo      info_;
    std::uint8_t          lights_ = 0;
    std::atomic<bool>     cancel_ = false;
    std::unique_ptr<Line> line_; ///< null: closed
};

} // namespace palp
