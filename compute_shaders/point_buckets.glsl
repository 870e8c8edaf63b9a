// point_buckets.glsl - scattered points as the kernels that sample them are given them, at bindings 0 to 2; see
// point_layout.h. What they write, at bindings 3 and 4, is alike, too.

#include "compute_shaders/plate_prelude.glsl"
#include "compute_shaders/shared/point_layout.h"

layout(std430, binding = 0) readonly buffer Layout { PointLayout grid; };
layout(std430, binding = 1) readonly buffer Starts { uint starts[]; };
layout(std430, binding = 2) readonly buffer Points { ScatteredPoint points[]; };
layout(std430, binding = 3) writeonly buffer Rigidity { float D[]; };
layout(std430, binding = 4) writeonly buffer Without { uint without[]; };

int bucketStart(int n) { return int(starts[n]); }
float pointX(int n) { return points[n].x; }
float pointZ(int n) { return points[n].z; }
float pointLogarithm(int n) { return points[n].logarithm; }
uint pointNumber(int n) { return points[n].number; }

#include "compute_shaders/shared/nearest_point.h"
