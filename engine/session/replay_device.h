#pragma once
#include <cstddef>
#include <vector>

#include "device/haptic_device.h"
#include "engine/session/tick_record.h"

namespace palp {

/// The device of a recorded session: each exchange gives what the next sample had, to the bit, in the scene's frame,
/// whatever the force and the time. After the last sample it is lost. \thread as HapticDevice
class ReplayDevice : public HapticDevice {
public:
    /// \param samples  of RecordedSession; outlive it
    /// \param limits   of the device that was held then
    explicit ReplayDevice(const std::vector<TickRecord>& samples, const HapticDeviceInfo& limits = {});

    [[nodiscard]] const HapticDeviceInfo& info() const noexcept override { return info_; }

    void        open() override {}
    void        close() noexcept override {}
    HapticState exchange(const GovernedForce& force, double now) noexcept override;

private:
    const std::vector<TickRecord>& samples_;
    HapticDeviceInfo               info_;
    std::size_t                    next_ = 0;
};

} // namespace palp
