// transfer_layout.h - layout of the transfer tables of one axis between two levels (GLSL and C++).
//
//   entry of a fine node     first coarse node, kFineWeights weights       (kFineStride numbers)
//   entry of a coarse node   first fine node, kCoarseWeights weights       (kCoarseStride numbers, after the fine ones)
#ifndef PALPATE_TRANSFER_LAYOUT_H
#define PALPATE_TRANSFER_LAYOUT_H

#ifdef __cplusplus
namespace palp::shared {
#endif

const int kFineWeights   = 4;
const int kFineStride    = 5;
const int kCoarseWeights = 8;
const int kCoarseStride  = 9;

#ifdef __cplusplus
} // namespace palp::shared
#endif
#endif
