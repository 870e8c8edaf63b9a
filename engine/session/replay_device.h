#pragma once
#include <cstddef>
#include <vector>

#include "device/haptic_device.h"
#include "engine/session/tick_record.h"

namespace palp {

/// Plays the device of a recorded session: each exchange returns the hand of the next record, to the bit and in the
/// scene's frame, for any force and time. After the last record the device counts as lost.
/// \thread as HapticDevice
class ReplayDevice : public HapticDevice {
public:
    /// \param records  of RecordedSession; outlive this
    /// \param limits   of the device that was held then
    explicit ReplayDevice(const std::vector<TickRecord>& records, const HapticDeviceInfo& limits = {});

    [[nodiscard]] const HapticDeviceInfo& info() const noexcept override { return info_; }

    void        open() override {}
    void        close() noexcept override {}
    HapticState read(double now) noexcept override;
    void        render(const GovernedForce& /*force*/) noexcept override {} ///< moves nothing

private:
    const std::vector<TickRecord>& records_;
    HapticDeviceInfo               info_;
    std::size_t                    next_ = 0;
};

} // namespace palp
