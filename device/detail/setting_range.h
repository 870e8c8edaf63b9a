#pragma once
#include <string>

#include "engine/core/contract.h"

namespace palp {

/// Checks a setting.
/// \throws Error naming the device and its setting if the value is out of its range or not a number
inline void demandRange(const char* device, const char* setting, double value, double least, double most)
{
    if (!(value >= least && value <= most))
        throw Error(std::string(device) + ": " + setting + " must be from " + std::to_string(least) + " to " +
                    std::to_string(most) + ", found " + std::to_string(value));
}

} // namespace palp
