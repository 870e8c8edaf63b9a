#include "device/vendor/detail/drd_device.h"

namespace palp {
namespace {

constexpr std::size_t kReset = 3; ///< of a status: the device has to be reset

} // namespace

DrdDevice openDrd(const DrdLibrary& drd, int index) noexcept
{
    DrdDevice device{drd.drdOpenID(char(index)), true};
    if (device.id < 0) device = {drd.dhdOpenID(char(index)), false};
    if (device.id >= 0) device.type = drd.dhdGetSystemType(char(device.id));
    return device;
}

void closeDrd(const DrdLibrary& drd, DrdDevice& device) noexcept
{
    if (device.id < 0) return;
    device.isRobot ? drd.drdClose(char(device.id)) : drd.dhdClose(char(device.id));
    device = {};
}

bool isHomed(const DrdLibrary& drd, const DrdDevice& device, const DrdStatus& status) noexcept
{
    const bool asksRobot = device.isRobot && device.type != kDrdFalcon; // which the functions drd* cannot move
    return status[kReset] == 0 && (!asksRobot || drd.drdIsInitialized(char(device.id)));
}

bool isHomed(const DrdLibrary& drd, const DrdDevice& device) noexcept
{
    DrdStatus status{};
    return drd.dhdGetStatus(status.data(), char(device.id)) >= 0 && isHomed(drd, device, status);
}

} // namespace palp
