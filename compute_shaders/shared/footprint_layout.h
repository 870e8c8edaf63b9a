// footprint_layout.h - loads on few nodes as 32-bit words, and what each feels (GLSL and C++).
//
//   kFootprintHead words per load   where its parts begin, counted in words from the buffer's beginning; how many
//   kPartWords words per part       node; as floats the force and its changes as the load moves along x and z
#ifndef PALPATE_FOOTPRINT_LAYOUT_H
#define PALPATE_FOOTPRINT_LAYOUT_H

#ifdef __cplusplus
namespace palp::shared {
#endif

const int kFootprintHead = 2;
const int kPartWords     = 4;

// The answer for a load, as real numbers in the units of the solver.
const int kResponseWords   = 3;
const int kResponseWork    = 0; // (f + r, x)
const int kResponseChangeX = 1; // (change along x, x)
const int kResponseChangeZ = 2;

#ifdef __cplusplus
} // namespace palp::shared
#endif
#endif
