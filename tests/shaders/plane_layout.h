// What C++ and the test shaders agree on for planes of numbers, stored row by row, x fastest.
#ifdef __cplusplus
#pragma once
#include <cstdint>
namespace palp::shared {
using uint = std::uint32_t;
#endif

struct PlanePush {
    uint  nx, ny; // nodes [1]
    float scale;  // [1]
};

#ifdef __cplusplus
static_assert(sizeof(PlanePush) == 12);
} // namespace palp::shared
#endif
