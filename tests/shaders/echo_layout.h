// Push constants of layout_echo.comp, read by C++ and by GLSL: one definition, so that a field cannot move on one side.
#ifdef __cplusplus
#pragma once
#include <cstdint>
namespace palp::shared {
using uint = std::uint32_t;
#endif

struct EchoPush {
    uint  columns; // [1]
    float spacing; // [m]
    uint  rows;    // [1]
    float offset;  // [m]
    int   shift;   // [1]
};

#ifdef __cplusplus
static_assert(sizeof(EchoPush) == 20);
} // namespace palp::shared
#endif
