#pragma once
#include <cstdint>
#include <vector>

#include "engine/compute/kernel.h"
#include "tests/shaders/plane_accumulate.spv.h"
#include "tests/shaders/plane_layout.h"
#include "tests/shaders/plane_smooth.spv.h"
#include "tests/shaders/plane_smooth_past_end.spv.h"
#include "tests/shaders/plane_smooth_short.spv.h"

namespace palp {

inline constexpr int                 kPlanePushBytes = sizeof(shared::PlanePush);
inline constexpr compute::KernelCode kSmooth{"plane_smooth", plane_smooth_spv, 2, kPlanePushBytes};
inline constexpr compute::KernelCode kSmoothPastEnd{"plane_smooth_past_end", plane_smooth_past_end_spv, 2,
                                                    kPlanePushBytes};
inline constexpr compute::KernelCode kSmoothShort{"plane_smooth_short", plane_smooth_short_spv, 2, kPlanePushBytes};
inline constexpr compute::KernelCode kAccumulate{"plane_accumulate", plane_accumulate_spv, 2, kPlanePushBytes};

/// Values in (-1, 1) that look random and are the same everywhere.
inline std::vector<float> roughPlane(std::uint32_t nx, std::uint32_t ny)
{
    std::vector<float> values(std::size_t(nx) * ny);
    std::uint32_t      state = 12345;
    for (float& value : values) {
        state = state * 1664525u + 1013904223u; // Numerical Recipes
        value = float(std::int32_t(state)) / 2147483648.0f;
    }
    return values;
}

/// plane_smooth.comp in C++, in the same order of operations.
inline std::vector<float> smoothed(const std::vector<float>& source, const shared::PlanePush& push, std::uint32_t bias)
{
    std::vector<float> target(source.size());
    for (std::size_t y = 0; y < push.ny; ++y)
        for (std::size_t x = 0; x < push.nx; ++x) {
            const float* row   = source.data() + y * push.nx;
            const float  left  = row[x > 0 ? x - 1 : x];
            const float  right = row[x + 1 < push.nx ? x + 1 : x];
            const float  mean  = (left + row[x] + right) * (1.0f / 3.0f);

            target[y * push.nx + x] = mean * push.scale + float(bias);
        }
    return target;
}

} // namespace palp
