// region_layout.h - the square regions of plate_down.comp, plate_up.comp and plate_sweep.comp (GLSL and C++).
#ifndef PALPATE_REGION_LAYOUT_H
#define PALPATE_REGION_LAYOUT_H

#ifdef __cplusplus
namespace palp::shared {
#endif

const int kRegion      = 44; // nodes along either side; even; of a colour at most one for each of 1024 invocations
const int kRimPerSweep = 4;  // nodes along each side that others own: two per half sweep
const int kGathered =
    4; // nodes on either side of a coarse one from which its force is gathered, see transfer_table.cpp

#ifdef __cplusplus
} // namespace palp::shared
#endif
#endif
