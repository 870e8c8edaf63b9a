#pragma once
#include "device/device_record.h"

namespace palp {

extern const DeviceRecord kBridgeRecord;     ///< any device with the bridge's report
extern const DeviceRecord kSpaceMouseRecord; ///< 3Dconnexion's caps with six axes

} // namespace palp
